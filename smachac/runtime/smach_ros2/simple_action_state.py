"""SimpleActionState: a state that sends one goal to an action server and waits for its end."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import InvalidStateError, has_smach_interface
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.policies import Incoming, Outgoing
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.servers import watch_action
from smachac.runtime.state_callbacks import callback, checked_slots

ACCEPT_LIMIT = 10.0
"""Seconds within which a server has to accept or reject a goal."""


class GoalClient(ros.ActionClient):
    """An action client without two races of rclpy 9 between a program and its executor.

    rclpy gives the client to the executor before its lock exists, and registers a goal after the
    lock was released, so that a quick answer gets lost. Here the lock exists from the start, can be
    locked twice by one thread, and is held until the goal is registered.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        self._reentrant_lock = threading.RLock()
        super().__init__(*args, **kwargs)

    @property
    def _lock(self) -> threading.RLock:
        return self._reentrant_lock

    @_lock.setter
    def _lock(self, lock: object) -> None:
        """Keep the own lock; the constructor of rclpy sets another one."""

    def send_goal_async(self, *args: Any, **kwargs: Any) -> Any:
        """Send a goal; the future of its handle."""
        with self._reentrant_lock:
            return super().send_goal_async(*args, **kwargs)


class SimpleActionState(RosState):
    """Sends a goal and waits for its end; ends as succeeded, aborted or preempted.

    The goal is `goal` (default: an empty one) or the value of `goal_key`. Its fields `goal_slots`
    are set from the keys of the same names; then `goal_cb(userdata, goal)` may change it or return
    another. If that raises, no goal is sent and the state ends as aborted. Each visit sends a new
    goal.

    `result_cb(userdata, status, result)` may return an outcome; the result is written to
    `result_key`, its fields `result_slots` to the keys of the same names. During the wait the
    executor of the node calls `feedback_cb(userdata, feedback)`.

    A preempt request and `exec_timeout` cancel the goal. The state then ends with the server's
    status: preempted after a request, aborted after the timeout. It is also aborted when there is
    no server within `server_wait_timeout`, when the server rejects the goal, when a cancelled goal
    has not ended within `preempt_timeout`, and when the server has ended. The three are durations
    in ROS time: seconds, or rclpy.duration.Duration.

    The constants are the stages of smach_ros, for code that names them; no stage is stored.
    """

    WAITING_FOR_SERVER = 0
    INACTIVE = 1
    ACTIVE = 2
    PREEMPTING = 3
    COMPLETED = 4

    def __init__(
        self,
        node: Any,
        action_name: str,
        action_spec: Any,
        goal: Any = None,
        goal_key: str | None = None,
        goal_slots: Iterable[str] = (),
        goal_cb: Callable[..., Any] | None = None,
        goal_cb_args: Iterable[Any] = (),
        goal_cb_kwargs: Mapping[str, Any] | None = None,
        result_key: str | None = None,
        result_slots: Iterable[str] = (),
        result_cb: Callable[..., Any] | None = None,
        result_cb_args: Iterable[Any] = (),
        result_cb_kwargs: Mapping[str, Any] | None = None,
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        outcomes: Iterable[str] = (),
        exec_timeout: ros.Time | None = None,
        preempt_timeout: ros.Time = 60.0,
        server_wait_timeout: ros.Time = 60.0,
        feedback_cb: Callable[..., Any] | None = None,
        feedback_cb_args: Iterable[Any] = (),
        feedback_cb_kwargs: Mapping[str, Any] | None = None,
    ) -> None:
        super().__init__(node, outcomes=["succeeded", "aborted", "preempted"])
        if callable(goal):
            raise InvalidStateError("a goal is a message, no function: see goal_cb")
        self._name = action_name
        keys = tuple(input_keys), tuple(output_keys)
        self._outgoing = Outgoing(
            name=action_name,
            part="goal",
            kind=action_spec.Goal,
            default=action_spec.Goal() if goal is None else goal,
            key=goal_key,
            slots=checked_slots(goal_slots, ros.fields(action_spec.Goal), "goal"),
            callback=callback(self, "goal", goal_cb, goal_cb_args, goal_cb_kwargs, keys),
        )
        self._feedback_cb = callback(
            self, "feedback", feedback_cb, feedback_cb_args, feedback_cb_kwargs, keys
        )
        self._incoming = Incoming(
            name=action_name,
            key=result_key,
            slots=checked_slots(result_slots, ros.fields(action_spec.Result), "result"),
            callback=callback(self, "result", result_cb, result_cb_args, result_cb_kwargs, keys),
        )
        if has_smach_interface(result_cb):
            self.register_outcomes(result_cb.get_registered_outcomes())
        self.register_outcomes(outcomes)
        self.register_input_keys([*self._outgoing.keys(), *keys[0]])
        self.register_output_keys([*self._incoming.keys(), *keys[1]])
        self._exec_timeout = ros.limit(exec_timeout)
        self._preempt_timeout = ros.seconds(preempt_timeout)
        self._server_wait_timeout = ros.seconds(server_wait_timeout)
        self._client = GoalClient(node, action_spec, action_name, callback_group=ros.own_group())
        self._server = watch_action(node, action_name)

    def execute(self, ud: Any) -> str:
        """Send one goal and wait for its end."""
        if self._is_preempted():
            return "preempted"
        action = f"action '{self.node.resolve_topic_name(self._name)}'"
        found = self._found(action, self._client.server_is_ready, self._server_wait_timeout)
        if self._is_preempted():
            return "preempted"
        if not found:
            smach.logerr(f"there is no server for {action}")
            return "aborted"
        goal = self._outgoing.build(ud)
        if goal is None:
            return "aborted"
        handle = self._send(ud, goal)
        if handle is None:
            return "aborted"
        response = self._await_result(handle)
        if response is None:
            return "aborted"
        outcome = self._incoming.take(self, ud, response.result, response.status)
        return outcome or self._outcome_of(response.status)

    def _send(self, ud: Any, goal: Any) -> Any:
        """Send a goal; its handle if the server accepts it. None otherwise, which is logged."""
        self._server.start()
        try:
            sent = self._client.send_goal_async(
                goal, feedback_callback=lambda message: self._on_feedback(ud, message.feedback)
            )
        except (TypeError, ros.invalid_handle()) as error:
            smach.logerr(f"no goal can be sent to action '{self._name}': {error!r}")
            return None
        sent.add_done_callback(self._wake)
        self._wait_until(
            lambda: sent.done() or self._server.is_gone(), ACCEPT_LIMIT, stopped=lambda: False
        )
        if not sent.done():
            sent.add_done_callback(_cancel_if_accepted)
            smach.logerr(f"the server of action '{self._name}' does not answer to a goal")
            return None
        handle = sent.result()
        if handle is None or not handle.accepted:
            smach.logwarn(f"the server of action '{self._name}' rejected the goal")
            return None
        return handle

    def _await_result(self, handle: Any) -> Any:
        """The result of a goal, which is cancelled if necessary; None if it does not end."""
        result = handle.get_result_async()
        result.add_done_callback(self._wake)

        def ended() -> bool:
            return result.done() or self._server.is_gone()

        if not self._wait_until(ended, self._exec_timeout) and self.node.context.ok():
            if not self.preempt_requested():
                smach.logwarn(f"action '{self._name}' is cancelled after {self._exec_timeout} s")
            handle.cancel_goal_async().add_done_callback(self._on_cancel_response)
            if not self._wait_until(ended, self._preempt_timeout, stopped=lambda: False):
                smach.logerr(f"action '{self._name}' was cancelled and has not ended")
        if result.done():
            return result.result()
        if self._server.is_gone():
            smach.logerr(f"the server of action '{self._name}' has ended: the goal is lost")
        return None

    def _on_cancel_response(self, response: Any) -> None:
        """Log that the server rejects a cancel request. The return code is then 0, no error, and
        the response has no goals."""
        answer = response.result()
        if answer is not None and not answer.goals_canceling and answer.return_code == 0:
            smach.logwarn(
                f"the server of action '{self._name}' rejected the cancel request: the end of the "
                f"goal is waited for, up to {self._preempt_timeout:g} s"
            )

    def _on_feedback(self, ud: Any, feedback: Any) -> None:
        if self._feedback_cb is None:
            return
        try:
            self._feedback_cb(ud, feedback)
        except Exception:
            ros.log_failure(self.node, f"the feedback callback of action '{self._name}' failed")

    def _outcome_of(self, status: int) -> str:
        """The outcome for the status that the server gave."""
        known = ros.load("action_msgs.msg").GoalStatus
        if status == known.STATUS_SUCCEEDED:
            return "succeeded"
        if status == known.STATUS_CANCELED and self._is_preempted():
            return "preempted"
        return "aborted"


def _cancel_if_accepted(sent: Any) -> None:
    """Cancel a goal that was accepted after the state had ended."""
    handle = sent.result()
    if handle is not None and handle.accepted:
        handle.cancel_goal_async()
