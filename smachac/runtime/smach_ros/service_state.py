"""ServiceState: a state that calls a ROS service once."""

from __future__ import annotations

import copy
import threading
import traceback
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import has_smach_interface
from smachac.runtime.smach_ros.ros_state import RosState
from smachac.runtime.state_callbacks import callback, checked_slots, is_outcome

FIRST_WAIT = 0.5
"""Seconds to wait for a service before the wait is logged."""

NEXT_WAIT = 5.0
"""Seconds of each further wait, which is logged too."""


class ServiceState(RosState):
    """Waits for a service and calls it; ends as succeeded, aborted or preempted.

    The request is `request` (default: an empty one) or the value of `request_key`. Its fields
    `request_slots` are set from the keys of the same names; then `request_cb(userdata, request)`
    may change it or return another. An absent key, a callback that raises, and a call that fails
    end the state as aborted.

    `response_cb(userdata, response)` may return an outcome; the response goes to `response_key`,
    its fields `response_slots` to the keys of the same names.
    """

    def __init__(
        self,
        service_name: str,
        service_spec: Any,
        request: Any = None,
        request_cb: Callable[..., Any] | None = None,
        request_cb_args: Iterable[Any] = (),
        request_cb_kwargs: Mapping[str, Any] | None = None,
        request_key: str | None = None,
        request_slots: Iterable[str] = (),
        response_cb: Callable[..., Any] | None = None,
        response_cb_args: Iterable[Any] = (),
        response_cb_kwargs: Mapping[str, Any] | None = None,
        response_key: str | None = None,
        response_slots: Iterable[str] = (),
        input_keys: Iterable[str] = (),
        output_keys: Iterable[str] = (),
        outcomes: Iterable[str] = (),
    ) -> None:
        super().__init__(["succeeded", "aborted", "preempted"])
        self._name = service_name
        self._type = service_spec
        self._proxy: Any = None
        self._search_thread: threading.Thread | None = None
        self._request = service_spec._request_class() if request is None else request
        self._request_key = request_key
        self._response_key = response_key
        self._request_slots = checked_slots(
            request_slots, service_spec._request_class.__slots__, "request"
        )
        self._response_slots = checked_slots(
            response_slots, service_spec._response_class.__slots__, "response"
        )
        keys = tuple(input_keys), tuple(output_keys)
        self._request_cb = callback(
            self, "request", request_cb, request_cb_args, request_cb_kwargs, keys
        )
        self._response_cb = callback(
            self, "response", response_cb, response_cb_args, response_cb_kwargs, keys
        )
        if has_smach_interface(response_cb):
            self.register_outcomes(response_cb.get_registered_outcomes())
        self.register_outcomes(outcomes)
        self.register_input_keys([*filter(None, [request_key]), *self._request_slots, *keys[0]])
        self.register_output_keys([*filter(None, [response_key]), *self._response_slots, *keys[1]])

    def execute(self, ud: Any) -> str:
        """Call the service once."""
        if self._preempted():
            return "preempted"
        if not self._find_service():
            return "preempted" if self._preempted() else "aborted"
        request = self._fill_request(ud)
        if request is None:
            return "aborted"
        try:
            response = self._call(request)
        except Exception as error:  # also those of genpy, for values that do not fit their fields
            smach.logerr(f"the call of service '{self._name}' failed: {error}")
            return "aborted"
        return "aborted" if response is None else self._take_response(ud, response)

    def _find_service(self) -> bool:
        """Wait for the service, in a thread of its own: rospy's wait cannot be interrupted."""
        if self._proxy is None and (
            self._search_thread is None or not self._search_thread.is_alive()
        ):
            self._search_thread = threading.Thread(target=self._search, daemon=True)
            self._search_thread.start()
        return self._wait(lambda: self._proxy is not None)

    def _search(self) -> None:
        limit = FIRST_WAIT
        while not self._rospy.is_shutdown():
            try:
                self._rospy.wait_for_service(self._name, limit)
            except self._rospy.ROSException:
                if not self._rospy.is_shutdown():
                    smach.logwarn(f"waiting for service '{self._name}'")
                limit = NEXT_WAIT
                continue
            self._proxy = self._rospy.ServiceProxy(self._name, self._type)
            self._wake()
            break

    def _call(self, request: Any) -> Any:
        """The response of the service; None at a shutdown. Raises the exceptions of rospy.

        The call has a thread of its own, because rospy ignores Ctrl-C during a call.
        """
        responses: list[Any] = []
        errors: list[Exception] = []

        def call() -> None:
            try:
                responses.append(self._proxy(request))
            except Exception as error:
                errors.append(error)
            self._wake()

        threading.Thread(target=call, name=f"call of {self._name}", daemon=True).start()
        self._wait(lambda: bool(responses or errors), stopped=self._rospy.is_shutdown)
        for error in errors:
            raise error
        return responses[0] if responses else None

    def _fill_request(self, ud: Any) -> Any:
        """The request to send; None if a key is absent or the callback raised."""
        wanted = [*filter(None, [self._request_key]), *self._request_slots]
        absent = [key for key in wanted if key not in ud]
        if absent:
            smach.logerr(f"service '{self._name}' is not called: keys {absent} are absent")
            return None
        request = copy.copy(self._request if self._request_key is None else ud[self._request_key])
        for slot in self._request_slots:
            setattr(request, slot, ud[slot])
        if self._request_cb is not None:
            try:
                changed = self._request_cb(ud, request)
            except Exception:
                smach.logerr(f"the request callback failed:\n{traceback.format_exc()}")
                return None
            request = request if changed is None else changed
        return request

    def _take_response(self, ud: Any, response: Any) -> str:
        """Pass the response to the callback and the userdata; the outcome."""
        outcome = None
        if self._response_cb is not None:
            try:
                outcome = self._response_cb(ud, response)
            except Exception:
                smach.logerr(f"the response callback failed:\n{traceback.format_exc()}")
                return "aborted"
            if outcome is not None and not is_outcome(self, outcome, self._name):
                return "aborted"
        if self._response_key is not None:
            ud[self._response_key] = response
        for slot in self._response_slots:
            ud[slot] = getattr(response, slot)
        return "succeeded" if outcome is None else outcome
