"""Recordings of bags and look-ups of transforms: what is there, and what is not."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

# `ros2 bag record` is not on PyPI: this program stands for it.
ROS2 = """#!/bin/sh
echo "recorded $*" >"$4"
trap 'echo closed >>"$4"; exit 0' INT
while :; do sleep 0.05; done
"""

RECORD = """
import sys, time
from pathlib import Path
from machine_node import *
from smachac.runtime.smach_ros2.bags import Recordings

bag = Path(sys.argv[1])
recordings = Recordings()
report("started", recordings.start(str(bag), ["odom", "scan"]), recordings.start(str(bag), []))
while not bag.exists() and "there" in sys.argv:
    time.sleep(0.02)
report("stopped", recordings.stop(str(bag)), recordings.stop(str(bag)))
recordings.stop_all()
"""


def test_a_recording_is_closed_when_it_is_stopped(graph2: Graph, tmp_path: Path) -> None:
    command = tmp_path / "bin" / "ros2"
    command.parent.mkdir()
    command.write_text(ROS2, encoding="utf-8")
    command.chmod(0o755)
    graph2.environment["PATH"] = f"{command.parent}{os.pathsep}{os.environ['PATH']}"
    output = graph2.run(RECORD, str(tmp_path / "bag"), "there")
    assert "started: True False" in output
    assert "stopped: True False" in output
    lines = (tmp_path / "bag").read_text("utf-8").splitlines()
    assert lines == [f"recorded bag record --output {tmp_path / 'bag'} odom scan", "closed"]


def test_a_recording_needs_the_command(graph2: Graph, tmp_path: Path) -> None:
    graph2.environment["PATH"] = str(tmp_path)
    output = graph2.run(RECORD, str(tmp_path / "bag"))
    assert "no command ros2" in output
    assert "started: False False" in output


TRANSFORM = """
from machine_node import *
from smachac.runtime.smach_ros2.transform import TransformState
try:
    import tf2_ros
except ImportError:
    tf2_ros = None
try:
    state = TransformState(node, timeout=5.0)
except ImportError as error:
    report("without tf2", tf2_ros is None, error)
else:
    from geometry_msgs.msg import TransformStamped
    broadcaster = tf2_ros.StaticTransformBroadcaster(node)
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = "map", "base"
    transform.transform.translation.x = 2.0
    transform.transform.rotation.w = 1.0
    broadcaster.sendTransform(transform)
    ud = smach.UserData()
    ud.target, ud.source = "map", "base"
    report("with tf2", state.execute(ud), ud.output.transform.translation.x)
"""


def test_a_transform_is_looked_up_where_tf2_is_there(graph2: Graph) -> None:
    output = graph2.run(TRANSFORM)
    assert "with tf2: succeeded 2.0" in output or "without tf2: True smach_ros2 needs" in output
