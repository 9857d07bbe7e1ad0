"""RosState: a state that uses a node, and whose waits can be preempted."""

from __future__ import annotations

import math
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
        most = math.inf if limit is None else limit
        first = min(most, SILENCE_LIMIT)
        if self._wait_until(is_ready, first, interval=DISCOVERY_INTERVAL):
            return True
        if self.preempt_requested() or not self.node.context.ok() or first == most:
            return False
        left = "without a limit" if limit is None else f"up to {most:g} s"
        smach.logwarn(f"there is no server for {server} yet: it is waited for, {left}")
        rest = None if limit is None else most - first
        return self._wait_until(is_ready, rest, interval=DISCOVERY_INTERVAL)

    def _is_preempted(self) -> bool:
        """Whether there is a preempt request; if so, it is marked as answered."""
        if not self.preempt_requested():
            return False
        self.service_preempt()
        return True
