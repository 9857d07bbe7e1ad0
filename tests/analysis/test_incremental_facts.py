"""Facts at states that are kept for the machine after a change."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from smachac.analysis.incremental_facts import IncrementalResult, Preorder, found_at
from smachac.ir.nodes import Leaf, Node, StateMachine
from smachac.ir.traversal import walk
from tests.support.ir_machines import leaf, machine


def is_container(node: Node) -> bool:
    return not isinstance(node, Leaf)


def containers(root: StateMachine) -> Preorder:
    return Preorder([node for node in walk(root) if is_container(node[1])], is_container)


def tree() -> StateMachine:
    """`sm` with `A`, in which is `B`, and with `C` behind it."""
    inner = machine("B", "done", leaf("X", {"ok": "done"}))
    outer = machine("A", "done", inner, leaf("Y", {"ok": "done"}))
    return machine("sm", "done", outer, machine("C", "done", leaf("Z", {"ok": "done"})))


def test_what_has_not_changed_is_taken_from_the_machine_before() -> None:
    visited: list[str] = []

    def leaves(path: str, node: Node) -> Iterator[str]:
        visited.append(path)
        assert not isinstance(node, Leaf)
        yield from (f"{path}/{child.name}" for child in node.children if isinstance(child, Leaf))

    def found(root: StateMachine, before: IncrementalResult | None) -> IncrementalResult:
        visited.clear()
        return found_at(containers(root), leaves, (), before)

    root = tree()
    first = found(root, None)
    assert first.things == ("sm/A/Y", "sm/A/B/X", "sm/C/Z")
    assert visited == ["sm", "sm/A", "sm/A/B", "sm/C"]

    outer, last = root.children
    second = found(replace(root, children=(leaf("NEW", {"ok": "A"}), outer, last)), first)
    assert second.things == ("sm/NEW", *first.things)
    assert visited == ["sm"]

    assert isinstance(outer, StateMachine)
    inner, _ = outer.children
    third = found(replace(root, children=(replace(outer, children=(inner,)), last)), second)
    assert third.things == ("sm/A/B/X", "sm/C/Z")
    assert visited == ["sm", "sm/A"]


def test_a_container_that_has_moved_is_visited_again() -> None:
    def names(path: str, node: Node) -> Iterator[str]:
        yield path

    root = tree()
    before = found_at(containers(root), names, (), None)
    outer, last = root.children
    moved = replace(root, children=(replace(outer, name="D"), last))
    assert found_at(containers(moved), names, (), before).things == (
        "sm", "sm/D", "sm/D/B", "sm/C",
    )  # fmt: skip
