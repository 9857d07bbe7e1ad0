"""The states of a script as a comparison sees them: a list of facts for each, by its path.

They are those of the view `ir.written`: a state with `timeout`, `retry` or `for_each` is one state.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal, NamedTuple, TypeAlias

from smachac.diagnostics.source import Span
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, Sequence, StateMachine
from smachac.ir.printer import print_data
from smachac.ir.properties import Form, words
from smachac.ir.traversal import leads_to_child
from smachac.ir.written import Badge, WrittenState, written
from smachac.records import dataclass, field

FactKind = Literal[
    "field", "param", "property", "outcome", "input", "output", "variable", "userdata", "remapping",
    "transition", "rule",
]  # fmt: skip

Fact: TypeAlias = "tuple[FactKind, str]"
"""What a fact is about: its kind and its name, such as a transition and its outcome."""


class StateName(NamedTuple):
    """A state that a value names, by its path."""

    path: str

    def __str__(self) -> str:
        return self.path.rpartition("/")[2]


Value: TypeAlias = "tuple[str | StateName, ...]"
"""The value of a fact: parts of a text, in which the states can be recognised."""


@dataclass(slots=True, kw_only=True)
class State:
    """A state of a script. `children` are the paths of the states inside."""

    written: WrittenState
    path: str
    parent: str | None
    children: list[str]
    facts: dict[Fact, Value] = field(default_factory=dict)

    @property
    def node(self) -> Node:
        return self.written.node

    @property
    def name(self) -> str:
        return self.written.name

    @property
    def type(self) -> str:
        """The state type, or the kind of the container."""
        return self.node.type

    @property
    def span(self) -> Span:
        return self.node.span


_OUTCOME = "outcome "

States = dict[str, State]
"""The states of a script by path, parents before children; the first is the machine itself."""


def states_of(machine: Machine) -> States:
    """The states of a machine with their facts. Of two states with one path the first counts."""
    view = written(machine)
    found = {
        path: State(written=state, path=path, parent=state.parent, children=list(state.children))
        for path, state in view.states.items()
    }
    inside = {
        path: frozenset(view.states[child].name for child in state.children)
        for path, state in found.items()
    }
    for state in found.values():
        names = None if state.parent is None else inside[state.parent]
        state.facts = dict(_facts(state, names))
    found[machine.root.name].facts |= dict(_machine_facts(machine, found))
    return found


def _machine_facts(machine: Machine, states: States) -> Iterator[tuple[Fact, Value]]:
    yield ("field", "name"), (machine.root.name,)
    yield ("field", "template"), (machine.base,)
    for variable in machine.variables:
        yield ("variable", variable.name), (print_data(variable.value.data),)
    for param in machine.params:
        yield ("param", param.name), (print_data(param.value.data),)
    ends = _path_ends(states) if machine.properties else {}
    for property_ in machine.properties:
        yield ("property", property_.name), tuple(_property_parts(property_.form, ends))
    if machine.robot is not None:
        yield ("field", "robot"), (machine.robot.name,)


def _path_ends(states: States) -> dict[str, list[str]]:
    """The paths of the states by their names and by their whole paths."""
    found: dict[str, list[str]] = {}
    for path, state in states.items():
        for end in dict.fromkeys([state.name, path]):
            found.setdefault(end, []).append(path)
    return found


def _property_parts(form: Form, ends: Mapping[str, list[str]]) -> Iterator[str | StateName]:
    """The parts of a property in words, with the states that it names by a unique name or path."""
    for part in words(form):
        if isinstance(part, str):
            yield part
            continue
        paths = ends.get(part.name, []) if part.subject == "path" else []
        if len(paths) != 1 or paths[0].rpartition("/")[2] != part.name:
            yield f"`{part}`"
            continue
        yield from ("`", StateName(paths[0]), "`" if part.outcome is None else f":{part.outcome}`")


def renamed(fact: Fact, value: Value, paths: Mapping[str, str]) -> Fact:
    """What a fact is about, with other paths for the states: a property without a name has its
    words as its name."""
    kind, name = fact
    if kind != "property" or name != value_text(value):
        return fact
    return kind, value_text(translated(value, paths))


def _facts(state: State, siblings: frozenset[str] | None) -> Iterator[tuple[Fact, Value]]:
    """The facts of a state; `siblings` are the names of the states of its container, if it is in
    one."""
    node, outer = state.node, state.written.outer
    yield from _interface(node, outer)
    for badge in state.written.badges:
        yield from _badge_facts(badge)
    if isinstance(node, Leaf):
        for variable in node.variables:
            yield ("variable", variable.name), (print_data(variable.value.data),)
    else:
        yield from _container(node, state.path)
    if siblings is not None:
        yield from _transitions(outer, siblings, state.path)


def _interface(inner: Node, outer: Node) -> Iterator[tuple[Fact, Value]]:
    for name, text in (
        ("template", inner.type),
        ("doc", outer.doc),
        ("claims", ", ".join(inner.claims)),
        ("tags", ", ".join(inner.tags)),
        ("caught as", inner.catches or outer.catches),
    ):
        if text:
            yield ("field", name), (text,)
    for outcome in outer.outcomes:
        failure = {True: "failure", False: "no failure", None: ""}[outcome.failure]
        words = ", ".join(filter(None, [failure, outcome.doc]))
        yield ("outcome", outcome.name), (words,) if words else ()
    for kind, keys in (("input", inner.inputs), ("output", inner.outputs)):
        for key in keys:
            yield (kind, key.name), (str(key.type),)  # type: ignore[misc]
    for remap in outer.remaps:
        if remap.key != remap.to:
            yield ("remapping", remap.key), (remap.to,)


def _badge_facts(badge: Badge) -> Iterator[tuple[Fact, Value]]:
    """The facts of a field that acts on the whole state: its value, and after which outcomes the
    next try or item begins."""
    if badge.field == "catches":  # a fact of the interface
        return
    yield ("field", badge.field), (badge.limit,)
    if badge.items is not None:
        yield ("field", f"{badge.field}: in"), (print_data(badge.items.data),)
    if badge.delay:
        yield ("field", f"{badge.field}: delay"), (badge.delay,)
    if badge.again:
        yield ("field", f"{badge.field}: on"), (", ".join(sorted(badge.again)),)


def _container(container: Container, path: str) -> Iterator[tuple[Fact, Value]]:
    for preset in container.userdata:
        yield ("userdata", preset.key), (print_data(preset.value.data),)
    match container:
        case StateMachine() | Sequence():
            if container.initial:
                yield ("field", "initial"), (StateName(f"{path}/{container.initial}"),)
            if isinstance(container, Sequence):
                yield ("field", "connector outcome"), (container.connector_outcome,)
            elif container.forever:
                yield ("field", "forever"), ("true",)
        case Concurrence():
            yield ("field", "default outcome"), (container.default_outcome,)
            yield ("field", "ends with"), (f"{container.join} of its states",)
            yield from _rules(container, path)
        case nodes.Iterator():
            yield from _loop(container)


def _rules(container: Concurrence, path: str) -> Iterator[tuple[Fact, Value]]:
    """The rules of a concurrence by outcome, each as text: `A = done and B = done`."""
    found: dict[str, list[str | StateName]] = {}
    for rule in container.rules:
        parts = found.setdefault(rule.outcome, [])
        parts += [" or "] if parts else []
        for number, condition in enumerate(rule.when):
            parts += [" and "] if number else []
            parts += [StateName(f"{path}/{condition.child}"), f" = {condition.outcome}"]
    for outcome, parts in found.items():
        yield ("rule", outcome), tuple(parts)


def _loop(container: nodes.Iterator) -> Iterator[tuple[Fact, Value]]:
    items = container.items_key if container.items is None else print_data(container.items.data)
    for name, text in (
        ("items", items),
        ("item key", container.item_key),
        ("exhausted outcome", container.exhausted_outcome),
        ("loop outcomes", ", ".join(sorted(container.loop_outcomes))),
        ("final outcomes", ", ".join(f"{one}: {to}" for one, to in sorted(container.final_map))),
    ):
        if text:
            yield ("field", name), (text,)


def _transitions(outer: Node, siblings: frozenset[str], path: str) -> Iterator[tuple[Fact, Value]]:
    seen: set[str] = set()
    for step in outer.transitions:
        if step.outcome in seen:
            continue
        seen.add(step.outcome)
        value: Value = (f"{_OUTCOME}{step.target}",)
        if leads_to_child(step, siblings):
            value = (StateName(f"{path.rpartition('/')[0]}/{step.target}"),)
        yield ("transition", step.outcome), value


def outcome_of(text: str) -> str:
    """The outcome of a container to which a transition leads, from its value."""
    return text.removeprefix(_OUTCOME)


def value_text(value: Value) -> str:
    """A value as text."""
    return "".join(map(str, value))


def translated(value: Value, paths: Mapping[str, str]) -> Value:
    """A value with other paths for its states; a path without another one is kept."""
    return tuple(
        StateName(paths.get(part.path, part.path)) if isinstance(part, StateName) else part
        for part in value
    )
