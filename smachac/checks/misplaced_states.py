"""States in a wrong container: only transitions of another container lead to them (SM101)."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.control_flow import Linear, children_names, strays
from smachac.checks.messages import calls, other_place
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.nodes import Container, Node, Sequence, StateMachine, Transition
from smachac.ir.traversal import outcome_names, remapping


class Misplaced(NamedTuple):
    """A state with its path and its container, and the container that was meant with its path and a
    transition there that leads to the state."""

    path: str
    container: Linear
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


def misplaced_states(context: Context) -> list[Misplaced]:
    """The states to which no transition of their own container leads, but one of a container around
    it or inside it, where their own transitions have targets: they are indented wrongly."""
    wanted = {(each.path, each.step.target): each
              for each in context.at_containers(stray_transitions)}  # fmt: skip
    names = {target for _, target in wanted}
    found = []
    for path, container in context.linear if wanted else ():
        hidden = {child.name: child for child in container.children if child.name in names}
        for child in container.children if hidden else ():
            for step in child.transitions:
                hidden.pop(step.target, None)
        hidden.pop(container.initial or "", None)
        for name, child in hidden.items():
            for (meant_path, target), stray in wanted.items():
                one_in_other = f"{meant_path}/".startswith(f"{path}/")
                one_in_other = one_in_other or f"{path}/".startswith(f"{meant_path}/")
                if target != name or meant_path == path or not one_in_other:
                    continue
                meant = stray.container
                known = {*children_names(meant), *outcome_names(meant)}
                own = [step.target for step in child.transitions if step.outcome != child.catches]
                if known.issuperset(own):
                    whole = f"{path}/{name}"
                    found.append(Misplaced(whole, container, child, meant_path, meant, stray.step))
                    break
    return found


def ends_of_misplaced(context: Context) -> set[tuple[str, str]]:
    """The outcomes with which misplaced states would end the container that was meant, each with
    the path of the container."""
    return {
        (each.meant_path, step.target)
        for each in misplaced_states(context)
        for step in each.child.transitions
    }


def keys_of_misplaced(context: Context) -> set[tuple[str, str]]:
    """The keys that misplaced states would read in the container that was meant, each with the path
    of the container."""
    return {
        (each.meant_path, remapping(each.child).get(key.name, key.name))
        for each in misplaced_states(context)
        for key in each.child.inputs
    }


def misplaced_finding(found: Misplaced) -> Finding:
    """SM101 at a state in a wrong container."""
    name, owner, meant = found.child.name, found.container.name, found.meant.name
    deeper = found.meant_path.startswith(f"{found.path.rpartition('/')[0]}/")
    way = f"indent `{name}` as a state of `{meant}`"
    if not deeper:
        way = f"write `{name}` with the indentation of the states of `{meant}`"
    return Finding(
        span=found.child.span,
        message=f"`{name}` is a state of `{owner}`, but only transitions in `{meant}` lead to it",
        arguments=(name, meant, "container"),
        help=way,
        effect="SMACH refuses to run such a container: none of its states runs",
        related=(
            *other_place(found.step.target_span, f"a transition in `{meant}` leads to `{name}`"),
            *calls(found.child, found.child.span),
        ),
        node=found.path,
    )
