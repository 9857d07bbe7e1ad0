"""Subscription: a subscription for the time of one wait, which reports why no message arrives."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from types import TracebackType
from typing import Any

from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.waits import SILENCE_LIMIT


class Subscription:
    """The messages of a topic that arrive inside a `with` block.

    rclpy itself logs a warning with the name of the policy if a publisher has another quality of
    service.

    Attributes:
        received: the messages that were not taken yet, as many as the depth of the profile.
    """

    def __init__(
        self, node: Any, topic: str, msg_type: Any, qos: Any, wake: Callable[[], None]
    ) -> None:
        self.received: deque[Any] = deque(maxlen=qos.depth or None)
        self._node = node
        self._topic = topic
        self._wake = wake
        self._make = (msg_type, topic, self._store, qos)
        self._report_at: float | None = None

    def __enter__(self) -> Subscription:
        self._report_at = time.monotonic() + SILENCE_LIMIT
        self._subscription = self._node.create_subscription(
            *self._make, callback_group=ros.own_group()
        )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Leave the topic; in the thread of the executor, which may be using the subscription."""
        executor = self._node.executor
        if executor is not None and self._node.context.ok():
            executor.create_task(self._node.destroy_subscription, self._subscription)

    def _store(self, message: Any) -> None:
        self._report_at = None
        self.received.append(message)
        self._wake()

    def report_silence(self) -> None:
        """Log once that no message has arrived, with the publishers that are there."""
        if self._report_at is None or time.monotonic() < self._report_at:
            return
        self._report_at = None
        known = self._node.get_publishers_info_by_topic(self._subscription.topic_name)
        publishers = [
            f"{item.node_name} ({item.topic_type}, "
            f"{item.qos_profile.reliability.name.lower()}, "
            f"{item.qos_profile.durability.name.lower()})"
            for item in known
        ]
        self._node.get_logger().warning(
            f"topic '{self._topic}': no message for {SILENCE_LIMIT:.0f} s; "
            f"publishers: {', '.join(publishers) or 'none'}"
        )
