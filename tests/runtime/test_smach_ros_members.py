"""The members of smach_ros that code written for it overrides, calls or names; ROS is replaced."""

from __future__ import annotations

import sys
import types
from collections.abc import Callable
from typing import Any

import pytest

from smachac.runtime import smach, smach_ros
from smachac.runtime.smach import settings
from smachac.runtime.smach_ros import messages


class Message:
    """A message with the fields that it is made with."""

    __slots__ = ("fields", "header")

    def __init__(self, **fields: object) -> None:
        self.fields = fields
        self.header = types.SimpleNamespace(stamp=None)


class Topic:
    """A publisher or subscriber that keeps the messages published."""

    published: list[tuple[str, dict[str, Any]]]
    closed: list[str]

    def __init__(self, name: str, data_class: Any, *_: object, **__: object) -> None:
        self.name, self.data_class = name, data_class

    def publish(self, message: Any) -> None:
        self.published.append((self.name, message.fields))

    def get_num_connections(self) -> int:
        return 1

    def unregister(self) -> None:
        self.closed.append(self.name)


class Server:
    """An action server; `last` is the one made last."""

    last: Server

    def __init__(self, name: str, spec: Any, execute_cb: Callable[[Any], None], **_: Any) -> None:
        self.execute_cb = execute_cb
        self.ended: list[str] = []
        type(self).last = self

    def register_preempt_callback(self, callback: Callable[[], None]) -> None:
        self.preempt_cb = callback

    def start(self) -> None:
        self.ended.append("started")

    def publish_feedback(self, feedback: object) -> None:
        self.ended.append("feedback")

    def set_succeeded(self, result: object) -> None:
        self.ended.append("succeeded")

    def set_aborted(self, result: object = None) -> None:
        self.ended.append("aborted")


class Spec:
    """An action whose parts have no fields."""

    def __init__(self) -> None:
        self.action_goal = types.SimpleNamespace(goal=Message())
        self.action_feedback = types.SimpleNamespace(feedback=Message())
        self.action_result = types.SimpleNamespace(result=Message())


@pytest.fixture(autouse=True)
def ros(monkeypatch: pytest.MonkeyPatch) -> Any:
    quiet: Callable[[str], None] = lambda msg: None  # noqa: E731
    rospy = types.SimpleNamespace(
        Publisher=Topic,
        Subscriber=Topic,
        Time=types.SimpleNamespace(now=lambda: 0),
        ROSException=OSError,
        is_shutdown=lambda: False,
        loginfo=quiet,
        logwarn=quiet,
        logdebug=quiet,
        logerr=quiet,
    )
    monkeypatch.setitem(sys.modules, "rospy", rospy)
    actionlib = types.SimpleNamespace(SimpleActionServer=Server)
    monkeypatch.setitem(sys.modules, "actionlib", actionlib)
    for name in ("loginfo", "logwarn", "logdebug", "logerr", "is_shutdown"):
        monkeypatch.setattr(settings, name, getattr(settings, name))
    for name in ("container_structure", "container_status", "initial_status_command"):
        monkeypatch.setattr(messages, name, lambda: Message)
    monkeypatch.setattr(Topic, "published", [], raising=False)
    monkeypatch.setattr(Topic, "closed", [], raising=False)
    return rospy


def nested() -> smach.StateMachine:
    with (sm := smach.StateMachine(["done"])):
        with (inner := smach.StateMachine(["done"])):
            smach.StateMachine.add("A", smach.CBState(lambda ud: "done", outcomes=["done"]))
        smach.StateMachine.add("INNER", inner)
    return sm


def reported() -> set[str]:
    return {fields["path"] for _, fields in Topic.published}


def test_the_callbacks_of_a_wrapper_are_overridden() -> None:
    called: list[object] = []

    class Wrapper(smach_ros.ActionServerWrapper):
        def execute_cb(self, goal: Any) -> None:
            called.append("execute")
            super().execute_cb(goal)

        def preempt_cb(self) -> None:
            called.append("preempt")
            super().preempt_cb()

        def transition_cb(self, userdata: Any, active_states: Any) -> None:
            called.append(("transition", active_states))
            super().transition_cb(userdata, active_states)

        def termination_cb(self, userdata: Any, terminal_states: Any, outcome: Any) -> None:
            called.append(("termination", terminal_states, outcome))

        def publish_feedback(self, userdata: Any) -> None:
            called.append("feedback")

    with (sm := smach.StateMachine(["done"])):
        for name in ("A", "B"):
            smach.StateMachine.add(name, smach.CBState(lambda ud: "done", outcomes=["done"]))
    sm._transitions["A"]["done"] = "B"
    wrapper = Wrapper("name", Spec, sm, ["done"])
    wrapper.run_server()
    Server.last.execute_cb(Message())
    Server.last.preempt_cb()
    assert called == [
        "execute",
        ("transition", ["B"]),
        "feedback",
        ("termination", ["B"], "done"),
        "preempt",
    ]
    assert Server.last.ended == ["started", "succeeded"]
    assert sm.preempt_requested()


def test_the_stages_of_an_action() -> None:
    action = smach_ros.SimpleActionState
    stages = [action.WAITING_FOR_SERVER, action.INACTIVE, action.ACTIVE]
    assert [*stages, action.PREEMPTING, action.COMPLETED] == [0, 1, 2, 3, 4]


def test_a_server_reports_on_what_is_constructed() -> None:
    server = smach_ros.IntrospectionServer("sis", nested(), "/ROOT")
    server.start()
    assert reported() == {"/ROOT", "/ROOT/INNER"}
    other = nested()
    server.construct("sis", other, "/OTHER")
    assert reported() >= {"/OTHER", "/OTHER/INNER"}
    server.clear()
    Topic.published.clear()
    other.execute()
    assert reported() == set()
    with pytest.raises(smach.InvalidStateError):
        server.construct("another", other, "/OTHER")
    server.stop()
    assert len(Topic.closed) == 3


def test_a_server_of_a_leaf() -> None:
    server = smach_ros.IntrospectionServer("sis", smach.State(["done"]), "/ROOT")
    with pytest.raises(smach.InvalidStateError):
        server.start()


def test_a_proxy_reports_on_one_container() -> None:
    sm = nested()
    proxy = smach_ros.ContainerProxy("sis", sm, "/ROOT", update_rate=60.0)
    proxy.start()
    sm.execute()
    assert reported() == {"/ROOT"}
    proxy.stop()
    Topic.published.clear()
    sm.execute()
    assert reported() == set()


def test_labels_that_are_numbers_are_reported_as_text() -> None:
    with (sm := smach.StateMachine(["done"])):
        smach.StateMachine.add(0, smach.CBState(lambda ud: "done", outcomes=["done"]))  # type: ignore[arg-type]
    proxy = smach_ros.ContainerProxy("sis", sm, "/ROOT")
    proxy.start()
    first = next(fields for name, fields in Topic.published if "status" in name)
    assert first["initial_states"] == ["0"]
    proxy.stop()
