"""The state types of smachac for topics and transforms in ROS 2, and messages from values."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

HEAD = """
name: sm
template: ROSBase
outcomes: [succeeded, aborted, preempted]
"""

PUBLISHED = (
    HEAD
    + """
userdata:
  msg: [1.0, 2.0, 3.0]
  topic: point
  frame_id: base
  transform: [[10.0, 0.0, 0.0], [0.0, 0.0, 0.7071067811865476, 0.7071067811865476]]
states:
  - PUBLISH:
      template: PublishMsgState
      action: %s
      %s
      input_keys: [msg, topic, frame_id]
      transitions: {succeeded: READ, aborted: aborted}
  - READ:
      template: ReadTopicState
      timeout: 20.0
      %s
      input_keys: [topic]
      output_keys: [msg]
      transitions: {succeeded: MOVE, aborted: aborted, preempted: preempted}
  - MOVE:
      template: TransformMsgState
      input_keys: [msg, transform]
      output_keys: [output_msg]
      transitions: {succeeded: STOP, aborted: aborted, preempted: preempted}
  - STOP:
      template: PublishMsgState
      action: stop
      input_keys: [topic]
      transitions: {succeeded: STOP_AGAIN, aborted: aborted}
  - STOP_AGAIN:
      template: PublishMsgState
      action: stop
      input_keys: [topic]
      transitions: {succeeded: aborted, aborted: SHOW}
  - SHOW:
      template: PrintUserdataState
      input_keys: [output_msg]
      transitions: {succeeded: succeeded}
"""
)

MONITORED = (
    HEAD
    + """
userdata: {msg: {data: 0.5}, topic: level, msg_type: std_msgs/Float32, rate: 50.0}
states:
  - PUBLISH:
      template: PublishMsgState
      action: start
      input_keys: [msg, topic, msg_type, rate]
      transitions: {succeeded: WATCH, aborted: aborted}
  - WATCH:
      template: MonitorState
      topic: level
      msg_type: std_msgs/Float32
      cond_cb: 'lambda userdata, message: message.data == 0.5'
      max_checks: 3
      transitions: {valid: CHECK, invalid: aborted, preempted: preempted}
  - CHECK:
      template: ConditionState
      cond_cb: 'lambda userdata: userdata.rate == 50.0'
      input_keys: [rate]
      transitions: {"true": END, "false": aborted, preempted: preempted}
  - END:
      template: PublishMsgState
      action: stop_all
      transitions: {succeeded: succeeded, aborted: aborted}
"""
)

OBSERVED = (
    HEAD
    + """
userdata: {tick: {data: 1}, echo: {data: seen}, tick_topic: tick, echo_topic: echo,
           tick_type: std_msgs/Int32, echo_type: std_msgs/String}
states:
  - TICK:
      template: PublishMsgState
      action: start
      input_keys: [msg, topic, msg_type]
      remapping: {msg: tick, topic: tick_topic, msg_type: tick_type}
      transitions: {succeeded: ECHO, aborted: aborted}
  - ECHO:
      template: PublishObserverMsgState
      action: add
      sub_topic: tick
      input_keys: [msg, topic, msg_type]
      remapping: {msg: echo, topic: echo_topic, msg_type: echo_type}
      transitions: {succeeded: WAIT, aborted: aborted}
  - WAIT:
      template: WaitForMsgState
      topic: echo
      msg_type: std_msgs/String
      msg_cb: 'lambda message, userdata: message.data == "seen"'
      timeout: 20.0
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""
)

