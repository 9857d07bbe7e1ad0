# Made by smachac 0.1.0 from main.yml (sha256 6937b7d348686a85).
"""The state machine `patrol`."""

from smachac.runtime import signals
from smachac.runtime.additions import pass_on_stop_requests

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class ScriptedState(smach.State):
    """Ends with scripted outcomes: visit n performs step n; the last step repeats.

    After a preempt request, the outcome is `preempted` if the state has that outcome.
    """

    def __init__(self, outcomes, steps=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=outcomes,
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.steps = list(steps) or [{"outcome": outcomes[0]}]
        self.visits = 0

    def execute(self, userdata):
        step = self.steps[min(self.visits, len(self.steps) - 1)]
        self.visits += 1
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        for key, value in step.get("set", {}).items():
            userdata[key] = value
        return step["outcome"]


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


def build():
    """Build the state machine `patrol`."""
    patrol = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    patrol.userdata.waypoints = ["door", "window", "shelf"]
    with patrol:
        sm_visit_all = smach.Iterator(  # main.yml:9
            outcomes=["all_seen", "blocked", "preempted"],
            it=lambda: sm_visit_all.userdata["waypoints"],
            it_label="waypoint",
            exhausted_outcome="all_seen",
            input_keys=["waypoints"],
            output_keys=[],
        )
        with sm_visit_all:
            sm_visit = smach.StateMachine(  # main.yml:20
                outcomes=["seen", "blocked"], input_keys=["waypoint"]
            )
            with sm_visit:
                smach.StateMachine.add(  # main.yml:25
                    "DRIVE",
                    ScriptedState(outcomes=["arrived", "blocked"]),
                    transitions={"arrived": "LOOK", "blocked": "blocked"},
                )

                smach.StateMachine.add(  # main.yml:29
                    "LOOK",
                    PrintUserdataState(input_keys=["waypoint"]),
                    transitions={"succeeded": "seen"},
                )

            smach.Iterator.set_contained_state(
                "VISIT", sm_visit, loop_outcomes=["seen"], final_outcome_map={"seen": "preempted"}
            )

        smach.StateMachine.add(
            "VISIT_ALL",
            sm_visit_all,
            transitions={"all_seen": "succeeded", "blocked": "aborted", "preempted": "aborted"},
        )
    pass_on_stop_requests(patrol)
    return patrol


def main():
    """Run the state machine once and return its outcome."""
    patrol = build()
    if __name__ == "__main__":
        signals.stop_at_signals(patrol)
    return patrol.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
