"""Whether the server that works on a goal is still there."""

from __future__ import annotations

import time
from typing import Any

from smachac.runtime.smach_ros import ros

SILENCE = 1.0
"""Seconds without a word of the server after which its node is looked for (a word is due 5/s)."""

ACKNOWLEDGED = 5.0
"""Seconds that a server which talks has to mention a new goal."""


class Watch:
    """Looks after the goal of one handle.

    actionlib tells when a server that talks has forgotten a goal; not when the server is gone, nor
    when the goal never arrived, as after a restart of the server.

    Attributes:
        lost: why the goal will never end; None while it may.
    """

    def __init__(self, client: Any, handle: Any) -> None:
        self.lost: str | None = None
        self._client = client
        self._handle = handle
        self._word = client.last_status_msg
        self._sent = self._heard = time.monotonic()
        self._waiting = ros.load("actionlib").CommState.WAITING_FOR_GOAL_ACK

    def look(self) -> None:
        """Look once. This may take a moment when the server is silent."""
        now, word = time.monotonic(), self._client.last_status_msg
        if word is not self._word:
            self._word, self._heard = word, now
            unknown = self._handle.get_comm_state() == self._waiting
            if unknown and now - self._sent > ACKNOWLEDGED:
                self.lost = "the server does not know it"
        elif now - self._heard > SILENCE:
            self._heard = now
            if ros.is_gone(word._connection_header["callerid"]):
                self.lost = "the server is gone"
