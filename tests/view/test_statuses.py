"""The events of a run from the statuses of its containers: those of the trace of the same run."""

from __future__ import annotations

import threading
from itertools import count
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.source import NOWHERE, Source
from smachac.driver import analyse_script
from smachac.ir.nodes import Concurrence, Iterator, Leaf, Machine, StateMachine
from smachac.ir.traversal import walk
from smachac.runtime.container_tree import (
    NEW_PROTOCOL,
    containers,
    more_status,
    status_fields,
)
from smachac.runtime.smach.container import Container
from smachac.runtime.tracing.compare import compare
from smachac.runtime.tracing.trace import attach, script
from smachac.runtime.tracing.writer import Event
from smachac.view.statuses import Report, StatusEvents, report_of
from tests.runtime.test_trace import everything
from tests.runtime.test_trace_agreement import scripted_machines
from tests.support.examples import examples
from tests.support.ir_machines import short
from tests.support.smach_machines import Steps, built

pytestmark = pytest.mark.usefixtures("silent_smach")


class Node:
    """The statuses that a node publishes of a machine, with times that count up; with its trace.

    `more`: as JSON, with outcomes and values.
    """

    def __init__(self, root: StateMachine, steps: Steps, *, more: bool = True) -> None:
        self.root = root
        self.machine = built(Machine(root=root))
        self.statuses: list[dict[str, Any]] = []
        self.trace: list[Event] = []
        self._more = more
        self._lock = threading.Lock()
        self._time = count()
        script(self.machine, root.name, steps)
        attach(self.machine, root.name, self.trace.append)
        for path, container in containers(f"/{root.name}", self.machine):
            self._follow(path, container)

    def _follow(self, path: str, container: Container) -> None:
        def changed(userdata: object, *what: object) -> None:
            self.report(path, container, repr(what))

        container.register_start_cb(changed)
        container.register_transition_cb(changed)
        container.register_termination_cb(changed)

    def report(self, path: str, container: Container, info: str) -> None:
        with self._lock:
            fields = status_fields(path, container, info, NEW_PROTOCOL)
            more = more_status(container) if self._more else {}
            self.statuses.append({"stamp": next(self._time), **fields, **more})

    def heartbeat(self, info: str = "HEARTBEAT") -> None:
        for path, container in containers(f"/{self.root.name}", self.machine):
            self.report(path, container, info)

    def run(self) -> Node:
        self.heartbeat("Initial state")
        self.machine.execute()
        return self


def reports_of(statuses: list[dict[str, Any]]) -> list[Report]:
    reports = [report_of(each) for each in statuses]
    return [each for each in reports if each is not None]


def viewed(root: StateMachine, *batches: list[dict[str, Any]]) -> list[Event]:
    """The events of statuses that arrive in batches."""
    events = StatusEvents()
    events.use(Machine(root=root))
    return [each for batch in batches for each in events.events(reports_of(batch))]


def without_writes(events: list[Event]) -> list[Event]:
    return [each for each in events if each["event"] != "write"]


def active(events: list[Event]) -> set[str]:
    """The states that run after events."""
    found: set[str] = set()
    for each in events:
        if each["event"] == "start":
            found.clear()
        if each["event"] in ("start", "enter"):
            found.add(each["path"])
        elif each["event"] in ("exit", "finish"):
            found.discard(each["path"])
    return found


def test_statuses_of_every_kind_of_container_give_the_trace() -> None:
    node = Node(*everything()).run()
    events = viewed(node.root, node.statuses)
    expected = without_writes(node.trace)
    assert compare(without_writes(events), expected) is None
    assert sorted(short(without_writes(events))) == sorted(short(expected))
    assert [each["seq"] for each in events] == list(range(1, len(events) + 1))
    assert [each["t"] for each in events] == sorted(each["t"] for each in events)


@given(scripted_machines())
@settings(max_examples=examples(60))
def test_statuses_give_the_trace(case: tuple[StateMachine, Steps]) -> None:
    node = Node(*case).run()
    events = without_writes(viewed(node.root, node.statuses))
    assert compare(events, without_writes(node.trace)) is None
    assert sorted(short(events)) == sorted(short(without_writes(node.trace)))


@given(scripted_machines())
@settings(max_examples=examples(60))
def test_without_outcomes_the_states_are_the_same(case: tuple[StateMachine, Steps]) -> None:
    """Statuses of smach_msgs: an outcome that is shown is the right one. They do not show whether
    the child of an iterator ran before its end."""
    node = Node(*case, more=False).run()
    events = without_writes(viewed(node.root, node.statuses))
    expected = without_writes(node.trace)
    assert active(events) == set()
    if any(isinstance(each, Iterator) for _, each in walk(node.root)):
        return
    visits, wanted = (
        [(each["event"], each["path"]) for each in run if each["event"] != "transition"]
        for run in (events, expected)
    )
    assert sorted(visits) == sorted(wanted)
    if not any(isinstance(each, Concurrence) for _, each in walk(node.root)):
        assert visits == wanted
        shown = iter(short(expected))
        certain = [
            line
            for each, line in zip(events, short(events), strict=True)
            if each["event"] in ("start", "enter") or "outcome" in each
        ]
        assert all(line in shown for line in certain), "a part of the trace, in its order"


