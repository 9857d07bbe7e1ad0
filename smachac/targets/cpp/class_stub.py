"""A class in C++ to begin with, for a state type: it fits the interface and does nothing yet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from smachac.frontend.loader import Library
from smachac.ir.nodes import Key, StateType
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.records import key_types, project_names
from smachac.targets.cpp.types import cpp_type
from smachac.targets.cpp.user_classes import (
    field_type,
    interface_hash,
    parameter_type,
    step_fields,
    step_parameter_type,
    stops,
)

Fields = Mapping[str, str]
"""Names in C++ with their types."""


def class_stub(
    type_: StateType,
    outcomes: Sequence[str],
    library: Library,
    *,
    namespace: str,
    comment: str,
    stepped: bool,
) -> str:
    """The header of a class for a state type (docs/cpp.md, docs/cpp_step.md). Raises
    UnportableError."""
    names = project_names(library, stepped=stepped)
    type_ = names.state_type(type_)
    runtime = "smachac/step.hpp" if stepped else "smachac/smachac.hpp"
    headers = sorted({runtime, *names.headers(key_types(type_))})
    parts = {
        part: _fields(part, keys, library if stepped else None)
        for part, keys in (("In", type_.input_keys), ("Out", type_.output_keys))
    }
    variables = {
        identifier(name): step_parameter_type(variable.type, library.bounds)
        if stepped
        else parameter_type(variable.type)
        for name, variable in type_.variables.items()
    }
    kept = {} if stepped else {
        identifier(name): cpp_type(variable.type) for name, variable in type_.variables.items()
    }  # fmt: skip
    lines = [
        f"// {comment}",
        "#pragma once",
        "",
        "#include <cstdint>",
        "",
        *(f'#include "{header}"' for header in headers),
        "",
        f"namespace {namespace} {{",
        "",
        f"class {type_.name} {{",
        "public:",
        f"  enum class Outcome {{ {', '.join(map(identifier, outcomes))} }};",
        *(f"  struct {part} {{ {_declared(found, '; ')}; }};" for part, found in parts.items()
          if found),
        "  // The number of the interface: when the interface changes, this no longer compiles.",
        f"  static constexpr std::uint32_t smachac_interface = {interface_hash(type_)};",
        "",
        *_constructor(type_.name, variables, kept),
        *(_step(type_, outcomes[0]) if stepped else _execute(type_, outcomes[0])),
        *(["", "private:"] if kept else []),
        *(f"  {text} {name}_;" for name, text in kept.items()),
        "};",
        "",
        f"}}  // namespace {namespace}",
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _fields(part: str, keys: Sequence[Key], stepped: Library | None) -> Fields:
    """The fields of `In` or `Out`; `stepped` has the bounds of a stepped machine."""
    if stepped is not None:
        return step_fields(part, keys, stepped.bounds)
    return {identifier(key.name): field_type(part, key.type) for key in keys}


def _declared(fields: Fields, between: str) -> str:
    """The declarations of names."""
    return between.join(
        f"{text}{name}" if text.endswith("&") else f"{text} {name}" for name, text in fields.items()
    )


def _constructor(name: str, variables: Fields, kept: Fields) -> Iterator[str]:
    """The constructor with the variables of the interface; nothing without any. A class of a
    stepped machine decides what it keeps, and with which bounds."""
    if not variables:
        return
    initial = ", ".join(f"{name}_({name})" for name in kept)
    body = "" if kept else "".join(f" (void){name};" for name in variables) + " "
    explicit = "explicit " if len(variables) == 1 else ""
    between = f" : {initial}" if kept else ""
    yield f"  {explicit}{name}({_declared(variables, ', ')}){between} {{{body}}}"
    yield ""


def _execute(type_: StateType, outcome: str) -> Iterator[str]:
    """The function of a blocking machine."""
    given = [
        *(["In in"] if type_.input_keys else []),
        *(["Out out"] if type_.output_keys else []),
        *(["smachac::Stop &stop"] if stops(type_) else []),
    ]
    yield f"  Outcome execute({', '.join(given)}) {{"
    for name in ("in",) * bool(type_.input_keys) + ("stop",) * stops(type_):
        yield f"    (void){name};"
    for key in type_.output_keys:
        yield f"    out.{identifier(key.name)} = {cpp_type(key.type)}{{}};"
    yield f"    return Outcome::{identifier(outcome)};"
    yield "  }"


def _step(type_: StateType, outcome: str) -> Iterator[str]:
    """The function of a stepped machine."""
    given = {
        "context": "smachac::step::Context &context",
        **({"in": "In in"} if type_.input_keys else {}),
        **({"out": "Out out"} if type_.output_keys else {}),
    }
    yield f"  smachac::step::Result<Outcome> step({', '.join(given.values())}) {{"
    for name in given:
        yield f"    (void){name};"
    for key in type_.output_keys:
        yield f"    // out.{identifier(key.name)} = ...;"
    yield f"    return Outcome::{identifier(outcome)};"
    yield "  }"
