"""SMACHA's states for topics, tf and bags, run as a node."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from tests.ros.ros_graph import Graph

pytestmark = pytest.mark.ros

HEAD = """
name: sm
template: Base
outcomes: [succeeded, aborted, preempted]
states:
"""

TOPICS = """
  - PUBLISH:
      template: PublishMsgState
      action: start
      userdata: {point: [1.0, 2.0, 3.0], point_topic: smacha/point, often: 20.0}
      remapping: {msg: point, topic: point_topic, rate: often}
      transitions: {succeeded: OBSERVE, aborted: aborted}
  - OBSERVE:
      template: PublishObserverMsgState
      action: add
      sub_topic: smacha/point
      userdata: {pose: [[1, 2, 3], [0, 0, 0, 1]], pose_topic: smacha/pose}
      remapping: {msg: pose, topic: pose_topic}
      transitions: {succeeded: READ, aborted: aborted}
  - READ:
      template: ReadTopicState
      remapping: {topic: pose_topic}
      output_keys: [msg]
      transitions: {succeeded: SHOW, aborted: aborted}
  - SHOW: {template: PrintUserdataState, input_keys: [msg], transitions: {succeeded: WAIT}}
  - WAIT:
      template: WaitForMsgState
      topic: smacha/point
      msg_type: geometry_msgs/PointStamped
      msg_cb: "`lambda msg, ud: msg.point.x == 1.0`"
      transitions: {succeeded: MOVE, aborted: aborted}
  - MOVE:
      template: TransformMsgState
      userdata: {by: [[41, 0, 0], [0, 0, 0, 1]]}
      input_keys: [transform]
      remapping: {msg: point, transform: by, output_msg: moved}
      output_keys: [output_msg]
      transitions: {succeeded: SHOW_MOVED, aborted: aborted}
  - SHOW_MOVED: {template: PrintUserdataState, input_keys: [moved], transitions: {succeeded: TF}}
  - TF:
      template: TF2ListenerState
      timeout: 0.5
      userdata: {target: base, source: tool}
      transitions: {succeeded: aborted, aborted: STOP}
  - STOP:
      template: PublishMsgState
      action: stop_all
      transitions: {succeeded: LAST, aborted: aborted}
  - LAST:
      template: PublishObserverMsgState
      action: remove_all
      sub_topic: smacha/point
      transitions: {succeeded: succeeded, aborted: aborted}
"""

FIELDS = """
  - PUBLISH:
      template: PublishMsgState
      action: start
      userdata: {polygon: POLYGON, kind: KIND, topic: /polygon, often: 20.0}
      input_keys: [msg, msg_type, topic, rate]
      remapping: {msg: polygon, msg_type: kind, rate: often}
      transitions: {succeeded: READ, aborted: aborted}
  - READ:
      template: ReadTopicState
      input_keys: [topic, msg_type]
      remapping: {msg_type: kind}
      output_keys: [msg]
      transitions: {succeeded: SHOW, aborted: aborted}
  - SHOW: {template: PrintUserdataState, input_keys: [msg], transitions: {succeeded: succeeded}}
"""

BAG = """
  - PUBLISH:
      template: PublishMsgState
      action: start
      userdata: {point: Point(), topic: /smacha/point, rate: 50.0}
      remapping: {msg: point}
      transitions: {succeeded: SEEN, aborted: aborted}
  - SEEN:
      template: WaitForMsgState
      topic: /smacha/point
      msg_type: geometry_msgs/PointStamped
      transitions: {succeeded: RECORD, aborted: aborted}
  - RECORD:
      template: RecordROSBagState
      recorder: ROSBagAPIThreadRecorder
      action: start
      userdata: {file: FILE, topics: [/smacha/point]}
      transitions: {succeeded: AGAIN, aborted: aborted}
  - AGAIN:
      template: RecordROSBagState
      recorder: ROSBagAPIThreadRecorder
      action: start
      transitions: {succeeded: aborted, aborted: SOME}
  - SOME:
      template: WaitForMsgState
      topic: /smacha/point
      msg_type: geometry_msgs/PointStamped
      transitions: {succeeded: MORE, aborted: aborted}
  - MORE:
      template: WaitForMsgState
      topic: /smacha/point
      msg_type: geometry_msgs/PointStamped
      transitions: {succeeded: STOP, aborted: aborted}
  - STOP:
      template: RecordROSBagState
      recorder: ROSBagAPIThreadRecorder
      action: stop
      transitions: {succeeded: succeeded, aborted: aborted}
"""

READ = """
import rosbag
bag = rosbag.Bag("FILE")
print(sorted({(topic, message._type) for topic, message, _ in bag.read_messages()}))
"""


def built(folder: Path, states: str) -> str:
    path = folder / "main.yml"
    path.write_text(HEAD + states, encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    return text


def test_topics_are_published_observed_read_and_transformed(graph: Graph, tmp_path: Path) -> None:
    output = graph.run(built(tmp_path, TOPICS))
    assert output.endswith("outcome: succeeded\n")
    assert "x: 42.0" in output
    assert "no transform from tool to base in 0.5 s" in output


def test_a_bag_holds_what_was_published(graph: Graph, tmp_path: Path) -> None:
    file = str(tmp_path / "points.bag")
    assert graph.run(built(tmp_path, BAG.replace("FILE", file))).endswith("outcome: succeeded\n")
    assert (
        graph.run(READ.replace("FILE", file))
        == "[('/smacha/point', 'geometry_msgs/PointStamped')]\n"
    )


@pytest.mark.parametrize(
    "kind",
    [
        "geometry_msgs/PolygonStamped",
        "geometry_msgs/msg/PolygonStamped",
        "geometry_msgs.msg.PolygonStamped",
    ],
)
def test_a_message_is_made_of_a_mapping_of_its_fields(
    graph: Graph, tmp_path: Path, kind: str
) -> None:
    polygon = "{header: {frame_id: map, stamp: 3.5}, polygon: {points: [{x: 4}, [1, 2, 3]]}}"
    script = FIELDS.replace("POLYGON", polygon).replace("KIND", kind)
    output = graph.run(built(tmp_path, script))
    assert output.endswith("outcome: succeeded\n")
    assert 'frame_id: "map"' in output
    assert "x: 4.0" in output
    assert "z: 3.0" in output


def test_a_list_gives_the_fields_in_their_order(graph: Graph, tmp_path: Path) -> None:
    script = FIELDS.replace("POLYGON", "[0.5, 0.25, 1, 0]").replace("KIND", "std_msgs/ColorRGBA")
    output = graph.run(built(tmp_path, script))
    assert output.endswith("outcome: succeeded\n")
    assert "g: 0.25" in output


@pytest.mark.parametrize(
    ("polygon", "kind", "reason"),
    [
        ("{colour: 1}", "std_msgs/ColorRGBA", "std_msgs/ColorRGBA has no field colour"),
        ("{r: red}", "std_msgs/ColorRGBA", "std_msgs/ColorRGBA: "),
        ("[1, 2]", "std_msgs/ColorRGBA", "std_msgs/ColorRGBA has the fields r, g, b, a"),
        ("{data: 1}", "std_msgs/Nothing", "the message type std_msgs/Nothing is not available"),
    ],
)
def test_values_that_do_not_fit_are_an_invalid_message(
    graph: Graph, tmp_path: Path, polygon: str, kind: str, reason: str
) -> None:
    script = FIELDS.replace("POLYGON", polygon).replace("KIND", kind)
    output = graph.run(built(tmp_path, script))
    assert "the message is invalid: " + reason in output
    assert output.endswith("outcome: aborted\n")
