"""The model of the viewer: a machine as JSON data, with its findings and properties.

The edges are those of the control-flow graph of each container (`ir.graph.edges`).
docs/targets.md describes the fields.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any

from smachac.analysis.context import Context
from smachac.analysis.secret_values import secret_values
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.ir import graph, nodes
from smachac.ir.graph import START, Edge
from smachac.ir.nodes import Concurrence, Container, Key, Leaf, Machine, Node
from smachac.ir.outcome_names import fails, successes
from smachac.ir.properties import in_words
from smachac.ir.script_paths import name_in_script, role_in_words
from smachac.ir.secret_keys import SecretKeys
from smachac.ir.traversal import enclosing, remapping
from smachac.runtime.tracing.writer import SECRET
from smachac.targets.dot.edges import items

VERSION = 1
"""The version of the format; it increases with every change that a reader must know of."""

SNIPPET_LINES, SNIPPET_COLUMNS = 24, 160
"""The size of the part of the script that is kept for a state."""

_UNWRITTEN = frozenset(["implicit", "default", "caught"])
"""The kinds of edges that the script does not write: they are drawn dashed."""


def machine_model(
    machine: Machine, findings: Sequence[Diagnostic] = (), *, live: bool = False
) -> dict[str, Any]:
    """A machine, which may have errors, as JSON data.

    `live`: the page connects to the server that it comes from.
    """
    context = Context(machine)
    around = enclosing(machine.root)
    shown = context.script_paths
    hidden = [flow.span for flow in secret_values(context.types, context.secret_keys)]
    by_node: dict[str, list[int]] = {}
    for index, item in enumerate(findings):
        if item.finding.node is not None:
            by_node.setdefault(item.finding.node, []).append(index)
    return {
        "version": VERSION,
        "name": machine.root.name,
        "source": _file(machine.source),
        "digest": machine.digest,
        "root": machine.root.name,
        "live": live,
        "nodes": [
            _node(path, node, around, context, shown, by_node.get(path, []), hidden)
            | ({"unknown": machine.unknown[path]} if path in machine.unknown else {})
            for path, node in context.states
        ],
        "edges": [edge for path, node in context.containers for edge in edges_of(path, node)],
        "findings": [finding_data(item) for item in findings],
        "properties": [
            {
                "name": each.property.name,
                "text": in_words(each.property.form),
                "verdict": each.verdict,
                "states": list(each.states),
            }
            for each in (context.judgements if machine.properties else ())
        ],
    }


def _node(
    path: str,
    node: Node,
    around: Mapping[str, tuple[str, Container]],
    context: Context,
    shown: Mapping[str, str],
    found: list[int],
    hidden: Sequence[Span],
) -> dict[str, Any]:
    file, line = place_in_script(node.span)
    children = () if isinstance(node, Leaf) else node.children
    good = successes(node)
    data: dict[str, Any] = {
        "path": path,
        "name": name_in_script(node),
        "kind": "leaf" if isinstance(node, Leaf) else node.keyword,
        "parent": around[path][0] if path in around else None,
        "children": [f"{path}/{child.name}" for child in children],
        "initial": _initial(path, node),
        "type": node.type or None,
        "role": role_in_words(node) or None,
        "doc": node.doc,
        "file": file,
        "line": line,
        "snippet": snippet(node.span, hidden),
        "outcomes": [
            {
                "name": each.name,
                "failure": fails(node, each.name),
                "success": each.name in good,
                "doc": each.doc,
            }
            for each in node.outcomes
        ],
        "inputs": _keys(path, node, node.inputs, context.types.inputs, context.secret_keys),
        "outputs": _keys(path, node, node.outputs, context.types.outputs, context.secret_keys),
        "findings": found,
        "tags": list(node.tags),
    }
    if path in shown:
        data["shown"] = shown[path]
    return data | _of_container(path, node, context)


def _initial(path: str, node: Node) -> str | None:
    if not isinstance(node, nodes.StateMachine | nodes.Sequence) or not node.initial:
        return None
    return f"{path}/{node.initial}"


def _keys(
    path: str,
    node: Node,
    keys: Sequence[Key],
    types: Mapping[tuple[str, str], Any],
    secret: SecretKeys,
) -> list[dict[str, Any]]:
    """Keys of a state: `key` is the key of the container around it that each refers to."""
    names = remapping(node)
    return [
        {
            "name": key.name,
            "key": names[key.name],
            "type": str(types.get((path, key.name), key.type)),
            "doc": key.doc,
            **({"secret": True} if key.name in secret.get(path, ()) else {}),
        }
        for key in keys
    ]


def _of_container(path: str, node: Node, context: Context) -> dict[str, Any]:
    """The fields that only containers have."""
    if isinstance(node, Leaf):
        return {}
    data: dict[str, Any] = {
        "userdata": [
            {
                "key": preset.key,
                "type": str(context.types.keys.get((path, preset.key), preset.type)),
                "value": SECRET
                if preset.key in context.secret_keys.get(path, ())
                else " ".join(preset.value.span.text.split())[:SNIPPET_COLUMNS],
            }
            for preset in node.userdata
        ]
    }
    return data | form_of(path, node)


def form_of(path: str, container: Container) -> dict[str, Any]:
    """The fields that only a kind of container has: how it starts its states, and how it ends."""
    match container:
        case Concurrence():
            return {
                "join": container.join,
                "default": container.default_outcome or None,
                "rules": [
                    {
                        "outcome": rule.outcome,
                        "when": [[f"{path}/{each.child}", each.outcome] for each in rule.when],
                    }
                    for rule in container.rules
                ],
            }
        case nodes.Iterator() if not container.sugar:
            return {"items": f"{container.item_key} {items(container)}"}
    return {}


def edges_of(path: str, container: Container) -> Iterator[dict[str, Any]]:
    """The edges inside a container. `source` is null for the edge from its start, `target` is a
    state, or an outcome of the container."""
    by_name = {child.name: child for child in container.children}
    found = list(graph.edges(container))
    if container.catches:
        found.append(Edge(START, graph.exit_vertex(container.catches), "", "caught"))
    for edge in found:
        source = by_name.get(edge.source) if isinstance(edge.source, str) else None
        target = edge.target
        yield {
            "container": path,
            "source": f"{path}/{edge.source}" if isinstance(edge.source, str) else None,
            "outcome": edge.outcome,
            "target": f"{path}/{target}" if isinstance(target, str) else {"outcome": target[1]},
            "kind": edge.kind,
            "implicit": edge.kind in _UNWRITTEN,
            "failure": fails(source, edge.outcome) if source else edge.kind == "caught",
        }


def finding_data(item: Diagnostic) -> dict[str, Any]:
    file, line = place_in_script(item.span)
    return {
        "code": item.code,
        "severity": item.severity.value,
        "message": item.message,
        "help": item.help,
        "file": file,
        "line": line,
        "node": item.finding.node,
        "related": [
            dict(
                zip(("file", "line"), place_in_script(each.span), strict=True), message=each.message
            )
            for each in item.related
        ],
    }


def _file(name: str) -> str:
    """A file without its folder, which differs between computers."""
    return PurePath(name.replace("\\", "/")).name


def place_in_script(span: Span) -> tuple[str | None, int | None]:
    """The file of a span, without its folder, and its line, from 1."""
    if span.source is NOWHERE.source:
        return None, None
    return _file(span.source.name), span.line


def snippet(span: Span, hidden: Sequence[Span] = ()) -> str:
    """The lines of the script that describe a state: those of its span, and those indented deeper
    than its first one. Values of secret keys (`hidden`) are not shown."""
    if span.source is NOWHERE.source:
        return ""
    first, last = span.line, span.source.position(span.end)[0]
    start = _indentation(span.source, first)
    shown = _without(span.source, hidden)
    lines = [shown(first)]
    number = first + 1
    while number <= len(span.source.line_starts) and len(lines) <= SNIPPET_LINES:
        text = span.source.line(number)
        if number > last and text.strip() and _indentation(span.source, number) <= start:
            break
        lines.append(shown(number))
        number += 1
    while not lines[-1].strip() and len(lines) > 1:
        lines.pop()
    kept = [line[start : start + SNIPPET_COLUMNS] for line in lines[:SNIPPET_LINES]]
    return "\n".join([*kept, "…"] if len(lines) > SNIPPET_LINES else kept)


def _without(source: Source, hidden: Sequence[Span]) -> Callable[[int], str]:
    """The lines of a file by number, with `SECRET` in place of the hidden parts."""
    parts = [each for each in hidden if each.source is source]

    def shown(number: int) -> str:
        text, begin = source.line(number), source.line_starts[number - 1]
        for each in sorted(parts, key=lambda part: -part.start):
            indented = len(text) - len(text.lstrip(" "))
            start, end = max(each.start - begin, indented), min(each.end - begin, len(text))
            if start < end:
                text = text[:start] + SECRET + text[end:]
        return text

    return shown


def _indentation(source: Source, number: int) -> int:
    text = source.line(number)
    return len(text) - len(text.lstrip(" "))
