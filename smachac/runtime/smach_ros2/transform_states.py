"""The state types for tf2: wait for a transform, transform a message."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

from smachac.runtime import smach
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.message_fields import filled
from smachac.runtime.smach_ros2.plain_messages import parse_message, transformed
from smachac.runtime.smach_ros2.publish_states import optional, write_keys
from smachac.runtime.smach_ros2.transform import Transforms


def look_up(state: Any, target: str, source: str) -> Any:
    """The newest transform; None after the time limit of a state or a preempt request."""
    found = _LISTENERS.get(state.node)
    if found is None:
        found = _LISTENERS[state.node] = Transforms(state.node)
    return found.lookup(target, source, state.timeout, state)


_LISTENERS: WeakKeyDictionary[Any, Transforms] = WeakKeyDictionary()
"""The tf2 listener of each node; the first look-up makes it."""


def preempted_or_aborted(state: Any) -> str:
    """The outcome `preempted` after a preempt request, otherwise `aborted`."""
    if state.preempt_requested() and "preempted" in state.get_registered_outcomes():
        state.service_preempt()
        return "preempted"
    return "aborted"


class TF2ListenerState(smach.State):
    """Waits for a tf2 transform; a preempt request or a shutdown ends the wait."""

    def __init__(
        self,
        node: Any,
        timeout: float = 10.0,
        outcomes: Sequence[str] = ("succeeded", "aborted", "preempted"),
    ) -> None:
        super().__init__(
            outcomes=list(outcomes), input_keys=["target", "source"], output_keys=["output"]
        )
        self.node = node
        self.timeout = timeout

    def execute(self, userdata: Any) -> str:
        target, source = userdata["target"], userdata["source"]
        transform = look_up(self, target, source)
        if transform is None:
            return preempted_or_aborted(self)
        userdata["output"] = transform
        return "succeeded"


class TransformMsgState(smach.State):
    """Transforms a message to another frame."""

    def __init__(
        self,
        node: Any,
        transform_type: str = "transform",
        timeout: float = 10.0,
        input_keys: Sequence[str] = ("msg", "frame_id"),
        output_keys: Sequence[str] = ("output_msg",),
        outcomes: Sequence[str] = ("succeeded", "aborted", "preempted"),
    ) -> None:
        super().__init__(
            outcomes=list(outcomes), input_keys=list(input_keys), output_keys=list(output_keys)
        )
        self.node = node
        self.transform_type = transform_type
        self.timeout = timeout

    def execute(self, userdata: Any) -> str:
        try:
            message = parse_message(userdata["msg"], optional(userdata, "msg_type"), self.node)
            transform = self.transform(userdata, message)
            if transform is None:
                return preempted_or_aborted(self)
            result = transformed(message, transform)
        except (TypeError, ValueError, ImportError) as error:
            self.node.get_logger().error(f"the message cannot be transformed: {error}")
            return "aborted"
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["output_msg", "msg", "msg_output"], result)
        names = ["transform", "output_transform", "transform_output"]
        write_keys(userdata, outputs, names, transform)
        return "succeeded"

    def transform(self, userdata: Any, message: Any) -> Any:
        """The applied part of the transform; None if tf2 does not provide it."""
        if "transform" in userdata:
            found = _transform(userdata["transform"])
        else:
            target = optional(userdata, "target") or optional(userdata, "frame_id")
            header = getattr(message, "header", None)
            source = optional(userdata, "source") or getattr(header, "frame_id", "")
            if not target or not source:
                raise ValueError("the source frame or the target frame is missing")
            found = look_up(self, target, source)
        if found is not None:
            found = copy.deepcopy(found)
            if self.transform_type == "translation":
                filled(found.transform.rotation, [0.0, 0.0, 0.0, 1.0])
            elif self.transform_type == "rotation":
                filled(found.transform.translation, [0.0, 0.0, 0.0])
        return found


def _transform(value: Any) -> Any:
    """A TransformStamped from one, from a Transform, or from `[[x, y, z], [x, y, z, w]]`."""
    messages = ros.load("geometry_msgs.msg")
    if isinstance(value, messages.TransformStamped):
        return value
    return messages.TransformStamped(transform=filled(messages.Transform(), value))
