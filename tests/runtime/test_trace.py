"""Traces of machines built with SMACH, and leaves that follow a script."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from smachac.ir.nodes import Machine, Node, StateMachine
from smachac.runtime import smach
from smachac.runtime.tracing.compare import compare
from smachac.runtime.tracing.trace import attach, script
from smachac.runtime.tracing.writer import Event
from tests.support.ir_machines import concurrence, iterator, leaf, machine, sequence, short
from tests.support.smach_machines import Steps, built, interpreted, traced

pytestmark = pytest.mark.usefixtures("silent_smach")


def everything() -> tuple[StateMachine, Steps]:
    """A machine with every kind of container, and steps for its leaves."""
    fetch = machine(
        "FETCH",
        "ok failed",
        leaf("LOOK", {"seen": "GRASP"}, outs="pose"),
        leaf("GRASP", {"succeeded": "ok", "aborted": "LOOK"}, outs="width"),
        to={"ok": "BOTH", "failed": "stopped"},
        outs="width",
        remaps={"width": "w"},
    )
    both = concurrence(
        "BOTH",
        "fine bad",
        leaf("A", outcomes="done"),
        sequence("B", "done", "done", leaf("B1", {"done": "B2"}), leaf("B2", {"done": "done"})),
        default="bad",
        rules=(("fine", {"A": "done", "B": "done"}),),
        to={"fine": "EACH", "bad": "stopped"},
    )
    each = iterator(
        "EACH",
        "exhausted found",
        machine("ONE", "next found", leaf("TRY", {"next": "next", "found": "found"})),
        items=[1, 2, 3],
        loop="next",
        to={"exhausted": "stopped", "found": "done"},
    )
    root = machine("sm", "done stopped", fetch, both, each)
    steps: Steps = {
        "sm/FETCH/LOOK": [("seen", {"pose": [1, {"x": 2}]})],
        "sm/FETCH/GRASP": [("aborted", {}), ("succeeded", {"width": 0.5, "undeclared": 1})],
        "sm/BOTH/A": [("done", {})],
        "sm/BOTH/B/B1": [("done", {})],
        "sm/BOTH/B/B2": [("done", {})],
        "sm/EACH/ONE/TRY": [("next", {}), ("found", {})],
    }
    return root, steps


def test_a_built_machine_gives_the_trace_of_the_interpreter() -> None:
    root, steps = everything()
    outcome, events = traced(root, steps)
    assert outcome == "done"
    expected = interpreted(root, steps)
    assert compare(events, expected) is None
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert sorted(short(events)) == sorted(short(expected))
    lines = short(events)
    assert lines[:6] == [
        "start sm",
        "enter sm/FETCH",
        "enter sm/FETCH/LOOK",
        "write sm/FETCH/LOOK pose [1, {'x': 2}]",
        "exit sm/FETCH/LOOK seen",
        "transition sm/FETCH/LOOK seen -> sm/FETCH/GRASP",
    ]
    assert lines[-3:] == [
        "exit sm/EACH found",
        "transition sm/EACH found -> sm:done",
        "finish sm done",
    ]


def test_a_second_run_is_traced_too() -> None:
    root, steps = everything()
    made = built(Machine(root=root))
    events: list[Event] = []
    script(made, "sm", steps)
    attach(made, "sm", events.append)
    made.execute()
    first = len(events)
    made.execute()
    assert short(events)[first] == "start sm"
    assert events[first]["seq"] == first + 1


def test_events_carry_time_and_place() -> None:
    root = machine("sm", "x", leaf("A", {"x": "x"}))
    times = iter(range(100, 200))
    _, events = traced(
        root, {"sm/A": [("x", {})]}, sources={"sm/A": "main.yml:3"}, clock=lambda: next(times)
    )
    assert [event["t"] for event in events] == [1, 2, 3, 3, 4]
    assert [event.get("src") for event in events][:3] == [None, "main.yml:3", "main.yml:3"]
    assert list(events[2]) == ["seq", "event", "path", "outcome", "t", "src"]


def leaves_of(made: Any) -> dict[str, Any]:
    """The leaves of a built machine by label."""
    found: dict[str, Any] = {}
    stack = [made]
    while stack:
        for label, state in stack.pop().get_children().items():
            if hasattr(state, "get_children"):
                stack.append(state)
            else:
                found[label] = state
    return found


def acting(root: StateMachine, name: str, act: Any) -> tuple[Any, list[Event]]:
    """A run in which one leaf acts on its own; its outcome or exception, and its events."""
    made = built(Machine(root=root))
    leaves_of(made)[name].execute = act
    events: list[Event] = []
    attach(made, root.name, events.append)
    try:
        return made.execute(), events
    except Exception as error:
        return error, events


def nested(inner: Node) -> StateMachine:
    return machine("sm", "x", machine("M", "x", inner, to={"x": "x"}))


def raising(ud: Any) -> str:
    raise ValueError("broken\nin two lines")


@pytest.mark.parametrize(
    ("root", "act", "error"),
    [
        (nested(leaf("A", {"x": "x"})), raising, "error sm/M/A ValueError: broken"),
        (
            nested(leaf("A", {"x": "x"})),
            lambda ud: "y",
            "error sm/M/A ended with `y`, which is not one of its outcomes",
        ),
        (nested(leaf("A", {"x": "x"})), lambda ud: None, "error sm/M/A ended without an outcome"),
        (
            nested(leaf("A", {"x": "x"}, ins="k")),
            lambda ud: ud.k,
            "error sm/M/A KeyError: userdata key 'k' is absent; present: []",
        ),
        (
            nested(concurrence("C", "x", leaf("A", outcomes="x"), default="x", to={"x": "x"})),
            raising,
            "error sm/M/C/A ValueError: broken",
        ),
        (
            nested(
                iterator(
                    "I", "exhausted", leaf("A", outcomes="x"), items=[1], to={"exhausted": "x"}
                )
            ),
            raising,
            "error sm/M/I/A ValueError: broken",
        ),
        (
            nested(
                iterator("I", "exhausted", leaf("A", outcomes="x"), items=3, to={"exhausted": "x"})
            ),
            raising,
            "error sm/M/I TypeError: 'int' object is not iterable",
        ),
    ],
)
def test_an_error_is_told_once_where_it_happened(root: StateMachine, act: Any, error: str) -> None:
    result, events = acting(root, "A", act)
    assert isinstance(result, Exception)
    assert [line for line in short(events) if line.startswith("error")] == [error]
    assert short(events)[-1] == error


def test_a_machine_that_refuses_to_run_is_an_error() -> None:
    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "nowhere"}))))
    events: list[Event] = []
    attach(made, "sm", events.append)
    assert made.execute() is None
    assert short(events) == ["start sm", "error sm ended without an outcome"]


def test_preempt_requests_are_told_from_outside_in() -> None:
    inner = machine("M", "x", leaf("A", {"x": "B"}), leaf("B", {"x": "x"}), to={"x": "x"})
    made = built(Machine(root=machine("sm", "x", inner)))
    events: list[Event] = []

    def ask(ud: Any) -> str:
        made.request_preempt()
        return "x"

    leaves = leaves_of(made)
    leaves["A"].execute = ask
    leaves["B"].execute = lambda ud: "x"
    attach(made, "sm", events.append)
    made.execute()
    told = [line for line in short(events) if line.startswith("preempt")]
    assert told == ["preempt sm", "preempt sm/M", "preempt sm/M/A", "preempt sm/M/B"]
    assert short(events).index("preempt sm/M/B") + 1 == short(events).index("enter sm/M/B")


def test_a_scripted_leaf_that_was_asked_to_stop_says_preempted() -> None:
    root = machine("sm", "x stopped", leaf("A", {"x": "x", "preempted": "stopped"}))
    made = built(Machine(root=root))
    script(made, "sm", {"sm/A": [("x", {})]})
    made.request_preempt()
    assert made.execute() == "stopped"
    assert made.execute() == "x"


@pytest.mark.parametrize("steps", [{"sm/B": [("x", {})]}, {"sm": [("x", {})]}, {"sm/A": []}])
def test_a_script_for_no_leaf_is_refused(steps: Any) -> None:
    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "x"}))))
    with pytest.raises(KeyError):
        script(made, "sm", steps)


def test_a_state_in_two_places_is_told_by_its_label() -> None:
    class Twice(smach.State):
        def execute(self, ud: Any, /) -> str:
            return "x"

    made = smach.StateMachine(["x"])
    state = Twice(["x"])
    with made:
        smach.StateMachine.add("A", state, {"x": "B"})
        smach.StateMachine.add("B", state, {"x": "x"})
    events: list[Event] = []
    attach(made, "sm", events.append)
    made.execute()
    assert [event["path"] for event in events if event["event"] == "enter"] == ["sm/A", "sm/B"]


def test_writes_by_attribute_and_update_are_told() -> None:
    def act(ud: Any) -> str:
        ud.a = 1
        ud._private = 2
        more = smach.UserData()
        more.b = 3
        ud.update(more)
        assert ("a" in ud, ud["a"], ud.a, ud.keys()) == (True, 1, 1, ["a", "b"])
        return "x"

    root = machine("sm", "x", leaf("A", {"x": "x"}, ins="a b", outs="a b"))
    result, events = acting(root, "A", act)
    assert result == "x"
    assert short(events)[2:4] == ["write sm/A a 1", "write sm/A b 3"]


def test_watched_userdata_is_as_good_as_the_userdata() -> None:
    def act(ud: Any) -> str:
        with pytest.raises(TypeError):
            list(ud)
        assert dict(ud) == {"a": [1]}
        assert copy.copy(ud).a is ud.a
        return "x"

    root = machine("sm", "x", leaf("A", {"x": "x"}, ins="a"), held={"a": [1]})
    assert acting(root, "A", act)[0] == "x"


def test_an_observer_that_fails_does_not_stop_the_machine(
    capsys: pytest.CaptureFixture[str],
) -> None:
    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "x"}))))
    script(made, "sm", {"sm/A": [("x", {})]})

    def observe(event: Event) -> None:
        raise OSError("disk full")

    attach(made, "sm", observe)
    assert made.execute() == "x"
    assert capsys.readouterr().err == "the trace stops here: OSError: disk full\n"
