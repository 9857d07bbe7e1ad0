"""Topics: wait for a message, read one, publish once or at a rate."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable, Iterable
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach_ros2 import delivery, interfaces, ros
from smachac.runtime.smach_ros2 import qos as qos_profiles
from smachac.runtime.smach_ros2.message_fields import FieldError, checked
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.subscriptions import Subscription
from smachac.runtime.smach_ros2.waits import CHECK_INTERVAL, DISCOVERY_INTERVAL, Wait

PREEMPT_INTERVAL = 0.05
"""Seconds between two checks for a preempt request of a state that cannot end the wait."""


def wait_for_message(
    node: Any,
    topic: str,
    msg_type: Any,
    state: Any = None,
    timeout: ros.Time | None = None,
    qos: Any = None,
) -> Any:
    """The next message on a topic; None after a timeout, a shutdown or a preempt request."""
    wait = state._ros_wait if isinstance(state, RosState) else Wait(node)
    is_prompt = state is None or isinstance(state, RosState)
    found: list[Any] = []
    profile = qos_profiles.profile(qos)
    with Subscription(node, topic, msg_type, profile, wait.wake) as messages:

        def arrived() -> bool:
            found.extend(messages.received)
            messages.report_silence()
            return bool(found)

        wait.until(
            arrived,
            lambda: state is not None and state.preempt_requested(),
            ros.limit(timeout),
            CHECK_INTERVAL if is_prompt else PREEMPT_INTERVAL,
        )
    return found[0] if found else None


class WaitForMsgState(RosState):
    """Waits for a message; ends as succeeded, as aborted after `timeout`, or preempted.

    `msg_cb(message, userdata)` may return false, which ends the state as aborted. The message is
    written to the first of the output keys if there is no callback. With `latch` the last message
    since the construction of the state counts too.
    """

    def __init__(
        self,
        node: Any,
        topic: str,
        msg_type: Any,
        msg_cb: Callable[..., Any] | None = None,
        output_keys: Iterable[str] = (),
        latch: bool = False,
        timeout: ros.Time | None = None,
        qos: Any = None,
    ) -> None:
        self._keys = list(output_keys)
        super().__init__(
            node, outcomes=["succeeded", "aborted", "preempted"], output_keys=self._keys
        )
        self._source = topic, msg_type
        self._callback = msg_cb
        self._timeout = timeout
        self._qos = qos
        self._last: Any = None
        if latch:
            node.create_subscription(
                msg_type,
                topic,
                self._store,
                qos_profiles.profile(qos),
                callback_group=ros.own_group(),
            )
        self._latch = latch

    def _store(self, message: Any) -> None:
        self._last = message
        self._wake()

    def execute(self, ud: Any) -> str:
        """Wait for one message."""
        if self._latch:
            self._wait_until(lambda: self._last is not None, ros.limit(self._timeout))
            message = self._last
        else:
            message = wait_for_message(
                self.node, *self._source, state=self, timeout=self._timeout, qos=self._qos
            )
        if message is None:
            return "preempted" if self._is_preempted() else "aborted"
        if self._callback is None:
            for key in self._keys[:1]:
                ud[key] = message
            return "succeeded"
        try:
            result = self._callback(message, ud)
        except Exception:
            smach.logerr(f"the callback of a message failed:\n{traceback.format_exc()}")
            return "aborted"
        return "succeeded" if result is None or result else "aborted"


class ReadTopicState(RosState):
    """Reads one message; without `topic` and `msg_type` the keys of these names state them.

    Without a type at all it is that of the publishers on the ROS graph.
    """

    def __init__(
        self,
        node: Any,
        topic: str | None = None,
        msg_type: Any = None,
        timeout: ros.Time | None = None,
        qos: Any = None,
        input_keys: Iterable[str] = ("topic",),
        output_keys: Iterable[str] = ("output",),
        outcomes: Iterable[str] = ("succeeded", "aborted", "preempted"),
    ) -> None:
        super().__init__(
            node,
            outcomes=list(outcomes),
            input_keys=list(input_keys),
            output_keys=list(output_keys),
        )
        self._source = topic, msg_type
        self._timeout = ros.limit(timeout)
        self._qos = qos

    def execute(self, ud: Any) -> str:
        """Read one message."""
        topic = self._source[0] or ud["topic"]
        wanted = self._source[1]
        if wanted is None and "msg_type" in ud:
            wanted = ud["msg_type"]
        try:
            msg_type = self._type_of(topic) if wanted is None else wanted
            if isinstance(msg_type, str):
                msg_type = interfaces.message_class(msg_type)
        except ImportError as error:
            smach.logerr(f"topic '{topic}' cannot be read: {error}")
            return "aborted"
        message = None
        if msg_type is not None:
            message = wait_for_message(self.node, topic, msg_type, self, self._timeout, self._qos)
        if message is None:
            ends = self.get_registered_outcomes()
            return "preempted" if "preempted" in ends and self._is_preempted() else "aborted"
        for key in self.get_registered_output_keys():
            ud[key] = message
        return "succeeded"

    def _type_of(self, topic: str) -> str | None:
        """The type of the topic's publishers, waited for; None if there are none."""
        found: list[str] = []
        name = self.node.resolve_topic_name(topic)

        def known() -> bool:
            publishers = self.node.get_publishers_info_by_topic(name)
            found.extend(publisher.topic_type for publisher in publishers)
            return bool(found)

        self._wait_until(known, self._timeout, interval=DISCOVERY_INTERVAL)
        return found[0] if found else None


