"""States of smach_ros2 end whoever spins the node: nobody, the program, or a busy executor."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = """
import threading, rclpy
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_srvs.srv import Trigger
from test_msgs.action import Fibonacci
from smachac.runtime import smach
from smachac.runtime import smach_ros2 as smach_ros

rclpy.init()
node = rclpy.create_node("machine")

def sequence():
    states = smach.Sequence(["succeeded", "aborted", "preempted"], "succeeded")
    goal = Fibonacci.Goal(order=8)
    with states:
        smach.Sequence.add("CALL", smach_ros.ServiceState(node, "trigger", Trigger))
        smach.Sequence.add("GOAL", smach_ros.SimpleActionState(node, "work", Fibonacci, goal))
    return states

def left():
    main = threading.main_thread()
    print("threads left:", [each.name for each in threading.enumerate() if each is not main])

"""


def test_nobody_spins(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
print("outcome:", sequence().execute(), sequence().execute())
node.destroy_node()
rclpy.shutdown()
for thread in threading.enumerate():
    if thread is not threading.main_thread():
        thread.join()
left()
"""
    )
    assert "outcome: succeeded succeeded" in output


@pytest.mark.parametrize("executor", ["SingleThreadedExecutor()", "MultiThreadedExecutor(2)"])
def test_a_thread_of_the_program_spins(graph2: Graph, executor: str) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + f"""
executor = {executor}
executor.add_node(node)

def spin():
    try:
        executor.spin()
    except rclpy.executors.ExternalShutdownException:
        pass

thread = threading.Thread(target=spin)
thread.start()
print("outcome:", sequence().execute())
print("ours:", [each.name for each in threading.enumerate() if "executor of" in each.name])
rclpy.shutdown()
thread.join()
executor.shutdown()
left()
"""
    )
    assert "outcome: succeeded" in output
    assert "ours: []" in output


def test_the_main_thread_spins_after_the_machine_has_started(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
def run():
    print("outcome:", sequence().execute())
    rclpy.shutdown()

thread = threading.Thread(target=run)
thread.start()
try:
    rclpy.spin(node)
except rclpy.executors.ExternalShutdownException:
    pass
thread.join()
for other in threading.enumerate():
    if other is not threading.main_thread():
        other.join(10)
left()
"""
    )
    assert "outcome: succeeded" in output


def test_the_machine_runs_in_a_callback_of_the_executor(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
machine = sequence()

def run():
    timer.cancel()
    print("outcome:", machine.execute())
    rclpy.shutdown()

timer = node.create_timer(0.05, run)
executor = SingleThreadedExecutor()
executor.add_node(node)
try:
    executor.spin()
except rclpy.executors.ExternalShutdownException:
    pass
for other in threading.enumerate():
    if other is not threading.main_thread():
        other.join(10)
left()
"""
    )
    assert "outcome: succeeded" in output
    assert "the executor of the node does not run" in output


def test_the_node_of_smach_spins_itself(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START.replace('rclpy.create_node("machine")', 'smach_ros.SmachNode("machine")')
        + """
node.start()
print("outcome:", sequence().execute())
rclpy.shutdown()
node.join()
left()
"""
    )
    assert "outcome: succeeded" in output


def test_a_program_that_ends_without_a_shutdown_ends_cleanly(graph2: Graph) -> None:
    graph2.node("server")
    program = graph2.start(START + 'print("outcome:", sequence().execute())\n')
    assert program.end() == 0, program.output
    assert "outcome: succeeded" in program.output


def test_an_executor_may_use_an_action_client_that_is_being_made(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
add = node.add_waitable

def used_at_once(waitable):
    add(waitable)
    print("entities:", waitable.get_num_entities().num_clients)

node.add_waitable = used_at_once
smach_ros.SimpleActionState(node, "work", Fibonacci)
rclpy.shutdown()
left()
"""
    )
    assert "entities: 3" in output


def test_a_limit_begins_with_the_first_message_of_the_clock(graph2: Graph) -> None:
    output = graph2.run(
        START.replace(
            'rclpy.create_node("machine")',
            'rclpy.create_node("machine", parameter_overrides='
            '[rclpy.Parameter("use_sim_time", value=True)])',
        )
        + """
from rosgraph_msgs.msg import Clock
clock = rclpy.create_node("clock")
publisher = clock.create_publisher(Clock, "/clock", 10)
seen, begun = [], threading.Event()

def now():
    return node.get_clock().now().nanoseconds // 10**9

def condition(userdata):
    seen.append(now())
    begun.set()
    return False

state = smach_ros.ConditionState(node, condition, poll_rate=100.0, timeout=500.0, max_checks=-1)
thread = threading.Thread(target=lambda: print("outcome:", state.execute(smach.UserData())))
thread.start()
begun.wait()
second = 1_000_000
while thread.is_alive():
    message = Clock()
    message.clock.sec = second
    publisher.publish(message)
    second += 100
    thread.join(0.05)
print("seconds:", seen[0], any(each > 1_000_000 for each in seen))
rclpy.shutdown()
for other in threading.enumerate():
    if other is not threading.main_thread():
        other.join(10)
left()
"""
    )
    assert "outcome: false" in output
    assert "seconds: 0 True" in output


def test_limits_are_in_simulated_time(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        START.replace(
            'rclpy.create_node("machine")',
            'rclpy.create_node("machine", parameter_overrides='
            '[rclpy.Parameter("use_sim_time", value=True)])',
        )
        + """
from rosgraph_msgs.msg import Clock
clock = rclpy.create_node("clock")
publisher = clock.create_publisher(Clock, "/clock", 10)
goal = Fibonacci.Goal(order=4)
state = smach_ros.SimpleActionState(node, "work", Fibonacci, goal, exec_timeout=1000.0)
thread = threading.Thread(target=lambda: print("outcome:", state.execute(smach.UserData())))
thread.start()
input()
second = 0
while thread.is_alive():
    message = Clock()
    message.clock.sec = second
    publisher.publish(message)
    second += 100
    thread.join(0.05)
rclpy.shutdown()
for other in threading.enumerate():
    if other is not threading.main_thread():
        other.join(10)
left()
"""
    )
    server.expect("goal 4")
    program.say("let the time pass")
    assert program.end() == 0, program.output
    assert "outcome: aborted" in program.output
    assert "is cancelled after 1000.0 s" in program.output


@pytest.mark.parametrize(
    ("state", "served"),
    [
        ('smach_ros.SimpleActionState(node, "none", Fibonacci, server_wait_timeout=2.0)', False),
        ('smach_ros.SimpleActionState(node, "work", Fibonacci, Fibonacci.Goal(order=4), '
         "exec_timeout=2.0)", True),
        ('smach_ros.ServiceState(node, "none", Trigger, server_wait_timeout=2.0)', False),
        ('topics.WaitForMsgState(node, "none", String, timeout=2.0)', False),
        ("smach_ros.ConditionState(node, lambda ud: False, timeout=2.0, max_checks=-1)", False),
    ],
)  # fmt: skip
def test_the_log_says_that_no_simulated_time_comes(state: str, served: bool, graph2: Graph) -> None:
    if served:
        graph2.node("server")
    program = graph2.start(
        """
from machine_node import *
from smachac.runtime.smach_ros2 import topics

state = STATE
on_line(state.request_preempt)
report("outcome", state.execute(smach.UserData()))
""".replace("STATE", state),
        *("--ros-args", "-p", "use_sim_time:=true"),
    )
    program.expect("no time came on /clock for 5 s: time limits begin with the first one")
    program.say("stop")
    assert program.end() == 0, program.output
    assert "preempted" in program.output
