"""Descriptions of state types, as text, Markdown and JSON: fields, keys, outcomes."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from smachac.frontend import schema
from smachac.frontend.loader import Library
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import ContainerKind, StateType, VariableType
from smachac.ir.types import ANY, Type
from smachac.report.terminal import on_one_line

WIDTH = 90
"""Width of descriptions, in columns."""


class Known(NamedTuple):
    """A state type, its origin (a folder of the user, or `built-in`), and the languages of its
    code."""

    type: StateType
    place: str
    languages: tuple[str, ...] = ()


def container_type(name: ContainerKind) -> StateType:
    """A container as a state type; its variables are the fields of the schema."""
    names = schema.REQUIRED[name]
    own = [row for row in schema.VARIABLES.values() if name in row.owners]
    return StateType(
        name=name,
        kind="container",
        doc=schema.CONTAINER_DOCS[name],
        variables={
            row.name: VariableType(name=row.name, required=row.name in names)
            for row in own
            if row.name not in ("template", "transitions", "remapping", "doc")
        },
        given=frozenset(["outcomes", "input_keys", "output_keys"]),
    )


def usable_types(library: Library) -> Iterator[tuple[StateType, bool]]:
    """The state types that a script can name, by name, and whether they are of the user. A template
    without an interface is none if it is built-in, or if it makes no state: only other templates
    include it."""
    for name in sorted(library.template_names()):
        own = any(library.own_template(f"{name}{end}") for end in (".yml", ".tpl.py", ".tpl"))
        has_interface = library.template(f"{name}.yml") is not None
        type_ = find_state_type(name, library, []) if own or has_interface else None
        if type_ is not None and (has_interface or _makes_state(type_)):
            yield type_, own


def _makes_state(type_: StateType) -> bool:
    """Whether the template of a type without an interface prints a state, has its class, or extends
    one with an interface."""
    facts = type_.class_facts
    has_class = facts is not None and (facts.is_function or facts.execute is not None)
    return has_class or type_.prints_itself or not type_.open


def list_text(known: Sequence[Known]) -> str:
    """All types, one on each line, by origin and kind."""
    width = max((len(other.type.name) for other in known), default=0)
    lines: list[str] = []
    for title, some in _grouped(known):
        lines += ["", title] if lines else [title]
        lines += [
            f"  {on_one_line(known.type.name):<{width}}  {_first(known.type.doc)}".rstrip()
            for known in some
        ]
    return "\n".join([*lines, "", "smachac states NAME describes one of them."]) + "\n"


def _grouped(known: Sequence[Known]) -> Iterable[tuple[str, list[Known]]]:
    kinds = {"state": "state types", "container": "containers", "base": "bases"}
    for place in dict.fromkeys(other.place for other in known):
        for kind, word in kinds.items():
            some = [other for other in known if other.place == place and other.type.kind == kind]
            if some:
                yield f"{word} ({on_one_line(place)})", some


def _first(doc: str) -> str:
    """The first sentence of a text."""
    line = " ".join(doc.split())
    end = line.find(". ")
    return line[: end + 1] if end > 0 else line


def type_text(known: Known) -> str:
    """One type as text."""
    type_ = known.type
    lines = [f"{on_one_line(type_.name)}: a {type_.kind} ({on_one_line(known.place)})"]
    if type_.doc:
        lines += ["", *textwrap.wrap(type_.doc, WIDTH)]
    if type_.open:
        lines += ["", "It has no interface: only what its template shows is known."]
    for title, rows in _sections(type_):
        lines += ["", f"{title}:"]
        width = max(len(name) for name, _ in rows)
        for name, doc in rows:
            lines.append(f"  {name:<{width}}  {doc}".rstrip())
    facts = _facts(known)
    lines += ["", *facts] if facts else []
    return "\n".join(lines) + "\n"


def type_markdown(known: Known, level: int = 2) -> str:
    """One type as a section of Markdown."""
    type_ = known.type
    lines = [f"{'#' * level} {type_.name}", "", type_.doc or "No description.", ""]
    for title, rows in _sections(type_):
        lines += [f"| {title} | |", "| --- | --- |"]
        lines += [f"| `{_cell(name)}` | {_cell(doc)} |" for name, doc in rows]
        lines.append("")
    lines += [f"- {fact}" for fact in _facts(known)]
    return "\n".join(lines).rstrip("\n") + "\n"


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("\n", " ")


def _sections(type_: StateType) -> Iterable[tuple[str, list[tuple[str, str]]]]:
    variables = [(_variable(variable), variable.doc) for variable in type_.variables.values()]
    keys = {"input keys": type_.input_keys, "output keys": type_.output_keys}
    parts: dict[str, list[tuple[str, str]]] = {"variables": variables}
    for title, several in keys.items():
        parts[title] = [(_named(key.name, key.type), key.doc) for key in several]
    parts["outcomes"] = [(outcome.name, outcome.doc or _comes_with(type_, outcome.name))
                         for outcome in type_.outcomes]  # fmt: skip
    for title, rows in parts.items():
        if title.replace(" ", "_") in type_.given:
            rows = [*rows, ("...", "what the script lists")]
        if rows:
            yield title, rows


def _comes_with(type_: StateType, outcome: str) -> str:
    keys = dict(type_.writes).get(outcome, ())
    return f"with {', '.join(keys)}" if keys else ""


def _variable(variable: VariableType) -> str:
    text = _named(variable.name, variable.type)
    if variable.required:
        return f"{text} (required)"
    return f"{text} = {_default(variable)}" if variable.default is not None else text


def _default(variable: VariableType) -> str:
    assert variable.default is not None
    span = variable.default.span
    return " ".join(span.text.split()) or json.dumps(_data(variable))


def _data(variable: VariableType) -> Any:
    from smachac.interpreter.userdata import python_data, trace_value

    return trace_value(python_data(variable.default.data)) if variable.default else None


def _named(name: str, type_: Type) -> str:
    return name if type_ == ANY else f"{name}: {type_}"


def _facts(known: Known) -> list[str]:
    type_ = known.type
    facts: list[str] = []
    if type_.claims:
        facts.append(f"It claims {', '.join(type_.claims)} while it runs.")
    if type_.blocking:
        facts.append("It waits for the outside world.")
    if known.languages:
        facts.append(f"It has code for: {', '.join(known.languages)}.")
    return facts


def type_json(known: Known) -> dict[str, Any]:
    """One type as data for JSON."""
    type_ = known.type
    return {
        "name": type_.name,
        "kind": type_.kind,
        "place": known.place,
        "doc": type_.doc,
        "open": type_.open,
        "variables": [
            {
                "name": variable.name,
                "type": str(variable.type),
                "required": variable.required,
                "default": _data(variable),
                "doc": variable.doc,
            }
            for variable in type_.variables.values()
        ],
        "input_keys": [_key(key.name, key.type, key.doc) for key in type_.input_keys],
        "output_keys": [_key(key.name, key.type, key.doc) for key in type_.output_keys],
        "outcomes": [{"name": outcome.name, "doc": outcome.doc} for outcome in type_.outcomes],
        "writes": {outcome: list(keys) for outcome, keys in type_.writes},
        "given_by_script": sorted(type_.given),
        "claims": list(type_.claims),
        "blocking": type_.blocking,
        "languages": list(known.languages),
    }


def _key(name: str, type_: Type, doc: str) -> dict[str, str]:
    return {"name": name, "type": str(type_), "doc": doc}
