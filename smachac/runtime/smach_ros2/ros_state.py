"""RosState: a state that uses a node, and whose waits can be preempted."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import State
from smachac.runtime.smach_ros2.waits import CHECK_INTERVAL, DISCOVERY_INTERVAL, SILENCE_LIMIT, Wait


class RosState(State):
    """A state with a node. The keyword arguments are those of State."""

    def __init__(self, node: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__node = node
        self._ros_wait = Wait(node)

    @property
    def node(self) -> Any:
        """The node that the state uses."""
        return self.__node

    def request_preempt(self) -> None:
        """Request that the state ends early; its wait ends."""
        super().request_preempt()
        self._ros_wait.wake()

    def _wake(self, *_: object) -> None:
        """Make the waiting thread check its condition again; also a callback of futures."""
        self._ros_wait.wake()

    def _wait_until(
        self,
        ready: Callable[[], bool],
        limit: float | None = None,
        stopped: Callable[[], bool] | None = None,
        interval: float = CHECK_INTERVAL,
    ) -> bool:
        """Wait until `ready()`, `stopped()`, a shutdown or `limit` seconds; whether it is ready.

        `stopped` defaults to a preempt request.
        """
        return self._ros_wait.until(ready, stopped or self.preempt_requested, limit, interval)

    def _found(self, server: str, is_ready: Callable[[], bool], limit: float | None) -> bool:
        """Wait for a server up to `limit` seconds; whether it is there. After a few seconds the log
        names the server."""
        report_at = time.monotonic() + SILENCE_LIMIT
        left = "without a limit" if limit is None else f"up to {limit:g} s"

        def is_found() -> bool:
            nonlocal report_at
            if is_ready():
                return True
            if time.monotonic() > report_at:
                report_at = math.inf
                smach.logwarn(f"there is no server for {server} yet: it is waited for, {left}")
            return False

        return self._wait_until(is_found, limit, interval=DISCOVERY_INTERVAL)

    def _is_preempted(self) -> bool:
        """Whether there is a preempt request; if so, it is marked as answered."""
        if not self.preempt_requested():
            return False
        self.service_preempt()
        return True
