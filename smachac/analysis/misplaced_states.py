"""States in a wrong container: only transitions of another container lead to them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import NamedTuple

from smachac.analysis.control_flow import Linear, children_names, strays
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Node,
    Sequence,
    StateMachine,
    Transition,
)
from smachac.ir.traversal import outcome_names, remapping


class Misplaced(NamedTuple):
    """A state with its path and its container, and the container that was meant with its path and a
    transition there that leads to the state."""

    path: str
    container: Container
    child: Node
    meant_path: str
    meant: Linear
    step: Transition


class Stray(NamedTuple):
    """A transition that leads nowhere, with its state, and the container with its path."""

    path: str
    container: Linear
    child: Node
    step: Transition


def stray_transitions(path: str, container: Container) -> Iterator[Stray]:
    """The transitions in a container that lead neither to one of its states nor out of it."""
    if not isinstance(container, StateMachine | Sequence):
        return
    names, exits = children_names(container), frozenset(outcome_names(container))
    for child in container.children:
        for step in strays(child, names, exits):
            yield Stray(path, container, child, step)


def misplaced_states(
    containers: Iterable[tuple[str, Container]], strays: Iterable[Stray]
) -> list[Misplaced]:
    """The states to which no transition of their own container leads, but one of a container around
    it or inside it, where their own transitions have targets: they are indented wrongly."""
    wanted = {(each.path, each.step.target): each for each in strays}
    names = {target for _, target in wanted}
    found = []
    for path, container in containers if wanted else ():
        for child in _unentered(container, names):
            for (meant_path, target), stray in wanted.items():
                one_in_other = f"{meant_path}/".startswith(f"{path}/")
                one_in_other = one_in_other or f"{path}/".startswith(f"{meant_path}/")
                if target != child.name or meant_path == path or not one_in_other:
                    continue
                meant = stray.container
                known = {*children_names(meant), *outcome_names(meant)}
                own = [step.target for step in child.transitions if step.outcome != child.catches]
                if known.issuperset(own):
                    whole = f"{path}/{child.name}"
                    found.append(Misplaced(whole, container, child, meant_path, meant, stray.step))
                    break
    return found


def _unentered(container: Container, names: Collection[str]) -> list[Node]:
    """The states with some names to which nothing in their container leads; of a concurrence, which
    has no transitions, those that have some."""
    wanted = [child for child in container.children if child.name in names]
    if isinstance(container, Concurrence):
        return [child for child in wanted if child.transitions]
    if not wanted or not isinstance(container, StateMachine | Sequence):
        return []
    entered = {step.target for child in container.children for step in child.transitions}
    entered.add(container.initial or "")
    return [child for child in wanted if child.name not in entered]


def ends_of_misplaced(misplaced: Iterable[Misplaced]) -> set[tuple[str, str]]:
    """The outcomes with which misplaced states would end the container that was meant, each with
    the path of the container."""
    return {(each.meant_path, step.target) for each in misplaced for step in each.child.transitions}


def keys_of_misplaced(misplaced: Iterable[Misplaced]) -> set[tuple[str, str]]:
    """The keys that misplaced states would read in the container that was meant, each with the path
    of the container."""
    return {
        (each.meant_path, remapping(each.child).get(key.name, key.name))
        for each in misplaced
        for key in each.child.inputs
    }
