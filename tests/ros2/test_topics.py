"""MonitorState and the states that read and publish messages, with live publishers."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = """
from machine_node import *
from smachac.runtime.smach_ros2.topics import (
    Publications, ReadTopicState, WaitForMsgState, wait_for_message
)
"""


def test_a_monitor_decides_by_the_messages(graph2: Graph) -> None:
    publisher = graph2.node("publisher", "numbers", "reliable")
    publisher.say("cycle 1 2 3")
    output = graph2.run(
        START
        + """
def condition(ud, message):
    ud.last = message.data
    return message.data < 3

def monitor(**arguments):
    return smach_ros.MonitorState(
        node, "numbers", Int32, condition, output_keys=["last"], **arguments
    )

ud = smach.UserData()
report("invalid", monitor().execute(ud), ud.last)
report("both", {monitor(max_checks=1).execute(ud) for _ in range(5)} >= {"valid"})
raising = smach_ros.MonitorState(node, "numbers", Int32, lambda ud, message: 1 / 0)
report("raising", raising.execute(ud))
"""
    )
    assert "invalid: invalid 3" in output
    assert "both: True" in output
    assert "raising: invalid" in output


def test_waits_for_messages_of_dead_publishers_end(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
ud = smach.UserData()
monitor = smach_ros.MonitorState(node, "silent", Int32, bool, timeout=Duration(seconds=0.2))
report("monitor", monitor.execute(ud))
monitor = smach_ros.MonitorState(node, "silent", Int32, bool)
after(0.2, monitor.request_preempt)
report("preempted", monitor.execute(ud))
report("message", wait_for_message(node, "silent", Int32, timeout=0.2))
report("waiting", WaitForMsgState(node, "silent", Int32, timeout=0.2).execute(ud))
ud.topic = "silent"
report("reading", ReadTopicState(node, timeout=0.2).execute(ud))
reading = ReadTopicState(node)
after(0.2, reading.request_preempt)
report("stopped", reading.execute(ud))
"""
    )
    assert "monitor: invalid" in output
    assert "preempted: preempted" in output
    assert "message: None" in output
    assert "waiting: aborted" in output
    assert "reading: aborted" in output
    assert "stopped: preempted" in output


def test_messages_are_read_and_checked(graph2: Graph) -> None:
    publisher = graph2.node("publisher", "numbers", "reliable", "latched")
    publisher.say("7")
    publisher.expect("published")
    output = graph2.run(
        START
        + """
ud = smach.UserData()
ud.topic = "numbers"
latched = {"durability": "transient_local"}
report("typed", ReadTopicState(node, "numbers", Int32, qos=latched).execute(ud), ud.output.data)
report("found", ReadTopicState(node, qos="latched").execute(ud), ud.output.data)

def waiting(**arguments):
    return WaitForMsgState(node, "numbers", Int32, qos=latched, **arguments)

report("kept", waiting(output_keys=["message"]).execute(ud), ud.message.data)
report("refused", waiting(msg_cb=lambda message, ud: message.data > 10).execute(ud))
report("failing", waiting(msg_cb=lambda message, ud: 1 / 0).execute(ud))
state = waiting(latch=True)
report("latch", state.execute(ud), state.execute(ud))
"""
    )
    assert "typed: succeeded 7" in output
    assert "found: succeeded 7" in output
    assert "kept: succeeded 7" in output
    assert "refused: aborted" in output
    assert "failing: aborted" in output
    assert "latch: succeeded succeeded" in output


def test_publications_start_and_stop(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
publications = Publications(node)
publications.start("ticks", Int32, lambda: Int32(data=5), rate=50)
publications.start("once", Int32, Int32(data=6), qos="latched")
report("ticks", wait_for_message(node, "ticks", Int32).data)
report("once", wait_for_message(node, "once", Int32, qos="latched").data)
report("stopped", publications.stop("ticks"), publications.stop("ticks"))
report("silent", wait_for_message(node, "ticks", Int32, timeout=0.3))
publications.stop_all()
"""
    )
    assert "ticks: 5" in output
    assert "once: 6" in output
    assert "stopped: True False" in output
    assert "silent: None" in output


def test_a_publisher_with_another_quality_of_service_is_named(graph2: Graph) -> None:
    graph2.node("publisher", "numbers", "best_effort")
    program = graph2.start(
        START
        + """
report("message", wait_for_message(node, "numbers", Int32, timeout=30))
"""
    )
    assert "RELIABILITY" in program.expect("offering incompatible QoS")
    assert program.expect("no message for 5 s").endswith(
        "publishers: publisher (std_msgs/msg/Int32, best_effort, volatile)"
    )


def test_sensor_data_come_from_every_publisher(graph2: Graph) -> None:
    publisher = graph2.node("publisher", "numbers", "best_effort")
    program = graph2.start(
        START
        + """
report("message", wait_for_message(node, "numbers", Int32, qos="sensor_data").data)
"""
    )
    publisher.say("cycle 4")
    assert program.end() == 0, program.output
    assert "message: 4" in program.output