MESSAGES = """
from geometry_msgs.msg import Pose, PoseArray, PoseStamped
from std_msgs.msg import Float64MultiArray
from test_msgs.msg import Arrays, BasicTypes
from smachac.runtime.smach_ros2.message_fields import filled
from smachac.runtime.smach_ros2.plain_messages import parse_message

header = {"frame_id": "map", "stamp": 1.5}
pose = filled(PoseStamped(), {"header": header, "pose": [[1, 2, 3], [0, 0, 0, 1]]})
print(pose.header.frame_id, pose.header.stamp.sec, pose.header.stamp.nanosec)
print(pose.pose.position.z, pose.pose.orientation.w)
poses = filled(PoseArray(), {"poses": [{"position": {"x": 1}}, [[0, 0, 7], [0, 0, 0, 1]], Pose()]})
print([each.position.x for each in poses.poses], poses.poses[1].position.z)
print(list(filled(Float64MultiArray(), {"data": [1, 2]}).data))
nested = filled(Arrays(), {"basic_types_values": [{"int8_value": 1}, {}, BasicTypes(int8_value=3)]})
print([each.int8_value for each in nested.basic_types_values])
for values in ({"pose": {"positon": 1}}, {"pose": {"position": {"x": "far"}}}, {"pose": [1, 2, 3]}):
    try:
        filled(PoseStamped(), values)
    except (TypeError, ValueError) as error:
        print(type(error).__name__, error)
cloud = parse_message([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]])
print(type(cloud).__name__, cloud.width, type(parse_message([[0, 0, 1], [0, 0, 0, 1]])).__name__)
print("threads left: []")
"""


def outcome(graph: Graph, folder: Path, script: str) -> str:
    """The output of the program of a script."""
    path = folder / "main.yml"
    path.write_text(script, encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    program = graph.start(text)
    assert program.end() == 0, program.output
    assert program.output.endswith("outcome: succeeded\n"), program.output
    return program.output


@pytest.mark.parametrize(
    ("action", "qos"), [("start", ""), ("once", "qos: latched")], ids=["start", "once"]
)
def test_a_message_is_published_read_and_transformed(
    action: str, qos: str, graph2: Graph, tmp_path: Path
) -> None:
    output = outcome(graph2, tmp_path, PUBLISHED % (action, qos, qos))
    # (1, 2, 3) turned by 90 degrees about z is (-2, 1, 3)
    assert "x=8.0" in output or "x=7.999" in output
    assert "y=1.0" in output or "y=0.999" in output
    assert "z=3.0" in output


SAID = (
    HEAD
    + """
userdata: {msg: %s, topic: said, msg_type: std_msgs/Bool}
states:
  - SAY:
      template: PublishMsgState
      action: once
      qos: latched
      input_keys: %s
      transitions: {succeeded: HEAR, aborted: aborted}
  - HEAR:
      template: WaitForMsgState
      topic: said
      qos: latched
      msg_type: std_msgs/Bool
      msg_cb: 'lambda message, userdata: message.data'
      timeout: 20.0
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""
)


@pytest.mark.parametrize(
    ("message", "keys"),
    [
        ("Bool(data=True)", "[msg, topic]"),
        ("std_msgs.msg.Bool(data=True)", "[msg, topic]"),
        ("{data: true}", "[msg, topic, msg_type]"),
    ],
)
def test_a_message_of_std_msgs_is_published(
    message: str, keys: str, graph2: Graph, tmp_path: Path
) -> None:
    outcome(graph2, tmp_path, SAID % (message, keys))


def test_a_topic_is_monitored_and_a_condition_polled(graph2: Graph, tmp_path: Path) -> None:
    outcome(graph2, tmp_path, MONITORED)


def test_a_message_follows_another_topic(graph2: Graph, tmp_path: Path) -> None:
    outcome(graph2, tmp_path, OBSERVED)


def test_messages_are_made_from_values(graph2: Graph) -> None:
    lines = graph2.run(MESSAGES).splitlines()
    assert lines[:4] == ["map 1 500000000", "3.0 1.0", "[1.0, 0.0, 0.0] 7.0", "[1.0, 2.0]"]
    assert lines[4] == "[1, 0, 3]"
    assert lines[5].startswith("FieldError `PoseStamped.pose.positon` does not exist")
    assert "the fields of geometry_msgs/msg/Pose are position, orientation" in lines[5]
    assert "`PoseStamped.pose.position.x` is float64, not 'far'" in lines[6]
    assert "Pose (a mapping or a list of position, orientation), not" in lines[7]
    assert lines[8] == "PointCloud2 3 PoseStamped"
