"""IntrospectionServer: publishes the structure and the status of a machine on ROS topics.

Where smach_msgs can be imported the messages are those of SMACH's viewer. Otherwise they are JSON
texts (std_msgs/String) with the same fields, on topics of their own. The field `local_data` has
userdata as a pickle: its bytes in smach_msgs, base64 in JSON.
"""

from __future__ import annotations

import base64
import json
import threading
import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from smachac.runtime import smach
from smachac.runtime.container_tree import (
    NEW_PROTOCOL,
    containers,
    more_status,
    pickled,
    received_userdata,
    status_fields,
)
from smachac.runtime.smach import InvalidStateError, State, UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach_ros2 import delivery, ros, spinning
from smachac.runtime.smach_ros2.message_fields import FieldError, checked

STATUS_TOPIC = "/smach/container_status"
INIT_TOPIC = "/smach/container_init"
STRUCTURE_TOPIC = "/smach/container_structure"
JSON_SUFFIX = "_json"
"""What follows the name of a topic whose messages are JSON texts."""

STATUS_DEPTH = 20
"""Messages on the status of one container that are kept: a machine may be faster than a viewer."""

HEARTBEAT = 2.0
"""Seconds between two reports on all containers; a viewer that starts late waits for one."""


REPEAT = 0.25
"""Seconds after which a command that no server has confirmed is sent again."""


class Format:
    """The messages of introspection: those of smach_msgs, or JSON texts without it."""

    def __init__(self) -> None:
        try:
            self._types: Any = import_module("smach_msgs.msg")
        except ImportError:
            self._types = None
            self._text: Any = ros.load("std_msgs.msg").String

    def topic(self, server: str, name: str) -> str:
        """The full name of a topic."""
        return f"{server}{name}" + ("" if self._types else JSON_SUFFIX)

    def message_type(self, name: str) -> Any:
        """The class of the messages on a topic."""
        names = {
            STATUS_TOPIC: "SmachContainerStatus",
            STRUCTURE_TOPIC: "SmachContainerStructure",
            INIT_TOPIC: "SmachContainerInitialStatusCmd",
        }
        return getattr(self._types, names[name]) if self._types else self._text

    @property
    def is_json(self) -> bool:
        """Whether the messages are JSON texts, which may have more fields than smach_msgs."""
        return self._types is None

    def encode(self, node: Any, name: str, fields: Mapping[str, Any]) -> Any:
        """The message with these fields."""
        if not self._types:
            stamp = node.get_clock().now().nanoseconds / ros.NANOSECONDS
            texts = {
                field: base64.b64encode(value).decode() if isinstance(value, bytes) else value
                for field, value in fields.items()
            }
            return self._text(data=json.dumps({"stamp": stamp, **texts}))
        message = self.message_type(name)()
        if hasattr(message, "header"):
            message.header.stamp = node.get_clock().now().to_msg()
        for field, value in fields.items():
            setattr(message, field, value)
        if name == STATUS_TOPIC:
            message.local_data = readable_twice(fields["local_data"])
        return checked(message, type(message), name)

    def decode(self, message: Any) -> Initial:
        """The path, initial states and userdata in a command or a status.

        Raises ValueError for a JSON text that has no such fields.
        """
        if self._types:
            states = list(message.initial_states)
            return Initial(path=message.path, states=states, data=bytes(message.local_data))
        try:
            fields = json.loads(message.data)
            states = [str(label) for label in fields["initial_states"]]
            data = base64.b64decode(fields["local_data"])
            return Initial(path=str(fields["path"]), states=states, data=data)
        except (TypeError, KeyError, RecursionError) as error:
            raise ValueError(f"it has not the fields of a command: {error!r}") from None


@dataclass(frozen=True, slots=True, kw_only=True)
class Initial:
    """The initial states of a container, and the pickle of its userdata."""

    path: str
    states: list[str]
    data: bytes


def readable_twice(data: bytes) -> bytes:
    """A pickle that gives the same value if it is decoded as base64 first.

    In smach_ros 3.0.3 for ROS 2 the server sends the bytes of a pickle, as the viewer reads them,
    but the client decodes the status as base64. The text in base64 stands before the pickle. It
    begins with V, and a line that begins so is a text in a pickle; the value is what comes last. A
    decoder of base64 ends at the padding. What gives the V is again a text in a pickle: `U`, its
    length, one character.
    """
    padded = data if len(data) % 3 else data + b"."  # so that base64 has padding
    return base64.b64encode(b"U\x01 " + padded) + b"\n" + data


