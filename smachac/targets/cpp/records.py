"""Structs for records: a record that `types` names is a struct in C++, or a class of the user.

A record `{name: str, at: Pose?}` of the script is the type `struct` here: its class in C++, then
its fields. A field that may be absent is a `std::optional`; C++ does not tell an absent field from
null. A type of messages such as `geometry_msgs/Pose` is the type `class` if `cpp_types` names one.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Iterator, Mapping
from collections.abc import Set as AbstractSet
from typing import NamedTuple

from smachac.frontend.loader import Library
from smachac.ir.nodes import Key, Machine, StateType
from smachac.ir.types import ANY, Bounds, CppClass, Type, parse_type
from smachac.records import dataclass, field, replace
from smachac.targets.cpp.bounded import bounded
from smachac.targets.cpp.identifiers import identifier, member_identifier, outermost
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_type, fields_of, plain

PROJECT, STEPPED_PROJECT = "smachac::types", "smachac::step::types"
"""The namespaces of the structs for the types of the project file."""

PROJECT_HEADER, STEPPED_PROJECT_HEADER = "smachac/types.hpp", "smachac/step_types.hpp"


class NamedRecord(NamedTuple):
    """A record with its name. `own` is the class of the user for it."""

    name: str
    type: Type
    own: CppClass | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordNames:
    """The records that have names: those of the project file, and those of the script alone, whose
    structs are in the namespace `inner`. `classes` are classes of the user for types of messages,
    `opaque` types whose values are a `std::any`. `stepped`: texts and lists in records have bounds.
    """

    project: tuple[NamedRecord, ...] = ()
    script: tuple[NamedRecord, ...] = ()
    inner: str = ""
    classes: Mapping[str, CppClass] = field(default_factory=dict)
    opaque: AbstractSet[str] = frozenset()
    stepped: bool = False

    @property
    def outer(self) -> str:
        """The namespace of the structs for the types of the project file."""
        return STEPPED_PROJECT if self.stepped else PROJECT

    @property
    def header(self) -> str:
        """The header with these structs."""
        return STEPPED_PROJECT_HEADER if self.stepped else PROJECT_HEADER

    def class_of(self, record: Type) -> str:
        """The class for a record. Raises UnportableError without a name for it."""
        for names, space in ((self.project, self.outer), (self.script, self.inner)):
            for name, type_, own in names:
                if type_ == record:
                    return f"::{own.name}" if own is not None else f"{space}::{identifier(name)}"
        where = "`types:`" if self.inner else "`[types]` of smachac.toml"
        help_ = f"write `Part: {record}` under {where}, with a name of yours, and use the name"
        raise UnportableError(f"C++ needs a name for the record `{record}`", help=help_)

    def with_structs(self, type_: Type) -> Type:
        """A type with structs in place of records. Raises UnportableError."""
        if type_.name in self.classes and not type_.args:
            return Type("class", (f"::{self.classes[type_.name].name}",))
        if type_.name in self.opaque and not type_.args:
            return ANY
        args = [self.with_structs(arg) if isinstance(arg, Type) else arg for arg in type_.args]
        if type_.name != "record":
            return Type(type_.name, (*args,))
        return Type("struct", (self.class_of(type_), *args))

    def headers(self, types: Iterable[Type]) -> list[str]:
        """The headers with the classes in types with structs, sorted."""
        own = {f"::{own.name}": own.header for _, _, own in self.project if own is not None}
        own |= {f"::{class_.name}": class_.header for class_ in self.classes.values()}
        script = {self.class_of(type_) for _, type_, class_ in self.script if class_ is None}
        own |= {f"::{own.name}": own.header for _, _, own in self.script if own is not None}
        used = {name for type_ in types for name in _classes(type_)} - script
        return sorted({own.get(name, self.header) for name in used})

    def state_type(self, type_: StateType) -> StateType:
        """A state type with structs in place of records. Raises UnportableError."""
        # A header of the user can include the types of the project, but not those of a script.
        names = replace(self, script=(), inner="")

        def keys(keys: Iterable[Key]) -> tuple[Key, ...]:
            return tuple(replace(key, type=names.with_structs(key.type)) for key in keys)

        return replace(
            type_,
            input_keys=keys(type_.input_keys),
            output_keys=keys(type_.output_keys),
            variables={
                name: replace(variable, type=names.with_structs(variable.type))
                for name, variable in type_.variables.items()
            },
        )


def key_types(type_: StateType) -> list[Type]:
    """The types of the keys and variables of a state type."""
    found = [key.type for key in (*type_.input_keys, *type_.output_keys)]
    return [*found, *(variable.type for variable in type_.variables.values())]


def _classes(type_: Type) -> Iterator[str]:
    """The classes of the structs and of the messages in a type."""
    if type_.name in ("struct", "class"):
        yield str(type_.args[0])
    for arg in type_.args:
        if isinstance(arg, Type):
            yield from _classes(arg)


def project_names(library: Library, *, stepped: bool = False) -> RecordNames:
    """The names of records in the project file: those of the interfaces of all machines."""
    classes = library.cpp_types
    return RecordNames(
        project=_named(library.types.items(), classes),
        classes={name: class_ for name, class_ in classes.items() if "/" in name or "." in name},
        stepped=stepped,
    )


def record_names(machine: Machine, library: Library, *, stepped: bool = False) -> RecordNames:
    """The names of records for a machine."""
    outer = library.types
    own = ((name, text) for name, text in machine.aliases.items() if outer.get(name) != text)
    return replace(
        project_names(library, stepped=stepped),
        script=_named(own, library.cpp_types),
        inner=f"{outermost(machine.root.name)}_types",
    )


def scripted_names(machine: Machine, library: Library | None, *, stepped: bool) -> RecordNames:
    """The names of records for a program without the classes of the user, whose states perform test
    cases: all of them count as names of the project file, and a value of a class is a `std::any`.
    """
    classes = library.cpp_types if library is not None else {}
    return RecordNames(
        project=_named(machine.aliases.items(), {}), opaque=frozenset(classes), stepped=stepped
    )


def _named(
    types: Iterable[tuple[str, str]], classes: Mapping[str, CppClass]
) -> tuple[NamedRecord, ...]:
    """The records among types with names."""
    parsed = ((name, parse_type(text)) for name, text in types)
    return tuple(
        NamedRecord(name, type_, classes.get(name))
        for name, type_ in parsed
        if type_ is not None and type_.name == "record"
    )


def project_header(names: RecordNames, bounds: Bounds | None, made_by: str) -> str:
    """The header with the structs for the types of the project file."""
    runtime = "smachac/step_values.hpp" if names.stepped else "smachac/values.hpp"
    types = [type_ for _, type_ in _stored(names, names.project, bounds)]
    headers = [runtime, *(header for header in names.headers(types) if header != names.header)]
    included = "\n".join(f'#include "{header}"' for header in headers)
    blocks = project_structs(names, bounds)
    return "\n\n".join([f"// {made_by}\n#pragma once", included, *blocks]) + "\n"


def project_structs(names: RecordNames, bounds: Bounds | None) -> list[str]:
    """The structs for the types of the project file. A type that C++ cannot have is left out: the
    keys of this type are refused."""
    return [*_structs(names, names.project, names.outer, bounds)]


def script_structs(
    names: RecordNames, bounds: Bounds | None, types: Iterable[Type] = ()
) -> list[str]:
    """The structs for the types of the script alone. Classes of the user for messages in `types`
    get a mark: smachac does not know their members."""
    used = {name for type_ in types for name in _classes(type_)}
    opaque = [
        _once([f"template <> struct smachac::Opaque<{class_}> : std::true_type {{}};"])
        for class_ in sorted({f"::{class_.name}" for class_ in names.classes.values()} & used)
    ]
    return [*opaque, *_structs(names, names.script, names.inner, bounds)]


def _stored(
    names: RecordNames, records: Iterable[NamedRecord], bounds: Bounds | None
) -> Iterator[tuple[NamedRecord, Type]]:
    """The records that C++ can have, with the types of their structs."""
    for record in records:
        try:
            type_ = names.with_structs(record.type)
            stored = plain(type_) if bounds is None else bounded(type_, bounds)
            cpp_fields = [cpp_type(part) for part in fields_of(stored).values()]
        except UnportableError:
            continue
        if cpp_fields:
            yield record, stored


def _structs(
    names: RecordNames, records: Iterable[NamedRecord], space: str, bounds: Bounds | None
) -> Iterator[str]:
    """The structs of records, and what smachac has to know of their members."""
    for record, stored in _stored(names, records, bounds):
        fields = {name: cpp_type(part) for name, part in fields_of(stored).items()}
        if record.own is None:
            yield _struct(identifier(record.name), fields, space)
        else:
            yield "\n".join(_assertions(record.own.name, fields))
        yield _fields(names.class_of(record.type), fields)


def _struct(name: str, fields: Mapping[str, str], space: str) -> str:
    """The definition of a struct."""
    lines = [
        f"namespace {space} {{",
        f"struct {name} {{",
        *(f"  {type_} {member_identifier(field)}{{}};" for field, type_ in fields.items()),
        "};",
        f"}} // namespace {space}",
    ]
    return _once(lines)


def _fields(class_: str, fields: Mapping[str, str]) -> str:
    """The names and members of a class, for equality and for traces: sorted by name."""
    names = sorted(fields)
    members = ", ".join(f"value.{member_identifier(name)}" for name in names)
    lines = [
        f"template <> struct smachac::Fields<{class_}> : std::true_type {{",
        f"  static constexpr const char *names[] = {{{', '.join(map(cpp_literal, names))}}};",
        "  template <class Value> static auto members(Value &value) {",
        f"    return std::tie({members});",
        "  }",
        "};",
    ]
    return _once(lines)


def _assertions(class_: str, fields: Mapping[str, str]) -> Iterator[str]:
    """The static assertions for a class of the user; their messages are instructions."""
    for name, type_ in fields.items():
        member = member_identifier(name)
        yield f"static_assert(std::is_same_v<decltype(::{class_}::{member}), {type_}>,"
        yield f'              "{class_}::{member} must be {type_}");'


def _once(lines: list[str]) -> str:
    """Definitions that two headers of one program can have: the second one is left out. Other ones
    of the same names are an error of the compiler."""
    guard = f"SMACHAC_DEFINED_{zlib.crc32(chr(10).join(lines).encode()):08X}"
    return "\n".join([f"#ifndef {guard}", f"#define {guard}", *lines, "#endif"])


def same_members(names: RecordNames) -> Iterator[tuple[str, str, str]]:
    """The records in which two fields would have one name in C++, with these fields."""
    for record in (*names.project, *names.script):
        first: dict[str, str] = {}
        for name in map(str, record.type.args[::2]):
            other = first.setdefault(member_identifier(name), name)
            if other != name:
                yield record.name, other, name
