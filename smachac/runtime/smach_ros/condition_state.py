"""ConditionState: polls a function until it returns true."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from smachac.runtime.smach import InvalidUserCodeError, has_smach_interface
from smachac.runtime.smach_ros import ros
from smachac.runtime.smach_ros.ros_state import RosState


class ConditionState(RosState):
    """Ends with the outcome `true` as soon as `cond_cb(userdata)` is true.

    It ends as `false` after `max_checks` calls (-1: no limit) or after `timeout`; between two calls
    it waits for `poll_rate`. Both are durations in ROS time (s, or rospy.Duration). An exception of
    the condition becomes InvalidUserCodeError.
    """

    def __init__(
        self,
        cond_cb: Callable[..., Any],
        input_keys: list[str] | None = None,
        poll_rate: ros.Time = 0.05,
        timeout: ros.Time | None = None,
        max_checks: int = 1,
    ) -> None:
        super().__init__(["true", "false", "preempted"], input_keys)
        self._condition = cond_cb
        if has_smach_interface(cond_cb):
            self.register_input_keys(cond_cb.get_registered_input_keys())
            self.register_output_keys(cond_cb.get_registered_output_keys())
        self._pause = ros.seconds(poll_rate)
        self._limit = ros.limit(timeout)
        self._max_checks = max_checks

    def execute(self, ud: Any) -> str:
        """Poll the condition until it is true or a limit is reached."""
        end = None if self._limit is None else self._rospy.get_time() + self._limit
        checks = 0
        while not self._rospy.is_shutdown():
            if end is not None and self._rospy.get_time() > end:
                return "false"
            if self._preempted():
                return "preempted"
            if self._holds(ud):
                return "true"
            checks += 1
            if checks == self._max_checks:
                return "false"
            self._wait(lambda: False, self._pause)
        return "preempted"

    def _holds(self, ud: Any) -> bool:
        try:
            return bool(self._condition(ud))
        except Exception as error:
            raise InvalidUserCodeError(
                f"the condition {self._condition!r} failed:\n{traceback.format_exc()}"
            ) from error