class ContainerProxy:
    """Reports on one container, and not on those below it, every `update_rate` seconds."""

    def __init__(
        self,
        server: Any,
        server_name: str,
        container: Container,
        path: str,
        update_rate: float = HEARTBEAT,
        unpickle: bool = False,
    ) -> None:
        self._node = server
        self._container = container
        self._path = path
        self._unpickle = unpickle
        self._format = Format()
        self._running = False
        self._publishers = {
            name: server.create_publisher(
                self._format.message_type(name),
                self._format.topic(server_name, name),
                latched(depth),
            )
            for name, depth in ((STATUS_TOPIC, STATUS_DEPTH), (STRUCTURE_TOPIC, 1))
        }
        server.create_subscription(
            self._format.message_type(INIT_TOPIC),
            self._format.topic(server_name, INIT_TOPIC),
            self._on_init_command,
            10,
        )
        self._timer = server.create_timer(update_rate, self._on_heartbeat)
        container.register_start_cb(self._on_change)
        container.register_transition_cb(self._on_change)
        container.register_termination_cb(self._on_change)

    def start(self) -> None:
        """Start to report."""
        self._running = True
        self._publish_structure()
        self._publish_status("Initial state")

    def stop(self) -> None:
        """Stop to report."""
        self._running = False
        self._timer.cancel()

    def _on_change(self, userdata: UserData, *what: object) -> None:
        self._publish_status(repr(what))

    def _on_heartbeat(self) -> None:
        self._publish_structure()
        self._publish_status("HEARTBEAT")

    def _publish_structure(self) -> None:
        container = self._container
        edges = [[str(part) for part in edge] for edge in container.get_internal_edges()]
        self._publish(
            STRUCTURE_TOPIC,
            path=self._path,
            children=[str(label) for label in container.get_children()],
            internal_outcomes=[outcome for outcome, _, _ in edges],
            outcomes_from=[label for _, label, _ in edges],
            outcomes_to=[target for _, _, target in edges],
            container_outcomes=[str(outcome) for outcome in container.get_registered_outcomes()],
        )

    def _publish_status(self, info: str = "") -> None:
        container = self._container
        fields = status_fields(self._path, container, info, NEW_PROTOCOL)
        if self._format.is_json:
            fields |= more_status(container)
        self._publish(STATUS_TOPIC, **fields)

    def _publish(self, name: str, **fields: Any) -> None:
        if not self._running or not self._node.context.ok():
            return
        try:
            self._publishers[name].publish(self._format.encode(self._node, name, fields))
        except (ros.invalid_handle(), ros.rclpy.exceptions.ROSInterruptException) as error:
            smach.logdebug(f"nothing is reported: {error}")
        except FieldError as error:
            smach.logerr(f"nothing is reported: {error}")

    def _on_init_command(self, message: Any) -> None:
        """Set the initial state of the container for all later runs."""
        try:
            command = self._format.decode(message)
        except ValueError as error:
            smach.logerr(f"a command to a container cannot be read: {error}")
            return
        if command.path != self._path:
            return
        known = {str(label): label for label in self._container.get_children()}
        unknown = [label for label in command.states if label not in known]
        if unknown:
            smach.logerr(f"container '{self._path}' has no states {unknown} to start in")
            return
        userdata = received_userdata(self._path, command.data, self._unpickle)
        self._container.set_initial_state([known[label] for label in command.states], userdata)
        self._publish_status("REMOTE_INIT")


