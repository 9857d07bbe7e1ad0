"""Transforms between frames with tf2_ros, which is imported when it is needed.

tf2_ros is part of ROS 2 installations; it is not on PyPI.
"""

from __future__ import annotations

from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.waits import Wait

INTERVAL = 0.05
"""Seconds between two look-ups; tf2 has no notification for a transform that becomes known."""


class Transforms:
    """The transforms that a node has received."""

    def __init__(self, node: Any) -> None:
        tf2 = ros.load("tf2_ros")
        self._node = node
        self._errors: type[Exception] = tf2.TransformException
        self._buffer = tf2.Buffer()
        self._listener = tf2.TransformListener(self._buffer, node)

    def lookup(
        self, target: str, source: str, timeout: ros.Time | None = 10.0, state: Any = None
    ) -> Any:
        """The newest transform from `source` to `target`; None if it does not become known.

        The wait ends at a preempt request to `state` too.
        """
        newest = ros.load("rclpy.time").Time()
        found: list[Any] = []
        cause = ""

        def known() -> bool:
            nonlocal cause
            try:
                found.append(self._buffer.lookup_transform(target, source, newest))
            except self._errors as error:
                cause = str(error)
            return bool(found)

        Wait(self._node).until(
            known,
            lambda: state is not None and state.preempt_requested(),
            ros.limit(timeout),
            INTERVAL,
        )
        if not found:
            smach.logerr(f"no transform from '{source}' to '{target}': {cause}")
        return found[0] if found else None


class TransformState(RosState):
    """Waits for the transform from the frame in key `source` to that in key `target`."""

    def __init__(self, node: Any, timeout: ros.Time | None = 10.0) -> None:
        super().__init__(
            node,
            outcomes=["succeeded", "aborted", "preempted"],
            input_keys=["target", "source"],
            output_keys=["output"],
        )
        self._timeout = timeout
        self._transforms = Transforms(node)

    def execute(self, ud: Any) -> str:
        """Look the transform up."""
        found = self._transforms.lookup(ud["target"], ud["source"], self._timeout, self)
        if found is None:
            return "preempted" if self._is_preempted() else "aborted"
        ud["output"] = found
        return "succeeded"
