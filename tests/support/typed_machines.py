"""State types for machines that no script describes."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import cast

from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import Key, KeyRole, Leaf, Machine, Node, StateMachine, StateType
from smachac.ir.traversal import walk

BUILT_IN = disk_library(Path(__file__).parent / "main.yml", [])


def with_state_types(machine: Machine, library: Library = BUILT_IN) -> Machine:
    """The machine with the state types of its states and its base, as a library has them."""
    names = dict.fromkeys([machine.base, *(node.type for _, node in walk(machine.root))])
    types = {name: find_state_type(name, library, []) for name in names}
    known = {name: type_ for name, type_ in types.items() if type_ is not None}
    made: dict[str, Node] = {}
    for path, node in reversed(list(walk(machine.root))):
        if isinstance(node, Leaf):
            made[path] = with_facts(node, known[node.type]) if node.type in known else node
        else:
            children = tuple(made[f"{path}/{child.name}"] for child in node.children)
            made[path] = replace(node, children=children)
    root = cast(StateMachine, made[machine.root.name])
    return replace(machine, root=root, state_types=known)


def as_built_in(leaf: Leaf) -> Leaf:
    """The leaf with the facts of the built-in state type that its type names, if there is one."""
    type_ = _built_in(leaf.type)
    return with_facts(leaf, type_) if type_ is not None else leaf


@cache
def _built_in(name: str) -> StateType | None:
    return find_state_type(name, BUILT_IN, [])


def with_facts(leaf: Leaf, type_: StateType) -> Leaf:
    """The leaf with the facts of its state type."""
    roles = {name: held.role for name, held in type_.variables.items()}

    def keys(
        own: tuple[Key, ...], known: tuple[Key, ...], others: dict[str, KeyRole]
    ) -> tuple[Key, ...]:
        named = {key.name: key.role for key in known}
        found = {**others, **named}
        return tuple(replace(key, role=found.get(key.name, others.get("*", ""))) for key in own)

    return replace(
        leaf,
        variables=tuple(replace(held, role=roles.get(held.name, "")) for held in leaf.variables),
        inputs=keys(leaf.inputs, type_.input_keys, dict(type_.listed_inputs)),
        outputs=keys(leaf.outputs, type_.output_keys, dict(type_.listed_outputs)),
        built_in=type_.built_in,
        stand_in=type_.stand_in,
        adds_frames=type_.adds_frames,
    )
