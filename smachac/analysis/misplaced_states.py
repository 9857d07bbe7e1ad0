"""States in a wrong container: only transitions of another container lead to them, or only the
outcome map of a concurrence beside them names them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from collections.abc import Sequence as PathSequence
from typing import NamedTuple

from smachac.analysis.control_flow import Linear, children_names, strays
from smachac.diagnostics.source import Span
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
    """A state with its path and its container, and the container that was meant with its path and
    the place of the name of the state there: in a transition, or in a rule of a concurrence."""

    path: str
    container: Container
    child: Node
    meant_path: str
    meant: Linear | Concurrence
    place: Span


class Stray(NamedTuple):
    """A transition that leads nowhere, with its state, and the container with its path."""

    path: str
    container: Linear
    child: Node
    step: Transition


def stray_transitions(path: str, container: Linear) -> Iterator[Stray]:
    """The transitions in a container that lead neither to one of its states nor out of it."""
    names, exits = children_names(container), frozenset(outcome_names(container))
    for child in container.children:
        for step in strays([child], names, exits):
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
                    place = stray.step.target_span
                    found.append(Misplaced(whole, container, child, meant_path, meant, place))
                    break
    return found


def misplaced_branches(containers: PathSequence[tuple[str, Container]]) -> list[Misplaced]:
    """The states beside a concurrence that only its outcome map names and that have no transitions:
    they are meant as its branches."""
    found = []
    around: dict[str, Container] = {}
    for path, meant in containers:
        if not isinstance(meant, Concurrence):
            continue
        names = children_names(meant)
        unknown = {part.child: part.span for rule in meant.rules for part in rule.when
                   if part.child and part.child not in names}  # fmt: skip
        around = around or (dict(containers) if unknown else {})
        outer_path = path.rpartition("/")[0]
        outer = around.get(outer_path)
        if outer is None or not unknown:
            continue
        for child in _unentered(outer, unknown):
            steps = (each for each in child.transitions if each.outcome != child.catches)
            if not any(step.origin == "written" for step in steps):
                place = unknown[child.name]
                whole = f"{outer_path}/{child.name}"
                found.append(Misplaced(whole, outer, child, path, meant, place))
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
        (each.meant_path, remapping(each.child)[key.name])
        for each in misplaced
        for key in each.child.inputs
    }
