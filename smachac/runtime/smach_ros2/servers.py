"""ServerWatch: detects that the server of a service or an action has ended."""

from __future__ import annotations

import time
from typing import Any

CHECK_INTERVAL = 0.5
"""Seconds between two looks at the ROS graph, which take about as long as a service call."""

Gids = frozenset[bytes]


class ServerWatch:
    """Checks whether a server that was found is still on the ROS graph.

    A server is identified by the publishers of one of its topics: the status topic of an action,
    the topic of the responses of a service. A server that was started again has other publishers.
    Where the middleware has no such topic the server counts as alive.
    """

    def __init__(self, node: Any, topic: str, is_dds_name: bool = False) -> None:
        self._node = node
        self._topic = topic
        self._is_dds_name = is_dds_name
        self._found: Gids = frozenset()
        self._next_check = 0.0
        self._is_gone = False

    def start(self) -> None:
        """Remember the servers that are there now."""
        self._found = self._publishers()
        self._is_gone = False
        self._next_check = time.monotonic() + CHECK_INTERVAL

    def is_gone(self) -> bool:
        """Whether none of the remembered servers is left."""
        if self._found and not self._is_gone and time.monotonic() >= self._next_check:
            self._next_check = time.monotonic() + CHECK_INTERVAL
            self._is_gone = not self._found & self._publishers()
        return self._is_gone

    def _publishers(self) -> Gids:
        known = self._node.get_publishers_info_by_topic(self._topic, self._is_dds_name)
        return frozenset(bytes(item.endpoint_gid) for item in known)


def watch_action(node: Any, name: str) -> ServerWatch:
    """The watch for the server of an action."""
    return ServerWatch(node, f"{node.resolve_topic_name(name)}/_action/status")


def watch_service(node: Any, name: str) -> ServerWatch:
    """The watch for the server of a service."""
    return ServerWatch(node, f"rr{node.resolve_service_name(name)}Reply", is_dds_name=True)
