"""The lines of a Mermaid state diagram: containers are composite states, concurrences have a region
for each child.

Mermaid cannot style edges, so marks in their labels show failures and implicit transitions.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.ir import nodes
from smachac.ir.graph import Edge, Vertex, edges
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, StateMachine
from smachac.ir.outcome_names import fails
from smachac.ir.script_paths import name_in_script, role_in_words
from smachac.targets.dot.edges import items
from smachac.targets.dot.style import UNKNOWN_LEGEND

FAILURE = "✗"
"""The mark of an edge for an outcome of failure."""

_PLAIN = re.compile(r"[^\W_]+(?:(?:(?<!direction) |[_.-])[^\W_]+)*", re.IGNORECASE)
"""Letters and digits, also with single signs between them that mean nothing to Mermaid there:
`direction TB` is a statement, wherever it stands."""

_ODD = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")
"""Characters that HTML cannot represent."""


def diagram(machine: Machine, *, depth: int | None, direction: str) -> Iterator[str]:
    """The lines of a state diagram. Containers below `depth` levels are drawn as closed boxes."""
    root = machine.root
    yield "stateDiagram-v2"
    yield f"  accTitle: {label(root.name)}"
    yield f"  direction {direction}"
    ids = _Ids()
    dashed: list[str] = []
    todo: list[str | _Open] = [_Open(root, ids.new(root.name), root.name, 1)]
    while todo:
        item = todo.pop()
        if isinstance(item, str):
            yield item
        else:
            todo += reversed(list(_inside(item, ids, depth, machine.unknown, dashed)))
    if dashed:  # Mermaid ignores classes that are given in a composite state
        legend = ids.new("legend")
        yield f'  state "{label(UNKNOWN_LEGEND)}" as {legend}'
        yield "  classDef unknown stroke-dasharray: 4 3"
        yield f"  class {','.join([legend, *dashed])} unknown"


class _Open(NamedTuple):
    """A container whose states are drawn in it: its identifier, its path, its level from 1."""

    container: Container
    id: str
    path: str
    level: int


def _inside(
    place: _Open, ids: _Ids, depth: int | None, unknown: Mapping[str, str], dashed: list[str]
) -> Iterator[str | _Open]:
    """The lines in a container, and the containers in it that are drawn open. The identifiers of
    the states in `unknown` go into `dashed`."""
    container, pad = place.container, "  " * place.level
    inside = {child.name: ids.new(f"{place.id}__{child.name}") for child in container.children}
    arrows = _arrows(container, inside)
    parallel = isinstance(container, Concurrence)

    def closed(child: Node) -> bool:
        return isinstance(child, Leaf) or not child.children or place.level == depth

    # Mermaid's layout fails for some composite states that follow a simple one.
    children = container.children if parallel else sorted(container.children, key=closed)
    for number, child in enumerate(children):
        id, path = inside[child.name], f"{place.path}/{child.name}"
        if parallel and number:
            yield f"{pad}--"
        if isinstance(child, Leaf) or closed(child):
            yield from (pad + line for line in _box(child, id))
        else:
            yield f'{pad}state "{_title(child)}" as {id} {{'
            yield _Open(child, id, path, place.level + 1)
            yield f"{pad}}}"
        if path in unknown:
            dashed.append(id)
        if parallel:
            yield from (pad + line for line in arrows.pop(child.name, ()))
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
        found += [_code(each) for each in text[at : plain.start()]]
        found.append(plain[0])
        at = plain.end()
    found += [_code(each) for each in text[at:]]
    return "".join(found) or "#160;"


def _code(character: str) -> str:
    return f"#{ord(character)};"


def _kind(node: Node) -> str:
    return role_in_words(node) or node.type


def _box(node: Node, id: str) -> Iterator[str]:
    """A leaf, or a container that is drawn closed."""
    yield f'state "{label(name_in_script(node))}" as {id}'
    if node.type:
        more = "" if isinstance(node, Leaf) else " +"
        yield f"{id} : {label(_kind(node))}{more}"


def _title(container: Container) -> str:
    name = label(name_in_script(container))
    if isinstance(container, StateMachine) and not container.sugar:
        return name
    first = isinstance(container, Concurrence) and container.join == "any" and not container.sugar
    return f"{name} ({label(_kind(container))}{', first to end' if first else ''})"


def _rules(child: Node, outcome: str) -> str:
    """When a concurrence of the script ends with an outcome; empty for all other nodes."""
    if not isinstance(child, Concurrence) or child.sugar:
        return ""
    found = []
    for rule in child.rules:
        if rule.outcome == outcome:
            when = [f"{label(each.child)} = {label(each.outcome)}" for each in rule.when]
            found.append(" and ".join(when) or "always")
    if outcome == child.default_outcome:
        found.append("otherwise")
    return f" ({' or '.join(found)})" if found else ""


def _arrows(container: Container, ids: dict[str, str]) -> dict[str, list[str]]:
    """The lines of the edges in a container, by the child that they start at or enter; all edges
    between the same two states are one.

    The edges on which an iterator goes on are a label of its start: Mermaid draws the label of an
    edge from a state to itself below other labels.
    """
    children = {child.name: child for child in container.children}
    bundles: dict[tuple[str, str], dict[str, None]] = {}
    for edge in edges(container):
        source, target = _name(edge.source), _name(edge.target)
        if edge.kind == "loop":
            continue
        line = f"{ids.get(source, '[*]')} --> {ids.get(target, '[*]')}"
        bundle = bundles.setdefault((source or target, line), {})
        texts = _words(container, edge, children[source]) if source else _start(container, edge)
        bundle.update(dict.fromkeys(texts))
    found: dict[str, list[str]] = {}
    for (owner, line), labels in bundles.items():
        text = f"{line} : {'<br/>'.join(labels)}" if labels else line
        found.setdefault(owner, []).append(text)
    return found


def _name(vertex: Vertex) -> str:
    """A child by its name; empty for the start and the exits."""
    return vertex if isinstance(vertex, str) else ""


def _words(container: Container, edge: Edge, child: Node) -> list[str]:
    """The label of an edge: its outcome, and that of the container if it ends with another one."""
    text = label(edge.outcome) + _rules(child, edge.outcome)
    if not isinstance(edge.target, str) and not isinstance(container, Concurrence):
        end = edge.target[1]
        text += f" → {label(end)}" if end != edge.outcome else ""
        text += f" (after the last {_round(container)})" if edge.kind == "exhausted" else ""
    if edge.kind == "implicit":
        text = f"({text})"
    return [f"{FAILURE} {text}" if fails(child, edge.outcome) else text]


def _start(container: Container, edge: Edge) -> list[str]:
    """The lines of the label of an edge from the start; those of an iterator describe the loop."""
    if not isinstance(container, nodes.Iterator):
        return []
    if not isinstance(edge.target, str):
        return [f"no items → {label(edge.target[1])}"]
    found = []
    if container.sugar != "retry":
        found.append(f"for each {label(container.item_key)} {label(items(container))}")
    again = [label(name) for name in container.loop_outcomes]
    return [*found, f"next {_round(container)} after {' or '.join(again)}"] if again else found


def _round(container: Container) -> str:
    return "try" if container.sugar == "retry" else "item"
