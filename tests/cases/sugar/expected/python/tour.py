# Made by smachac 0.1.0 from main.yml (sha256 20f3bf8389600712).
"""The state machine `tour`."""

from smachac.runtime import signals
from smachac.runtime.additions import (
    SleepState,
    ends_preempted,
    pass_on_stop_requests,
    with_retries,
    with_timeout,
)

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


class CallbacksState(smach.State):
    """Calls functions of the userdata and writes each result to an output key."""

    def __init__(self, callbacks=(), input_keys=(), output_keys=()):
        super().__init__(
            outcomes=["succeeded"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.callbacks = callbacks

    def execute(self, userdata):
        for key in sorted(self.callbacks):
            function = self.callbacks[key]
            if not smach.has_smach_interface(function):
                userdata[key] = function(userdata)
            else:  # the function writes its output keys
                inputs = function.get_registered_input_keys()
                outputs = function.get_registered_output_keys()
                function(smach.Remapper(userdata, inputs, outputs, {}))
        return "succeeded"


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
    """Build the state machine `tour`."""
    tour = smach.StateMachine(outcomes=["done", "failed", "stopped"])  # main.yml:1
    tour.userdata.waypoints = [1, 2, 3]
    tour.userdata.count = 0
    with tour:
        smach.StateMachine.add(  # main.yml:6
            "LOOK",
            with_retries(
                with_timeout(
                    ScriptedState(
                        outcomes=["succeeded", "aborted", "preempted"],
                        steps=[{"outcome": "aborted"}, {"outcome": "succeeded"}],
                    ),
                    20.0,
                    "LOOK",
                ),
                3,
                on=["aborted", "timeout"],
                delay=0.1,
                label="TIMED",
            ),
            transitions={"succeeded": "VISIT", "exhausted": "failed", "preempted": "stopped"},
        )

        sm_visit = smach.Iterator(  # main.yml:13
            outcomes=["succeeded", "preempted"],
            it=lambda: sm_visit.userdata["waypoints"],
            it_label="goal",
            exhausted_outcome="exhausted",
            input_keys=["total", "waypoints"],
            output_keys=["total"],
        )
        with sm_visit:
            smach.Iterator.set_contained_state(  # main.yml:13
                "VISIT",
                CallbacksState(
                    callbacks={"total": lambda ud: ud.total + ud.goal},
                    input_keys=["goal", "total"],
                    output_keys=["total"],
                ),
                loop_outcomes=["succeeded"],
                final_outcome_map={"exhausted": "succeeded", "succeeded": "preempted"},
            )

        smach.StateMachine.add(
            "VISIT",
            ends_preempted(sm_visit),
            transitions={"succeeded": "HASTE", "preempted": "stopped", "exhausted": "HASTE"},
            remapping={"total": "count"},
        )

        # It takes longer than it may.
        smach.StateMachine.add(  # main.yml:21
            "HASTE",
            with_timeout(SleepState(time=60), 0.05, "HASTE"),
            transitions={"timeout": "TRIES", "succeeded": "failed", "preempted": "stopped"},
        )

        sm_tries = smach.StateMachine(outcomes=["again", "good"])  # main.yml:27
        with sm_tries:
            smach.StateMachine.add(  # main.yml:32
                "HOPE", ScriptedState(outcomes=["again"]), transitions={"again": "again"}
            )

        smach.StateMachine.add(
            "TRIES",
            with_retries(sm_tries, 2, on=["again"], label="TRIES"),
            transitions={"good": "failed", "exhausted": "WITHOUT", "preempted": "stopped"},
        )

        sm_without = smach.Iterator(  # main.yml:36
            outcomes=["succeeded", "preempted"],
            it=[],
            it_label="unused",
            exhausted_outcome="exhausted",
            input_keys=[],
            output_keys=[],
        )
        with sm_without:
            smach.Iterator.set_contained_state(  # main.yml:36
                "WITHOUT",
                SleepState(time=0.01),
                loop_outcomes=["succeeded"],
                final_outcome_map={"exhausted": "succeeded", "succeeded": "preempted"},
            )

        smach.StateMachine.add(
            "WITHOUT",
            ends_preempted(sm_without),
            transitions={"succeeded": "EACH", "preempted": "stopped", "exhausted": "EACH"},
        )

        sm_each = smach.Iterator(  # main.yml:41
            outcomes=["found", "preempted", "exhausted"],
            it=["a", "b"],
            it_label="unused",
            exhausted_outcome="exhausted_2",
            input_keys=[],
            output_keys=[],
        )
        with sm_each:
            smach.Iterator.set_contained_state(  # main.yml:41
                "TRIES",
                with_retries(
                    ScriptedState(
                        outcomes=["found", "lost", "preempted"],
                        steps=[{"outcome": "lost"}, {"outcome": "lost"}, {"outcome": "found"}],
                    ),
                    2,
                    on=["lost"],
                    label="EACH",
                ),
                loop_outcomes=["exhausted"],
                final_outcome_map={"exhausted_2": "exhausted", "exhausted": "preempted"},
            )

        smach.StateMachine.add(
            "EACH",
            ends_preempted(sm_each),
            transitions={
                "found": "SHOW",
                "exhausted": "failed",
                "preempted": "stopped",
                "exhausted_2": "failed",
            },
        )

        smach.StateMachine.add(  # main.yml:48
            "SHOW", PrintUserdataState(input_keys=["count"]), transitions={"succeeded": "done"}
        )
    pass_on_stop_requests(tour)
    return tour


def main():
    """Run the state machine once and return its outcome."""
    tour = build()
    if __name__ == "__main__":
        signals.stop_at_signals(tour)
    return tour.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
