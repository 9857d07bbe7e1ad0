"""What an import of a machine for YASMIN lists, or refuses."""

import sys

from arm_states import Drive
from std_srvs.srv import Trigger
from yasmin import CbState, Concurrence, JoinState, OrthogonalState, State, StateMachine
from yasmin_ros import ServiceState
from yasmin_ros.basic_outcomes import ABORT, SUCCEED, TIMEOUT


class Sleep(State):
    def __init__(self, seconds, *, outcomes=("slept", "woken")):
        super().__init__(outcomes=outcomes)
        self.seconds = seconds


def request(blackboard):
    return Trigger.Request()


class Robot:
    def __init__(self, arm):
        sm = StateMachine(["done", "failed"])
        sm.add_state("CALL", ServiceState(Trigger, "/start", request, response_timeout=2.0),
                     {SUCCEED: "ASK", ABORT: "failed", TIMEOUT: "CALL"})
        sm.add_state("ASK", CbState(["yes", "no"], self.ask), {"yes": "BOTH", "no": "DRIVE"})
        sleep = Sleep(arm, outcomes=["slept", "woken"])
        if arm:
            sleep.set_parameter("depth", 2)
        both = Concurrence(
            {"LEFT": sleep, "RIGHT": Sleep(2)}, "failed",
            {"done": {"LEFT": "slept"}, "half": {"RIGHT": "slept"}},
        )
        sm.add_state("BOTH", both, {"half": "DRIVE"})
        sm.add_state("DRIVE", Drive(arm, speed=2), {"arrived": "done", "lost": "failed"})
        sm.add_end_cb(self.ended)
        self.machine = sm

    def ask(self, blackboard):
        return "yes"

    def ended(self, blackboard, outcome):
        print(outcome)


def together():
    sm = StateMachine(["done"])
    regions = OrthogonalState("done", {"done": {"A": "done", "B": "done"}})
    for name in ("A", "B"):
        region = StateMachine(["done"])
        region.add_state("JOIN", JoinState("middle"), {"joined": "done"})
        regions.add_region(name, region)
    sm.add_state("REGIONS", regions)
    return sm


Robot(sys.argv[1])
together()
