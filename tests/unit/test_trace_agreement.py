"""Built machines and the interpreter do the same, whatever the machine and the schedule."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ir_machines import concurrence, iterator, leaf, machine, ran
from smach_machines import Steps, interpreted, traced

from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.userdata import Userdata
from smachac.ir.walk import walk
from smachac.runtime import smach
from smachac.runtime.compare import compare


@pytest.fixture(autouse=True)
def _quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("loginfo", "logwarn", "logdebug", "logerr"):
        monkeypatch.setattr(smach, name, smach.log.quiet)


# Machines whose leaves follow steps and that go only forward, so that every run ends.

OUTCOMES = ["a", "b"]
To = st.SearchStrategy[dict[str, str]]


@st.composite
def forward_machines(draw: st.DrawFn, name: str = "sm", depth: int = 2) -> StateMachine:
    size = draw(st.integers(1, 3))
    names = [f"{name}{number}" for number in range(size)]
    children = []
    for number, child in enumerate(names):
        targets = st.sampled_from([*names[number + 1 :], *OUTCOMES])
        children.append(
            draw(nodes(child, depth, st.fixed_dictionaries(dict.fromkeys(OUTCOMES, targets))))
        )
    return machine(name, "a b", *children, outs=" ".join(f"k{child}" for child in names))


def nodes(name: str, depth: int, to: To) -> st.SearchStrategy[Node]:
    """Nodes with the outcomes `a` and `b`, and transitions as `to` draws them."""
    kinds = ["leaf", "leaf"] if not depth else ["leaf", "machine", "both", "each"]
    return st.sampled_from(kinds).flatmap(lambda kind: _node(kind, name, depth, to))


@st.composite
def _node(draw: st.DrawFn, kind: str, name: str, depth: int, to: To) -> Node:
    if kind == "leaf":
        return leaf(name, draw(to), outcomes="a b", outs=f"k{name}")
    if kind == "machine":
        inner = draw(forward_machines(name, depth - 1))
        return machine(name, "a b", *inner.children, to=draw(to), outs=f"k{name}0")
    if kind == "each":
        child = draw(nodes(f"{name}i", depth - 1, st.just({})))
        loop = draw(st.sampled_from(["", "a", "a b"]))
        items = draw(st.lists(st.integers(), max_size=3))
        return iterator(name, "a b", child, items=items, exhausted="b", loop=loop, to=draw(to))
    count = draw(st.integers(1, 3))
    children = [draw(nodes(f"{name}c{n}", depth - 1, st.just({}))) for n in range(count)]
    rules = draw(
        st.lists(
            st.tuples(
                st.sampled_from(OUTCOMES),
                st.dictionaries(
                    st.sampled_from([child.name for child in children]),
                    st.sampled_from(OUTCOMES),
                    min_size=1,
                ),
            ),
            max_size=3,
        )
    )
    return concurrence(
        name,
        "a b",
        *children,
        default=draw(st.sampled_from(OUTCOMES)),
        rules=tuple(rules),
        to=draw(to),
    )


@st.composite
def scripted_machines(draw: st.DrawFn) -> tuple[StateMachine, Steps]:
    root = draw(forward_machines())
    step = st.sampled_from(OUTCOMES)
    steps = {
        path: [
            (outcome, {f"k{node.name}": at})
            for at, outcome in enumerate(draw(st.lists(step, min_size=1, max_size=3)))
        ]
        for path, node in walk(root)
        if isinstance(node, Leaf)
    }
    return root, steps


@given(scripted_machines())
@settings(max_examples=60)
def test_built_machines_do_what_the_interpreter_does(case: tuple[StateMachine, Steps]) -> None:
    root, steps = case
    outcome, events = traced(root, steps)
    expected = interpreted(root, steps)
    assert not isinstance(outcome, Exception)
    assert compare(events, expected) is None
    assert expected[-1]["outcome"] == outcome


@given(scripted_machines(), st.integers(0, 5))
@settings(max_examples=40)
def test_the_order_of_branches_does_not_change_what_is_done(
    case: tuple[StateMachine, Steps], seed: int
) -> None:
    root, steps = case

    def act(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
        row = steps[path]
        return row[min(visit, len(row)) - 1][0]

    one, other = ran(root, act, seed=seed), ran(root, act, seed=seed + 1)
    assert compare(one[1], other[1]) is None
    assert ran(root, act, seed=seed) == one
    assert one[0].userdata == other[0].userdata
