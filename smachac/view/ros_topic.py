"""The statuses of machines on a ROS topic: those of the introspection server of a node.

rclpy (ROS 2) and rospy (ROS 1) are imported when a topic is opened. They receive in threads of
their own.
"""

from __future__ import annotations

import json
import os
from collections import deque
from collections.abc import Mapping
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Protocol

from smachac.runtime.tracing.writer import LONGEST_LINE

Fields = Mapping[str, Any]

STATUS_TOPIC = "/smach/container_status"
JSON_SUFFIX = "_json"

DEPTH = 10_000
"""The most statuses that wait to be read."""


class RosError(Exception):
    """ROS cannot be used; the message gives the reason."""


class Topic(Protocol):
    """A topic that may not exist yet. `topic` is its name as soon as it exists, else empty;
    `awaited` are the names that it may have, in words."""

    topic: str
    awaited: str

    def read(self) -> list[Fields]:
        """The fields of the statuses that have arrived, each with its `stamp` (s)."""
        ...

    def close(self) -> None:
        """Leave the ROS graph."""


def open_topic(name: str) -> Topic:
    """The topic with a name, or that of the server with a name. Raises RosError."""
    version = os.environ.get("ROS_VERSION", "")
    if version != "1" and find_spec("rclpy") is not None:
        return Ros2Topic(name)
    if version != "2" and find_spec("rospy") is not None:
        return Ros1Topic(name)
    raise RosError(
        "a ROS topic needs rclpy or rospy: start smachac with the Python of ROS, in its environment"
    )


def candidates(name: str) -> list[str]:
    """The topics that a name may stand for: its own, or those of a server."""
    full = "/" + name.strip("/")
    if full.endswith((STATUS_TOPIC, STATUS_TOPIC + JSON_SUFFIX)):
        return [full]
    server = full.rstrip("/")
    return [f"{server}{STATUS_TOPIC}{JSON_SUFFIX}", f"{server}{STATUS_TOPIC}"]


class Ros2Topic:
    """A topic of ROS 2: JSON texts, or messages of smach_msgs."""

    def __init__(self, name: str) -> None:
        try:
            rclpy: Any = import_module("rclpy")
            from smachac.runtime.smach_ros2.spinning import Spinner
        except ImportError as error:
            raise RosError(f"rclpy cannot be imported: {error}") from None
        self.topic = ""
        self._names = candidates(name)
        self.awaited = " or ".join(self._names)
        self._received: deque[Fields] = deque(maxlen=DEPTH)
        self._context = rclpy.Context()
        no_handlers = rclpy.signals.SignalHandlerOptions.NO
        rclpy.init(args=[], context=self._context, signal_handler_options=no_handlers)
        self._node = rclpy.create_node(
            f"smachac_view_{os.getpid()}",
            context=self._context,
            enable_rosout=False,
            start_parameter_services=False,
        )
        self._spinner = Spinner(self._node)
        self._spinner.start()

    def read(self) -> list[Fields]:
        """The statuses that have arrived; the first ones after the topic exists."""
        if not self.topic:
            self._find()
        return [self._received.popleft() for _ in range(len(self._received))]

    def close(self) -> None:
        """Leave the ROS graph."""
        self._spinner.stop()
        self._node.destroy_node()
        self._context.try_shutdown()

    def _find(self) -> None:
        """Subscribe to the first topic that is published."""
        qos: Any = import_module("rclpy.qos")
        for name in self._names:
            offered = self._node.get_publishers_info_by_topic(name)
            if not offered:
                continue
            latched, volatile = qos.DurabilityPolicy.TRANSIENT_LOCAL, qos.DurabilityPolicy.VOLATILE
            are_latched = all(item.qos_profile.durability == latched for item in offered)
            durability = latched if are_latched else volatile
            quality = qos.QoSProfile(depth=DEPTH, durability=durability)
            if name.endswith(JSON_SUFFIX):
                text: Any = import_module("std_msgs.msg").String
                self._node.create_subscription(text, name, self._on_text, quality)
            else:
                self._node.create_subscription(_status_type(), name, self._on_status, quality)
            self.topic = name
            return

    def _on_text(self, message: Any) -> None:
        if len(message.data) > LONGEST_LINE:
            return
        try:
            fields = json.loads(message.data)
        except ValueError:
            return
        if isinstance(fields, dict):
            self._received.append(fields)

    def _on_status(self, message: Any) -> None:
        stamp = message.header.stamp
        self._received.append(status_fields(message, stamp.sec + stamp.nanosec * 1e-9))


def _status_type() -> Any:
    try:
        return import_module("smach_msgs.msg").SmachContainerStatus
    except ImportError:
        raise RosError("the messages of this topic need the package smach_msgs") from None


def status_fields(message: Any, stamp: float) -> Fields:
    """The fields of a message of smach_msgs."""
    names = "path", "initial_states", "active_states", "info"
    return {"stamp": stamp, **{name: getattr(message, name) for name in names}}


class Ros1Topic:
    """A topic of ROS 1: messages of smach_msgs, which need no package."""

    def __init__(self, name: str) -> None:
        self.topic = ""
        self._name = self.awaited = candidates(name)[-1]
        self._received: deque[Fields] = deque(maxlen=DEPTH)
        self._subscriber: Any = None

    def read(self) -> list[Fields]:
        """The statuses that have arrived; the first ones after the topic exists."""
        if not self.topic:
            self._find()
        return [self._received.popleft() for _ in range(len(self._received))]

    def close(self) -> None:
        """Leave the ROS graph."""
        if self._subscriber is not None:
            import_module("rospy").signal_shutdown("the view ends")

    def _find(self) -> None:
        """Subscribe if a node publishes the topic; without a master or a publisher, do nothing."""
        from smachac.runtime.smach_ros import messages

        rosgraph: Any = import_module("rosgraph")
        rospy: Any = import_module("rospy")
        master = rosgraph.Master("/smachac_view")
        try:
            published = master.getPublishedTopics("/")
        except (OSError, rosgraph.MasterException):
            return
        if self._name not in [topic for topic, _ in published]:
            return
        rospy.init_node("smachac_view", anonymous=True, disable_signals=True, disable_rosout=True)
        type_ = messages.container_status()
        self._subscriber = rospy.Subscriber(self._name, type_, self._on_status, queue_size=DEPTH)
        self.topic = self._name

    def _on_status(self, message: Any) -> None:
        self._received.append(status_fields(message, message.header.stamp.to_sec()))
