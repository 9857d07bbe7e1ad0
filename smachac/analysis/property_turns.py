"""Turns: the transition at which a counterexample leaves the way that its property requires.

The transitions are those of the replay of the counterexample, so that time limits, retries, loops
and stop requests lead where they lead in a run.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise, takewhile
from typing import TYPE_CHECKING, NamedTuple

from smachac.ir.nodes import Leaf, Node, Transition
from smachac.ir.outcome_names import fails
from smachac.ir.properties import After, AlwaysEnds, AtMost, Atoms, Before, Form, Never
from smachac.ir.traversal import walk

if TYPE_CHECKING:
    from smachac.interpreter.counterexample import Replay


class Turn(NamedTuple):
    """A transition of the script with its state. `missed` are the states beside it that the
    property requires, if no transition behind this one leads to any of them; `unled`: no transition
    at all leads to them."""

    node: Node
    step: Transition
    missed: tuple[Node, ...] = ()
    unled: bool = False


class _Taken(NamedTuple):
    """A transition of the script that the replay takes, with the path of its state."""

    path: str
    step: Transition


def turn_of(form: Form, replayed: Replay, visits: int, nodes: Mapping[str, Node]) -> Turn | None:
    """The turn of a counterexample with a number of visits; None if there is none. `nodes` are all
    nodes by path. For an `after` it is the transition that leads past a required state, or the
    first one behind which no required state comes, otherwise the one that follows its first event;
    for a `never` with `until` and for a `before` the transition that leads past a required state to
    which nothing leads. Otherwise it is the last transition, and of repeated states the last one
    for a failure.
    """
    steps = list(_steps(replayed, visits, nodes))
    if isinstance(form, After):
        steps = _from_last(form.first, steps)
        missed = _first_miss(form.answer, steps, nodes)
        if missed is not None:
            return missed
        steps = steps[:1]
    if isinstance(form, Never | Before):
        missed = _unled_miss(form, steps, nodes)
        if missed is not None:
            return missed
    if isinstance(form, AtMost | AlwaysEnds):
        steps = [step for step in steps if fails(nodes[step.path], step.step.outcome)] or steps
    return Turn(nodes[steps[-1].path], steps[-1].step) if steps else None


def _unled_miss(
    form: Never | Before, steps: list[_Taken], nodes: Mapping[str, Node]
) -> Turn | None:
    """The transition that leads past a state which must come between two events, or before one, if
    nothing leads to that state."""
    if isinstance(form, Never):
        found = (
            _first_miss(form.until, _from_last(form.after, steps), nodes) if form.until else None
        )
    else:
        found = _first_miss(form.earlier, steps, nodes)
    return found if found is not None and found.unled else None


def _steps(replayed: Replay, visits: int, nodes: Mapping[str, Node]) -> Iterator[_Taken]:
    """The transitions of the script up to the visit after the last one of a counterexample."""
    ended = 0
    for event in replayed.events if replayed.followed else ():
        node = nodes.get(event["path"])
        ended += event["event"] == "exit" and isinstance(node, Leaf)
        if ended > visits:
            return
        for step in node.transitions if node is not None and event["event"] == "transition" else ():
            if step.outcome == event["outcome"] and step.origin == "written":
                yield _Taken(event["path"], step)


def _from_last(events: Atoms, steps: list[_Taken]) -> list[_Taken]:
    """The transitions from the last one that follows one of some events."""

    def follows(taken: _Taken) -> bool:
        return any(
            event.subject == "path"
            and f"/{taken.path}".endswith(f"/{event.name}")
            and event.outcome in (None, taken.step.outcome)
            for event in events
        )

    before = len([*takewhile(lambda step: not follows(step), reversed(steps))])
    return steps[len(steps) - before - 1 :] if before < len(steps) else []


def _first_miss(answer: Atoms, steps: list[_Taken], nodes: Mapping[str, Node]) -> Turn | None:
    """The first transition behind which no state of `answer` comes; where no transition leads to
    such a state, the one that leads past it."""
    required: dict[str, _Required] = {}
    for at, (path, step) in enumerate(steps):
        around = path.rpartition("/")[0]
        if around not in required:
            required[around] = _required(nodes[around], answer)
        if required[around].states and step.target not in required[around].leading:
            states, unled = required[around].states, required[around].unled
            past = _past(around, states, steps[at:], nodes) if unled else None
            if past is not None:
                return Turn(nodes[past.path], past.step, states, unled=True)
            others = tuple(state for state in states if state is not nodes[path])
            return Turn(nodes[path], step, others or states, unled=unled and others == states)
    return None


def _past(
    around: str, states: tuple[Node, ...], steps: list[_Taken], nodes: Mapping[str, Node]
) -> _Taken | None:
    """The transition on a path that leads past the only required state to which nothing leads: to a
    target to which that one leads as well. It is that of the state before it in the script, or the
    last one."""
    container = nodes[around]
    if len(states) != 1 or isinstance(container, Leaf):
        return None
    after = {step.target for step in states[0].transitions
             if step.origin == "written" and not fails(states[0], step.outcome)}  # fmt: skip
    found = [step for step in steps
             if step.path.rpartition("/")[0] == around and step.step.target in after
             and not fails(nodes[step.path], step.step.outcome)]  # fmt: skip
    before = [one for one, state in pairwise(container.children) if state is states[0]]
    near = [taken for taken in found if nodes[taken.path] in before]
    return next(iter([*near, *reversed(found)]), None)


class _Required(NamedTuple):
    """The states of a container that a property requires, and the names from which transitions
    lead to one of them. No states, where the container does not have all of them. `unled`: no
    transition leads to any of these states."""

    states: tuple[Node, ...]
    leading: frozenset[str]
    unled: bool = False


def _required(container: Node, answer: Atoms) -> _Required:
    """The states of `answer`, or those around them; only those to which no transition leads, if
    there are some."""
    children = () if isinstance(container, Leaf) else container.children
    names = [atom.name for atom in answer if atom.subject == "path" and atom.outcome is None]
    beside = {child.name: child for child in children}
    inside: dict[str, Node] = {}
    for child in children:
        for _, node in walk(child):
            if node.name in names:
                inside.setdefault(node.name, child)
    found = [beside.get(name) or inside.get(name) for name in names]
    states = tuple(node for node in found if node is not None)
    ends = _ends(container, children, answer)
    if not states or ends is None or len(states) < len(names):
        return _Required((), frozenset())
    sources: dict[str, list[str]] = {}
    for child in children:
        for step in child.transitions:
            sources.setdefault(step.target, []).append(child.name)
    leading = {node.name for node in states} | ends
    todo = list(leading)
    while todo:
        before = set(sources.get(todo.pop(), ())) - leading
        leading |= before
        todo += before
    unled = tuple(node for node in states if node.name not in sources)
    return _Required(unled or states, frozenset(leading), bool(unled))


def _ends(container: Node, children: Sequence[Node], answer: Atoms) -> set[str] | None:
    """The names in a container at which an answer with an outcome may come: its states and its own
    outcomes. None if an answer may come elsewhere."""
    found: set[str] = set()
    for atom in answer:
        if atom.subject != "path":
            return None
        if atom.outcome is None:
            continue
        if atom.name == container.name:
            found.add(atom.outcome)
        elif any(atom.name == child.name for child in children):
            found.add(atom.name)
        else:
            return None
    return found