@given(scripted_machines(), st.data())
@settings(max_examples=examples(60))
def test_a_view_that_comes_late_or_misses_statuses_finds_the_active_states(
    case: tuple[StateMachine, Steps], data: st.DataObject
) -> None:
    """Any statuses may be lost; after a few heartbeats the states are those of the node."""
    node = Node(*case).run()
    cut = data.draw(st.integers(0, len(node.statuses)))
    before = node.statuses[:cut]
    kept = [each for each in before if data.draw(st.booleans())]
    latest = {each["path"].strip("/"): each for each in before}
    for path, each in latest.items():
        if (report := report_of(each)) is not None and report.outcome is not None:
            latest[path] = {**each, "active_states": []}  # of a heartbeat after the end
    beats = [
        [
            {**each, "info": "HEARTBEAT", "stamp": 10_000 + 100 * number + order}
            for order, each in enumerate(latest.values())
        ]
        for number in range(5)
    ]
    events = viewed(node.root, kept, *beats, [], [])
    nodes = dict(walk(node.root))
    leaves = {path for path, each in nodes.items() if isinstance(each, Leaf)}
    running: set[str] = set()
    pending = [node.root.name]
    while pending:
        path = pending.pop()
        running.add(path)
        labels = latest[path]["active_states"] if path in latest and path not in leaves else []
        pending += [f"{path}/{label}" for label in labels if label != "None"]
    assert active(events) & leaves == running & leaves


def test_values_are_written_by_the_state_that_has_ended() -> None:
    node = Node(*everything()).run()
    events = viewed(node.root, node.statuses)
    writes = [line for line in short(events) if line.startswith("write")]
    assert writes[:3] == [
        "write sm/FETCH/LOOK pose [1, {'x': 2}]",
        "write sm/FETCH/GRASP width 0.5",
        "write sm/FETCH width 0.5",
    ]
    again = viewed(node.root, node.statuses, node.statuses)
    assert [line for line in short(again) if line.startswith("write")] == writes * 2


def test_values_of_secret_keys_are_hidden() -> None:
    script = Source(
        "main.yml",
        "name: sm\noutcomes: [done]\n"
        "userdata: {pin: {type: int?, value: null, secret: true}, n: 1}\n"
        "states:\n  - A: {template: ScriptedState, outcomes: [done], transitions: {done: done}}\n",
    )
    machine = analyse_script(script).machine
    assert machine is not None
    events = StatusEvents()
    events.use(machine)
    values = {"pin": 4711, "n": 1}
    found = events.events([Report(stamp=1.0, path="sm", active=("A",), values=values)])
    assert [line for line in short(list(found)) if line.startswith("write")] == [
        "write sm pin '(secret)'",
        "write sm n 1",
    ]


def test_a_heartbeat_made_before_a_change_that_is_known_is_no_news() -> None:
    """A node may make a heartbeat, then start, and publish the heartbeat after its start."""
    node = Node(*everything()).run()
    started = node.statuses[: len(list(containers("/sm", node.machine))) + 2]
    stale = {**started[0], "stamp": 1_000}
    assert stale["info"] == "Initial state"
    events = StatusEvents()
    events.use(Machine(root=node.root))
    known = events.events(reports_of(started))
    assert active(list(known)) == {"sm", "sm/FETCH", "sm/FETCH/LOOK"}
    assert events.events(reports_of([stale])) == []
    (finish,) = (
        each
        for each in events.events(reports_of([{**stale, "stamp": 1_001}]))
        if each["event"] == "finish"
    )
    assert "outcome" not in finish, "the end did not arrive"


def test_statuses_of_another_machine_are_shown_as_they_are() -> None:
    node = Node(*everything()).run()
    other = StateMachine(type="StateMachine", name="other", span=NOWHERE)
    events = viewed(other, node.statuses)
    entered, known = (
        {each["path"] for each in run if each["event"] == "enter"} for run in (events, node.trace)
    )
    assert entered == known
    assert short(events)[-1] == "finish sm done"


@pytest.mark.parametrize(
    "fields",
    [
        {},
        {"stamp": "x", "path": "/sm", "active_states": [], "info": ""},
        {"stamp": 1, "path": "/sm", "active_states": None, "info": ""},
        {"stamp": 1, "path": "/sm", "active_states": [], "info": "", "ended": 3},
        {"stamp": 1, "path": "/sm", "active_states": [], "info": "", "userdata": 3},
    ],
)
def test_a_message_that_is_no_status(fields: dict[str, Any]) -> None:
    assert report_of(fields) is None
