"""Turns: the transition at which a counterexample leaves the way that its property requires."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.properties import Judgement, Visit
from smachac.ir.nodes import Leaf, Node, Transition
from smachac.ir.properties import After, Atom, Atoms, Form
from smachac.ir.traversal import walk


class Turn(NamedTuple):
    """A transition of the script with its state. `missed` are the states beside it that the
    property requires, if no transition behind this one leads to any of them."""

    node: Node
    step: Transition
    missed: tuple[Node, ...] = ()


def turns(
    judgements: Sequence[Judgement], states: Iterable[tuple[str, Node]]
) -> tuple[Turn | None, ...]:
    """The turn of each counterexample, None without one. `states` are all nodes with their paths.
    For an `after` it is the first transition behind which no required state comes, otherwise that
    of the first event; for the other forms it is the last transition."""
    if not any(each.counterexample for each in judgements):
        return (None,) * len(judgements)
    nodes = dict(states)
    return tuple(
        None
        if each.counterexample is None
        else _turn(each.property.form, each.counterexample.visits, nodes)
        for each in judgements
    )


def _turn(form: Form, visits: Sequence[Visit], nodes: Mapping[str, Node]) -> Turn | None:
    if isinstance(form, After):
        visits = _from_last(form.first, visits)
        return _first_miss(form.answer, visits, nodes) or _taken(visits[:1], nodes)
    return _taken(visits[-1:], nodes)


def _first_miss(answer: Atoms, visits: Sequence[Visit], nodes: Mapping[str, Node]) -> Turn | None:
    """The first transition behind which no state of `answer` comes."""
    required: dict[str, _Required] = {}
    for visit in visits:
        path, step = _step(visit, nodes)
        if step is None:
            continue
        around = path.rpartition("/")[0]
        if around not in required:
            required[around] = _required(nodes[around], answer)
        if required[around].states and step.target not in required[around].leading:
            return Turn(nodes[path], step, required[around].states)
    return None


def _taken(visits: Sequence[Visit], nodes: Mapping[str, Node]) -> Turn | None:
    """The transition that follows the only visit, if there is one."""
    for visit in visits:
        path, step = _step(visit, nodes)
        return Turn(nodes[path], step) if step is not None else None
    return None


def _from_last(events: Atoms, visits: Sequence[Visit]) -> Sequence[Visit]:
    """The visits from the last one that is one of some events."""
    numbers = [n for n, visit in enumerate(visits) if any(_matches(each, visit) for each in events)]
    return visits[numbers[-1] :] if numbers else ()


def _matches(atom: Atom, visit: Visit) -> bool:
    """Whether an event names the state of a visit, and its outcome."""
    same = f"/{visit.path}".endswith(f"/{atom.name}")
    return atom.subject == "path" and same and atom.outcome in (None, visit.outcome)


def _step(visit: Visit, nodes: Mapping[str, Node]) -> tuple[str, Transition | None]:
    """The transition of the script that follows a visit, with the path of its state."""
    path = visit.path if visit.outcome is not None else ""
    while "/" in path:
        for step in nodes[path].transitions:
            if step.outcome == visit.outcome and step.origin == "written":
                return path, step
        path = path.rpartition("/")[0]
    return path, None


class _Required(NamedTuple):
    """The states of a container that a property requires, and the names from which transitions
    lead to one of them. No states, where the container does not have all of them."""

    states: tuple[Node, ...]
    leading: frozenset[str]


def _required(container: Node, answer: Atoms) -> _Required:
    """The states of `answer`, or those around them; only those to which no transition leads, if
    there are some."""
    children = () if isinstance(container, Leaf) else container.children
    names = [each.name for each in answer if each.subject == "path" and each.outcome is None]
    beside = {child.name: child for child in children}
    inside: dict[str, Node] = {}
    for child in children:
        for _, node in walk(child):
            if node.name in names:
                inside.setdefault(node.name, child)
    found = [beside.get(name) or inside.get(name) for name in names]
    states = tuple(node for node in found if node is not None)
    if not states or len(states) < len(answer):
        return _Required((), frozenset())
    sources: dict[str, list[str]] = {}
    for child in children:
        for step in child.transitions:
            sources.setdefault(step.target, []).append(child.name)
    leading = {node.name for node in states}
    todo = list(leading)
    while todo:
        before = set(sources.get(todo.pop(), ())) - leading
        leading |= before
        todo += before
    unled = tuple(node for node in states if node.name not in sources)
    return _Required(unled or states, frozenset(leading))
