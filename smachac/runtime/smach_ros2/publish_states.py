"""The state types that publish messages: at a rate, once, or whenever another topic has one."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any, ClassVar
from weakref import WeakKeyDictionary

from smachac.runtime.smach_ros2 import delivery
from smachac.runtime.smach_ros2.interfaces import message_class
from smachac.runtime.smach_ros2.message_fields import FieldError, checked
from smachac.runtime.smach_ros2.plain_messages import parse_message
from smachac.runtime.smach_ros2.qos import profile
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.topics import Publications


def optional(userdata: Any, key: str, default: Any = None) -> Any:
    """The value of a userdata key, or the default if the key is absent."""
    return userdata[key] if key in userdata else default  # noqa: SIM401


def write_keys(userdata: Any, outputs: Sequence[str], names: Sequence[str], value: Any) -> None:
    """Write a value to each of the names that is an output key."""
    for name in names:
        if name in outputs:
            userdata[name] = value


class _PublishingState(RosState):
    """A state that takes a message and a topic from userdata.

    The first message on a topic waits up to `subscriber_wait_timeout` seconds for a subscription;
    a preempt request ends the wait, and the message is published.
    """

    def __init__(
        self,
        node: Any,
        action: str,
        topic: str,
        input_keys: Sequence[str] = ("msg", "topic"),
        output_keys: Sequence[str] = (),
        qos: Any = None,
        subscriber_wait_timeout: float = delivery.MATCH_LIMIT,
    ) -> None:
        super().__init__(
            node,
            outcomes=["succeeded", "aborted"],
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self.action = action
        self.topic = topic
        self.qos = qos
        self._subscriber_wait_timeout = subscriber_wait_timeout

    def message(self, userdata: Any) -> Any:
        """The message to publish; None if the value is none, which is logged."""
        try:
            message = parse_message(userdata["msg"], optional(userdata, "msg_type"), self.node)
        except (TypeError, ValueError, ImportError) as error:
            self.node.get_logger().error(f"the message is invalid: {error}")
            return None
        frame = optional(userdata, "frame_id", "")
        if frame and hasattr(message, "header"):
            message.header.frame_id = frame
        return message

    def stamped(self, message: Any) -> Any:
        """The message with the present time in its header, if it has one."""
        if hasattr(message, "header"):
            message.header.stamp = self.node.get_clock().now().to_msg()
        return message

    def await_subscription(self, publisher: Any) -> None:
        """Wait until a new publisher has a subscription."""
        delivery.await_subscription(
            self.node,
            publisher,
            self._subscriber_wait_timeout,
            self._ros_wait,
            self.preempt_requested,
        )

    def write(self, userdata: Any, message: Any, topic: str) -> None:
        """Write the message and the topic to the output keys that the script lists."""
        outputs = self.get_registered_output_keys()
        write_keys(userdata, outputs, ["msg", "output_msg", "msg_output"], message)
        write_keys(userdata, outputs, ["topic", "output_topic", "topic_output"], topic)


class PublishMsgState(_PublishingState):
    """Publishes a message once, or starts or stops its periodic publication on a topic."""

    publications: ClassVar[WeakKeyDictionary[Any, Publications]] = WeakKeyDictionary()

    def execute(self, userdata: Any) -> str:
        running = self.publications.setdefault(self.node, Publications(self.node))
        if self.action == "stop_all":
            running.stop_all()
            return "succeeded"
        topic = optional(userdata, "topic", self.topic)
        if self.action == "stop":
            return "succeeded" if running.stop(topic) else "aborted"
        message = self.message(userdata)
        if message is None:
            return "aborted"
        rate = None if self.action == "once" else optional(userdata, "rate", 100.0)
        make = self._maker(message, optional(userdata, "callback"))
        try:
            running.start(topic, type(message), make, rate, self.qos, self.await_subscription)
        except FieldError as error:
            self.node.get_logger().error(f"the message is invalid: {error}")
            return "aborted"
        self.write(userdata, message, topic)
        return "succeeded"

    def _maker(self, message: Any, callback: Callable[[Any], Any] | None) -> Callable[[], Any]:
        """The function of the message to publish next."""
        held = [message]

        def make() -> Any:
            if callback is not None:
                held[0] = callback(held[0])
            return self.stamped(held[0])

        return make


class Observer:
    """Publishes messages whenever a message arrives on the observed topic."""

    def __init__(self, node: Any, topic: str) -> None:
        self._node = node
        self._topic = topic
        self._lock = threading.Lock()
        self._messages: dict[str, tuple[Any, Callable[[], Any]]] = {}
        self._subscription: Any = None

    def add(
        self,
        topic: str,
        msg_type: Any,
        make: Callable[[], Any],
        qos: Any,
        before_first: Callable[[Any], None],
    ) -> bool:
        """Add a publication; False if the type of the observed topic is unknown. A message with a
        value that does not fit its field ends it.

        `before_first(publisher)` is called before the first message.
        """
        if self._subscription is None and not self._observe():
            return False
        publisher = self._node.create_publisher(msg_type, topic, profile(qos))
        before_first(publisher)
        with self._lock:
            self._messages[topic] = (publisher, lambda: checked(make(), msg_type, "msg"))
        return True

    def remove(self, topic: str) -> bool:
        """Remove a publication; False if there is none."""
        with self._lock:
            publisher, _ = self._messages.pop(topic, (None, None))
        if publisher is None:
            return False
        delivery.await_acknowledgements([publisher])
        self._node.destroy_publisher(publisher)
        return True

    def remove_all(self) -> None:
        """Remove all publications."""
        for topic in list(self._messages):
            self.remove(topic)

    def _observe(self) -> bool:
        wanted = self._node.resolve_topic_name(self._topic)
        types = [kinds for name, kinds in self._node.get_topic_names_and_types() if name == wanted]
        if not types:
            self._node.get_logger().error(f"topic '{wanted}' has no publisher yet")
            return False
        kind = message_class(types[0][0])
        self._subscription = self._node.create_subscription(
            kind, self._topic, self._publish, profile("sensor_data"), raw=True
        )
        return True

    def _publish(self, _: bytes) -> None:
        with self._lock:
            messages = list(self._messages.items())
        for topic, (publisher, make) in messages:
            try:
                publisher.publish(make())
            except FieldError as error:
                self._node.get_logger().error(f"the publication on '{topic}' ends: {error}")
                self.remove(topic)


class PublishObserverMsgState(_PublishingState):
    """Publishes a message whenever a message arrives on another topic."""

    observers: ClassVar[WeakKeyDictionary[Any, dict[str, Observer]]] = WeakKeyDictionary()

    def __init__(
        self, node: Any, action: str, topic: str, sub_topic: str = "tf", **keywords: Any
    ) -> None:
        super().__init__(node, action, topic, **keywords)
        observers = self.observers.setdefault(node, {})
        self.observer = observers.setdefault(sub_topic, Observer(node, sub_topic))

    def execute(self, userdata: Any) -> str:
        if self.action == "remove_all":
            self.observer.remove_all()
            return "succeeded"
        topic = optional(userdata, "topic", self.topic)
        if self.action == "remove":
            return "succeeded" if self.observer.remove(topic) else "aborted"
        message = self.message(userdata)
        if message is None:
            return "aborted"
        added = self.observer.add(
            topic,
            type(message),
            lambda: self.stamped(message),
            self.qos,
            self.await_subscription,
        )
        self.write(userdata, message, topic)
        return "succeeded" if added else "aborted"
