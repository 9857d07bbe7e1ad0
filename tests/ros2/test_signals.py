"""Stop signals to programs of smach_ros2, whatever they do at that moment."""

from __future__ import annotations

import signal

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = """
import sys
from machine_node import *

class Deaf(smach.State):
    def execute(self, ud):
        report("state", "deaf")
        sys.stdin.readline()
        return "succeeded"

    def request_preempt(self):
        super().request_preempt()
        report("requested")

class Last(smach.State):
    def execute(self, ud):
        report("state", "last")
        return "preempted" if self.preempt_requested() else "succeeded"

states = {
    "server": lambda: smach_ros.SimpleActionState(node, "nothing", Fibonacci),
    "service": lambda: smach_ros.ServiceState(node, "nothing", Trigger),
    "goal": lambda: goal_state(4),
    "call": lambda: smach_ros.ServiceState(node, "hang", Trigger, preempt_timeout=0.2),
    "topic": lambda: smach_ros.MonitorState(node, "silent", Int32, bool),
    "condition": lambda: smach_ros.ConditionState(node, lambda ud: False, max_checks=-1),
    "deaf": lambda: Deaf(["succeeded"]),
}

def machine(name):
    ends = ["succeeded", "preempted", "aborted"]
    result = smach.StateMachine(ends)
    with result:
        state = states[name]()
        known = state.get_registered_outcomes()
        smach.StateMachine.add("FIRST", state, dict.fromkeys(known, "LAST"))
        last = Last(ends)
        smach.StateMachine.add("LAST", last, {end: end for end in ends})
    return result
"""

RUN = """
report("waits")
outcome = program.run(node, machine({name!r}))
report("outcome", outcome)
sys.exit(program.exit_code(outcome))
"""

NAMES = ["server", "service", "goal", "call", "topic", "condition"]


@pytest.mark.parametrize("name", NAMES)
def test_the_first_signal_preempts_the_machine(graph2: Graph, name: str) -> None:
    server = graph2.node("server") if name in ("goal", "call") else None
    program = graph2.start(START + RUN.format(name=name))
    program.expect("waits")
    if server is not None:
        server.expect({"goal": "goal 4", "call": "called"}[name])
    else:
        program.expect("starting in 'FIRST'")
    number = {"service": signal.SIGTERM, "goal": signal.SIGHUP}.get(name, signal.SIGINT)
    program.send(number)
    code = program.end()
    assert "state: last" in program.output, "the machine continues with its clean-up"
    assert "threads left: []" in program.output
    assert "Traceback" not in program.output
    if server is not None and name == "goal":
        server.expect("cancel 4")
    assert "outcome: succeeded" in program.output, "the request was answered by the first state"
    assert code == 128 + number


def test_a_state_that_checks_nothing_is_given_five_seconds(graph2: Graph) -> None:
    program = graph2.start(START + RUN.format(name="deaf"))
    program.expect("state: deaf")
    program.send(signal.SIGINT)
    program.expect("did not end within 5 s: the node shuts down")
    program.say("end")
    assert program.end() == 130
    assert "outcome: None" in program.output
    assert "threads left: []" in program.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_the_second_signal_ends_a_state_that_checks_nothing(
    graph2: Graph, number: signal.Signals
) -> None:
    program = graph2.start(START + RUN.format(name="deaf"))
    program.expect("state: deaf")
    program.send(signal.SIGTERM)
    program.expect("requested")
    program.send(number)
    assert program.end() == 128 + number
    assert "Traceback" not in program.output
    assert "outcome" not in program.output


UPSTREAM = """
import threading, rclpy
from test_msgs.action import Fibonacci
from smachac.runtime import smach
from smachac.runtime import smach_ros2 as smach_ros

rclpy.init()
node = rclpy.create_node("machine")
machine = smach.StateMachine(["succeeded", "aborted", "preempted"])
with machine:
    state = smach_ros.SimpleActionState(node, "work", Fibonacci, Fibonacci.Goal(order=4))
    smach.StateMachine.add("GO", state)
smach_ros.set_preempt_handler(machine)
"""


def test_the_preempt_handler_cancels_goals_while_the_main_thread_spins(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        UPSTREAM
        + """
thread = threading.Thread(target=lambda: print("outcome:", machine.execute()))
thread.start()
try:
    rclpy.spin(node)
except rclpy.executors.ExternalShutdownException:
    pass
print("spin has ended")
thread.join()
"""
    )
    server.expect("goal 4")
    program.send(signal.SIGINT)
    server.expect("cancel 4")
    assert program.end() == 0, program.output
    assert "outcome: preempted" in program.output
    assert "spin has ended" in program.output


def test_the_preempt_handler_lets_the_main_thread_go_on_after_its_machine(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        UPSTREAM
        + """
print("outcome:", machine.execute(), rclpy.ok())
node.destroy_node()
rclpy.shutdown()
"""
    )
    server.expect("goal 4")
    program.send(signal.SIGTERM)
    server.expect("cancel 4")
    assert program.end() == 0, program.output
    assert "outcome: preempted True" in program.output


def test_a_shutdown_by_the_program_ends_the_machine(graph2: Graph) -> None:
    server = graph2.node("server")
    last = """
    last = smach.CBState(lambda ud: print("the last state runs"), outcomes=["succeeded"])
    following = dict.fromkeys(state.get_registered_outcomes(), "LAST")
    smach.StateMachine.add("GO", state, following)
    smach.StateMachine.add("LAST", last)
"""
    program = graph2.start(
        UPSTREAM.replace('    smach.StateMachine.add("GO", state)\n', last)
        + """
thread = threading.Thread(target=lambda: print("outcome:", machine.execute()))
thread.start()
input()
rclpy.shutdown()
thread.join()
"""
    )
    server.expect("goal 4")
    program.say("end")
    assert program.end() == 0, program.output
    assert "outcome: None" in program.output
    assert "the last state runs" not in program.output


@pytest.mark.parametrize("stage", ["before", "after"])
def test_a_signal_before_or_after_the_machine_does_no_harm(graph2: Graph, stage: str) -> None:
    program = graph2.start(
        START
        + f"""
def pause():
    report("stage")
    sys.stdin.readline()

machine = smach.StateMachine(["succeeded", "preempted"])
with machine:
    for name in "FIRST", "SECOND":
        target = "SECOND" if name == "FIRST" else "succeeded"
        waiting = smach_ros.ConditionState(node, lambda ud: stage == "after")
        smach.StateMachine.add(
            name, waiting, {{"true": target, "false": target, "preempted": "preempted"}}
        )
stage = {stage!r}
if stage == "before":
    pause()
report("outcome", program.run(node, machine))
if stage == "after":
    pause()
"""
    )
    program.expect("stage")
    program.send(signal.SIGINT)
    program.say("go on")
    assert program.end() == 0, program.output
    assert f"outcome: {'preempted' if stage == 'before' else 'succeeded'}" in program.output
    assert "threads left: []" in program.output


def test_signals_during_the_end_of_the_program_are_ignored(graph2: Graph) -> None:
    program = graph2.start(
        START
        + """
import os, signal
stop = node.stop

def interrupted():
    for _ in range(3):
        os.kill(os.getpid(), signal.SIGINT)
    stop()

node.stop = interrupted
"""
    )
    assert program.end() == 0, program.output
    assert "threads left: []" in program.output
    assert "KeyboardInterrupt" not in program.output
