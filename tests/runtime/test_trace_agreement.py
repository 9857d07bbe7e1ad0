"""Built machines and the interpreter do the same, whatever the machine and the schedule."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.traversal import walk
from smachac.runtime.tracing.compare import compare
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran
from tests.support.smach_machines import Steps, interpreted, traced

T = TypeVar("T")

OUTCOMES = ("a", "b")

# A strategy that is made anew for each draw costs more than the draw.
BELOW = [st.integers(0, most) for most in range(8)]


pytestmark = pytest.mark.usefixtures("silent_smach")


class Maker:
    """Draws machines that go only forward, so that every run ends.

    Every node has the outcomes `a` and `b`; a leaf `x` writes the key `kx`.
    """

    def __init__(self, draw: st.DrawFn) -> None:
        self.draw = draw

    def pick(self, options: Sequence[T]) -> T:
        return options[self.draw(BELOW[len(options) - 1])]

    def machine(self, name: str, depth: int, to: dict[str, str]) -> StateMachine:
        names = [f"{name}{number}" for number in range(self.pick((1, 2, 3)))]
        children = [
            self.node(child, depth, {o: self.pick((*names[at:], *OUTCOMES)) for o in OUTCOMES})
            for at, child in enumerate(names, 1)
        ]
        return machine(name, "a b", *children, to=to, outs=f"k{names[0]} k{names[-1]}")

    def node(self, name: str, depth: int, to: dict[str, str]) -> Node:
        kind = self.pick(("leaf", "machine", "each", "both")) if depth else "leaf"
        if kind == "leaf":
            return leaf(name, to, outcomes="a b", outs=f"k{name}")
        if kind == "machine":
            return self.machine(name, depth - 1, to)
        return (self.each if kind == "each" else self.both)(name, depth, to)

    def each(self, name: str, depth: int, to: dict[str, str]) -> Node:
        return iterator(
            name,
            "a b",
            self.node(f"{name}i", depth - 1, {}),
            items=self.pick(([], [1], [1, 2], [1, 2, 3])),
            exhausted="b",
            loop=self.pick(("", "a", "a b")),
            to=to,
        )

    def both(self, name: str, depth: int, to: dict[str, str]) -> Node:
        names = [f"{name}c{number}" for number in range(self.pick((1, 2, 3)))]
        rules = tuple(
            (self.pick(OUTCOMES), {child: self.pick(OUTCOMES) for child in names[: at + 1]})
            for at in range(self.pick((0, 1, 2)))
        )
        children = [self.node(child, depth - 1, {}) for child in names]
        default = self.pick(OUTCOMES)
        return concurrence(name, "a b", *children, default=default, rules=rules, to=to)

    def steps(self, name: str) -> list[tuple[str, dict[str, object]]]:
        return [(self.pick(OUTCOMES), {f"k{name}": at}) for at in range(self.pick((1, 2, 3)))]


@st.composite
def scripted_machines(draw: st.DrawFn) -> tuple[StateMachine, Steps]:
    """A machine, and what each of its leaves does at each visit."""
    maker = Maker(draw)
    root = maker.machine("sm", 3, {})
    leaves = [(path, node) for path, node in walk(root) if isinstance(node, Leaf)]
    return root, {path: maker.steps(node.name) for path, node in leaves}


@given(scripted_machines())
@settings(max_examples=examples(60))
def test_built_machines_do_what_the_interpreter_does(case: tuple[StateMachine, Steps]) -> None:
    root, steps = case
    outcome, events = traced(root, steps)
    expected = interpreted(root, steps)
    assert not isinstance(outcome, Exception)
    assert compare(events, expected) is None
    assert expected[-1]["outcome"] == outcome


@given(scripted_machines(), BELOW[5])
@settings(max_examples=examples(60))
def test_the_order_of_branches_does_not_change_what_is_done(
    case: tuple[StateMachine, Steps], seed: int
) -> None:
    root, steps = case

    def act(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        outcome, writes = steps[path][min(visit, len(steps[path])) - 1]
        for key, value in writes.items():
            userdata[key] = value
        return outcome

    one, other = ran(root, act, seed=seed), ran(root, act, seed=seed + 1)
    assert compare(one[1], other[1]) is None
    assert ran(root, act, seed=seed) == one
    assert one[0].userdata == other[0].userdata
