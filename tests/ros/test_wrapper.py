"""ActionServerWrapper: a machine behind an action; and set_preempt_handler."""

from __future__ import annotations

import signal

import pytest

from tests.ros.ros_graph import Graph

pytestmark = pytest.mark.ros

SERVER = """
import threading
import client
import rospy
from smachac.runtime import smach, smach_ros
from actionlib.msg import TestAction, TestResult

class Double(smach.State):
    def __init__(self):
        super().__init__(["doubled", "negative", "preempted"], ["goal"], ["result"])
        self.woken = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.woken.set()

    def execute(self, userdata):
        client.say(f"goal {userdata.goal}")
        if userdata.goal == 0:
            self.woken.wait()
            self.service_preempt()
            return "preempted"
        if userdata.goal < 0:
            return "negative"
        if userdata.goal == 13:
            raise ValueError("no luck")
        userdata.result = 2 * userdata.goal
        return "doubled"

client.node("server")
machine = smach.StateMachine(["doubled", "negative", "preempted"], ["goal"], ["result"])
with machine:
    smach.StateMachine.add("DOUBLE", Double())
wrapper = smach_ros.ActionServerWrapper(
    "work", TestAction, machine, ["doubled"], ["negative"], ["preempted"],
    expand_goal_slots=True, pack_result_slots=True,
)
wrapper.run_server()
smach_ros.set_preempt_handler(machine)
client.say("ready")
rospy.spin()
client.say(f"idle: {not machine.is_running()}")
"""

CLIENT = """
import client
from smachac.runtime import smach, smach_ros
from actionlib.msg import TestAction

client.node()
machine = smach.StateMachine(["succeeded", "aborted", "preempted"])
with machine:
    smach.StateMachine.add("WORK", smach_ros.SimpleActionState(
        "work", TestAction, goal_slots=["goal"], result_slots=["result"]
    ))
machine.userdata.goal = {goal}
client.run(machine, "result")
"""


SLEEPER = """
import threading
import client
from smachac.runtime import smach, smach_ros

class Sleep(smach.State):
    def __init__(self):
        super().__init__(["preempted"])
        self.woken = threading.Event()

    def request_preempt(self):
        super().request_preempt()
        self.woken.set()

    def execute(self, userdata):
        client.say("sleeping")
        self.woken.wait()
        self.service_preempt()
        return "preempted"

client.node()
both = smach.Concurrence(
    ["preempted", "awake"], "awake", outcome_map={"preempted": {"ONE": "preempted"}}
)
with both:
    smach.Concurrence.add("ONE", Sleep())
    smach.Concurrence.add("TWO", Sleep())
smach_ros.set_preempt_handler(both)
client.again(both)
"""


def test_ctrl_c_preempts_a_concurrence_of_the_main_thread(graph: Graph) -> None:
    program = graph.start(SLEEPER)
    program.expect("sleeping")
    program.expect("sleeping")
    program.send(signal.SIGINT)
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_outcomes_of_the_machine_are_ends_of_goals(graph: Graph) -> None:
    graph.start(SERVER).expect("ready")
    assert "result: 42\noutcome: succeeded\n" in graph.run(CLIENT.format(goal=21))
    assert "outcome: aborted\n" in graph.run(CLIENT.format(goal=-1))
    assert "outcome: aborted\n" in graph.run(CLIENT.format(goal=13))
    assert "result: 6\noutcome: succeeded\n" in graph.run(CLIENT.format(goal=3))


def test_a_cancelled_goal_preempts_the_machine(graph: Graph) -> None:
    server = graph.start(SERVER)
    server.expect("ready")
    program = graph.start(CLIENT.format(goal=0))
    server.expect("goal 0")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_ctrl_c_preempts_a_machine_with_a_handler_before_the_node_ends(graph: Graph) -> None:
    server = graph.start(SERVER)
    server.expect("ready")
    program = graph.start(CLIENT.format(goal=0))
    server.expect("goal 0")
    server.send(signal.SIGINT)
    assert server.end() == 0
    assert "idle: True\n" in server.output
    assert program.end() == 0
