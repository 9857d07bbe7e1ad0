"""Printer of the textual IR (.smir): stable, complete and readable. The notation is
grammars/ir.lark.

All fields are printed except spans and `via`; fields with their default value are left out.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import Field, fields
from typing import Any, Protocol, get_args

from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.nodes import (
    Container,
    Data,
    Expression,
    Key,
    Leaf,
    Machine,
    Node,
    OutcomeRule,
    Preset,
    Struct,
    Transition,
    Value,
    Variable,
)
from smachac.ir.parser import IrSyntaxError, parse_machine
from smachac.ir.types import ANY, Type

__all__ = ["IrSyntaxError", "parse_machine", "print_data", "print_machine"]

HEADER = "# A state graph of smachac, format 1: one statement a line, as in grammars/ir.lark."

_NAME = re.compile(r"[^\W\d]\w*")
_PLAIN_TYPE = re.compile(r'[^\s"={}#][^\n"={}#]*')
_PLAIN_CODE = re.compile(r"[^`\n\r\ud800-\udfff]*")
_SURROGATE = re.compile(r"[\ud800-\udfff]")
_encode = json.JSONEncoder(ensure_ascii=False).encode

MOST_BITS = 10_000
"""Integers with more bits are printed in hexadecimal; Python limits the length of decimal ones."""


KEYWORDS: Mapping[str, str] = {
    "connector_outcome": "connector",
    "default_outcome": "default",
    "rules": "rule",
    "items_key": "items from",
    "item_key": "item",
    "exhausted_outcome": "exhausted",
    "loop_outcomes": "loop",
    "final_map": "final",
}
"""The keywords of the fields of containers; any other field is its own keyword."""

OWN_FIELDS: Mapping[type[Container], tuple[Field[Any], ...]] = {
    kind: tuple(
        sorted(
            (
                field
                for field in fields(kind)
                if field.compare and field not in fields(kind.__base__)
            ),
            key=lambda field: isinstance(field.default, tuple),
        )
    )
    for kind in get_args(Container)
}
"""The fields that only containers of one kind have, those with several values last."""


class KeyTypes(Protocol):
    """The inferred types of keys by node path and key name (analysis/type_inference.py)."""

    @property
    def keys(self) -> Mapping[tuple[str, str], Type]: ...
    @property
    def inputs(self) -> Mapping[tuple[str, str], Type]: ...
    @property
    def outputs(self) -> Mapping[tuple[str, str], Type]: ...


def print_machine(machine: Machine, types: KeyTypes | None = None) -> str:
    """The text of a machine, for people and for `parse_machine`, ending in a line feed.

    Inferred types in `types` that no statement contains are printed as comments. Iterative, so that
    deep nesting needs no recursion.
    """
    inferred = _inferred(types) if types is not None else {}
    lines = [HEADER, *_preamble(machine)]
    todo: list[tuple[Node | None, str, int]] = [(machine.root, machine.root.name, 0)]
    while todo:
        node, path, depth = todo.pop()
        margin = "  " * depth
        if node is None:
            lines.append(f"{margin}}}")
            continue
        head = f"{node.keyword} {_name(node.name)}: {_name(node.type)} {{"
        body = [*_statements(node), *_comments(node, inferred.get(path, ()))]
        children = () if isinstance(node, Leaf) else node.children
        lines.append("")
        if not body and not children:
            lines.append(f"{margin}{head}}}")
            continue
        lines.append(margin + head)
        lines.extend(f"{margin}  {statement}" for statement in body)
        todo.append((None, path, depth))
        todo.extend((child, f"{path}/{child.name}", depth + 1) for child in reversed(children))
    return "\n".join(lines) + "\n"


def _inferred(types: KeyTypes) -> dict[str, list[tuple[str, str, Type]]]:
    """Inferred types by path: the keyword of the statement, the key, its type."""
    found: dict[str, list[tuple[str, str, Type]]] = {}
    maps = (("userdata", types.keys), ("input", types.inputs), ("output", types.outputs))
    for word, known in maps:
        for (path, key), type_ in known.items():
            found.setdefault(path, []).append((word, key, type_))
    return found


def _comments(node: Node, inferred: Iterable[tuple[str, str, Type]]) -> Iterator[str]:
    """Comments with the inferred types of keys that have no type in the statements of a node."""
    held = () if isinstance(node, Leaf) else node.userdata
    own = {*node.inputs, *node.outputs}
    said = {key.name for key in own if key.type != ANY} | {p.key for p in held if p.type != ANY}
    for word, key, type_ in inferred:
        if type_ != ANY and key not in said:
            yield f"# {word} {_name(key)}{_type(type_)}"


def _preamble(machine: Machine) -> Iterator[str]:
    if machine.source:
        yield f"script {_quote(machine.source)}"
    if machine.digest:
        yield f"digest {_quote(machine.digest)}"
    if machine.base != "Base":
        yield f"base {_name(machine.base)}"
    yield from map(_variable, machine.variables)


def _statements(node: Node) -> Iterator[str]:
    """The statements of one node, without its children, in the order of the notation."""
    if node.doc:
        yield f"doc {_quote(node.doc)}"
    yield from _outcomes(node.outcomes)
    for key in node.inputs:
        yield f"input {_key(key)}"
    for key in node.outputs:
        yield f"output {_key(key)}"
    if node.claims:
        yield f"claims {_names(node.claims)}"
    yield from _line("tags", _names(node.tags))
    yield from _optional("catches", node.catches)
    if isinstance(node, Leaf):
        yield from _leaf(node)
    else:
        yield from _line("sugar", node.sugar)
        yield from map(_preset, node.userdata)
        for field in OWN_FIELDS[type(node)]:
            value = getattr(node, field.name)
            if value != field.default:
                yield from _field(KEYWORDS.get(field.name, field.name), value)
    for remap in node.remaps:
        yield f"remap {_name(remap.key)} -> {_name(remap.to)}"
    yield from map(_transition, node.transitions)


def _outcomes(outcomes: tuple[nodes.Outcome, ...]) -> Iterator[str]:
    """One line for all outcomes, or a line for each if one has a doc."""
    if not any(outcome.doc for outcome in outcomes):
        names = _names(outcome.name for outcome in outcomes)
        yield from _line("outcomes", names)
        return
    for outcome in outcomes:
        yield f"outcomes {_name(outcome.name)}{_doc(outcome.doc)}"


def _leaf(leaf: Leaf) -> Iterator[str]:
    yield from ("open",) * leaf.open
    yield from ("blocking",) * leaf.blocking
    for outcome, keys in leaf.writes:
        yield f"writes {_name(outcome)}: {_names(keys)}"
    yield from map(_variable, leaf.variables)


def _field(keyword: str, value: Any) -> Iterator[str]:
    """The statements for a field of a container: a name, a flag, a value, names, rules, pairs."""
    match value:
        case True:
            yield keyword
        case str():
            yield f"{keyword} {_name(value)}"
        case Value():
            yield f"{keyword} {print_data(value.data)}"
        case (str(), *_):
            yield f"{keyword} {_names(value)}"
        case (OutcomeRule(), *_):
            yield from (f"{keyword} {_rule(item)}" for item in value)
        case _:
            yield from (f"{keyword} {_name(first)} -> {_name(last)}" for first, last in value)


def _line(word: str, rest: str) -> Iterator[str]:
    if rest:
        yield f"{word} {rest}"


def _optional(word: str, name: str) -> Iterator[str]:
    yield from _line(word, _name(name) if name else "")


def _key(key: Key) -> str:
    return f"{_name(key.name)}{_type(key.type)}{_doc(key.doc)}"


def _preset(preset: Preset) -> str:
    return f"userdata {_name(preset.key)}{_type(preset.type)} = {print_data(preset.value.data)}"


def _variable(variable: Variable) -> str:
    return (
        f"variable {_name(variable.name)}{_type(variable.type)} = {print_data(variable.value.data)}"
    )


def _transition(step: Transition) -> str:
    origin = "" if step.origin == "written" else f" ({step.origin})"
    return f"on {_name(step.outcome)} -> {_name(step.target)}{origin}"


def _rule(rule: OutcomeRule) -> str:
    conditions = ", ".join(
        f"{_name(condition.child)} = {_name(condition.outcome)}" for condition in rule.when
    )
    return f"{_name(rule.outcome)}{' when ' if conditions else ''}{conditions}"


def _type(type_: Type) -> str:
    if type_ == ANY:
        return ""
    text = str(type_)
    return f": {text if _PLAIN_TYPE.fullmatch(text) else _quote(text)}"


def _doc(doc: str) -> str:
    return f" {_quote(doc)}" if doc else ""


def _names(names: Iterable[str]) -> str:
    return ", ".join(map(_name, names))


def _name(name: str) -> str:
    return name if _NAME.fullmatch(name) else _quote(name)


def _quote(text: str) -> str:
    return json.dumps(text) if _SURROGATE.search(text) else _encode(text)


def print_data(data: Data) -> str:
    """A value on one line; expressions are in backticks."""
    match data:
        case float():
            return repr(data)
        case str():
            return _quote(data)
        case None:
            return "null"
        case bool():
            return "true" if data else "false"
        case int():
            return hex(data) if data.bit_length() > MOST_BITS else repr(data)
        case Expression(text=text):
            return f"`{text}`" if _PLAIN_CODE.fullmatch(text) else f"code {_quote(text)}"
        case Struct(entries=entries):
            pairs = (f"{_name(name)}: {print_data(item)}" for name, item in entries)
            return f"{{{', '.join(pairs)}}}"
        case tuple():
            return f"[{', '.join(map(print_data, data))}]"
    return assert_never(data)
