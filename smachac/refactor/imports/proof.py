"""The proof that a script has the graph of a machine in Python: each part is compared."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Iterator

from smachac.ir.nodes import Concurrence, Container, Leaf, Node, StateMachine
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.nodes import Sequence as SequenceNode
from smachac.ir.traversal import leads_to_child, outcome_names, remapping, written_children
from smachac.pysource.machines.constructions import Callbacks, Constructions, Names
from smachac.refactor.imports.scripts import Rules, selected
from smachac.refactor.imports.state_types import is_optional


def differences(
    python: StateMachine, script: StateMachine, constructions: Constructions
) -> list[str]:
    """The differences between a machine in Python and that of its script, each as a sentence; empty
    if their graphs are equal. The names of the machines themselves do not count."""
    return [*_different(python, script, (python.name,), constructions)]


def _different(
    python: Node, script: Node, names: Names, constructions: Constructions
) -> Iterator[str]:
    path = "/".join(names)
    kinds = type(python).__name__, type(script).__name__
    if kinds[0] != kinds[1]:
        yield f"{path} is a {kinds[0]}, and a {kinds[1]} in the script"
        return
    yield from _unequal(path, "outcomes", set(outcome_names(python)), set(outcome_names(script)))
    for word, own, other in (
        ("input keys", python.inputs, script.inputs),
        ("output keys", python.outputs, script.outputs),
    ):
        yield from _unequal(path, word, {key.name for key in own}, {key.name for key in other})
    if isinstance(python, Leaf) or isinstance(script, Leaf):
        optional = ({key.name for key in node.inputs if is_optional(key)}
                    for node in (python, script))  # fmt: skip
        yield from _unequal(path, "optional keys", *optional)
        return
    yield from _different_container(python, script, names, constructions)
    inner = {child.name: child for child in written_children(script)}
    wanted = [child.name for child in written_children(python)]
    yield from _unequal(path, "states", wanted, [*inner])
    for child in written_children(python):
        if child.name in inner:
            below = (*names, child.name)
            yield from _different_edges(python, child, script, inner[child.name], below)
            yield from _different(child, inner[child.name], below, constructions)


def _different_edges(
    python: Container, child: Node, script: Container, other: Node, names: Names
) -> Iterator[str]:
    path = "/".join(names)
    yield from _unequal(path, "transitions", _edges(python, child), _edges(script, other))
    yield from _unequal(path, "remapping", _remaps(child), _remaps(other))
    levels = ({one.outcome: one.level for one in node.autonomy} for node in (child, other))
    yield from _unequal(path, "autonomy", *levels)


def _edges(container: Container, child: Node) -> dict[str, tuple[str, bool]]:
    """Where each outcome of a state leads, and whether that is a state."""
    inside = frozenset(state.name for state in container.children)
    return {
        step.outcome: (step.target, leads_to_child(step, inside))
        for step in reversed(child.transitions)
    }


def _remaps(node: Node) -> dict[str, str]:
    return {key: name for key, name in remapping(node).items() if key != name}


def _different_container(
    python: Container, script: Container, names: Names, constructions: Constructions
) -> Iterator[str]:
    path = "/".join(names)
    keys = ({preset.key for preset in node.userdata} for node in (python, script))
    yield from _unequal(path, "userdata", *keys)
    match python, script:
        case StateMachine(), StateMachine():
            yield from _unequal(path, "the first state", python.initial, script.initial)
        case SequenceNode(), SequenceNode():
            yield from _unequal(path, "the first state", python.initial, script.initial)
            own, other = python.connector_outcome, script.connector_outcome
            yield from _unequal(path, "the connector outcome", own, other)
        case Concurrence(), Concurrence():
            callbacks = constructions.callbacks.get(names, Callbacks())
            yield from _different_rules(path, python, script, callbacks)
        case IteratorNode(), IteratorNode():
            for word, one, two in (
                ("the key of the item", python.item_key, script.item_key),
                ("the outcome at the end", python.exhausted_outcome, script.exhausted_outcome),
                ("the outcomes that loop", {*python.loop_outcomes}, {*script.loop_outcomes}),
                ("the final outcomes", {*python.final_map}, {*script.final_map}),
            ):
                yield from _unequal(path, word, one, two)


def _different_rules(
    path: str, python: Concurrence, script: Concurrence, callbacks: Callbacks
) -> Iterator[str]:
    """The differences of two concurrences. With an `outcome_cb`, the rules of the script have to
    select what it selects, in every case."""
    yield from _unequal(path, "`join`", python.join, script.join)
    if callbacks.decided is None:
        if any(name == "outcome_cb" for name, _ in callbacks.lost):
            yield f"{path}: `outcome_cb` was not taken over"
        else:
            order = list if python.join == "rule" else set
            yield from _unequal(path, "rules", order(_rules(python)), order(_rules(script)))
            yield from _unequal(
                path, "the default outcome", python.default_outcome, script.default_outcome
            )
        return
    rules: Rules = [(rule.outcome, [(part.child, part.outcome) for part in rule.when])
                    for rule in script.rules]  # fmt: skip
    cases = itertools.product(*([(child.name, outcome) for outcome in outcome_names(child)]
                                for child in written_children(script)))  # fmt: skip
    for case in cases:
        wanted, found = callbacks.decided.get(case), selected(rules, script.default_outcome, case)
        if wanted != found:
            ended = ", ".join(f"{child} {outcome}" for child, outcome in case)
            yield f"{path}: after {ended} it ends with {wanted}, and with {found} in the script"
            return


def _rules(node: Concurrence) -> Iterator[tuple[str, frozenset[tuple[str, str]]]]:
    for rule in node.rules:
        yield rule.outcome, frozenset((part.child, part.outcome) for part in rule.when)


def _unequal(path: str, word: str, python: object, script: object) -> Iterator[str]:
    if python != script:
        yield f"{path}: {word}: {_text(python)}, and {_text(script)} in the script"


def _text(value: object) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{key}: {part}" for key, part in sorted(value.items())) or "none"
    if isinstance(value, Iterable) and not isinstance(value, str):
        return ", ".join(sorted(map(str, value))) or "none"
    return str(value) or "none"
