"""IntrospectionServer: publishes the structure and the status of a machine on ROS topics."""

from __future__ import annotations

import base64
import threading
from typing import Any

from smachac.runtime import smach
from smachac.runtime.container_tree import (
    PROTOCOL,
    containers,
    pickled,
    received_userdata,
    status_fields,
)
from smachac.runtime.smach import InvalidStateError, State, UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach_ros import messages, ros

STATUS_TOPIC = "/smach/container_status"
INIT_TOPIC = "/smach/container_init"
STRUCTURE_TOPIC = "/smach/container_structure"

HEARTBEAT = 2.0
"""Seconds between two reports on all containers."""


class _Reporter:
    """Reports on containers, by path, on the topics of one server name."""

    def __init__(self, server_name: str, update_rate: ros.Time, unpickle: bool) -> None:
        self._rospy = ros.rospy()
        self._name = server_name
        self._update_rate = ros.seconds(update_rate)
        self._unpickle = unpickle
        self._paths: dict[str, Container] = {}
        self._registered: list[Container] = []
        self._due = threading.Event()
        self._running = False
        self._topics: list[Any] = []

    def start(self) -> None:
        """Start to report."""
        if self._running:
            return
        topic, listener = self._rospy.Publisher, _SubscriberListener(self._due)
        self._structures = topic(
            self._name + STRUCTURE_TOPIC,
            messages.container_structure(),
            subscriber_listener=listener,
            latch=True,
            queue_size=max(10, len(self._paths)),
        )
        self._statuses = topic(
            self._name + STATUS_TOPIC,
            messages.container_status(),
            subscriber_listener=listener,
            queue_size=max(100, len(self._paths)),
        )
        commands = self._rospy.Subscriber(
            self._name + INIT_TOPIC, messages.initial_status_command(), self._on_init_command
        )
        self._topics = [self._structures, self._statuses, commands]
        self._running = True
        for path, container in self._paths.items():
            self._follow(path, container)
        threading.Thread(
            target=self._heartbeat, name=f"{self._name}:heartbeat", daemon=True
        ).start()

    def stop(self) -> None:
        """Stop to report and leave the topics."""
        self._running = False
        self._due.set()
        while self._topics:
            self._topics.pop().unregister()

    def _follow(self, path: str, container: Container) -> None:
        """Report on a container from now on."""
        self._register_callbacks(path, container)
        self._report(path, container, "Initial state")

    def _register_callbacks(self, path: str, container: Container) -> None:
        """Report on the container from now on; once, however often the server is started."""
        if any(container is other for other in self._registered):
            return
        self._registered.append(container)

        def report(userdata: UserData, *what: object) -> None:
            if self._paths.get(path) is container:
                self._report(path, container, repr(what))

        container.register_start_cb(report)
        container.register_transition_cb(report)
        container.register_termination_cb(report)

    def _heartbeat(self) -> None:
        """Report on all containers every `update_rate` seconds, and for each new subscriber."""
        while self._running and not self._rospy.is_shutdown():
            for path, container in self._paths.items():
                self._describe(path, container)
                self._report(path, container, "HEARTBEAT")
            self._due.wait(self._update_rate)
            self._due.clear()

    def _describe(self, path: str, container: Container) -> None:
        """Publish the structure of a container."""
        edges = [[str(part) for part in edge] for edge in container.get_internal_edges()]
        self._publish(
            self._structures,
            path=path,
            children=[str(label) for label in container.get_children()],
            internal_outcomes=[outcome for outcome, _, _ in edges],
            outcomes_from=[label for _, label, _ in edges],
            outcomes_to=[target for _, _, target in edges],
            container_outcomes=[str(outcome) for outcome in container.get_registered_outcomes()],
        )

    def _report(self, path: str, container: Container, info: str) -> None:
        """Publish the status of a container, if there are subscribers."""
        if not self._running or not self._statuses.get_num_connections():
            return
        fields = status_fields(path, container, info, PROTOCOL)
        text = base64.b64encode(fields["local_data"]).decode()
        self._publish(self._statuses, **{**fields, "local_data": text})

    def _publish(self, topic: Any, **fields: Any) -> None:
        message = topic.data_class(**fields)
        message.header.stamp = self._rospy.Time.now()
        try:
            topic.publish(message)
        except self._rospy.ROSException as error:
            smach.logdebug(f"nothing is reported: {error}")

    def _on_init_command(self, command: Any) -> None:
        """Set the initial state of a container for all later runs."""
        container = self._paths.get(command.path)
        if container is None:
            return
        known = {str(label): label for label in container.get_children()}
        unknown = [label for label in command.initial_states if label not in known]
        if unknown:
            smach.logerr(f"container '{command.path}' has no states {unknown} to start in")
            return
        try:
            data = base64.b64decode(command.local_data)
        except ValueError as error:
            smach.logerr(f"a command to container '{command.path}' cannot be read: {error}")
            return
        userdata = received_userdata(command.path, data, self._unpickle)
        container.set_initial_state([known[state] for state in command.initial_states], userdata)
        self._report(command.path, container, "REMOTE_INIT")


