"""ServiceState: a state that calls a ROS service once."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import has_smach_interface
from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.policies import Incoming, Outgoing
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.servers import watch_service
from smachac.runtime.state_callbacks import callback, checked_slots


class ServiceState(RosState):
    """Waits for a service and calls it; ends as succeeded, aborted or preempted.

    The request is `request` (default: an empty one) or the value of `request_key`. Its fields
    `request_slots` are set from the keys of the same names; then `request_cb(userdata, request)`
    may change it or return another. An absent key and a callback that raises end the state as
    aborted. Each call sends a new request.

    `response_cb(userdata, response)` may return an outcome; the response goes to `response_key`,
    its fields `response_slots` to the keys of the same names.

    The state is also aborted when there is no service within `server_wait_timeout`, when the server
    ends during the call, and when there is no response within `response_timeout` (default: no
    limit). A preempt request ends the wait for the service. A call that is under way has
    `preempt_timeout` to end; its response is then used, as on ROS 1. All are durations: seconds, or
    rclpy.duration.Duration.
    """

    def __init__(
        self,
        node: Any,
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
        server_wait_timeout: ros.Time | None = 60.0,
        response_timeout: ros.Time | None = None,
        preempt_timeout: ros.Time = 5.0,
    ) -> None:
        super().__init__(node, outcomes=["succeeded", "aborted", "preempted"])
        self._name = service_name
        keys = tuple(input_keys), tuple(output_keys)
        self._outgoing = Outgoing(
            name=service_name,
            part="request",
            kind=service_spec.Request,
            default=service_spec.Request() if request is None else request,
            key=request_key,
            slots=checked_slots(request_slots, ros.fields(service_spec.Request), "request"),
            callback=callback(
                self, "request", request_cb, request_cb_args, request_cb_kwargs, keys
            ),
        )
        self._incoming = Incoming(
            name=service_name,
            key=response_key,
            slots=checked_slots(response_slots, ros.fields(service_spec.Response), "response"),
            callback=callback(
                self, "response", response_cb, response_cb_args, response_cb_kwargs, keys
            ),
        )
        if has_smach_interface(response_cb):
            self.register_outcomes(response_cb.get_registered_outcomes())
        self.register_outcomes(outcomes)
        self.register_input_keys([*self._outgoing.keys(), *keys[0]])
        self.register_output_keys([*self._incoming.keys(), *keys[1]])
        self._server_wait_timeout = ros.limit(server_wait_timeout)
        self._response_timeout = ros.limit(response_timeout)
        self._preempt_timeout = ros.seconds(preempt_timeout)
        self._client = node.create_client(
            service_spec, service_name, callback_group=ros.own_group()
        )
        self._server = watch_service(node, service_name)

    def execute(self, ud: Any) -> str:
        """Call the service once."""
        if self._is_preempted():
            return "preempted"
        service = f"service '{self.node.resolve_service_name(self._name)}'"
        if not self._found(service, self._client.service_is_ready, self._server_wait_timeout):
            if self._is_preempted():
                return "preempted"
            smach.logerr(f"{service} is not available")
            return "aborted"
        request = self._outgoing.build(ud)
        if request is None:
            return "aborted"
        response = self._call(request)
        if response is None:
            return "preempted" if self._is_preempted() else "aborted"
        return self._incoming.take(self, ud, response) or "succeeded"

    def _call(self, request: Any) -> Any:
        """The response of the service; None if there is none, which is logged."""
        self._server.start()
        begin = time.monotonic()
        try:
            call = self._client.call_async(request)
        except (TypeError, ros.invalid_handle()) as error:
            smach.logerr(f"service '{self._name}' cannot be called: {error!r}")
            return None
        call.add_done_callback(self._wake)

        def ended() -> bool:
            return call.done() or self._server.is_gone()

        if not self._wait_until(ended, self._response_timeout) and self.preempt_requested():
            self._wait_until(ended, self._preempt_timeout, stopped=lambda: False)
        cause = "its server has ended" if self._server.is_gone() else "no response"
        if call.done():
            if call.exception() is None:
                return call.result()
            cause = repr(call.exception())
        self._client.remove_pending_request(call)
        smach.logerr(
            f"the call of service '{self._name}' failed after {time.monotonic() - begin:.1f} s: "
            f"{cause}"
        )
        return None
