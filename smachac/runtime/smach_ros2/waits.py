"""Wait: the wait of a thread for ROS, which ends at an event, a stop request or a time limit."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from types import TracebackType
from typing import Any

from smachac.runtime.smach_ros2 import ros, spinning

CHECK_INTERVAL = 0.5
"""Seconds between two checks of what notifies nobody: the executor, a server that was killed."""

SILENCE_LIMIT = 5.0
"""Seconds after which the log names what a state waits for: a topic or a server."""

DISCOVERY_INTERVAL = 0.02
"""Seconds between two checks of the ROS graph; rclpy has no notification for its changes."""


class TimeLimit:
    """A limit in the time of the node's clock: simulated time if the node uses it.

    In simulated time `wake` is called at each change of the clock. That clock is zero until its
    first message, which may have any time: the limit begins with it. If none comes within
    SILENCE_LIMIT seconds of real time, the log says so once.
    """

    def __init__(self, node: Any, length: float | None, wake: Callable[[], None]) -> None:
        self._clock = node.get_clock()
        self._wake = wake
        self._jumps: Any = None
        self._length = math.inf if length is None else length
        self._simulated = length is not None and self._clock.ros_time_is_active
        self._begin = self._now()
        self._report_at = time.monotonic() + SILENCE_LIMIT if self._simulated else math.inf
        self._node = node

    def __enter__(self) -> TimeLimit:
        if self._simulated:
            module = ros.load("rclpy.clock")
            step = ros.load("rclpy.duration").Duration(nanoseconds=1)
            threshold = module.JumpThreshold(min_forward=step, min_backward=None)
            self._jumps = self._clock.create_jump_callback(
                threshold, post_callback=lambda jump: self._wake()
            )
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._jumps is not None:
            self._jumps.unregister()

    def _now(self) -> float:
        if self._simulated:
            return float(self._clock.now().nanoseconds) / ros.NANOSECONDS
        return time.monotonic()

    def left(self) -> float:
        """The seconds until the end; inf without a limit."""
        now = self._now()
        self._begin = self._begin or now
        if not self._begin and time.monotonic() > self._report_at:
            self._report_at = math.inf
            self._node.get_logger().warning(
                f"use_sim_time is set, and no time came on /clock for {SILENCE_LIMIT:g} s: "
                "time limits begin with the first one"
            )
        return self._length - (now - self._begin)

    def pause(self) -> float:
        """The seconds of wall time that a thread may wait before it checks the limit again."""
        return math.inf if self._simulated else self.left()


class Wait:
    """The waits of one thread for one node. Any thread may end a pause with `wake`."""

    def __init__(self, node: Any) -> None:
        self._node = node
        self._woken = threading.Event()
        node.context.on_shutdown(self.wake)

    def wake(self) -> None:
        """Make the waiting thread check its condition again."""
        self._woken.set()

    def until(
        self,
        ready: Callable[[], bool],
        stopped: Callable[[], bool],
        limit: float | None = None,
        interval: float = CHECK_INTERVAL,
    ) -> bool:
        """Wait until `ready()`, `stopped()`, a shutdown or `limit` seconds; whether it is ready.

        The conditions are checked at each `wake` and after `interval` seconds without one.
        """
        probe = spinning.Probe(self._node)
        spinning.ensure(self._node)
        next_probe = time.monotonic() + CHECK_INTERVAL
        with TimeLimit(self._node, limit, self.wake) as end:
            while True:
                self._woken.clear()
                if ready():
                    return True
                if stopped() or not self._node.context.ok() or end.left() <= 0:
                    return False
                self._woken.wait(min(interval, end.pause()))
                if time.monotonic() > next_probe and self._node.context.ok():
                    probe.check()
                    next_probe = time.monotonic() + CHECK_INTERVAL
