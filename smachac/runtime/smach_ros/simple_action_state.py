"""SimpleActionState: a state that sends one goal to an action server and waits for its end."""

from __future__ import annotations

import copy
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import InvalidStateError, has_smach_interface
from smachac.runtime.smach_ros import ros
from smachac.runtime.smach_ros.ros_state import RosState
from smachac.runtime.smach_ros.server_watch import GoalMonitor
from smachac.runtime.state_callbacks import callback, checked_slots, is_outcome

SHUTDOWN_WAIT = 5.0
"""Seconds that a shutdown of the node waits for the end of a cancelled goal."""


class SimpleActionState(RosState):
    """Sends a goal and waits for its end; ends as succeeded, aborted or preempted.

    The goal is `goal` (default: an empty one) or the value of `goal_key`. Its fields `goal_slots`
    are set from the keys of the same names; then `goal_cb(userdata, goal)` may change it or return
    another. If that raises, no goal is sent and the state ends as aborted.

    `result_cb(userdata, status, result)` may return an outcome; the result is written to
    `result_key`, its fields `result_slots` to the keys of the same names. During the wait a thread
    of rospy calls `feedback_cb(userdata, feedback)`.

    A preempt request and `exec_timeout` cancel the goal. The state then ends with the server's
    status: preempted after a request, aborted after the timeout. It is also aborted when there is
    no server within `server_wait_timeout`, when a cancelled goal has not ended within
    `preempt_timeout`, and when the server has ended. The three are durations in ROS time.

    The constants are the stages of smach_ros, for code that names them; no stage is stored.
    """

    WAITING_FOR_SERVER = 0
    INACTIVE = 1
    ACTIVE = 2
    PREEMPTING = 3
    COMPLETED = 4

    def __init__(
        self,
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
        super().__init__(["succeeded", "aborted", "preempted"])
        if callable(goal):
            raise InvalidStateError("a goal is a message, no function: see goal_cb")
        self._name = action_name
        self._type = action_spec
        message = action_spec()
        self._goal = message.action_goal.goal if goal is None else goal
        self._goal_key = goal_key
        self._result_key = result_key
        self._goal_slots = checked_slots(goal_slots, message.action_goal.goal.__slots__, "goal")
        self._result_slots = checked_slots(
            result_slots, message.action_result.result.__slots__, "result"
        )
        keys = tuple(input_keys), tuple(output_keys)
        self._goal_cb = callback(self, "goal", goal_cb, goal_cb_args, goal_cb_kwargs, keys)
        self._feedback_cb = callback(
            self, "feedback", feedback_cb, feedback_cb_args, feedback_cb_kwargs, keys
        )
        self._result_cb = callback(
            self, "result", result_cb, result_cb_args, result_cb_kwargs, keys
        )
        if has_smach_interface(result_cb):
            self.register_outcomes(result_cb.get_registered_outcomes())
        self.register_outcomes(outcomes)
        self.register_input_keys([*filter(None, [goal_key]), *self._goal_slots, *keys[0]])
        self.register_output_keys([*filter(None, [result_key]), *self._result_slots, *keys[1]])
        self._exec_timeout = ros.limit(exec_timeout)
        self._preempt_timeout = ros.seconds(preempt_timeout)
        self._server_wait_timeout = ros.seconds(server_wait_timeout)
        self._client: Any = None
        self._search_thread: threading.Thread | None = None
        self._has_shutdown_hook = False

    def execute(self, ud: Any) -> str:
        """Send one goal and wait for its end."""
        found = self._find_server()
        if self._preempted():
            return "preempted"
        if not found:
            if not self._rospy.is_shutdown():
                smach.logerr(f"there is no server for action '{self._name}'")
            return "aborted"
        try:
            handle = self._client.send_goal(
                self._fill_goal(ud),
                lambda handle: self._wake(),
                lambda handle, feedback: self._on_feedback(ud, feedback),
            )
        except self._rospy.ROSSerializationException as error:
            smach.logerr(f"no goal is sent to action '{self._name}': {error}")
            return "aborted"
        except Exception:
            smach.logerr(f"no goal is sent to action '{self._name}':\n{traceback.format_exc()}")
            return "aborted"
        try:
            ended = self._await_end(handle)
        finally:
            self._cancel(handle)
        return self._take_result(ud, handle) if ended else "aborted"

    # The server

    def _find_server(self) -> bool:
        """Wait for the server, in a thread of its own: rospy's wait cannot be interrupted."""
        if self._client is None:
            self._client = ros.load("actionlib").ActionClient(self._name, self._type)
        if self._search_thread is None or not self._search_thread.is_alive():
            self._search_thread = threading.Thread(target=self._search, daemon=True)
            self._search_thread.start()
        thread = self._search_thread
        found = self._wait(lambda: not thread.is_alive(), self._server_wait_timeout)
        return found and not self._rospy.is_shutdown()

    def _search(self) -> None:
        # Not in the main thread: on_shutdown may wait for the end of a shutdown that is under way.
        if not self._has_shutdown_hook:
            self._rospy.on_shutdown(self._cancel_at_shutdown)
            self._has_shutdown_hook = True
        self._client.wait_for_server()

    def _cancel_at_shutdown(self) -> None:
        """Cancel the goal during a shutdown of the node, while its topics still work.

        This may run in a signal handler that interrupts the sending of a goal: so the goals are
        taken from actionlib, and another thread does what may need a lock of the interrupted code.
        """
        goals = [reference() for reference in list(self._client.manager.statuses)]
        handle = ros.load("actionlib").ClientGoalHandle
        under_way = [handle(goal) for goal in goals if goal is not None]
        if not under_way:
            return

        def cancel() -> None:
            for goal in under_way:
                self._cancel(goal)
            while not all(map(self._is_done, under_way)):
                time.sleep(0.01)

        thread = threading.Thread(target=cancel, daemon=True)
        thread.start()
        thread.join(SHUTDOWN_WAIT)

    # The goal

    def _fill_goal(self, ud: Any) -> Any:
        """The goal to send; a copy, so that each visit starts from the given goal."""
        if self._goal_key is None:
            goal = copy.deepcopy(self._goal)
        else:
            goal = copy.copy(ud[self._goal_key])
        for slot in self._goal_slots:
            setattr(goal, slot, ud[slot])
        if self._goal_cb is None:
            return goal
        changed = self._goal_cb(ud, goal)
        return goal if changed is None else changed

    def _await_end(self, handle: Any) -> bool:
        """Wait for the end of a goal, and cancel it if necessary; whether it has ended."""
        monitor = GoalMonitor(self._client, handle)

        def done() -> bool:
            return self._is_done(handle) or monitor.lost is not None

        def stopped() -> bool:
            monitor.check()
            return self._stopped()

        def shut_down() -> bool:
            monitor.check()
            return bool(self._rospy.is_shutdown())

        if not self._wait(done, self._exec_timeout, stopped):
            if not self._stopped():
                smach.logwarn(f"action '{self._name}' is cancelled after {self._exec_timeout} s")
            self._cancel(handle)
            if not self._wait(done, self._preempt_timeout, shut_down):
                smach.logerr(f"action '{self._name}' was cancelled and has not ended")
        if monitor.lost is not None and not self._is_done(handle):
            smach.logerr(f"the goal of action '{self._name}' is lost: {monitor.lost}")
        return self._is_done(handle)

    def _is_done(self, handle: Any) -> bool:
        return bool(handle.get_comm_state() == ros.load("actionlib").CommState.DONE)

    def _cancel(self, handle: Any) -> None:
        try:
            if not self._is_done(handle):
                handle.cancel()
        except self._rospy.ROSException as error:
            smach.logdebug(f"action '{self._name}' is not told that it is cancelled: {error}")

    def _on_feedback(self, ud: Any, feedback: Any) -> None:
        if self._feedback_cb is not None:
            self._feedback_cb(ud, feedback)

    # The result

    def _take_result(self, ud: Any, handle: Any) -> str:
        """Pass the result of an ended goal to the callback and the userdata; the outcome."""
        status, result = handle.get_goal_status(), handle.get_result()
        if result is None:
            smach.logerr(f"action '{self._name}' ended without a result")
            return "aborted"
        outcome = None
        if self._result_cb is not None:
            try:
                outcome = self._result_cb(ud, status, result)
            except Exception:
                smach.logerr(f"the result callback failed:\n{traceback.format_exc()}")
                return "aborted"
            if outcome is not None and not is_outcome(self, outcome, self._name):
                return "aborted"
        if self._result_key is not None:
            ud[self._result_key] = result
        for slot in self._result_slots:
            ud[slot] = getattr(result, slot)
        return self._status_outcome(status) if outcome is None else outcome

    def _status_outcome(self, status: int) -> str:
        """The outcome for the status that the server gave."""
        known = ros.load("actionlib_msgs.msg").GoalStatus
        if status == known.SUCCEEDED:
            return "succeeded"
        if status in (known.PREEMPTED, known.RECALLED) and self._preempted():
            return "preempted"
        return "aborted"
