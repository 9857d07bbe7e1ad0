"""The first and the last messages of publishers arrive."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

LISTENER = """
import sys
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("listener")
got = []
node.create_subscription(String, "said", lambda message: got.append(len(message.data)), 10)
print("ready", flush=True)
while not got:
    rclpy.spin_once(node)
print("got", got[0], flush=True)
"""

ONCE = """
name: first
template: ROSBase
outcomes: [succeeded, aborted]
userdata: {msg: {data: '%s'}, msg_type: std_msgs/String, topic: said, rate: 0.001}
states:
  - SAY:
      template: PublishMsgState
      action: %s
      subscriber_wait_timeout: 60.0
      %s
      input_keys: [msg, msg_type, topic, rate]
      transitions: {succeeded: succeeded, aborted: aborted}
"""


@pytest.mark.parametrize(
    ("action", "more", "length"),
    [("once", "", 4), ("once", "qos: latched", 4), ("start", "", 4), ("once", "", 3_000_000)],
)
def test_the_only_message_of_a_program_arrives(
    action: str, more: str, length: int, graph2: Graph, tmp_path: Path
) -> None:
    path = tmp_path / "first.yml"
    path.write_text(ONCE % ("x" * length, action, more), encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    listener, program = graph2.start(LISTENER), graph2.start(text)
    assert program.end() == 0, program.output
    listener.expect(f"got {length}")


def test_a_message_waits_for_a_subscription_that_comes_later(graph2: Graph, tmp_path: Path) -> None:
    path = tmp_path / "first.yml"
    path.write_text(ONCE % ("x", "once", ""), encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    program = graph2.start(text)
    program.expect("starting in 'SAY'")
    graph2.start(LISTENER).expect("got 1")
    assert program.end() == 0, program.output


START = """
from machine_node import *
from smachac.runtime.smach_ros2.publish_states import PublishMsgState, PublishObserverMsgState

def state(**arguments):
    return PublishMsgState(node, "once", "said", input_keys=["msg", "msg_type"], **arguments)

ud = smach.UserData()
ud.msg, ud.msg_type = {"data": "a"}, "std_msgs/String"
"""


def test_a_message_without_a_subscription_is_named(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
report("none", state(subscriber_wait_timeout=0.2).execute(ud), state().execute(ud))
"""
    )
    assert "none: succeeded succeeded" in output
    (line,) = [line for line in output.splitlines() if "no subscription" in line]
    assert line.endswith(
        "topic '/said': no subscription after 0.2 s, the message may be lost; "
        "subscriptions that do not fit: none"
    )


def test_subscriptions_that_do_not_fit_are_named(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
node.create_subscription(String, "said", print, 10)
while not node.get_subscriptions_info_by_topic("/said"):
    pass
report("sent", state(subscriber_wait_timeout=0.2, qos="sensor_data").execute(ud))
"""
    )
    assert "sent: succeeded" in output
    assert "do not fit: machine (std_msgs/msg/String, reliable, volatile)" in output


def test_no_wait_and_no_warning(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
report("at once", state(subscriber_wait_timeout=0.0).execute(ud))
stopped = state(subscriber_wait_timeout=1000.0, qos=1)
PublishMsgState.publications.clear()
after(0.2, stopped.request_preempt)
report("stopped", stopped.execute(ud))
PublishMsgState.publications.clear()
report("latched", state(subscriber_wait_timeout=0.1, qos="latched").execute(ud))
"""
    )
    assert "at once: succeeded" in output
    assert "stopped: succeeded" in output
    assert "latched: succeeded" in output
    assert "no subscription" not in output


def test_an_observer_waits_too(graph2: Graph) -> None:
    listener = graph2.start(LISTENER)
    program = graph2.start(
        START
        + """
import sys
ticks = node.create_publisher(Int32, "tick", 10)
while not node.get_publishers_info_by_topic("/tick"):
    pass
state = PublishObserverMsgState(
    node, "add", "said", "tick", input_keys=["msg", "msg_type"], subscriber_wait_timeout=60.0
)
report("added", state.execute(ud))
while not ticks.get_subscription_count():
    pass
ticks.publish(Int32(data=1))
sys.stdin.readline()
report("removed", PublishObserverMsgState(node, "remove", "said", "tick").execute(ud))
"""
    )
    listener.expect("got 1")
    program.say("end")
    assert program.end() == 0, program.output
    assert "removed: succeeded" in program.output


COMMAND = """
import rclpy
from smachac.runtime import smach_ros2 as smach_ros

rclpy.init()
client = smach_ros.IntrospectionClient()
print("set", client.set_initial_state("/viewed", "/ROOT", ["LAST"]), flush=True)
client.destroy_node()
rclpy.shutdown()
"""

VIEWED = """
import sys
from machine_node import *

machine = smach.StateMachine(["done"])
with machine:
    smach.StateMachine.add("FIRST", smach.CBState(lambda ud: "done", outcomes=["done"]))
    smach.StateMachine.add("LAST", smach.CBState(lambda ud: "done", outcomes=["done"]))
server = smach_ros.IntrospectionServer("viewed", machine, "/ROOT")
server.start()
print("ready", flush=True)
while machine.get_initial_states() != ["LAST"]:
    pass
server.stop()
"""


def test_a_command_without_a_time_limit_arrives(graph2: Graph) -> None:
    server = graph2.start(VIEWED)
    server.expect("ready")
    client = graph2.start(COMMAND)
    assert client.end() == 0, client.output
    assert "set None" in client.output
    assert server.end() == 0, server.output
