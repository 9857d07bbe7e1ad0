"""The model of the viewer: a machine as JSON data, with its findings and properties.

The states are those of the script, each with its badges (`ir.written`).
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
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Key, Leaf, Machine
from smachac.ir.outcome_names import fails, successes
from smachac.ir.properties import in_words
from smachac.ir.secret_keys import SecretKeys
from smachac.ir.traversal import remapping
from smachac.ir.written import (
    Badge,
    Written,
    WrittenEdge,
    WrittenState,
    items_in_words,
    written,
)
from smachac.runtime.tracing.writer import SECRET

VERSION = 2
"""The version of the format; it increases with every change that a reader must know of."""

SNIPPET_LINES, SNIPPET_COLUMNS = 24, 160
"""The size of the part of the script that is kept for a state."""

_UNWRITTEN = frozenset(["implicit", "default", "caught"])
"""The kinds of edges that the script does not write: they are drawn dashed."""


def machine_model(
    machine: Machine,
    findings: Sequence[Diagnostic] = (),
    *,
    live: bool = False,
    view: Written | None = None,
) -> dict[str, Any]:
    """A machine, which may have errors, as JSON data: as it was written, or the states of another
    `view` of it.

    `live`: the page connects to the server that it comes from.
    """
    context = Context(machine)
    view = written(machine) if view is None else view
    hidden = [flow.span for flow in secret_values(context.types, context.secret_keys)]
    by_state: dict[str, list[int]] = {}
    for index, item in enumerate(findings):
        if (place := item.finding.node) is not None:
            by_state.setdefault(_place(view, place), []).append(index)
    unknown = {view.state(path): reason for path, reason in machine.unknown.items()}
    return {
        "version": VERSION,
        "name": machine.root.name,
        "source": _file(machine.source),
        "digest": machine.digest,
        "root": machine.root.name,
        "live": live,
        "nodes": [
            _node(state, context, by_state.get(path, []), hidden)
            | ({"unknown": unknown[path]} if path in unknown else {})
            for path, state in view.states.items()
        ],
        "edges": [edge for state in view.states.values() for edge in edges_of(state, view.states)],
        "findings": [finding_data(item, view) for item in findings],
        "properties": [
            {
                "name": judgement.property.name,
                "text": in_words(judgement.property.form),
                "verdict": judgement.verdict,
                "states": list(dict.fromkeys(map(view.state, judgement.states))),
            }
            for judgement in (context.judgements if machine.properties else ())
        ],
    }


def _place(view: Written, path: str) -> str:
    """The state of a finding, whose path is that in the script."""
    return path if path in view.states else view.state(path)


def _node(
    state: WrittenState, context: Context, found: list[int], hidden: Sequence[Span]
) -> dict[str, Any]:
    node, outer = state.node, state.outer
    file, line = place_in_script(node.span)
    good = successes(outer)
    data: dict[str, Any] = {
        "path": state.path,
        "name": state.name,
        "kind": "leaf" if isinstance(node, Leaf) else node.keyword,
        "parent": state.parent,
        "children": list(state.children),
        "initial": _initial(state),
        "type": node.type or None,
        "badges": [badge_data(badge) for badge in state.badges],
        "doc": outer.doc,
        "file": file,
        "line": line,
        "snippet": snippet(node.span, hidden),
        "outcomes": [
            {
                "name": outcome.name,
                "failure": fails(outer, outcome.name),
                "success": outcome.name in good,
                "doc": outcome.doc,
                **({"field": field} if (field := state.field_of(outcome.name)) else {}),
            }
            for outcome in outer.outcomes
        ],
        "inputs": _keys(state, node.inputs, context.types.inputs, context.secret_keys),
        "outputs": _keys(state, node.outputs, context.types.outputs, context.secret_keys),
        "findings": found,
        "tags": list(node.tags),
    }
    if state.parts[0].shown != state.path:
        data["parts"] = [[part.shown, part.role, part.begins, part.full] for part in state.parts]
    if state.repeated:
        data["repeated"] = [{"name": name, "failure": fails(node, name)} for name in state.repeated]
    return data | _of_container(state, context)


def badge_data(badge: Badge) -> dict[str, Any]:
    """A badge: its field, its words, the outcome that it adds, and the outcomes after which the
    next of `count` tries or items begins."""
    return {
        "field": badge.field,
        "text": badge.text,
        "outcome": badge.outcome or None,
        "again": list(badge.again),
        "count": badge.number,
    }


def _initial(state: WrittenState) -> str | None:
    node = state.node
    if not isinstance(node, nodes.StateMachine | nodes.Sequence) or not node.initial:
        return None
    return f"{state.path}/{node.initial}"


def _keys(
    state: WrittenState,
    keys: Sequence[Key],
    types: Mapping[tuple[str, str], Any],
    secret: SecretKeys,
) -> list[dict[str, Any]]:
    """Keys of a state: `key` is the key of the container around it that each refers to."""
    names = remapping(state.outer)
    return [
        {
            "name": key.name,
            "key": names[key.name],
            "type": str(types.get((state.full, key.name), key.type)),
            "doc": key.doc,
            **({"secret": True} if key.name in secret.get(state.full, ()) else {}),
        }
        for key in keys
    ]


def _of_container(state: WrittenState, context: Context) -> dict[str, Any]:
    """The fields that only containers have."""
    node = state.node
    if isinstance(node, Leaf):
        return {}
    data: dict[str, Any] = {
        "userdata": [
            {
                "key": preset.key,
                "type": str(context.types.keys.get((state.full, preset.key), preset.type)),
                "value": SECRET
                if preset.key in context.secret_keys.get(state.full, ())
                else " ".join(preset.value.span.text.split())[:SNIPPET_COLUMNS],
            }
            for preset in node.userdata
        ]
    }
    return data | form_of(state.path, node)


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
                        "when": [
                            [f"{path}/{condition.child}", condition.outcome]
                            for condition in rule.when
                        ],
                    }
                    for rule in container.rules
                ],
            }
        case nodes.Iterator():
            return {"items": f"{container.item_key} {items_in_words(container)}"}
    return {}


def edges_of(state: WrittenState, states: Mapping[str, WrittenState]) -> Iterator[dict[str, Any]]:
    """The edges inside one of `states`. `source` is null for the edge from its start, `target` is a
    state, or an outcome of the container."""
    found = list(state.edges())
    if not isinstance(state.node, Leaf) and (caught := state.catches):
        found.append(WrittenEdge(state.path, None, "", caught, True, "caught"))
    for edge in found:
        source = states.get(edge.source) if edge.source is not None else None
        yield {
            "container": edge.container,
            "source": edge.source,
            "outcome": edge.outcome,
            "target": {"outcome": edge.target} if edge.leaves else edge.target,
            "kind": edge.kind,
            "implicit": edge.kind in _UNWRITTEN,
            "failure": fails(source.outer, edge.outcome) if source else edge.kind == "caught",
        }


def finding_data(item: Diagnostic, view: Written | None = None) -> dict[str, Any]:
    """A finding; its state is a state of the view."""
    place = item.finding.node
    file, line = place_in_script(item.span)
    return {
        "code": item.code,
        "severity": item.severity.value,
        "message": item.message,
        "help": item.help,
        "file": file,
        "line": line,
        "node": place if view is None or place is None else _place(view, place),
        "related": [
            dict(
                zip(("file", "line"), place_in_script(related.span), strict=True),
                message=related.message,
            )
            for related in item.related
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
    parts = [span for span in hidden if span.source is source]

    def shown(number: int) -> str:
        text, begin = source.line(number), source.line_starts[number - 1]
        for part in sorted(parts, key=lambda part: -part.start):
            indented = len(text) - len(text.lstrip(" "))
            start, end = max(part.start - begin, indented), min(part.end - begin, len(text))
            if start < end:
                text = text[:start] + SECRET + text[end:]
        return text

    return shown


def _indentation(source: Source, number: int) -> int:
    text = source.line(number)
    return len(text) - len(text.lstrip(" "))
