"""ActionServerWrapper: an action server that runs a machine for each goal."""

from __future__ import annotations

import copy
import traceback
from collections.abc import Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import Remapper, UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach_ros import ros


class ActionServerWrapper:
    """An action server that runs a container for each goal.

    Goal, feedback and result are stored in the wrapper's userdata, from which the container copies
    its input keys and to which it copies its output keys. The outcomes listed as succeeded or
    preempted end the goal so; any other outcome, and an exception, aborts it. The feedback is
    published at every transition if the container's userdata has it.

    The slot maps are from fields of the message to keys. `expand_goal_slots` writes each field of
    the goal to the key of the same name; `pack_result_slots` fills the fields of the result from
    the keys of the same names.

    The methods that end in `_cb`, and `publish_feedback`, may be overridden.
    """

    def __init__(
        self,
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
    ) -> None:
        ros.rospy()
        self.wrapped_container = wrapped_container
        self.userdata = UserData()
        self._succeeded = frozenset(succeeded_outcomes)
        self._preempted = frozenset(preempted_outcomes)
        both = (self._succeeded | self._preempted) & frozenset(aborted_outcomes)
        both |= self._succeeded & self._preempted
        if both:
            smach.logerr(f"outcomes of an action server stand for two ends: {sorted(both)}")
        self._keys = goal_key, feedback_key, result_key
        self._goal_slots = dict(goal_slots_map or {})
        self._feedback_slots = dict(feedback_slots_map or {})
        self._result_slots = dict(result_slots_map or {})
        self._expand = expand_goal_slots
        self._pack = pack_result_slots
        message = action_spec()
        self.userdata[goal_key] = message.action_goal.goal
        self.userdata[feedback_key] = message.action_feedback.feedback
        self.userdata[result_key] = message.action_result.result
        self._empty_result = copy.deepcopy(message.action_result.result)
        self._server = ros.load("actionlib").SimpleActionServer(
            server_name, action_spec, execute_cb=self.execute_cb, auto_start=False
        )
        self._server.register_preempt_callback(self.preempt_cb)
        wrapped_container.register_transition_cb(self.transition_cb)
        wrapped_container.register_termination_cb(self.termination_cb)

    def run_server(self) -> None:
        """Start the server; returns at once."""
        self._server.start()

    def execute_cb(self, goal: Any) -> None:
        """Run the container for one goal; called by the action server."""
        goal_key, _, result_key = self._keys
        self.userdata[goal_key] = goal
        self.userdata[result_key] = copy.deepcopy(self._empty_result)
        slots = {slot: slot for slot in goal.__slots__} if self._expand else {}
        for slot, key in (slots | self._goal_slots).items():
            self.userdata[key] = getattr(goal, slot)
        container = self.wrapped_container
        inputs = container.get_registered_input_keys()
        outputs = container.get_registered_output_keys()
        try:
            outcome = container.execute(Remapper(self.userdata, inputs, outputs, {}))
            result = self._result()
        except Exception:
            smach.logerr(f"the machine of an action server failed:\n{traceback.format_exc()}")
            self._server.set_aborted()
            return
        if outcome in self._succeeded:
            self._server.set_succeeded(result)
        elif outcome in self._preempted:
            self._server.set_preempted(result)
        else:
            self._server.set_aborted(result)

    def _result(self) -> Any:
        """The result message, filled from the userdata after the container ended."""
        result = self.userdata[self._keys[2]]
        packed = [slot for slot in result.__slots__ if self._pack and slot in self.userdata]
        for slot, key in (self._result_slots | {slot: slot for slot in packed}).items():
            setattr(result, slot, self.userdata[key])
        return result

    def preempt_cb(self) -> None:
        """Preempt the container; called by the action server when a client cancels the goal."""
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
        if key in userdata:
            feedback = userdata[key]
            for slot, source in self._feedback_slots.items():
                setattr(feedback, slot, userdata[source])
            self._server.publish_feedback(feedback)
