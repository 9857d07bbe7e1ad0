# Made by smachac 0.1.0 from main.yml (sha256 c4726401d5de566f).
"""The state machine `sm`."""

import threading

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class SleepState(smach.State):
    """Waits for `time` seconds: a number, or a function of the userdata.

    A preempt request ends the wait.
    """

    def __init__(self, time, input_keys=(), outcomes=("succeeded", "preempted")):
        super().__init__(
            outcomes=list(outcomes),
            input_keys=list(input_keys),
        )
        self.time = time
        self.end_of_wait = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.end_of_wait.set()

    def execute(self, userdata):
        self.end_of_wait.wait(self.time(userdata) if callable(self.time) else self.time)
        self.end_of_wait.clear()
        if self.preempt_requested() and "preempted" in self.get_registered_outcomes():
            self.service_preempt()
            return "preempted"
        return "succeeded"


def build():
    """Build the state machine `sm`."""
    # main.yml:2
    sm = smach.StateMachine(outcomes=["succeeded"])
    with sm:
        # main.yml:6
        smach.StateMachine.add(
            "SHORT",
            SleepState(time=0.5),
            transitions={"succeeded": "LONG", "preempted": "succeeded"},
        )

        # main.yml:7
        smach.StateMachine.add(
            "LONG",
            SleepState(time=5),
            transitions={"succeeded": "succeeded", "preempted": "succeeded"},
        )
    return sm


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
