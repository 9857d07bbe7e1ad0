"""Branches that write one key or hold one resource, in machines made by hand and in random ones."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac import driver
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Concurrence, Leaf, Node, StateMachine
from tests.support.examples import examples
from tests.support.ir_machines import concurrence, iterator, leaf, machine, ran
from tests.support.rule_findings import found, report


def beside(*branches: Node, **options: Any) -> StateMachine:
    both = concurrence("BOTH", "done", *branches, default="done", to={"done": "done"}, **options)
    return machine("sm", "done", both)


def part(name: str, *children: Node, **options: Any) -> StateMachine:
    return machine(name, "x", *children, **options)


WRITER = leaf("W", {"x": "x"}, outs="key")
READER = leaf("R", {"x": "x"}, ins="key")


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (leaf("A", outcomes="x", outs="key"), leaf("B", outcomes="x", outs="key")),
        (leaf("A", outcomes="x", outs="key"), leaf("B", outcomes="x", ins="key")),
        (leaf("A", outcomes="x", ins="key"), leaf("B", outcomes="x", outs="key")),
        (
            leaf("A", outcomes="x", outs="mine", remaps={"mine": "key"}),
            leaf("B", outcomes="x", ins="its", remaps={"its": "key"}),
        ),
        (part("A", WRITER, outs="key"), leaf("B", outcomes="x", outs="key")),
        (part("A", WRITER, outs="key"), part("B", READER, ins="key")),
        (part("A", part("IN", WRITER, outs="key", to={"x": "x"}), outs="key"), READER),
        (part("A", leaf("L", {"x": "x"}), ins="key", outs="key"), READER),
        (part("A", leaf("L", {"x": "x"}), outs="key", held={"key": 1}), READER),
        (iterator("A", "exhausted", leaf("L", outcomes="x"), items=[1], item_key="key",
                  outs="key", loop="x"), READER),
        (iterator("A", "exhausted", leaf("L", outcomes="x"), items_key="key", ins="key",
                  loop="x"), WRITER),
    ],
    ids=["write write", "write read", "read write", "remapped", "container writes",
         "containers", "deep", "passed through", "preset handed out", "items", "items from"],
)  # fmt: skip
def test_a_race_is_one_finding(one: Node, other: Node) -> None:
    one, other = (replace(node, transitions=()) for node in (one, other))
    writes = other if any(key.name in ("key", "mine") for key in other.outputs) else one
    assert found(beside(one, other), "SM405") == [f"SM405 sm/BOTH/{writes.name}"]
    assert found(beside(other, one), "SM405") != []


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (leaf("A", outcomes="x", ins="key"), leaf("B", outcomes="x", ins="key")),
        (
            leaf("A", outcomes="x", outs="key", remaps={"key": "its"}),
            leaf("B", outcomes="x", outs="key"),
        ),
        (part("A", WRITER), leaf("B", outcomes="x", outs="key")),
        (part("A", WRITER, outs="key", remaps={"key": "its"}), leaf("B", outcomes="x", ins="key")),
        (part("A", leaf("L", {"x": "x"}), outs="key"), leaf("B", outcomes="x", ins="key")),
        (part("A", leaf("L", {"x": "x"}), ins="key"), leaf("B", outcomes="x", outs="key")),
        (part("A", READER, ins="key"), leaf("B", outcomes="x", ins="key")),
        (part("A", WRITER, READER), part("B", WRITER, READER)),
    ],
    ids=["both read", "remapped apart", "stays inside", "handed out elsewhere", "never set",
         "never read", "inputs", "own userdata"],
)  # fmt: skip
def test_these_are_no_races(one: Node, other: Node) -> None:
    assert found(beside(one, other), "SM405") == []


def test_who_reads_what_it_writes_races_with_nobody() -> None:
    counter = leaf("A", outcomes="x", ins="key", outs="key")
    assert found(beside(counter, leaf("B", outcomes="x")), "SM405") == []


def test_all_who_take_part_are_named_once_for_each_key() -> None:
    branches = [leaf(name, outcomes="x", outs="key pose") for name in "ABC"]
    items = [item for item in report(beside(*branches, leaf("D", outcomes="x", ins="key")))
             if item.code == "SM405"]  # fmt: skip
    assert [item.finding.message.partition(":")[0] for item in items] == [
        "`A`, `B` and `C` write `key` at the same time, and `D` reads it",
        "`A`, `B` and `C` write `pose` at the same time",
    ]


KEYS = "abc"


@st.composite
def branches(draw: st.DrawFn) -> StateMachine:
    """Two or three branches, leaves or machines of leaves, over three keys."""
    keys = st.lists(st.sampled_from(KEYS), max_size=2, unique=True).map(" ".join)
    remaps = st.dictionaries(st.sampled_from(KEYS), st.sampled_from(KEYS), max_size=2)

    def worker(name: str, to: dict[str, str]) -> Leaf:
        return leaf(name, to, outcomes="x", ins=draw(keys), outs=draw(keys), remaps=draw(remaps))

    def branch(name: str) -> Node:
        if draw(st.booleans()):
            return worker(name, {})
        children = [worker("P", {"x": "Q"}), worker("Q", {"x": "x"})]
        return part(name, *children, ins=draw(keys), outs=draw(keys), remaps=draw(remaps),
                    held=dict.fromkeys(draw(keys).split(), 0))  # fmt: skip

    names = "ABC"[: draw(st.integers(2, 3))]
    return beside(*map(branch, names), held=dict.fromkeys(draw(keys).split(), 0))


def works(path: str, node: Leaf, visit: int, userdata: Userdata) -> str:
    """Writes what it has read, and who it is."""
    seen = [path, *((key.name, userdata[key.name]) for key in node.inputs if key.name in userdata)]
    for key in node.outputs:
        userdata[key.name] = seen
    return "x"


@settings(max_examples=examples(150))
@given(branches())
def test_without_a_race_the_order_of_branches_does_not_matter(root: StateMachine) -> None:
    ends = []
    for seed in range(8):
        result, _ = ran(root, works, seed=seed)
        assert result.outcome == "done"
        ends.append(result.scopes["sm/BOTH"])
    if any(end != ends[0] for end in ends):
        assert found(root, "SM405") != []


def claiming(name: str, *claims: str, **options: Any) -> Leaf:
    return replace(leaf(name, {"x": "x"}, **options), claims=claims)


@pytest.mark.parametrize(
    ("one", "other", "clash"),
    [
        (claiming("A", "arm"), claiming("B", "arm"), "arm"),
        (claiming("A", "arm.left"), claiming("B", "arm"), "arm"),
        (claiming("A", "arm"), claiming("B", "arm.left"), "arm"),
        (claiming("A", "arm.left"), claiming("B", "arm.left.hand"), "arm.left"),
        (claiming("A", "arm.left"), claiming("B", "arm.right"), None),
        (claiming("A", "arm"), claiming("B", "armour"), None),
        (claiming("A", "arm"), claiming("B"), None),
        (part("A", claiming("L", "arm")), part("B", part("IN", claiming("R", "arm"))), "arm"),
        (replace(part("A", leaf("L", {"x": "x"})), claims=("arm",)), claiming("B", "arm"), "arm"),
        (part("A", claiming("L", "arm.left", "arm")), claiming("B", "arm.left"), "arm"),
        (part("A", claiming("L", "arm", "arm.left")), claiming("B", "leg"), None),
    ],
)
def test_claims_clash_where_one_covers_the_other(one: Node, other: Node, clash: str | None) -> None:
    one, other = (replace(node, transitions=()) for node in (one, other))
    items = [item for item in report(beside(one, other)) if item.code == "SM406"]
    assert [item.finding.message.split("`")[5] for item in items] == ([clash] if clash else [])
    assert all(item.finding.node == "sm/BOTH/B" for item in items)


@pytest.mark.parametrize("held", ["arm.left", "arm"])
def test_a_claim_deep_in_a_branch_clashes_with_a_sibling(held: str) -> None:
    deep = concurrence("IN", "x", claiming("DEEP", "arm.left"), leaf("WAIT", outcomes="x"),
                       default="x", to={"x": "x"})  # fmt: skip
    loop = iterator("LOOP", "exhausted", part("PART", deep), items=[1], loop="x")
    for branch in (deep, part("A", part("B", deep)), loop):
        sibling = replace(claiming("SIBLING", held), transitions=())
        root = beside(replace(branch, transitions=()), sibling)
        assert found(root, "SM406") == ["SM406 sm/BOTH/SIBLING"]
    apart = replace(claiming("SIBLING", "arm.right"), transitions=())
    assert found(beside(replace(deep, transitions=()), apart), "SM406") == []


def limbs(one: Any, other: Any, *, held: Any, **options: Any) -> list[str]:
    """What is found of two branches whose claim depends on the key `limb`."""
    branches = []
    for name, outer in (("A", one), ("B", other)):
        inside = claiming("MOVE", "arm.{limb}", ins="limb")
        branches.append(part(name, inside, ins="limb", remaps={"limb": outer}))
    return found(beside(*branches, held=held, **options), "SM406")


def test_claims_are_resolved_through_constants_of_the_userdata() -> None:
    assert limbs("l", "r", held={"l": "left", "r": "right"}) == []
    assert limbs("l", "r", held={"l": "left", "r": "left"}) == ["SM406 sm/BOTH/B"]
    assert limbs("l", "r", held={"l": "left"}) == []
    assert limbs("l", "l", held={"l": 1}) == ["SM406 sm/BOTH/B"]
    assert limbs("l", "r", held={"l": "left", "r": "left"}, ins="r") == ["SM406 sm/BOTH/B"]


def test_a_key_that_somebody_writes_is_no_constant() -> None:
    both = {"l": "left", "r": "left"}
    root = beside(
        part("A", claiming("M", "arm.{limb}", ins="limb"), ins="limb", remaps={"limb": "l"}),
        part("B", claiming("M", "arm.{limb}", ins="limb"), ins="limb", remaps={"limb": "r"}),
        leaf("C", outcomes="x", outs="r"),
        held=both,
    )
    assert found(root, "SM406") == []
    inside = part("A", leaf("SET", {"x": "M"}, outs="limb"),
                  claiming("M", "arm.{limb}", ins="limb"), held={"limb": "left"})  # fmt: skip
    other = claiming("B", "arm.left")
    assert found(beside(inside, replace(other, transitions=())), "SM406") == []


def test_a_claim_of_a_key_that_is_no_input_is_not_known() -> None:
    one, other = (replace(claiming(name, "arm.{limb}"), transitions=()) for name in "AB")
    assert found(beside(one, other, held={"limb": "left"}), "SM406") == []
    whole = replace(claiming("C", "arm"), transitions=())
    assert found(beside(one, whole), "SM406") == ["SM406 sm/BOTH/C"]


SCRIPT = """
name: sm
template: Base
outcomes: [done]
params: {side: left}
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      states:
        - A: {template: Grasp, FIRST}
        - B: {template: Grasp, SECOND}
