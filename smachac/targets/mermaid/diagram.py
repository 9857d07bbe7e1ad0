"""The lines of a Mermaid state diagram: containers are composite states, concurrences have a region
for each child.

Mermaid cannot style edges, so marks in their labels show failures and implicit transitions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Leaf, Machine, StateMachine
from smachac.ir.outcome_names import fails
from smachac.ir.written import Written, WrittenEdge, WrittenState, items_in_words
from smachac.targets.dot.style import JOINS, UNKNOWN_LEGEND

FAILURE = "✗"
"""The mark of an edge for an outcome of failure."""

_PLAIN = re.compile(r"[^\W_]+(?:(?:(?<!direction) |[_.-])[^\W_]+)*", re.IGNORECASE)
"""Letters and digits, also with single signs between them that mean nothing to Mermaid there:
`direction TB` is a statement, wherever it stands."""

_ODD = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""Characters that HTML cannot represent."""


def diagram(machine: Machine, view: Written, *, depth: int | None, direction: str) -> Iterator[str]:
    """The lines of a state diagram of the states of a view. Containers below `depth` levels are
    drawn as closed boxes."""
    root = view.root
    yield "stateDiagram-v2"
    yield f"  accTitle: {label(root.name)}"
    yield f"  direction {direction}"
    picture = _Picture(view, depth, frozenset(map(view.state, machine.unknown)))
    dashed: list[str] = []
    todo: list[str | _Open] = [_Open(root, picture.ids.new(root.name))]
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            yield item
        else:
            todo += reversed(list(_inside(item, picture, dashed)))
    if dashed:  # Mermaid ignores classes that are given in a composite state
        legend = picture.ids.new("legend")
        yield f'  state "{label(UNKNOWN_LEGEND)}" as {legend}'
        yield "  classDef unknown stroke-dasharray: 4 3"
        yield f"  class {','.join([legend, *dashed])} unknown"


class _Picture:
    """What is drawn: the states of a view, the levels that are open, and the states that are not
    known exactly."""

    def __init__(self, view: Written, depth: int | None, unknown: frozenset[str]) -> None:
        self.view, self.depth, self.unknown = view, depth, unknown
        self.ids = _Ids()

    def is_closed(self, state: WrittenState) -> bool:
        return not state.children or (self.depth is not None and state.level >= self.depth)


class _Open(NamedTuple):
    """A container whose states are drawn in it, and its identifier."""

    state: WrittenState
    id: str


def _inside(place: _Open, picture: _Picture, dashed: list[str]) -> Iterator[str | _Open]:
    """The lines in a container, and the containers in it that are drawn open. The identifiers of
    the states that are not known exactly go into `dashed`."""
    container, pad = place.state, "  " * (place.state.level + 1)
    states = [picture.view.states[path] for path in container.children]
    ids = {state.path: picture.ids.new(f"{place.id}__{state.name}") for state in states}
    arrows = _arrows(container, {state.path: state for state in states}, ids)
    parallel = isinstance(container.node, Concurrence)
    # Mermaid's layout fails for some composite states that follow a simple one.
    ordered = states if parallel else sorted(states, key=picture.is_closed)
    for number, state in enumerate(ordered):
        id = ids[state.path]
        if parallel and number:
            yield f"{pad}--"
        if picture.is_closed(state):
            yield from (pad + line for line in _box(state, id))
        else:
            yield f'{pad}state "{_title(state)}" as {id} {{'
            yield _Open(state, id)
            yield f"{pad}}}"
        if state.path in picture.unknown:
            dashed.append(id)
        if parallel:
            yield from (pad + line for line in arrows.pop(state.path, ()))
    for lines in arrows.values():
        yield from (pad + line for line in lines)


class _Ids:
    """The identifiers of states in a diagram: one space of names for all containers."""

    def __init__(self) -> None:
        self._used: set[str] = set()
        self._next: dict[str, int] = {}

    def new(self, text: str) -> str:
        """An identifier like a text that is not used yet.

        Mermaid itself adds `_start` and `_end` to the identifiers of composite states.
        """
        word = re.sub(r"[^A-Za-z0-9_]", "_", text)
        word = f"{word}_" if word.endswith(("_start", "_end")) else word
        id = word
        while id in self._used:
            self._next[word] = self._next.get(word, 1) + 1
            id = f"{word}_{self._next[word]}"
        self._used.add(id)
        return id


