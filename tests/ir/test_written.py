"""The machine as it was written: one state of the script is one state of the view."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.script_paths import role, script_paths, walk_script
from smachac.ir.traversal import outcome_names, walk
from smachac.ir.written import duration, generated, written
from tests.ir.test_script_paths import EACH, LIMIT, RETRY, SLOWLY, machine
from tests.support.examples import seeds
from tests.support.sugared_scripts import random_script

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*/main.yml"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.parent.name)
def test_each_state_of_an_example_is_one_state_of_the_view(path: Path) -> None:
    found = analyse_script(path).machine
    assert found is not None
    mine = [item for item in walk_script(found.root) if not item.added and not role(item.node)]
    assert list(written(found).states) == [item.plain for item in mine]
    assert_every_node_has_its_place(found)


@pytest.mark.parametrize("seed", seeds(40, 100, 300))
def test_each_state_of_a_random_script_is_one_state_of_the_view(seed: int) -> None:
    script = random_script(seed)
    found = script.machine()
    assert tuple(written(found).states) == script.states
    assert_every_node_has_its_place(found)


def assert_every_node_has_its_place(machine: Machine) -> None:
    """Every node of the graph is a part of one state, and has its path in traces there."""
    view = written(machine)
    shown = script_paths(machine.root)
    assert set(view.parts) == {path for path, _ in walk(machine.root)}
    for path, node in walk(machine.root):
        part = view.parts[path]
        assert part.shown == shown.get(path, path)
        assert view.traced[part.shown] == part
        state = view.states[part.state]
        assert state.name == part.state.rpartition("/")[2]
        assert (state.node is node) == (part.role == "state")
        assert (state.outer is node) == view.is_whole(path)
    assert all(state.node.span is not None for state in view.states.values())
    for state in view.states.values():
        inside = () if isinstance(state.node, Leaf) else state.node.children
        assert state.children == tuple(f"{state.path}/{child.name}" for child in inside)
        assert all(view.states[child].parent == state.path for child in state.children)
        assert {part.state for part in state.parts} == {state.path}
        ends = {edge.target for edge in state.edges() if not edge.leaves}
        assert ends <= set(state.children)


def test_the_badges_of_a_state_say_what_its_fields_do() -> None:
    view = written(machine(f"{SLOWLY}; {LIMIT}; {EACH}"))
    state = view.states["sm/DRIVE"]
    assert list(view.states) == ["sm", "sm/DRIVE"]
    assert [badge.text for badge in state.badges] == [
        "limit 5 s",
        "3 tries",
        "for each one in [a, b]",
    ]
    assert [(badge.outcome, badge.again) for badge in state.badges] == [
        ("timeout", ()),
        ("exhausted", ("aborted",)),
        ("", ("succeeded",)),
    ]
    assert isinstance(state.node, Leaf)
    assert isinstance(state.outer, nodes.Iterator)
    assert state.repeated == ("aborted", "succeeded")
    assert [(part.role, part.shown) for part in state.parts] == [
        ("for_each", "sm/DRIVE (for_each)"),
        ("retry", "sm/DRIVE (retry)"),
        ("try", "sm/DRIVE (try)"),
        ("pause", "sm/DRIVE (try)/PAUSE"),
        ("timeout", "sm/DRIVE (timeout)"),
        ("timer", "sm/DRIVE (timeout)/TIMER"),
        ("state", "sm/DRIVE"),
    ]


def test_an_outcome_belongs_to_the_field_that_adds_it() -> None:
    state = written(machine(f"{RETRY}; {LIMIT}")).states["sm/DRIVE"]
    assert {name: state.field_of(name) for name in outcome_names(state.outer)} == {
        "succeeded": None,
        "timeout": "timeout",
        "exhausted": "retry",
        "preempted": "timeout",
    }
    assert state.part_with("timeout").full == "sm/DRIVE/TIMED"
    assert state.part_with("exhausted").full == "sm/DRIVE"
    assert state.part_with("aborted").full == "sm/DRIVE/TIMED/DRIVE"


def test_old_traces_have_full_paths() -> None:
    view = written(machine(f"{RETRY}; {LIMIT}"))
    assert view.traced["sm/DRIVE/TIMED/TIMER"].role == "timer"
    assert view.state("sm/DRIVE/TIMED:timeout") == "sm/DRIVE:timeout"
    assert view.state("sm:done") == "sm:done"
    assert view.state("another/STATE") == "another/STATE"


def test_the_generated_view_has_every_node() -> None:
    found = machine(f"{SLOWLY}; {LIMIT}")
    view = generated(found)
    assert list(view.states) == [path for path, _ in walk(found.root)]
    assert [state.name for state in view.states.values()][1:] == [
        "DRIVE", "TRY", "PAUSE", "TIMED", "DRIVE", "TIMER",
    ]  # fmt: skip
    assert view.traced["sm/DRIVE (timeout)/TIMER"].state == "sm/DRIVE/TRY/TIMED/TIMER"


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0.05, "50 ms"), (2, "2 s"), (2.5, "2.5 s"), (60, "1 min"), (90, "1 min 30 s"),
     (300, "5 min"), (7200, "2 h"), (5400, "1 h 30 min"), (0, "0 s"), (3661.5, "1 h 1 min 1.5 s")],
)  # fmt: skip
def test_a_time_limit_is_in_the_units_of_a_script(seconds: float, text: str) -> None:
    assert duration(seconds) == text


def test_exceptions_in_a_state_with_tries_are_a_badge() -> None:
    text = """
name: sm
template: Base
outcomes: [done, failed]
on_error: failed
states:
  - A: {template: ScriptedState, outcomes: [ok, bad], retry: {on: [bad], max: 2},
        transitions: {ok: done, exhausted: failed, preempted: failed}}
"""
    found = analyse_script(Source("m.yml", text)).machine
    assert found is not None
    state = written(found).states["sm/A"]
    texts = [badge.text for badge in state.badges]
    assert texts == ["exception \N{RIGHTWARDS ARROW} error", "2 tries"]
    assert state.field_of("error") == "catches"
    (whole, inner) = [item for item in generated(found).states.values() if item.name == "A"]
    assert (whole.repeated, inner.repeated) == ((), ())


def test_the_item_of_a_loop_has_its_name_in_the_script() -> None:
    path = ROOT / "tests" / "cases" / "sugar" / "main.yml"
    found = analyse_script(path).machine
    assert found is not None
    (badge,) = written(found).states["tour/VISIT"].badges
    assert badge.text == "for each wp in waypoints"
