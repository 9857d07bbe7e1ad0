"""Rare parts of behaviors of FlexBE."""

from flexbe_core import Autonomy, Behavior, EventState, Logger, OperatableStateMachine
from flexbe_states.calculation_state import CalculationState
from flexbe_states.decision_state import DecisionState
from flexbe_states.log_state import LogState
from unknown_states.drive_state import DriveState
from unknown_behaviors.dock_sm import DockSM


class Count(EventState):
    def __init__(self, outcomes, limit=1):
        super().__init__(outcomes=["more", "preempted"], io_keys=["n"], output_keys=["last"])
        self.limit = limit

    def execute(self, userdata):
        userdata.n = userdata.last = userdata.n + 1
        return "more" if userdata.n < self.limit else "preempted"


def double(value):
    return value * 2


class TaskSM(Behavior):
    def __init__(self, node):
        super().__init__()
        self.name = "Task"
        self.add_parameter("limit", 4)
        self.add_parameter("place", {"x": 1.5})
        self.add_behavior(DockSM, "Dock", node)

    def create(self):
        _state_machine = OperatableStateMachine(outcomes=["finished"], output_keys=["n"])
        _state_machine.userdata.n = 1
        _state_machine.userdata.pose = self.place
        slow = Count([], limit=self.limit)
        slow.set_rate(2)
        with _state_machine:
            OperatableStateMachine.add(
                "Log",
                LogState(text="hello", severity=Logger.REPORT_HINT),
                transitions={"done": "Double"},
                autonomy={"done": Autonomy.Off},
            )
            OperatableStateMachine.add(
                "Double",
                CalculationState(calculation=double),
                transitions={"done": "Count"},
                autonomy={"done": Autonomy.Low},
                remapping={"input_value": "n", "output_value": "n"},
            )
            OperatableStateMachine.add(
                "Count",
                slow,
                transitions={"more": "Decide"},
                autonomy={"more": Autonomy.Off},
                remapping={"n": "n", "other": "n"},
            )
            OperatableStateMachine.add(
                "Decide",
                DecisionState(outcomes=["up", "down"], conditions=lambda x: "up" if x else "down"),
                transitions={"up": "Drive", "down": "Dock"},
                autonomy={"up": Autonomy.Full, "down": Autonomy.High},
                remapping={"input_value": "last"},
            )
            OperatableStateMachine.add(
                "Drive",
                DriveState(speed=2, topic="a/b.c"),
                transitions={"arrived": "finished", "blocked": "preempted"},
                autonomy={"arrived": Autonomy.Off, "blocked": Autonomy.Off},
                remapping={"goal": "pose"},
            )
            OperatableStateMachine.add(
                "Dock",
                self.use_behavior(DockSM, "Dock"),
                transitions={"finished": "finished"},
                autonomy={"finished": Autonomy.Inherit},
            )
        return _state_machine
