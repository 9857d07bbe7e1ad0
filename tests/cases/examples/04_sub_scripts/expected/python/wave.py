# Made by smachac 0.1.0 from main.yml (sha256 d4b5d1deaa440d73).
"""The state machine `wave`."""

from smachac.runtime import signals

try:
    import smach
except ImportError:  # without SMACH: smachac.runtime has the same names
    from smachac.runtime import smach


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


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
    """Build the state machine `wave`."""
    wave = smach.StateMachine(outcomes=["succeeded", "aborted"])  # main.yml:2
    with wave:
        smach.StateMachine.add(  # main.yml:9
            "WAVE_LEFT",
            build_wave(topic="/left/joint_command", times=2),
            transitions={"succeeded": "WAVE_RIGHT", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:14
            "WAVE_RIGHT",
            build_wave(topic="/right/joint_command", times=3),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return wave


def build_wave(topic, times):
    """Build the state machine of `wave.yml`."""
    sm_wave = smach.StateMachine(outcomes=["succeeded", "aborted"])
    sm_wave.userdata.topic = topic
    sm_wave.userdata.times = times
    with sm_wave:
        smach.StateMachine.add(  # wave.yml:10
            "TELL",
            PrintUserdataState(input_keys=["topic", "times"]),
            transitions={"succeeded": "MOVE"},
        )

        smach.StateMachine.add(  # wave.yml:14
            "MOVE",
            ScriptedState(outcomes=["succeeded", "aborted"]),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return sm_wave


def main():
    """Run the state machine once and return its outcome."""
    wave = build()
    if __name__ == "__main__":
        signals.stop_at_signals(wave)
    return wave.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