class IntrospectionServer(ros.Node):
    """Reports on the container `state`, whose path is `path`, and on all containers below it.

    It is a node, with the name of the server and `_introspection`, because the node of the machine
    often has the name of the server. It publishes on `<server_name>/smach/container_structure` and
    `container_status` (without smach_msgs: `..._json`): at every start, transition and end of a
    container, and on all containers every two seconds; a new subscriber gets the newest report on
    each container.

    On `container_init` a viewer may set the initial state of a container for all later runs, and
    userdata. That is a pickle, and unpickling can run any code: only plain values are accepted
    (plain_pickle), unless `unpickle` is true.

    A thread spins the node, as in smach_ros, until another executor takes it.
    """

    def __init__(
        self, server_name: str, state: State, path: str, unpickle: bool = False, **kwargs: Any
    ) -> None:
        name = server_name.strip("/").replace("/", "_")
        super().__init__(f"{name}_introspection", **kwargs)
        self._server_name = server_name
        self._state = state
        self._path = path
        self._unpickle = unpickle
        self._proxies: list[ContainerProxy] = []
        self._spinner = spinning.Spinner(self)
        self._spinner.start()

    def start(self) -> None:
        """Start to report. Raises InvalidStateError for a state that is no container."""
        self.construct(self._server_name, self._state, self._path)
        if not spinning.is_assigned(self):
            self._spinner = spinning.Spinner(self)
            self._spinner.start()

    def stop(self) -> None:
        """Stop to report; the last reports get up to a second to arrive."""
        for proxy in self._proxies:
            proxy.stop()
        if self.context.ok():
            delivery.await_acknowledgements(self.publishers)
        self._spinner.stop()

    def construct(self, server_name: str, state: State, path: str) -> None:
        """Report also on the container `state`, whose path is `path`, and on those below it.

        Raises InvalidStateError for a state that is no container.
        """
        if not isinstance(state, Container):
            raise InvalidStateError(f"a {type(state).__name__} has nothing to look into")
        for text, container in containers(path, state):
            proxy = ContainerProxy(self, server_name, container, text, unpickle=self._unpickle)
            self._proxies.append(proxy)
            proxy.start()

    def clear(self) -> None:
        """Report on no container any more, until `construct` or `start` adds some."""
        while self._proxies:
            self._proxies.pop().stop()


class IntrospectionClient(ros.Node):
    """The viewer's side, a node: finds servers, and sets the initial states of containers.

    A thread spins it, as in smach_ros, until another executor takes it.
    """

    def __init__(self, node_name: str = "introspection_client", **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._format = Format()
        self._spinner = spinning.Spinner(self)
        self._spinner.start()

    def destroy_node(self) -> None:
        """Stop the thread, and destroy the node."""
        self._spinner.stop()
        super().destroy_node()

    def get_servers(self) -> list[str]:
        """The names of the introspection servers on the ROS graph."""
        end = self._format.topic("", STATUS_TOPIC)
        topics = self.get_topic_names_and_types()
        return [name[: -len(end)] for name, _ in topics if name.endswith(end)]

    def set_initial_state(
        self,
        server: str,
        path: str,
        initial_states: list[str],
        initial_userdata: UserData | None = None,
        timeout: ros.Time | None = None,
    ) -> bool | None:
        """Set the initial states of a container; whether it confirms them within `timeout`.

        Without a timeout the command is sent once, and the result is None. A server that is being
        found may miss a command: with a timeout it is sent again until the server confirms it.
        """
        confirmed, limit = threading.Event(), ros.seconds(timeout)
        commands = self.create_publisher(
            self._format.message_type(INIT_TOPIC), self._format.topic(server, INIT_TOPIC), 10
        )
        fields = {
            "path": path,
            "initial_states": list(initial_states),
            "local_data": pickled(initial_userdata or UserData(), NEW_PROTOCOL),
        }
        command = self._format.encode(self, INIT_TOPIC, fields)
        if limit is None:
            delivery.await_subscription(self, commands)
            commands.publish(command)
            return None

        def on_status(message: Any) -> None:
            with suppress(ValueError):  # it is of no server
                status = self._format.decode(message)
                if (status.path, status.states) == (path, list(initial_states)):
                    confirmed.set()

        statuses = self.create_subscription(
            self._format.message_type(STATUS_TOPIC),
            self._format.topic(server, STATUS_TOPIC),
            on_status,
            STATUS_DEPTH,
        )
        spinning.ensure(self)
        end = time.monotonic() + limit
        while not confirmed.is_set() and time.monotonic() < end:
            commands.publish(command)
            confirmed.wait(min(REPEAT, max(0.0, end - time.monotonic())))
        for destroy, entity in (
            (self.destroy_subscription, statuses),
            (self.destroy_publisher, commands),
        ):
            self.executor.create_task(destroy, entity)
        return confirmed.is_set()


def latched(depth: int = 1) -> Any:
    """The quality of service with which a new subscriber gets the last messages.

    The depth is also the number of messages that a slow network may delay without a loss.
    """
    module = ros.load("rclpy.qos")
    return module.QoSProfile(depth=depth, durability=module.DurabilityPolicy.TRANSIENT_LOCAL)
