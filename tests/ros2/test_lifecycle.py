"""A managed node whose machine runs while the node is active."""

from __future__ import annotations

import signal

import pytest

from tests.ros2.ros2_graph import Graph, Program

pytestmark = pytest.mark.ros2

PROGRAM = """
import sys, threading
from test_msgs.action import Fibonacci
from smachac.runtime import smach
from smachac.runtime import smach_ros2 as smach_ros
from smachac.runtime.smach_ros2 import lifecycle, program

builds = []

def build(node):
    builds.append(node)
    if len(builds) == 1 and "fail" in sys.argv:
        raise ValueError("not yet")
    order = int(sys.argv[1])
    machine = smach.StateMachine(["succeeded", "aborted", "preempted"])
    with machine:
        goal = Fibonacci.Goal(order=order)
        smach.StateMachine.add("GO", smach_ros.SimpleActionState(node, "work", Fibonacci, goal))
    return machine

node = lifecycle.start_node("machine", build)
outcome = lifecycle.run(node)
program.stop_node(node)
print("outcome:", outcome, "builds:", len(builds))
left = [each.name for each in threading.enumerate() if each is not threading.main_thread()]
print("threads left:", left)
"""


def transition(manager: Program, *names: str) -> None:
    for name in names:
        manager.say(name)
        manager.expect(f"{name} done")


def test_transitions_build_run_and_preempt_the_machine(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(PROGRAM, "4")
    manager = graph2.node("manager")
    for _ in range(2):
        transition(manager, "configure", "activate")
        server.expect("goal 4")
        transition(manager, "deactivate")
        server.expect("cancel 4")
        transition(manager, "cleanup")
    transition(manager, "shutdown")
    assert program.end() == 0, program.output
    assert "outcome: preempted builds: 2" in program.output
    assert "threads left: []" in program.output


def test_a_machine_that_ends_deactivates_the_node(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(PROGRAM, "1", "fail")
    manager = graph2.node("manager")
    manager.say("configure")
    manager.expect("configure failed")
    transition(manager, "configure")
    for _ in range(2):
        transition(manager, "activate")
        server.expect("goal 1")
        manager.say("inactive")
        manager.expect("is inactive")
    program.send(signal.SIGINT)
    assert program.end() == 0, program.output
    assert "ValueError: not yet" in program.output
    assert "outcome: succeeded builds: 2" in program.output
    assert "threads left: []" in program.output


def test_ctrl_c_preempts_an_active_machine(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(PROGRAM, "4")
    manager = graph2.node("manager")
    transition(manager, "configure", "activate")
    server.expect("goal 4")
    program.send(signal.SIGINT)
    server.expect("cancel 4")
    assert program.end() == 0, program.output
    assert "outcome: preempted" in program.output
    assert "threads left: []" in program.output
