"""MonitorState on a topic that is published, and ConditionState in ROS time."""

from __future__ import annotations

import pytest

from tests.ros.ros_graph import Graph

pytestmark = pytest.mark.ros

MONITOR = """
import client
from smachac.runtime import smach, smach_ros
from std_msgs.msg import Int32

def small(userdata, message):
    userdata.last = message.data
    return message.data < 10 // message.data

client.node()
machine = smach.StateMachine(["valid", "invalid", "preempted"])
with machine:
    smach.StateMachine.add(
        "WATCH",
        smach_ros.MonitorState("number", Int32, small, max_checks={checks}, output_keys=["last"]),
    )
machine.userdata.last = None
client.run(machine, "last")
"""

CONDITION = """
import client
import rospy
from smachac.runtime import smach, smach_ros

def met(userdata):
    userdata.asked += 1
    return userdata.asked >= 3

client.node()
cases = [{cases}]
for arguments in cases:
    machine = smach.StateMachine(["true", "false", "preempted"])
    state = smach_ros.ConditionState(met, ["asked"], **arguments)
    state.register_output_keys(["asked"])
    with machine:
        smach.StateMachine.add("ASK", state)
    machine.userdata.asked = 0
    client.run(machine, "asked")
"""


@pytest.mark.parametrize(
    ("numbers", "checks", "last", "outcome"),
    [
        (["1", "2", "1", "9", "1"], -1, 9, "invalid"),
        (["1", "2", "1", "9"], 3, 1, "valid"),
        (["1", "2", "9", "1"], 3, 9, "invalid"),
        (["1", "0"], -1, 0, "invalid"),
    ],
)
def test_messages_decide(
    graph: Graph, numbers: list[str], checks: int, last: int, outcome: str
) -> None:
    graph.node("topics", *numbers)
    output = graph.run(MONITOR.format(checks=checks))
    assert f"last: {last}\noutcome: {outcome}\n" in output
    assert ("ZeroDivisionError" in output) == ("0" in numbers)


def test_a_monitor_without_messages_is_preempted(graph: Graph) -> None:
    program = graph.start(MONITOR.format(checks=-1))
    program.expect("starting in 'WATCH'")
    program.say("preempt")
    assert program.end() == 0
    assert "last: None\noutcome: preempted\n" in program.output


def test_a_condition_is_asked_until_it_is_true_or_often_enough(graph: Graph) -> None:
    cases = [
        ("{}", 1, "false"),
        ("dict(max_checks=2)", 2, "false"),
        ("dict(max_checks=3, timeout=rospy.Duration(0))", 3, "true"),
        ("dict(max_checks=-1, poll_rate=rospy.Duration(0.01))", 3, "true"),
    ]
    output = graph.run(CONDITION.format(cases=", ".join(case for case, _, _ in cases)))
    told = [line for line in output.splitlines() if line.startswith(("asked", "outcome"))]
    assert told == [
        line for _, asked, outcome in cases for line in (f"asked: {asked}", f"outcome: {outcome}")
    ]


def test_a_condition_is_asked_no_more_when_its_time_is_over(graph: Graph) -> None:
    graph.simulate()
    case = "dict(max_checks=-1, poll_rate=2000, timeout=rospy.Duration(1000))"
    text = CONDITION.format(cases=case).replace("return", "client.say('asking'); return")
    program = graph.start(text)
    program.expect("asking")
    graph.node("clock")
    assert program.end() == 0
    assert "asked: 1\noutcome: false\n" in program.output


def test_a_condition_that_waits_is_preempted(graph: Graph) -> None:
    program = graph.start(CONDITION.format(cases="dict(max_checks=-1, poll_rate=1000)"))
    program.expect("starting in 'ASK'")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_a_condition_that_raises_is_the_fault_of_its_code(graph: Graph) -> None:
    program = graph.start(CONDITION.format(cases="{}").replace("return", "return 1 / 0 and"))
    assert program.end() == 1
    assert "InvalidUserCodeError: the condition" in program.output
    assert "ZeroDivisionError" in program.output
