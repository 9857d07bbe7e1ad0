# Made by smachac 0.1.0 from main.yml (sha256 902e49a7a704b304).
"""The state machine `sm`."""

from smachac.runtime import signals

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


def build():
    """Build the state machine `sm`."""
    sm = smach.StateMachine(outcomes=["done"])  # main.yml:2
    with sm:
        smach.StateMachine.add("C0", build_c0(), transitions={"done": "done"})  # main.yml:6
    return sm


def build_c0():
    """Build the state machine `C0`."""
    sm_c0 = smach.StateMachine(outcomes=["done"])
    with sm_c0:
        sm_c1 = smach.StateMachine(outcomes=["done"])  # main.yml:10
        with sm_c1:
            sm_c2 = smach.StateMachine(outcomes=["done"])  # main.yml:14
            with sm_c2:
                smach.StateMachine.add(  # main.yml:18
                    "C3", build_c3(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C2", sm_c2, transitions={"done": "done"})

        smach.StateMachine.add("C1", sm_c1, transitions={"done": "done"})
    return sm_c0


def build_c3():
    """Build the state machine `C3`."""
    sm_c3 = smach.StateMachine(outcomes=["done"])
    with sm_c3:
        sm_c4 = smach.StateMachine(outcomes=["done"])  # main.yml:22
        with sm_c4:
            sm_c5 = smach.StateMachine(outcomes=["done"])  # main.yml:26
            with sm_c5:
                smach.StateMachine.add(  # main.yml:30
                    "C6", build_c6(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C5", sm_c5, transitions={"done": "done"})

        smach.StateMachine.add("C4", sm_c4, transitions={"done": "done"})
    return sm_c3


def build_c6():
    """Build the state machine `C6`."""
    sm_c6 = smach.StateMachine(outcomes=["done"])
    with sm_c6:
        sm_c7 = smach.StateMachine(outcomes=["done"])  # main.yml:34
        with sm_c7:
            sm_c8 = smach.StateMachine(outcomes=["done"])  # main.yml:38
            with sm_c8:
                smach.StateMachine.add(  # main.yml:42
                    "C9", build_c9(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C8", sm_c8, transitions={"done": "done"})

        smach.StateMachine.add("C7", sm_c7, transitions={"done": "done"})
    return sm_c6


def build_c9():
    """Build the state machine `C9`."""
    sm_c9 = smach.StateMachine(outcomes=["done"])
    with sm_c9:
        sm_c10 = smach.StateMachine(outcomes=["done"])  # main.yml:46
        with sm_c10:
            sm_c11 = smach.StateMachine(outcomes=["done"])  # main.yml:50
            with sm_c11:
                smach.StateMachine.add(  # main.yml:54
                    "C12", build_c12(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C11", sm_c11, transitions={"done": "done"})

        smach.StateMachine.add("C10", sm_c10, transitions={"done": "done"})
    return sm_c9


def build_c12():
    """Build the state machine `C12`."""
    sm_c12 = smach.StateMachine(outcomes=["done"])
    with sm_c12:
        sm_c13 = smach.StateMachine(outcomes=["done"])  # main.yml:58
        with sm_c13:
            sm_c14 = smach.StateMachine(outcomes=["done"])  # main.yml:62
            with sm_c14:
                smach.StateMachine.add(  # main.yml:66
                    "C15", build_c15(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C14", sm_c14, transitions={"done": "done"})

        smach.StateMachine.add("C13", sm_c13, transitions={"done": "done"})
    return sm_c12


def build_c15():
    """Build the state machine `C15`."""
    sm_c15 = smach.StateMachine(outcomes=["done"])
    with sm_c15:
        sm_c16 = smach.StateMachine(outcomes=["done"])  # main.yml:70
        with sm_c16:
            sm_c17 = smach.StateMachine(outcomes=["done"])  # main.yml:74
            with sm_c17:
                smach.StateMachine.add(  # main.yml:78
                    "C18", build_c18(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C17", sm_c17, transitions={"done": "done"})

        smach.StateMachine.add("C16", sm_c16, transitions={"done": "done"})
    return sm_c15


def build_c18():
    """Build the state machine `C18`."""
    sm_c18 = smach.StateMachine(outcomes=["done"])
    with sm_c18:
        sm_c19 = smach.StateMachine(outcomes=["done"])  # main.yml:82
        with sm_c19:
            sm_c20 = smach.StateMachine(outcomes=["done"])  # main.yml:86
            with sm_c20:
                smach.StateMachine.add(  # main.yml:90
                    "C21", build_c21(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C20", sm_c20, transitions={"done": "done"})

        smach.StateMachine.add("C19", sm_c19, transitions={"done": "done"})
    return sm_c18


def build_c21():
    """Build the state machine `C21`."""
    sm_c21 = smach.StateMachine(outcomes=["done"])
    with sm_c21:
        sm_c22 = smach.StateMachine(outcomes=["done"])  # main.yml:94
        with sm_c22:
            sm_c23 = smach.StateMachine(outcomes=["done"])  # main.yml:98
            with sm_c23:
                smach.StateMachine.add(  # main.yml:102
                    "C24", build_c24(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C23", sm_c23, transitions={"done": "done"})

        smach.StateMachine.add("C22", sm_c22, transitions={"done": "done"})
    return sm_c21


def build_c24():
    """Build the state machine `C24`."""
    sm_c24 = smach.StateMachine(outcomes=["done"])
    with sm_c24:
        sm_c25 = smach.StateMachine(outcomes=["done"])  # main.yml:106
        with sm_c25:
            sm_c26 = smach.StateMachine(outcomes=["done"])  # main.yml:110
            with sm_c26:
                smach.StateMachine.add(  # main.yml:114
                    "C27", build_c27(), transitions={"done": "done"}
                )

            smach.StateMachine.add("C26", sm_c26, transitions={"done": "done"})

        smach.StateMachine.add("C25", sm_c25, transitions={"done": "done"})
    return sm_c24


def build_c27():
    """Build the state machine `C27`."""
    sm_c27 = smach.StateMachine(outcomes=["done"])
    with sm_c27:
        sm_c28 = smach.StateMachine(outcomes=["done"])  # main.yml:118
        with sm_c28:
            sm_c29 = smach.StateMachine(outcomes=["done"])  # main.yml:122
            with sm_c29:
                smach.StateMachine.add(  # main.yml:126
                    "LEAF", ScriptedState(outcomes=["done"]), transitions={"done": "done"}
                )

            smach.StateMachine.add("C29", sm_c29, transitions={"done": "done"})

        smach.StateMachine.add("C28", sm_c28, transitions={"done": "done"})
    return sm_c27


def main():
    """Run the state machine once and return its outcome."""
    sm = build()
    if __name__ == "__main__":
        signals.stop_at_signals(sm)
    return sm.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