class IntrospectionServer(_Reporter):
    """Reports on the container `state`, whose path is `path`, and on all containers below it.

    It publishes on `<server_name>/smach/container_structure` and `container_status`, in the format
    of SMACH's viewer: at every start, transition and end of a container, and on all containers for
    each new subscriber and every two seconds.

    On `container_init` a viewer may set the initial state of a container for all later runs, and
    userdata. That is a pickle, and unpickling can run any code: only plain values are accepted
    (plain_pickle), unless `unpickle` is true.
    """

    def __init__(self, server_name: str, state: State, path: str, unpickle: bool = False) -> None:
        super().__init__(server_name, HEARTBEAT, unpickle)
        self._state = state
        self._path = path

    def start(self) -> None:
        """Start to report. Raises InvalidStateError for a state that is no container."""
        if not self._running:
            self.construct(self._name, self._state, self._path)
        super().start()

    def construct(self, server_name: str, state: State, path: str) -> None:
        """Report also on the container `state`, whose path is `path`, and on those below it.

        Raises InvalidStateError for a state that is no container, and for the name of another
        server: a server has one name.
        """
        if not isinstance(state, Container):
            raise InvalidStateError(f"a {type(state).__name__} has nothing to look into")
        if server_name != self._name:
            raise InvalidStateError(f"server '{self._name}' does not report as '{server_name}'")
        added = dict(containers(path, state))
        self._paths = {**self._paths, **added}
        if self._running:
            for name, container in added.items():
                self._follow(name, container)

    def clear(self) -> None:
        """Report on no container any more, until `construct` or `start` adds some."""
        self._paths = {}


class ContainerProxy(_Reporter):
    """Reports on one container, and not on those below it, every `update_rate` seconds.

    It publishes what IntrospectionServer does, and obeys the same commands without their userdata.
    """

    def __init__(
        self,
        server_name: str,
        container: Container,
        path: str,
        update_rate: ros.Time = HEARTBEAT,
    ) -> None:
        super().__init__(server_name, update_rate, unpickle=False)
        self._paths = {path: container}


class IntrospectionClient:
    """The viewer's side: finds servers, and sets the initial states of their containers."""

    def __init__(self) -> None:
        self._rospy = ros.rospy()

    def get_servers(self) -> list[str]:
        """The names of the introspection servers on the ROS graph."""
        topics = self._rospy.get_published_topics()
        return [name[: -len(STATUS_TOPIC)] for name, _ in topics if name.endswith(STATUS_TOPIC)]

    def set_initial_state(
        self,
        server: str,
        path: str,
        initial_states: list[str],
        initial_userdata: UserData | None = None,
        timeout: ros.Time | None = None,
    ) -> bool | None:
        """Set the initial states of a container; whether it confirms them within `timeout`.

        Without a timeout the command is sent without waiting, and the result is None.
        """
        confirmed = threading.Event()

        def on_status(status: Any) -> None:
            if status.path == path and list(status.initial_states) == list(initial_states):
                confirmed.set()

        type_, limit = messages.initial_status_command(), ros.seconds(timeout)
        commands = self._rospy.Publisher(server + INIT_TOPIC, type_, queue_size=1, latch=True)
        data = base64.b64encode(pickled(initial_userdata or UserData(), PROTOCOL)).decode()
        commands.publish(type_(path=path, initial_states=initial_states, local_data=data))
        if limit is None:
            return None
        statuses = self._rospy.Subscriber(
            server + STATUS_TOPIC, messages.container_status(), on_status
        )
        confirmed.wait(limit)
        statuses.unregister()
        commands.unregister()
        return confirmed.is_set()


class _SubscriberListener:
    """The listener that rospy calls for new subscribers: it sets the event `due`."""

    def __init__(self, due: threading.Event) -> None:
        self._due = due

    def peer_subscribe(self, topic: str, publish: object, publish_to_peer: object) -> None:
        self._due.set()

    def peer_unsubscribe(self, topic: str, peers: int) -> None:
        """No report is due."""
