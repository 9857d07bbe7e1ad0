"""RosState: a state that uses a node, and whose waits can be preempted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from smachac.runtime.smach import State
from smachac.runtime.smach_ros2.waits import CHECK_INTERVAL, Wait


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

    def _is_preempted(self) -> bool:
        """Whether there is a preempt request; if so, it is marked as answered."""
        if not self.preempt_requested():
            return False
        self.service_preempt()
        return True
