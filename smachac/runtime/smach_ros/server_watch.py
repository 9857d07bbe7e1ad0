"""Detection of an action server that has ended or does not know a goal."""

from __future__ import annotations

import time
from typing import Any

from smachac.runtime.smach_ros import ros

SILENCE_LIMIT = 1.0
"""Seconds without a status message (due five times a second) after which the node is checked."""

ACKNOWLEDGE_LIMIT = 5.0
"""Seconds within which a live server has to list a new goal in its status messages."""


class GoalMonitor:
    """Checks whether the goal of one handle can still end.

    actionlib detects that a live server has dropped a goal. It does not detect that the server has
    ended, nor that a goal never arrived, as after a restart of the server.

    Attributes:
        lost: the reason why the goal will never end; None while it may end.
    """

    def __init__(self, client: Any, handle: Any) -> None:
        self.lost: str | None = None
        self._client = client
        self._handle = handle
        self._status = client.last_status_msg
        self._sent = self._received = time.monotonic()
        self._waiting = ros.load("actionlib").CommState.WAITING_FOR_GOAL_ACK

    def check(self) -> None:
        """Update `lost`. This takes up to a second if the server is silent."""
        now, status = time.monotonic(), self._client.last_status_msg
        if status is not self._status:
            self._status, self._received = status, now
            unacknowledged = self._handle.get_comm_state() == self._waiting
            if unacknowledged and now - self._sent > ACKNOWLEDGE_LIMIT:
                self.lost = "the server does not know it"
        elif now - self._received > SILENCE_LIMIT:
            self._received = now
            if ros.is_gone(status._connection_header["callerid"]):
                self.lost = "the server is gone"
