"""RosState: a leaf that waits for ROS and can be preempted."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable

from smachac.runtime.smach import State
from smachac.runtime.smach_ros import ros

POLL_INTERVAL = 0.05
"""Seconds between two checks of the conditions that notify nobody: shutdown, ROS time."""


class RosState(State):
    """A state whose waits end at a preempt request, a shutdown of the node, or a time limit."""

    def __init__(
        self,
        outcomes: Iterable[str],
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(outcomes, input_keys, output_keys)
        self._rospy = ros.rospy()
        self._changed = threading.Condition()

    def request_preempt(self) -> None:
        """Request that the state ends early; its wait ends."""
        super().request_preempt()
        self._wake()

    def _wake(self) -> None:
        """Make the waiting thread check its condition again."""
        with self._changed:
            self._changed.notify_all()

    def _stopped(self) -> bool:
        """Whether waits are to end: a preempt request or a shutdown."""
        return self.preempt_requested() or bool(self._rospy.is_shutdown())

    def _wait(
        self,
        ready: Callable[[], bool],
        limit: float | None = None,
        stopped: Callable[[], bool] | None = None,
    ) -> bool:
        """Wait until `ready()`, `stopped()`, or `limit` seconds of ROS time; whether it is ready.

        `stopped` defaults to a preempt request or a shutdown.
        """
        stopped = stopped or self._stopped
        end = None if limit is None else self._rospy.get_time() + limit
        while not ready():
            if stopped() or (end is not None and self._rospy.get_time() >= end):
                return False
            with self._changed:
                self._changed.wait(POLL_INTERVAL)
        return True

    def _preempted(self) -> bool:
        """Whether there is a preempt request; if so, it is marked as answered."""
        if not self.preempt_requested():
            return False
        self.service_preempt()
        return True
