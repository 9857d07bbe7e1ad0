"""ActionServerWrapper of smach_ros2, called by a plain client of rclpy."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

MACHINE = """
import sys
from machine_node import *

class Count(smach.State):
    '''Ends as the goal states: 1 succeeded, 2 aborted, 3 an error, 4 when it is preempted.'''

    def __init__(self):
        super().__init__(["succeeded", "aborted", "preempted"], ["order"], ["action_result"])
        self.feedback = Fibonacci.Feedback(sequence=[7])
        self.register_output_keys(["action_feedback"])

    def execute(self, ud):
        ud.action_feedback = self.feedback
        ud.action_result = Fibonacci.Result(sequence=[ud.order])
        if ud.order == 3:
            raise ValueError("the state fails")
        if ud.order == 4:
            report("runs")
            requested = lambda ud: self.preempt_requested()
            smach_ros.ConditionState(node, requested, max_checks=-1).execute(ud)
            self.service_preempt()
            return "preempted"
        return {1: "succeeded", 2: "aborted"}[ud.order]

ends = ["succeeded", "aborted", "preempted"]
inner = smach.StateMachine(ends, ["order"], ["action_result", "action_feedback"])
with inner:
    smach.StateMachine.add("COUNT", Count())
machine = smach.StateMachine(ends, output_keys=["action_result"])
with machine:
    smach.StateMachine.add("PART", inner, {"succeeded": "LAST"})
    smach.StateMachine.add("LAST", smach.CBState(lambda ud: "succeeded", outcomes=["succeeded"]))
wrapper = smach_ros.ActionServerWrapper(
    node, "machine", Fibonacci, machine, ["succeeded"], ["aborted"], ["preempted"],
    expand_goal_slots=True,
)
report("serves")
sys.stdin.readline()
"""


def test_the_end_of_the_machine_is_the_end_of_the_goal(graph2: Graph) -> None:
    program = graph2.start(MACHINE)
    caller = graph2.node("caller")
    caller.say("1")
    lines = {caller.expect("") for _ in range(3)}  # rclpy does not order them
    assert lines == {"accepted", "feedback [7]", "ended succeeded [1]"}
    caller.say("2")
    caller.expect("ended aborted [2]")
    caller.say("3")
    caller.expect("ended aborted []")
    caller.say("1")
    caller.expect("ended succeeded [1]")
    program.say("end")
    assert program.end() == 0, program.output
    assert "ValueError: the state fails" in program.output
    assert "threads left: []" in program.output


def test_a_cancel_request_preempts_the_machine(graph2: Graph) -> None:
    program = graph2.start(MACHINE)
    caller = graph2.node("caller")
    for _ in range(2):
        caller.say("4")
        caller.expect("accepted")
        program.expect("runs")
        caller.say("cancel")
        caller.expect("ended canceled [4]")
    caller.say("4")
    caller.expect("accepted")
    caller.say("cancel")
    assert caller.expect("ended").startswith("ended canceled")


def test_a_new_goal_preempts_the_one_that_runs(graph2: Graph) -> None:
    program = graph2.start(MACHINE)
    caller = graph2.node("caller")
    caller.say("4")
    program.expect("runs")
    caller.say("1")
    assert caller.expect("ended") == "ended aborted [4]"
    assert caller.expect("ended") == "ended succeeded [1]"


def test_paths_of_active_states(graph2: Graph) -> None:
    output = graph2.run(
        MACHINE.replace("sys.stdin.readline()", "")
        + """
from smachac.runtime.container_tree import active_paths
seen = []
for each in machine, inner:
    each.register_start_cb(lambda ud, states: seen.append(active_paths("/", machine)))
    each.register_transition_cb(lambda ud, states: seen.append(active_paths("/", machine)))
machine.userdata.order = 1
inner.register_input_keys(["order"])
report("outcome", machine.execute())
report("paths", seen)
"""
    )
    assert "paths: [['/PART'], ['/PART/COUNT'], ['/LAST']]" in output


FAILING = """
import sys
from machine_node import *

class Wrapper(smach_ros.ActionServerWrapper):
    def execute_cb(self, goal_handle):
        if goal_handle.request.order == 1:
            goal_handle.succeed()
        raise ValueError("this fails")

machine = smach.StateMachine(["succeeded"])
with machine:
    smach.StateMachine.add("ONLY", smach.CBState(lambda ud: "succeeded", outcomes=["succeeded"]))
wrapper = Wrapper(node, "machine", Fibonacci, machine, ["succeeded"])
report("serves")
sys.stdin.readline()
"""


def test_an_error_after_the_end_of_a_goal_is_logged(graph2: Graph) -> None:
    program = graph2.start(FAILING)
    caller = graph2.node("caller")
    caller.say("1")
    caller.expect("ended succeeded []")  # a goal that has succeeded cannot be aborted
    caller.say("2")
    caller.expect("ended aborted []")
    program.say("end")
    assert program.end() == 0, program.output
    assert program.output.count("ValueError: this fails") == 2
    assert program.output.count("the client gets status 4 and an empty result") == 1
