"""The flow of userdata as the rules judge it: with misspelt names put right, so that one fault is
reported once, and keys told apart by who could set them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple, cast

from smachac.analysis.accesses import callbacks, scripted_steps, userdata_fields
from smachac.analysis.context import containers, once
from smachac.analysis.control_flow import is_open, mended
from smachac.analysis.definite_assignment import Flow, data_flow
from smachac.diagnostics.spelling import guesser
from smachac.ir import nodes
from smachac.ir.leaf import CALLING
from smachac.ir.nodes import Container, Key, Leaf, Machine, Node, Remap, Sequence, StateMachine
from smachac.ir.traversal import outcome_names
from smachac.ir.types import ANY, Type


class UnknownRemap(NamedTuple):
    """A remap of a key that the state does not have: the key meant, and that if it is certain."""

    remap: Remap
    meant: str | None
    certain: str | None


def unknown_remaps(node: Node) -> list[UnknownRemap]:
    """The remaps of keys that a state does not have."""
    if is_open(node) or not node.remaps:
        return []
    own = {key.name for key in (*node.inputs, *node.outputs)}
    wrong = [remap for remap in node.remaps if remap.key not in own]
    if not wrong:
        return []
    taken = {remap.key for remap in node.remaps}
    guess = guesser(sorted(own - taken))
    return [UnknownRemap(each, guess(each.key), guess.sure(each.key)) for each in wrong]


def undeclared_writes(leaf: Leaf) -> tuple[str, ...]:
    """The keys that the script lets a leaf write though they are none of its outputs."""
    written: list[str] = []
    if leaf.type in CALLING:
        written = sorted(callbacks(leaf) or ())
    elif leaf.type == "ScriptedState":
        written = [key for _, keys in scripted_steps(leaf) for key in keys]
    outputs = {key.name for key in leaf.outputs}
    return tuple(key for key in dict.fromkeys(written) if key not in outputs)


def undeclared_reads(leaf: Leaf) -> Iterator[tuple[str, nodes.Expression]]:
    """The keys that code of the script reads though they are none of the leaf's inputs."""
    if leaf.type not in CALLING and leaf.type != "ConditionalOutcomeState":
        return
    inputs = {key.name for key in leaf.inputs}
    order = outcome_names(leaf) if leaf.type == "ConditionalOutcomeState" else None
    for name, code in sorted((callbacks(leaf) or {}).items()):
        fields = userdata_fields(code.text) if order is None or name in order else None
        for key in fields.read if fields is not None else ():
            if key not in inputs:
                inputs.add(key)
                yield key, code


PERHAPS = Type("optional", (ANY,))
"""What code reads without declaring it counts as used, but is not asked for: SM310 has said it."""


def mended_machine(machine: Machine) -> Machine:
    """The machine as it was meant: misspelt targets, outcomes and remaps put right, and what the
    code of the script reads and writes declared. Iterative, so that deep nesting costs nothing."""
    built: dict[int, Container] = {}
    for _, container in reversed(containers(machine)):
        raw = isinstance(container, nodes.Iterator)
        children = tuple(
            _meant(built.get(id(child), child), raw and isinstance(child, Leaf))
            for child in container.children
        )
        whole = container
        if any(new is not old for new, old in zip(children, container.children, strict=True)):
            whole = replace(container, children=children)
        if isinstance(whole, StateMachine | Sequence):
            whole = mended(whole)
        if whole is not container:
            built[id(container)] = whole
    root = cast(StateMachine, built.get(id(machine.root), machine.root))
    return machine if root is machine.root else replace(machine, root=root)


def _meant(node: Node, raw: bool) -> Node:
    """A state with its keys as they were meant. `raw`: it sees all keys as they are."""
    remaps = unknown_remaps(node)
    if remaps:
        wrong = {each.remap: each.meant for each in remaps}
        kept = (replace(each, key=wrong.get(each) or each.key) for each in node.remaps)
        node = replace(node, remaps=tuple(kept))
    if isinstance(node, Leaf) and not raw and not node.open:
        reads = tuple(
            Key(name=key, span=code.span, type=PERHAPS) for key, code in undeclared_reads(node)
        )
        writes = tuple(Key(name=key, span=node.span) for key in undeclared_writes(node))
        if reads or writes:
            node = replace(node, inputs=(*node.inputs, *reads), outputs=(*node.outputs, *writes))
    return node


@once
def flow_of(machine: Machine) -> Flow:
    """The flow of a machine as it was meant."""
    return data_flow(mended_machine(machine))
