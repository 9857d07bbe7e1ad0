# Made by smachac 0.1.0 from main.yml (sha256 4fc28c8251492587).
"""The state machine `code_in_both`."""

import sys

from smachac.runtime import signals

try:
    from arm_skills.carry import Carry
except ModuleNotFoundError as error:
    modules = ["arm_skills", "arm_skills.carry"]
    if __name__ != "__main__" or error.name not in modules:
        raise
    searched = "\n  ".join(sys.path)
    raise SystemExit(
        f"{error}; it was searched in these folders:\n  {searched}\n"
        "Add the folder that contains it to PYTHONPATH."
    ) from None

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


def build():
    """Build the state machine `code_in_both`."""
    code_in_both = smach.StateMachine(outcomes=["done", "lost"])  # main.yml:2
    code_in_both.userdata.shelf = [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]
    code_in_both.userdata.table = [[0.5, 0.3, 0.0], [0.0, 0.0, 0.0, 1.0]]
    with code_in_both:
        smach.StateMachine.add(  # main.yml:10
            "CARRY",
            Carry(speed=0.5),
            transitions={"done": "done", "not-found": "lost", "preempted": "lost"},
            remapping={"from": "shelf", "into": "table"},
        )
    return code_in_both


def main():
    """Run the state machine once and return its outcome."""
    code_in_both = build()
    if __name__ == "__main__":
        signals.stop_at_signals(code_in_both)
    return code_in_both.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
