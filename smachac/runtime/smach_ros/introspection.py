"""IntrospectionServer: tells the ROS graph what a machine is made of and what it does."""

from __future__ import annotations

import base64
import pickle
import threading
from collections.abc import Iterator
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach import InvalidStateError, State, UserData
from smachac.runtime.smach.container import Container
from smachac.runtime.smach.user_data import store
from smachac.runtime.smach_ros import messages, ros

STATUS_TOPIC = "/smach/container_status"
INIT_TOPIC = "/smach/container_init"
STRUCTURE_TOPIC = "/smach/container_structure"

HEARTBEAT = 2.0
"""Seconds between two reports on everything."""

PROTOCOL = 2
"""The pickle protocol that SMACH's viewer reads, in Python 2 too."""


class IntrospectionServer:
    """Reports on the container `state` and those below it, under the names of `path`.

    On `<server_name>/smach/container_structure` and `container_status`, as SMACH's viewer reads
    them: every start, transition and end of a container, all of it for each new subscriber, and
    every two seconds.

    On `container_init` a viewer may order where a container starts from now on. The userdata of
    such an order is a pickle, which can run any code: it is dropped, unless `unpickle` is true.
    """

    def __init__(self, server_name: str, state: State, path: str, unpickle: bool = False) -> None:
        self._rospy = ros.rospy()
        self._name = server_name
        self._state = state
        self._path = path
        self._unpickle = unpickle
        self._paths: dict[str, Container] = {}
        self._hooked: list[Container] = []
        self._due = threading.Event()
        self._running = False
        self._topics: list[Any] = []

    def start(self) -> None:
        """Begin to report. Raises InvalidStateError for a state that is no container."""
        if not isinstance(self._state, Container):
            raise InvalidStateError(f"a {type(self._state).__name__} has nothing to look into")
        if self._running:
            return
        self._paths = dict(_containers(self._path, self._state))
        topic, listener = self._rospy.Publisher, _Listener(self._due)
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
        orders = self._rospy.Subscriber(
            self._name + INIT_TOPIC, messages.initial_status_command(), self._obey
        )
        self._topics = [self._structures, self._statuses, orders]
        self._running = True
        for path, container in self._paths.items():
            self._hook(path, container)
            self._report(path, container, "Initial state")
        threading.Thread(target=self._beat, name=f"{self._name}:heartbeat", daemon=True).start()

    def stop(self) -> None:
        """Fall silent."""
        self._running = False
        self._due.set()
        while self._topics:
            self._topics.pop().unregister()

    def _hook(self, path: str, container: Container) -> None:
        """Report what the container does from now on; once, however often the server starts."""
        if any(container is hooked for hooked in self._hooked):
            return
        self._hooked.append(container)

        def report(userdata: UserData, *what: object) -> None:
            self._report(path, container, repr(what))

        container.register_start_cb(report)
        container.register_transition_cb(report)
        container.register_termination_cb(report)

    def _beat(self) -> None:
        """Report on everything every now and then, and when somebody begins to listen."""
        while self._running and not self._rospy.is_shutdown():
            for path, container in self._paths.items():
                self._describe(path, container)
                self._report(path, container, "HEARTBEAT")
            self._due.wait(HEARTBEAT)
            self._due.clear()

    def _describe(self, path: str, container: Container) -> None:
        """Publish what a container is made of."""
        edges = [[str(part) for part in edge] for edge in container.get_internal_edges()]
        self._publish(
            self._structures,
            path=path,
            children=list(container.get_children()),
            internal_outcomes=[outcome for outcome, _, _ in edges],
            outcomes_from=[label for _, label, _ in edges],
            outcomes_to=[target for _, _, target in edges],
            container_outcomes=list(container.get_registered_outcomes()),
        )

    def _report(self, path: str, container: Container, info: str) -> None:
        """Publish what a container does."""
        if not self._running or not self._statuses.get_num_connections():
            return
        self._publish(
            self._statuses,
            path=path,
            initial_states=container.get_initial_states(),
            active_states=container.get_active_states(),
            local_data=_pickled(container.userdata),
            info=info,
        )

    def _publish(self, topic: Any, **fields: Any) -> None:
        message = topic.data_class(**fields)
        message.header.stamp = self._rospy.Time.now()
        try:
            topic.publish(message)
        except self._rospy.ROSException as error:
            smach.logdebug(f"nothing is reported: {error}")

    def _obey(self, order: Any) -> None:
        """Start a container elsewhere from now on, as a viewer orders."""
        container = self._paths.get(order.path)
        if container is None:
            return
        known = container.get_children()
        unknown = [label for label in order.initial_states if label not in known]
        if unknown:
            smach.logerr(f"container '{order.path}' has no states {unknown} to start in")
            return
        userdata = UserData()
        if order.local_data and self._unpickle:
            store(userdata).update(pickle.loads(base64.b64decode(order.local_data)))
        elif order.local_data not in ("", _pickled(UserData())):
            smach.logwarn(
                f"container '{order.path}' is given an initial state; the userdata that came with "
                "it is dropped, for unpickling it may run any code (IntrospectionServer: unpickle)"
            )
        container.set_initial_state(order.initial_states, userdata)
        self._report(order.path, container, "REMOTE_INIT")


class IntrospectionClient:
    """What a viewer does: finds servers, and orders containers to start elsewhere."""

    def __init__(self) -> None:
        self._rospy = ros.rospy()

    def get_servers(self) -> list[str]:
        """The names of the servers on the graph."""
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
        """Order a container to start in these states; whether it says so within `timeout`.

        Without a time limit the order is sent and nothing is waited for: None.
        """
        obeyed = threading.Event()

        def heed(status: Any) -> None:
            if status.path == path and list(status.initial_states) == list(initial_states):
                obeyed.set()

        type_, limit = messages.initial_status_command(), ros.seconds(timeout)
        orders = self._rospy.Publisher(server + INIT_TOPIC, type_, queue_size=1, latch=True)
        data = _pickled(initial_userdata or UserData())
        orders.publish(type_(path=path, initial_states=initial_states, local_data=data))
        if limit is None:
            return None
        statuses = self._rospy.Subscriber(server + STATUS_TOPIC, messages.container_status(), heed)
        obeyed.wait(limit)
        statuses.unregister()
        orders.unregister()
        return obeyed.is_set()


class _Listener:
    """What rospy tells of new subscribers."""

    def __init__(self, due: threading.Event) -> None:
        self._due = due

    def peer_subscribe(self, topic: str, publish: object, publish_to_peer: object) -> None:
        self._due.set()

    def peer_unsubscribe(self, topic: str, peers: int) -> None:
        """Nothing is due."""


def _containers(path: str, container: Container) -> Iterator[tuple[str, Container]]:
    """A container and those below it, each with its path."""
    pending = [(path, container)]
    while pending:
        path, container = pending.pop(0)
        yield path, container
        for label, child in container.get_children().items():
            if isinstance(child, Container):
                pending.append((f"{path.rstrip('/')}/{label}", child))


def _pickled(userdata: UserData) -> str:
    """The userdata as SMACH's viewer reads it; what cannot be pickled stands as its text."""
    held = dict(store(userdata))
    try:
        data = pickle.dumps(held, PROTOCOL)
    except Exception:
        data = pickle.dumps({key: _picklable(value) for key, value in held.items()}, PROTOCOL)
    return base64.b64encode(data).decode("ascii")


def _picklable(value: object) -> object:
    try:
        pickle.dumps(value, PROTOCOL)
    except Exception:
        return repr(value)
    return value