class Publications:
    """The publications of a node: once, or at a rate until they are stopped.

    The first message on a topic waits for a subscription, up to delivery.MATCH_LIMIT seconds.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        self._changing = threading.Lock()
        self._publishers: dict[str, Any] = {}
        self._timers: dict[str, Any] = {}

    def start(
        self,
        topic: str,
        msg_type: Any,
        message: Any,
        rate: float | None = None,
        qos: Any = None,
        before_first: Callable[[Any], None] | None = None,
    ) -> None:
        """Publish a message, or the result of a function: once, or `rate` times a second.

        Raises FieldError for a value that does not fit its field. If a later message has one, the
        log contains it, and the publication ends. `before_first(publisher)` replaces the
        wait for a subscription.
        """
        create = message if callable(message) else lambda: message

        def checked_message() -> Any:
            return checked(create(), msg_type, "msg")

        def publish_next() -> None:
            try:
                publisher.publish(checked_message())
            except FieldError as error:
                smach.logerr(f"the publication on '{topic}' ends: {error}")
                self._stop_timer(topic)

        self._stop_timer(topic)
        with self._changing:
            publisher: Any = self._publishers.get(topic)
            is_first = publisher is None
            if is_first:
                profile = qos_profiles.profile(qos)
                publisher = self._node.create_publisher(msg_type, topic, profile)
                self._publishers[topic] = publisher
        if is_first and before_first is not None:
            before_first(publisher)
        elif is_first:
            delivery.await_subscription(self._node, publisher)
        try:
            first = checked_message()
        except FieldError:
            if is_first:
                self.stop(topic)
            raise
        with self._changing:
            publisher.publish(first)
            if rate is not None:
                self._timers[topic] = self._node.create_timer(
                    1 / rate, publish_next, callback_group=ros.own_group()
                )

    def stop(self, topic: str) -> bool:
        """End the publication on a topic; whether there was one."""
        self._stop_timer(topic)
        with self._changing:
            publisher = self._publishers.pop(topic, None)
        if publisher is not None:
            delivery.await_acknowledgements([publisher])
            self._node.destroy_publisher(publisher)
        return publisher is not None

    def stop_all(self) -> None:
        """End all publications."""
        for topic in list(self._publishers):
            self.stop(topic)

    def _stop_timer(self, topic: str) -> None:
        with self._changing:
            timer = self._timers.pop(topic, None)
        if timer is not None:
            timer.cancel()
            executor = self._node.executor
            if executor is not None and self._node.context.ok():
                executor.create_task(self._node.destroy_timer, timer)
