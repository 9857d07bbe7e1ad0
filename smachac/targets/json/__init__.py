"""JSON: the state graph for other programs, in the format of grammars/machine.schema.json."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.nodes import Checked, Expression, Machine, Node, Struct, Value
from smachac.ir.script_paths import script_paths
from smachac.ir.traversal import walk
from smachac.ir.types import Type
from smachac.targets import BuildContext, Files, Target, made_by, stem

VERSION = 2
"""The version of the format; it increases with every change of the schema."""


_NOT_IN_THE_GRAPH = frozenset(
    ["class_facts", "given", "written", "role", "limits", "built_in", "stand_in", "any_key",
     "adds_frames", "tags", "failure", "ignored", "item_span", "exhausted_span", "loop_spans",
     "final_spans", "frame", "secret", "to_span", "misplaced_keys", "takes_userdata", "synthetic",
     "autonomy"]
)  # fmt: skip
"""Fields for rules and templates, which are not part of the state graph."""


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One JSON file, named after the machine. It is ASCII, and equal machines give equal bytes."""
    return {f"{stem(machine)}.json": json.dumps(to_json(machine), indent=2) + "\n"}


def to_json(machine: Machine) -> dict[str, Any]:
    """A machine as JSON data: its states in a flat list, parents before children.

    The list is flat, so that deep nesting is no problem for a reader.
    """
    shown = script_paths(machine.root)
    return {
        "made_by": made_by(machine),
        "version": VERSION,
        "source": machine.source,
        "digest": machine.digest,
        "base": machine.base,
        "variables": _plain(machine.variables),
        "states": [_node(path, node, shown) for path, node in walk(machine.root)],
    }


def _node(path: str, node: Node, shown: Mapping[str, str]) -> dict[str, Any]:
    """A node; `script_path` is the path that the script shows, where it is another one."""
    data = {"kind": type(node).__name__, "path": path}
    script_path = {"script_path": shown[path]} if path in shown else {}
    return {**data, **script_path, **dict(_entries(node))}


def _entries(value: Any) -> Iterator[tuple[str, Any]]:
    """The fields of a value of the IR; spans are places, children are names."""
    for field in fields(value):
        if field.name in _NOT_IN_THE_GRAPH:
            continue
        content = getattr(value, field.name)
        if isinstance(content, Span):
            yield field.name.replace("span", "place"), _place(content)
        elif field.name == "children":
            yield field.name, [child.name for child in content]
        else:
            yield field.name, _plain(content)


def _plain(value: Any) -> Any:
    """JSON for anything that the IR is made of, nodes excepted."""
    match value:
        case Span():
            return _place(value)
        case Type():
            return str(value)
        case Expression():
            return {"expression": value.text}
        case Struct():
            return {"struct": [[key, _plain(entry)] for key, entry in value.entries]}
        case Value():
            return _plain(value.data)
        case float() if not math.isfinite(value):
            return {"float": str(value)}
        case tuple():
            return [_plain(item) for item in value]
    return dict(_entries(value)) if is_dataclass(value) else value


def _place(span: Span) -> str | None:
    """`file:line:column`, without the folder, which differs between computers."""
    if span.source is NOWHERE.source:
        return None
    line, column = span.source.position(span.start)
    file = span.source.name.replace("\\", "/").rsplit("/", 1)[-1]
    return f"{file}:{line}:{column}"


TARGET = Target(name="json", description="the state graph as JSON, for other programs", emit=emit)
