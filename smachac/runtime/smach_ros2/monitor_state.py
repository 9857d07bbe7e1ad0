"""MonitorState: checks the messages of a topic against a condition."""

from __future__ import annotations

import traceback
from collections.abc import Callable
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach_ros2 import qos as qos_profiles
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.subscriptions import Subscription


class MonitorState(RosState):
    """Ends as `invalid` at the first message for which `cond_cb(userdata, message)` is false.

    After `max_checks` messages for which it is true the state ends as `valid`; -1 is no limit.
    A condition that raises counts as false. If `timeout` passes without a decision the state ends
    as `invalid`; the default is no limit. `qos` is the quality of service of the subscription, see
    `smach_ros2.qos.profile`.
    """

    def __init__(
        self,
        node: Any,
        topic: str,
        msg_type: Any,
        cond_cb: Callable[..., Any],
        max_checks: int = -1,
        input_keys: list[str] | None = None,
        output_keys: list[str] | None = None,
        timeout: ros.Time | None = None,
        qos: Any = None,
    ) -> None:
        super().__init__(
            node,
            outcomes=["valid", "invalid", "preempted"],
            input_keys=list(input_keys or []),
            output_keys=list(output_keys or []),
        )
        self._topic = topic
        self._type = msg_type
        self._condition = cond_cb
        self._max_checks = max_checks
        self._limit = ros.limit(timeout)
        self._qos = qos_profiles.profile(qos)

    def execute(self, ud: Any) -> str:
        """Check messages until one decides the outcome."""
        if self._is_preempted():
            return "preempted"
        held = 0
        outcome = ""
        with Subscription(self.node, self._topic, self._type, self._qos, self._wake) as messages:

            def decided() -> bool:
                nonlocal held, outcome
                while not outcome and messages.received:
                    holds = self._holds(ud, messages.received.popleft())
                    held += holds
                    if not holds or held == self._max_checks:
                        outcome = "valid" if holds else "invalid"
                messages.report_silence()
                return bool(outcome)

            self._wait_until(decided, self._limit)
        if self._is_preempted():
            return "preempted"
        if not outcome and self.node.context.ok():
            smach.logwarn(f"topic '{self._topic}' was monitored for {self._limit} s")
            return "invalid"
        return outcome or "preempted"

    def _holds(self, ud: Any, message: Any) -> bool:
        try:
            return bool(self._condition(ud, message))
        except Exception:
            smach.logerr(f"the condition of a monitor failed:\n{traceback.format_exc()}")
            return False
