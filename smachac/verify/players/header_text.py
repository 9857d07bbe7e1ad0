"""The parts of a generated C++ header: its namespaces, enumerations, states and their code.

This is not a parser of C++. It reads the form that the C++ target prints, with changes by hand
inside that form.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import Source
from smachac.records import dataclass, field
from smachac.targets.cpp.cpp_text import without_literals

_TOKEN = re.compile(
    r"\bnamespace\s+(?P<space>[\w:]+)\s*\{"
    r"|\benum\s+(?:class|struct)\s+(?P<enum>\w+)[^;{}]{0,200}\{(?P<values>[^{}]*)\}"
    r"|\b(?:class|struct)\s+(?P<struct>\w+)\b[^;(){}=]{0,200}\{"
    r"|\bexecute\s*\((?P<parameters>[^(){}]*)\)[^;(){}]{0,200}(?P<body>\{)"
    r"|(?P<case>\bcase\s+)?\bState::(?P<state>\w+)"
    r"|\b(?P<run>\w+)\.enter\s*\([^(){};]*\)\s*(?P<entered>;)"
    r"|(?P<brace>[{}])"
)
_STOP = re.compile(r"\bStop\s*&\s*(\w+)")

TYPES = "types"
"""The namespace, in that of a container, with the structs of built-in states."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Execute:
    """The function `execute` of a struct: the offset after its opening brace, and the name of its
    parameter for requests to stop, if it has one."""

    start: int
    stop: str


@dataclass(slots=True, kw_only=True)
class Scope:
    """A namespace or a struct: its line, the values of its enumerations, the lines of the states
    that its code names, the offsets after the calls that start a state, with the name of the run,
    and its function `execute`."""

    line: int
    enums: dict[str, tuple[str, ...]] = field(default_factory=dict)
    states: dict[str, int] = field(default_factory=dict)
    starts: list[tuple[int, str]] = field(default_factory=list)
    execute: Execute | None = None


def scopes(source: Source) -> dict[str, Scope]:
    """The namespaces and structs of a header by their qualified names."""
    text = without_literals(source.text)
    found: dict[str, Scope] = {}
    cases: set[tuple[str, str]] = set()
    open_: list[str] = []  # the name of the scope of each brace that is open

    def scope(name: str, at: int) -> Scope:
        return found.setdefault(name, Scope(line=source.position(at)[0]))

    for token in _TOKEN.finditer(text):
        around = open_[-1] if open_ else ""
        if name := token["space"] or token["struct"]:
            open_.append(f"{around}::{name}" if around else name)
            scope(open_[-1], token.start())
        elif token["enum"]:
            values = tuple(_names(token["values"]))
            scope(around, token.start()).enums.setdefault(token["enum"], values)
        elif token["body"]:
            stop = _STOP.search(token["parameters"])
            execute = Execute(start=token.end(), stop=stop[1] if stop is not None else "")
            scope(around, token.start()).execute = execute
            open_.append(around)
        elif name := token["state"]:
            states = scope(around, token.start()).states
            is_first_case = bool(token["case"]) and (around, name) not in cases
            if is_first_case or name not in states:
                states[name] = source.position(token.start())[0]
            if is_first_case:
                cases.add((around, name))
        elif token["entered"]:
            scope(around, token.start()).starts.append((token.end(), token["run"]))
        elif token["brace"] == "{":
            open_.append(around)
        elif open_:
            open_.pop()
    return found


def _names(values: str) -> Iterator[str]:
    """The names of an enumeration."""
    for value in values.split(","):
        name = value.partition("=")[0].strip()
        if name:
            yield name
