"""ConditionState: calls a function until it returns true."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from smachac.runtime.smach import InvalidUserCodeError, has_smach_interface
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.waits import TimeLimit


class ConditionState(RosState):
    """Ends with the outcome `true` as soon as `cond_cb(userdata)` is true.

    It ends as `false` after `max_checks` calls (-1: no limit) or after `timeout` (a duration:
    seconds, or rclpy.duration.Duration). `poll_rate` is the number of calls a second, or a Duration
    between two calls. An exception of the condition becomes InvalidUserCodeError.
    """

    def __init__(
        self,
        node: Any,
        cond_cb: Callable[..., Any],
        input_keys: list[str] | None = None,
        poll_rate: ros.Time = 20.0,
        timeout: ros.Time | None = None,
        max_checks: int = 1,
    ) -> None:
        super().__init__(node, outcomes=["true", "false", "preempted"], input_keys=input_keys)
        self._condition = cond_cb
        if has_smach_interface(cond_cb):
            self.register_input_keys(cond_cb.get_registered_input_keys())
            self.register_output_keys(cond_cb.get_registered_output_keys())
        is_rate = isinstance(poll_rate, (int, float))
        self._pause = 1 / poll_rate if is_rate else ros.seconds(poll_rate)  # type: ignore[operator]
        self._limit = ros.limit(timeout)
        self._max_checks = max_checks

    def execute(self, ud: Any) -> str:
        """Poll the condition until it is true or a limit is reached."""
        checks = 0
        with TimeLimit(self.node, self._limit, self._wake) as limit:
            while self.node.context.ok():
                if limit.left() < 0:
                    return "false"
                if self._is_preempted():
                    return "preempted"
                if self._holds(ud):
                    return "true"
                checks += 1
                if checks == self._max_checks:
                    return "false"
                self._wait_until(lambda: False, self._pause)
        return "preempted"

    def _holds(self, ud: Any) -> bool:
        try:
            return bool(self._condition(ud))
        except Exception as error:
            raise InvalidUserCodeError(
                f"the condition {self._condition!r} failed:\n{traceback.format_exc()}"
            ) from error