def label(text: str) -> str:
    """A text as Mermaid shows it: what it could read as syntax or markup is a character code."""
    text = _ODD.sub("\ufffd", " ".join(text.split()))
    found: list[str] = []
    at = 0
    for plain in _PLAIN.finditer(text):
        found += [_code(word) for word in text[at : plain.start()]]
        found.append(plain[0])
        at = plain.end()
    found += [_code(word) for word in text[at:]]
    return "".join(found) or "#160;"


def _code(character: str) -> str:
    return f"#{ord(character)};"


def _with_badges(text: str, state: WrittenState) -> str:
    """A text, and the badges of a state behind it."""
    return ", ".join([text, *(label(badge.text) for badge in state.badges)])


def _box(state: WrittenState, id: str) -> Iterator[str]:
    """A leaf, or a container that is drawn closed."""
    yield f'state "{label(state.name)}" as {id}'
    if state.node.type:
        more = "" if isinstance(state.node, Leaf) else " +"
        yield f"{id} : {_with_badges(label(state.node.type) + more, state)}"


def _title(state: WrittenState) -> str:
    name, container = label(state.name), state.node
    if isinstance(container, StateMachine):
        words = ", ".join(label(badge.text) for badge in state.badges)
        return f"{name} ({words})" if words else name
    kind = label(container.type)
    if isinstance(container, Concurrence):
        kind += JOINS[container.join]
    return f"{name} ({_with_badges(kind, state)})"


def _rules(state: WrittenState, outcome: str) -> str:
    """When a concurrence of the script ends with an outcome; empty for all other nodes."""
    node = state.node
    if not isinstance(node, Concurrence):
        return ""
    found = []
    for rule in node.rules:
        if rule.outcome == outcome:
            when = [
                f"{label(condition.child)} = {label(condition.outcome)}" for condition in rule.when
            ]
            found.append(" and ".join(when) or "always")
    if outcome == node.default_outcome:
        found.append("otherwise")
    return f" ({' or '.join(found)})" if found else ""


def _arrows(
    container: WrittenState, states: Mapping[str, WrittenState], ids: Mapping[str, str]
) -> dict[str, list[str]]:
    """The lines of the edges in a container, by the path of the state that they start at or enter;
    all edges between the same two states are one.

    The edges on which an iterator goes on are a label of its start: Mermaid draws the label of an
    edge from a state to itself below other labels.
    """
    bundles: dict[tuple[str, str], dict[str, None]] = {}
    for edge in container.edges():
        if edge.kind == "loop":
            continue
        source, target = edge.source or "", "" if edge.leaves else edge.target
        line = f"{ids.get(source, '[*]')} --> {ids.get(target, '[*]')}"
        bundle = bundles.setdefault((source or target, line), {})
        texts = _words(container, edge, states[source]) if source else _start(container, edge)
        bundle.update(dict.fromkeys(texts))
    found: dict[str, list[str]] = {}
    for (owner, line), labels in bundles.items():
        text = f"{line} : {'<br/>'.join(labels)}" if labels else line
        found.setdefault(owner, []).append(text)
    return found


def _words(container: WrittenState, edge: WrittenEdge, state: WrittenState) -> list[str]:
    """The label of an edge: its outcome, and that of the container if it ends with another one, or
    what begins after it."""
    text = label(edge.outcome) + _rules(state, edge.outcome)
    if edge.leaves and not isinstance(container.node, Concurrence):
        end = edge.target
        text += f" → {label(end)}" if end != edge.outcome else ""
        text += " (after the last item)" if edge.kind == "exhausted" else ""
        if (again := container.next_round(end)) is not None:
            text += f" → next {again}"
    if edge.kind == "implicit":
        text = f"({text})"
    return [f"{FAILURE} {text}" if fails(state.outer, edge.outcome) else text]


def _start(container: WrittenState, edge: WrittenEdge) -> list[str]:
    """The lines of the label of an edge from the start; those of an iterator describe the loop."""
    node = container.node
    if not isinstance(node, nodes.Iterator):
        return []
    if edge.leaves:
        return [f"no items → {label(edge.target)}"]
    found = [f"for each {label(node.item_key)} {label(items_in_words(node))}"]
    again = [label(name) for name in node.loop_outcomes]
    return [*found, f"next item after {' or '.join(again)}"] if again else found
