# Made by smachac 0.1.0 from main.yml (sha256 205e7c6b3d0fea7c).
"""The state machine `delivery_round`."""

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


class PrintUserdataState(smach.State):
    """Prints the input keys and their values, one key per line."""

    def __init__(self, input_keys=()):
        super().__init__(outcomes=["succeeded"], input_keys=list(input_keys))
        self.printed_keys = sorted(input_keys)

    def execute(self, userdata):
        for key in self.printed_keys:
            print(f"{key}: {userdata[key]}")
        return "succeeded"


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


def build():
    """Build the state machine `delivery_round`."""
    delivery_round = smach.StateMachine(outcomes=["done", "aborted", "preempted"])  # main.yml:2
    delivery_round.userdata.rooms = [12, 14, 17]
    delivery_round.userdata.failed_rooms = 0
    with delivery_round:
        sm_check_robot = smach.Concurrence(  # main.yml:10
            outcomes=["ready", "not_ready"],
            default_outcome="not_ready",
            outcome_map={
                "ready": {
                    "CHECK_BATTERY": "charged",
                    "CHECK_LASER": "succeeded",
                    "CHECK_DRAWERS": "locked",
                },
            },
        )
        with sm_check_robot:
            smach.Concurrence.add(  # main.yml:18
                "CHECK_BATTERY", ScriptedState(outcomes=["charged", "low"])
            )

            smach.Concurrence.add("CHECK_LASER", SleepState(time=0.01))  # main.yml:19

            smach.Concurrence.add(  # main.yml:20
                "CHECK_DRAWERS", ScriptedState(outcomes=["locked", "open"])
            )

        smach.StateMachine.add(
            "CHECK_ROBOT",
            sm_check_robot,
            transitions={"ready": "FETCH", "not_ready": "CALL_OPERATOR"},
        )

        smach.StateMachine.add(  # main.yml:22
            "FETCH",
            build_hand_over(time=7200.0),
            transitions={
                "done": "VISIT_ROOMS",
                "nobody": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        sm_visit_rooms = smach.Iterator(  # main.yml:27
            outcomes=["visited", "stuck", "preempted"],
            it=lambda: sm_visit_rooms.userdata["rooms"],
            it_label="room",
            exhausted_outcome="exhausted",
            input_keys=["failed_rooms", "rooms"],
            output_keys=["failed_rooms"],
        )
        with sm_visit_rooms:
            sm_visit_rooms_2 = smach.StateMachine(  # main.yml:27
                outcomes=["visited", "stuck", "preempted"],
                input_keys=["room", "failed_rooms"],
                output_keys=["failed_rooms"],
            )
            with sm_visit_rooms_2:
                smach.StateMachine.add(  # main.yml:35
                    "PLAN_PATH",
                    PrintUserdataState(input_keys=["room"]),
                    transitions={"succeeded": "DRIVE"},
                )

                smach.StateMachine.add(  # main.yml:39
                    "DRIVE",
                    with_retries(
                        with_timeout(
                            ScriptedState(outcomes=["arrived", "blocked"]), 300.0, "DRIVE"
                        ),
                        3,
                        on=["blocked", "timeout"],
                        delay=0.01,
                        label="TIMED",
                    ),
                    transitions={
                        "arrived": "KNOCK",
                        "exhausted": "STEP_BACK",
                        "preempted": "preempted",
                    },
                )

                smach.StateMachine.add(  # main.yml:45
                    "KNOCK",
                    SleepState(time=0.01),
                    transitions={"succeeded": "HAND_OVER", "preempted": "preempted"},
                )

                smach.StateMachine.add(  # main.yml:49
                    "HAND_OVER",
                    build_hand_over(time=90.0),
                    transitions={
                        "done": "visited",
                        "nobody": "NOTE_ABSENCE",
                        "preempted": "preempted",
                    },
                )

                smach.StateMachine.add(  # main.yml:53
                    "NOTE_ABSENCE",
                    CallbacksState(
                        callbacks={"failed_rooms": lambda ud: ud.failed_rooms + 1},
                        input_keys=["failed_rooms"],
                        output_keys=["failed_rooms"],
                    ),
                    transitions={"succeeded": "visited"},
                )

                smach.StateMachine.add(  # main.yml:59
                    "STEP_BACK",
                    ScriptedState(outcomes=["free", "jammed"]),
                    transitions={"free": "NOTE_ABSENCE", "jammed": "stuck"},
                )

            smach.Iterator.set_contained_state(
                "VISIT_ROOMS",
                sm_visit_rooms_2,
                loop_outcomes=["visited"],
                final_outcome_map={"exhausted": "visited", "visited": "preempted"},
            )

        smach.StateMachine.add(
            "VISIT_ROOMS",
            ends_preempted(sm_visit_rooms),
            transitions={
                "visited": "GO_HOME",
                "stuck": "CALL_OPERATOR",
                "preempted": "preempted",
                "exhausted": "GO_HOME",
            },
        )

        smach.StateMachine.add(  # main.yml:64
            "GO_HOME",
            with_retries(
                with_timeout(ScriptedState(outcomes=["arrived", "blocked"]), 300.0, "GO_HOME"),
                3,
                on=["blocked"],
                label="TIMED",
            ),
            transitions={
                "arrived": "DOCK",
                "timeout": "CALL_OPERATOR",
                "exhausted": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:71
            "DOCK",
            with_retries(
                ScriptedState(outcomes=["docked", "missed"]),
                5,
                on=["missed"],
                delay=0.01,
                label="DOCK",
            ),
            transitions={
                "docked": "CHARGE",
                "exhausted": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:76
            "CHARGE",
            with_timeout(ScriptedState(outcomes=["full", "no_current"]), 7200.0, "CHARGE"),
            transitions={
                "full": "done",
                "no_current": "DOCK_AGAIN",
                "timeout": "CALL_OPERATOR",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:82
            "DOCK_AGAIN",
            ScriptedState(outcomes=["docked", "missed"]),
            transitions={"docked": "done", "missed": "CALL_OPERATOR"},
        )

        smach.StateMachine.add(  # main.yml:86
            "CALL_OPERATOR",
            PrintUserdataState(input_keys=["failed_rooms"]),
            transitions={"succeeded": "aborted"},
        )
    pass_on_stop_requests(delivery_round)
    return delivery_round


def build_hand_over(time):
    """Build the state machine of `hand_over.yml`."""
    sm_hand_over = smach.StateMachine(outcomes=["done", "nobody", "preempted"])
    with sm_hand_over:
        smach.StateMachine.add(  # hand_over.yml:6
            "OPEN_DRAWER",
            with_retries(
                ScriptedState(outcomes=["open", "jammed"]), 2, on=["jammed"], label="OPEN_DRAWER"
            ),
            transitions={
                "open": "WAIT_FOR_PERSON",
                "exhausted": "nobody",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # hand_over.yml:11
            "WAIT_FOR_PERSON",
            with_timeout(ScriptedState(outcomes=["pressed"]), time, "WAIT_FOR_PERSON"),
            transitions={
                "pressed": "CLOSE_DRAWER",
                "timeout": "GIVE_UP",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # hand_over.yml:16
            "CLOSE_DRAWER", ScriptedState(outcomes=["closed"]), transitions={"closed": "done"}
        )

        smach.StateMachine.add(  # hand_over.yml:20
            "GIVE_UP", ScriptedState(outcomes=["closed"]), transitions={"closed": "nobody"}
        )
    return sm_hand_over


def main():
    """Run the state machine once and return its outcome."""
    delivery_round = build()
    if __name__ == "__main__":
        signals.stop_at_signals(delivery_round)
    return delivery_round.execute()


if __name__ == "__main__":
    outcome = main()
    print(f"outcome: {outcome}")
    raise SystemExit(signals.exit_code(outcome is None))
