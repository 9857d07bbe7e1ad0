"""ActionServerWrapper: an action server that runs a machine for each goal."""

from __future__ import annotations

import copy
import threading
import time
from collections import deque
from collections.abc import Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.container_tree import active_paths, containers
from smachac.runtime.smach import Remapper, UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach_ros2 import ros, spinning
from smachac.runtime.smach_ros2.message_fields import FieldError, checked, filled

CANCEL_LIMIT = 1.0
"""Seconds that the status of a goal may take to become `canceling` after the cancel request."""


class ActionServerWrapper:
    """An action server that runs a container for each goal, in a thread of its own.

    Goal, feedback and result are stored in the wrapper's userdata, from which the container copies
    its input keys and to which it copies its output keys. The outcomes listed as succeeded end the
    goal so, those listed as preempted end it as cancelled if a client has cancelled it; any other
    outcome, and an exception, aborts it. A cancel request preempts the container. A new goal
    preempts it too, and is executed after its end; of several goals that wait, the newest is.

    The feedback is published at every transition if the container's userdata has it. With
    `path_slot`, the name of a field of the feedback (a string or a list of strings), the wrapper
    publishes the paths of the active states there.

    The slot maps are from fields of the message to keys. `expand_goal_slots` writes each field of
    the goal to the key of the same name; `pack_result_slots` fills the fields of the result from
    the keys of the same names.

    The methods that end in `_cb`, and `publish_feedback`, may be overridden.
    """

    def __init__(
        self,
        node: Any,
        server_name: str,
        action_spec: Any,
        wrapped_container: Container,
        succeeded_outcomes: Iterable[str] = (),
        aborted_outcomes: Iterable[str] = (),
        preempted_outcomes: Iterable[str] = (),
        goal_key: str = "action_goal",
        feedback_key: str = "action_feedback",
        result_key: str = "action_result",
        goal_slots_map: Mapping[str, str] | None = None,
        feedback_slots_map: Mapping[str, str] | None = None,
        result_slots_map: Mapping[str, str] | None = None,
        expand_goal_slots: bool = False,
        pack_result_slots: bool = False,
        path_slot: str | None = None,
    ) -> None:
        self.wrapped_container = wrapped_container
        self.userdata = UserData()
        self._node = node
        self._spec = action_spec
        self._succeeded = frozenset(succeeded_outcomes)
        self._preempted = frozenset(preempted_outcomes)
        both = (self._succeeded | self._preempted) & frozenset(aborted_outcomes)
        both |= self._succeeded & self._preempted
        if both:
            smach.logerr(f"outcomes of an action server stand for two ends: {sorted(both)}")
        self._keys = goal_key, feedback_key, result_key
        expanded = ros.fields(action_spec.Goal) if expand_goal_slots else []
        self._goal_slots = [(slot, slot) for slot in expanded]
        self._goal_slots += dict(goal_slots_map or {}).items()
        self._feedback_slots = dict(feedback_slots_map or {})
        self._result_slots = dict(result_slots_map or {})
        self._packed = ros.fields(action_spec.Result) if pack_result_slots else []
        self._path_slot = path_slot
        self._changing = threading.Lock()
        self._current: Any = None
        self._waiting: deque[Any] = deque()
        self._cancelled: set[bytes] = set()
        self._worker: threading.Thread | None = None
        self._prepare_container()
        actions = ros.load("rclpy.action")
        self._responses = actions.CancelResponse
        self._server = actions.ActionServer(
            node,
            action_spec,
            server_name,
            execute_callback=lambda handle: self._spec.Result(),  # never called: see `_accept`
            callback_group=ros.own_group(),
            handle_accepted_callback=self._accept,
            cancel_callback=self._cancel,
        )

    def _prepare_container(self) -> None:
        """Set the userdata, the input keys and the callbacks."""
        goal_key, feedback_key, result_key = self._keys
        self.userdata[goal_key] = self._spec.Goal()
        self.userdata[feedback_key] = self._spec.Feedback()
        self.userdata[result_key] = self._spec.Result()
        container = self.wrapped_container
        container.register_input_keys([*self._keys, *(key for _, key in self._goal_slots)])
        container.register_start_cb(self._start_cb)
        container.register_transition_cb(self.transition_cb)
        container.register_termination_cb(self.termination_cb)
        if self._path_slot is not None:
            for _, other in containers("/", container):
                other.register_start_cb(self._publish_path)
                other.register_transition_cb(self._publish_path)

    def run_server(self) -> None:
        """Spin the node if nobody does; the server itself is up since it was constructed."""
        spinning.ensure(self._node)

    # Called by the executor

    def _accept(self, handle: Any) -> None:
        """Add a goal to those that wait, and preempt the goal that runs."""
        with self._changing:
            self._waiting.append(handle)
            is_busy = self._worker is not None
            if not is_busy:
                self._worker = threading.Thread(
                    target=self._work, name="goals of an action server", daemon=True
                )
                self._worker.start()
        if is_busy:
            smach.logwarn("a new goal preempts the machine of an action server")
            self.preempt_cb()

    def _cancel(self, handle: Any) -> Any:
        """Preempt the container if it runs for this goal."""
        with self._changing:
            self._cancelled.add(_key(handle))
            is_current = self._current is not None and _key(self._current) == _key(handle)
        if is_current:
            self.preempt_cb()
        return self._responses.ACCEPT

    # Called by the thread of the goals

    def _work(self) -> None:
        """Execute goals until none waits."""
        while True:
            with self._changing:
                superseded = [self._waiting.popleft() for _ in range(len(self._waiting) - 1)]
                self._current = self._waiting.popleft() if self._waiting else None
                if self._current is None:
                    self._worker = None
                    return
            for handle in superseded:
                self._end(handle, "a newer goal came")
            self._execute(self._current)

    def _execute(self, handle: Any) -> None:
        server = ros.load("rclpy.action.server")
        try:
            handle._update_state(server.GoalEvent.EXECUTE)
        except server.RCLError:  # a goal that is being cancelled does not begin
            self._end(handle, "it was cancelled before it began")
            return
        try:
            result = self.execute_cb(handle)
        except FieldError as error:
            self._end(handle, str(error))
            return
        except Exception:
            ros.log_failure(self._node, "the machine of an action server failed")
            self._end(handle, "its machine failed")
            return
        self._send_result(handle, result)

    def execute_cb(self, goal_handle: Any) -> Any:
        """Run the container for one goal, end the goal, and return the result."""
        goal, (goal_key, feedback_key, result_key) = goal_handle.request, self._keys
        self.userdata[goal_key] = goal
        self.userdata[feedback_key] = self._spec.Feedback()
        self.userdata[result_key] = self._spec.Result()
        for slot, key in self._goal_slots:
            self.userdata[key] = getattr(goal, slot)
        container = self.wrapped_container
        inputs = container.get_registered_input_keys()
        outputs = container.get_registered_output_keys()
        outcome = container.execute(Remapper(self.userdata, inputs, outputs, {}))
        result = self._result()
        if outcome in self._succeeded:
            goal_handle.succeed()
        elif outcome in self._preempted and self._is_cancelled(goal_handle):
            goal_handle.canceled()
        else:
            goal_handle.abort()
        return result

    def _result(self) -> Any:
        """The result message, filled from the userdata after the container ended. Raises FieldError
        for a value that does not fit."""
        packed = {slot: slot for slot in self._packed if slot in self.userdata}
        slots = self._result_slots | packed
        values = {slot: self.userdata[key] for slot, key in slots.items()}
        result = checked(self.userdata[self._keys[2]], self._spec.Result, "result")
        return filled(result, values, "result")

    def _is_cancelled(self, handle: Any) -> bool:
        """Whether the goal may end as cancelled; rclpy sets this after the cancel callback."""
        end = time.monotonic() + CANCEL_LIMIT
        while _key(handle) in self._cancelled and time.monotonic() < end:
            if handle.is_cancel_requested:
                return True
            time.sleep(0.005)
        return bool(handle.is_cancel_requested)

    def _end(self, handle: Any, cause: str) -> None:
        """End a goal that has no result."""
        smach.logwarn(f"a goal of an action server has no result: {cause}")
        if handle.is_active:
            if self._is_cancelled(handle):
                handle.canceled()
            else:
                handle.abort()
        else:  # rclpy cannot change the status any more
            smach.logerr(f"the client gets status {handle.status} and an empty result")
        self._send_result(handle, self._spec.Result())

    def _send_result(self, handle: Any, result: Any) -> None:
        """Give the result of an ended goal to the clients; the executor sends it."""
        self._cancelled.discard(_key(handle))
        if self._node.context.ok():
            self._server.notify_execute(handle, lambda _: result)

    # Called by the container

    def _start_cb(self, userdata: UserData, initial_states: list[str]) -> None:
        """Preempt the container if its goal was cancelled, or superseded, before it started."""
        with self._changing:
            handle = self._current
            is_over = handle is not None and (
                _key(handle) in self._cancelled or bool(self._waiting)
            )
        if is_over:
            self.preempt_cb()

    def preempt_cb(self) -> None:
        """Preempt the container."""
        self.wrapped_container.request_preempt()

    def transition_cb(self, userdata: UserData, active_states: list[str]) -> None:
        """Publish the feedback; called by the container at every transition."""
        self.publish_feedback(userdata)

    def termination_cb(
        self, userdata: UserData, terminal_states: Any, container_outcome: str | None
    ) -> None:
        """Do nothing; called by the container at its end."""

    def publish_feedback(self, userdata: UserData) -> None:
        """Publish the feedback message in this userdata, if it has one."""
        key = self._keys[1]
        if self._path_slot is not None or key not in userdata or self._current is None:
            return
        values = {slot: userdata[source] for slot, source in self._feedback_slots.items()}
        try:
            feedback = checked(userdata[key], self._spec.Feedback, "feedback")
            self._current.publish_feedback(filled(feedback, values, "feedback"))
        except FieldError as error:
            smach.logerr(f"no feedback of an action server is sent: {error}")

    def _publish_path(self, userdata: UserData, states: Any) -> None:
        """Publish the paths of the active states in the field `path_slot`."""
        if self._current is None or self._path_slot is None:
            return
        key = self._keys[1]
        feedback = copy.deepcopy(self.wrapped_container.userdata[key])
        paths = active_paths("/", self.wrapped_container)
        is_text = isinstance(getattr(feedback, self._path_slot), str)
        setattr(feedback, self._path_slot, ", ".join(paths) if is_text else paths)
        try:
            self._current.publish_feedback(checked(feedback, self._spec.Feedback, "feedback"))
        except FieldError as error:
            smach.logerr(f"no feedback of an action server is sent: {error}")


def _key(handle: Any) -> bytes:
    """The identifier of a goal."""
    return bytes(handle.goal_id.uuid)
