"""The delivery of messages: the first one of a publisher waits for a subscription, and the end of a
program waits until the last ones have arrived.

A publisher and a subscription need time to find each other. A message that is published before is
lost, unless both are transient local; a message that is under way when its publisher ends is lost
too.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from typing import Any

from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.waits import DISCOVERY_INTERVAL, Wait

MATCH_LIMIT = 3.0
"""Seconds that the first message of a publisher waits for a subscription."""

END_LIMIT = 1.0
"""Seconds that the end of a program waits until messages have arrived."""


def await_subscription(
    node: Any,
    publisher: Any,
    limit: float = MATCH_LIMIT,
    wait: Wait | None = None,
    stopped: Callable[[], bool] = lambda: False,
) -> None:
    """Wait up to `limit` seconds of real time until a publisher has a subscription.

    If there is none, a warning names those with another type or quality of service; not for a
    publisher that is transient local, whose messages later subscriptions may get.
    """
    end = time.monotonic() + limit

    def is_over() -> bool:
        return stopped() or time.monotonic() >= end

    def is_matched() -> bool:
        return bool(publisher.get_subscription_count())

    matched = (wait or Wait(node)).until(is_matched, is_over, interval=DISCOVERY_INTERVAL)
    durability = ros.load("rclpy.qos").DurabilityPolicy
    is_latched = publisher.qos_profile.durability == durability.TRANSIENT_LOCAL
    if matched or is_latched or not limit or stopped() or not node.context.ok():
        return
    others = [
        f"{item.node_name} ({item.topic_type}, {item.qos_profile.reliability.name.lower()}, "
        f"{item.qos_profile.durability.name.lower()})"
        for item in node.get_subscriptions_info_by_topic(publisher.topic_name)
    ]
    node.get_logger().warning(
        f"topic '{publisher.topic_name}': no subscription after {limit:g} s, the message may be "
        f"lost; subscriptions that do not fit: {', '.join(others) or 'none'}"
    )


def await_acknowledgements(publishers: Iterable[Any], limit: float = END_LIMIT) -> None:
    """Wait up to `limit` seconds until all subscriptions have the messages of the publishers."""
    end = time.monotonic() + limit
    duration = ros.load("rclpy.duration").Duration
    errors = ros.load("rclpy.impl.implementation_singleton").rclpy_implementation
    for publisher in publishers:
        try:
            publisher.wait_for_all_acked(duration(seconds=max(0.0, end - time.monotonic())))
        except (ros.invalid_handle(), errors.RCLError):  # destroyed; not every middleware can
            continue