"""

GRASP = """
name: Grasp
variables: {limb: {default: DEFAULT}, force: {default: 1}}
outcomes: {ok: {}}
claims: ["arm.{limb}", gripper]
code: {python: my.states:Grasp}
"""


@pytest.mark.parametrize(
    ("first", "second", "default", "claims"),
    [
        ("limb: left", "limb: [params, side]", "null", ["arm.left", "arm.left"]),
        ("limb: 1", "limb: null", "null", ["arm.1", "arm"]),
        ("force: 2", "limb: right", "left", ["arm.left", "arm.right"]),
        ("limb: [1, 2]", "limb: '`f(1)`'", "left", ["arm.{limb}", "arm.{limb}"]),
        ("claims: ['leg.{foot}']", "limb: true", "null", ["arm", "arm.{limb}"]),
    ],
)
def test_variables_and_params_fill_claims_in(
    first: str, second: str, default: str, claims: list[str], tmp_path: Path
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Grasp.yml").write_text(GRASP.replace("DEFAULT", default), "utf-8")
    script = tmp_path / "main.yml"
    script.write_text(SCRIPT.replace("FIRST", first).replace("SECOND", second), "utf-8")
    analysis = driver.analyse_script(script)
    assert "SM406" in {item.code for item in analysis.report}  # for the gripper
    assert analysis.machine is not None
    (both,) = analysis.machine.root.children
    assert isinstance(both, Concurrence)
    assert [child.claims[0] for child in both.children] == claims
