# Made by smachac 0.1.0 from main.yml (sha256 6937b7d348686a85).
"""The state machine `patrol`."""

try:
    import smach
except ImportError:  # no ROS on this machine: the same names without it
    from smachac.runtime import smach


class ScriptedState(smach.State):
    """Ends as it is told: visit n does step n, the last step is repeated.

    Asked to stop, it ends as `preempted` where it has that outcome.
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
    """Prints its input keys, one a line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


def build():
    """Build the state machine `patrol`."""
    # main.yml:2
    patrol = smach.StateMachine(outcomes=["succeeded", "aborted"])
    patrol.userdata.waypoints = ["door", "window", "shelf"]
    with patrol:
        # main.yml:9
        sm_visit_all = smach.Iterator(
            outcomes=["all_seen", "blocked", "preempted"],
            it=lambda: sm_visit_all.userdata["waypoints"],
            it_label="waypoint",
            exhausted_outcome="all_seen",
            input_keys=["waypoints"],
        )
        with sm_visit_all:
            # main.yml:20
            sm_visit = smach.StateMachine(
                outcomes=["seen", "blocked"],
                input_keys=["waypoint"],
            )
            with sm_visit:
                # main.yml:25
                smach.StateMachine.add(
                    "DRIVE",
                    ScriptedState(outcomes=["arrived", "blocked"]),
                    transitions={"arrived": "LOOK", "blocked": "blocked"},
                )

                # main.yml:29
                smach.StateMachine.add(
                    "LOOK",
                    PrintUserdataState(input_keys=["waypoint"]),
                    transitions={"succeeded": "seen"},
                )

            smach.Iterator.set_contained_state(
                "VISIT",
                sm_visit,
                loop_outcomes=["seen"],
                final_outcome_map={"seen": "preempted"},
            )

        smach.StateMachine.add(
            "VISIT_ALL",
            sm_visit_all,
            transitions={
                "all_seen": "succeeded",
                "blocked": "aborted",
                "preempted": "aborted",
            },
        )
    return patrol


def main():
    """Run the state machine once and return its outcome."""
    return build().execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(outcome is None)
