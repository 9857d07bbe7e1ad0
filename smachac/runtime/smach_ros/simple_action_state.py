"""SimpleActionState: one goal for an action server."""

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
from smachac.runtime.smach_ros.ros_state import RosState, callback, check_slots, is_outcome
from smachac.runtime.smach_ros.server_watch import Watch

STOPPING = 5.0
"""Seconds that a node which shuts down waits for the server to confirm that it stopped."""


class SimpleActionState(RosState):
    """Sends a goal and waits for its end; ends as succeeded, aborted or preempted.

    The goal is `goal` or an empty one, replaced by what is under `goal_key`, its fields
    `goal_slots` set from the keys of the same names, then given to `goal_cb(userdata, goal)`, which
    changes it or returns another; one that raises ends the state as aborted, with nothing sent.

    `result_cb(userdata, status, result)` may return an outcome; the result goes to `result_key`,
    its fields `result_slots` to the keys of the same names. `feedback_cb(userdata, feedback)` is
    called meanwhile, in a thread of rospy.

    A preempt request and `exec_timeout` cancel the goal. The state then ends as the server says:
    preempted if it stopped on request, aborted if it stopped for the timeout. It is aborted too
    when there is no server within `server_wait_timeout`, when a cancelled goal has not ended
    within `preempt_timeout`, and when the server is gone. The three are lengths of ROS time.
    """

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
        self._goal_slots = check_slots(goal_slots, message.action_goal.goal, "goal")
        self._result_slots = check_slots(result_slots, message.action_result.result, "result")
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
        self._search: threading.Thread | None = None
        self._guarded = False

    def execute(self, ud: Any, /) -> str:
        """Send one goal and wait for its end."""
        found = self._find_server()
        if self._preempted():
            return "preempted"
        if not found:
            if not self._rospy.is_shutdown():
                smach.logerr(f"there is no server for action '{self._name}'")
            return "aborted"
        try:
            goal = self._fill_goal(ud)
        except Exception:
            smach.logerr(f"no goal is sent to action '{self._name}':\n{traceback.format_exc()}")
            return "aborted"
        handle = self._client.send_goal(
            goal, lambda handle: self._tell(), lambda handle, feedback: self._heed(ud, feedback)
        )
        try:
            ended = self._pursue(handle)
        finally:
            self._cancel(handle)
        return self._conclude(ud, handle) if ended else "aborted"

    # The server

    def _find_server(self) -> bool:
        """Wait for the server, in a thread of its own: rospy's wait cannot be broken off."""
        if self._client is None:
            self._client = ros.load("actionlib").ActionClient(self._name, self._type)
        if self._search is None or not self._search.is_alive():
            self._search = threading.Thread(target=self._look, daemon=True)
            self._search.start()
        thread = self._search
        gone = self._wait(lambda: not thread.is_alive(), self._server_wait_timeout)
        return gone and not self._rospy.is_shutdown()

    def _look(self) -> None:
        if not self._guarded:  # not in the main thread: at a shutdown this may wait for its end
            self._rospy.on_shutdown(self._stop)
            self._guarded = True
        self._client.wait_for_server()

    def _stop(self) -> None:
        """Cancel the goal as the node shuts down, while there is still a way to tell the server.

        This may run in a signal handler, in the midst of sending: the goal is asked of actionlib,
        and what could wait for a lock of the interrupted code is done in another thread.
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
        thread.join(STOPPING)

    # The goal

    def _fill_goal(self, ud: Any) -> Any:
        """The goal to send; a copy, so that nothing of it is left to the next."""
        if self._goal_key is None:
            goal = copy.deepcopy(self._goal)
        else:
            goal = copy.copy(ud[self._goal_key])
        for slot in self._goal_slots:
            setattr(goal, slot, ud[slot])
        if self._goal_cb is None:
            return goal
        other = self._goal_cb(ud, goal)
        return goal if other is None else other

    def _pursue(self, handle: Any) -> bool:
        """Wait for the end of a goal, which is cancelled if need be; whether it has ended."""
        watch = Watch(self._client, handle)

        def done() -> bool:
            return self._is_done(handle) or watch.lost is not None

        def stopped() -> bool:
            watch.look()
            return self._stopped()

        def shut_down() -> bool:
            watch.look()
            return bool(self._rospy.is_shutdown())

        if not self._wait(done, self._exec_timeout, stopped):
            if not self._stopped():
                smach.logwarn(f"action '{self._name}' is cancelled after {self._exec_timeout} s")
            self._cancel(handle)
            if not self._wait(done, self._preempt_timeout, shut_down):
                smach.logerr(f"action '{self._name}' was cancelled and has not ended")
        if watch.lost is not None and not self._is_done(handle):
            smach.logerr(f"the goal of action '{self._name}' is lost: {watch.lost}")
        return self._is_done(handle)

    def _is_done(self, handle: Any) -> bool:
        return bool(handle.get_comm_state() == ros.load("actionlib").CommState.DONE)

    def _cancel(self, handle: Any) -> None:
        try:
            if not self._is_done(handle):
                handle.cancel()
        except self._rospy.ROSException as error:
            smach.logdebug(f"action '{self._name}' is not told that it is cancelled: {error}")

    def _heed(self, ud: Any, feedback: Any) -> None:
        if self._feedback_cb is not None:
            self._feedback_cb(ud, feedback)

    # The result

    def _conclude(self, ud: Any, handle: Any) -> str:
        """Hand the result of a goal that has ended to the user; the outcome."""
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
        plain = self._plain_outcome(status)
        return plain if outcome is None else outcome

    def _plain_outcome(self, status: int) -> str:
        """What the server's status amounts to."""
        known = ros.load("actionlib_msgs.msg").GoalStatus
        if status == known.SUCCEEDED:
            return "succeeded"
        if status in (known.PREEMPTED, known.RECALLED) and self._preempted():
            return "preempted"
        return "aborted"
