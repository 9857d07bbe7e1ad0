"""MonitorState: checks the messages of a topic against a condition."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach_ros.ros_state import RosState


class MonitorState(RosState):
    """Ends as `invalid` at the first message for which `cond_cb(userdata, message)` is false.

    After `max_checks` messages for which it is true the state ends as `valid`; -1 is no limit.
    A condition that raises counts as false.
    """

    def __init__(
        self,
        topic: str,
        msg_type: Any,
        cond_cb: Callable[..., Any],
        max_checks: int = -1,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
    ) -> None:
        super().__init__(["valid", "invalid", "preempted"], input_keys, output_keys)
        self._topic = topic
        self._type = msg_type
        self._condition = cond_cb
        self._max_checks = max_checks

    def execute(self, ud: Any) -> str:
        """Check messages until one decides the outcome."""
        if self._preempted():
            return "preempted"
        decided: list[str] = []
        held = 0

        def check(message: Any) -> None:
            nonlocal held
            if decided:
                return
            try:
                holds = bool(self._condition(ud, message))
            except Exception:
                smach.logerr(f"the condition of a monitor failed:\n{traceback.format_exc()}")
                holds = False
            held += holds
            if not holds or 0 < self._max_checks <= held:
                decided.append("valid" if holds else "invalid")
                self._wake()

        subscriber = self._rospy.Subscriber(self._topic, self._type, check)
        try:
            self._wait(lambda: bool(decided))
        finally:
            subscriber.unregister()
        if self._preempted():
            return "preempted"
        return decided[0] if decided else "preempted"
