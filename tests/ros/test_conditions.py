"""MonitorState on a topic that is published, and ConditionState in ROS time."""

from __future__ import annotations

import pytest
from live import Graph

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

asked = []

def met(userdata):
    asked.append(1)
    return len(asked) >= userdata.wanted

client.node()
machine = smach.StateMachine(["true", "false", "preempted"])
with machine:
    smach.StateMachine.add(
        "ASK", smach_ros.ConditionState(met, input_keys=["wanted"], {arguments})
    )
machine.userdata.wanted = 3
client.run(machine)
client.say("asked: " + str(len(asked)))
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


@pytest.mark.parametrize(
    ("arguments", "outcome", "asked"),
    [
        ("", "false", 1),
        ("max_checks=2", "false", 2),
        ("max_checks=3", "true", 3),
        ("max_checks=-1, poll_rate=rospy.Duration(0.01)", "true", 3),
        ("max_checks=-1, poll_rate=0.2, timeout=rospy.Duration(0.1)", "false", 1),
    ],
)
def test_a_condition_is_asked(graph: Graph, arguments: str, outcome: str, asked: int) -> None:
    output = graph.run(CONDITION.format(arguments=arguments))
    assert f"outcome: {outcome}\nasked: {asked}\n" in output


def test_a_condition_that_waits_is_preempted(graph: Graph) -> None:
    program = graph.start(CONDITION.format(arguments="max_checks=-1, poll_rate=1000"))
    program.expect("starting in 'ASK'")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\nasked: " in program.output


def test_a_condition_that_raises_is_the_fault_of_its_code(graph: Graph) -> None:
    program = graph.start(CONDITION.format(arguments="").replace("return", "return 1 / 0 and"))
    assert program.end() == 1
    assert "InvalidUserCodeError: the condition" in program.output
    assert "ZeroDivisionError" in program.output
