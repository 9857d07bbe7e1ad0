"""Displays of lists, tuples and mappings in C++."""

from __future__ import annotations

from smachac.ir.types import Type
from smachac.targets.cpp.terms import (
    NEVER,
    CppText,
    Term,
    call,
    converted,
    convertible,
    cpp,
    ground,
    has,
    inside,
    joined,
    present,
    shown,
    size_of,
)
from smachac.targets.cpp.types import (
    FIELDS,
    LISTED,
    STR,
    UnportableError,
    braced,
    check_fields,
    fields_of,
)


def listed(items: list[Term], kind: str) -> Term:
    """`[a, b]` and `(a, b)`; `kind` is `array` or `tuple`."""
    item = joined([item.type for item in items])
    if item.name == "mixed":
        own = item
    elif items:
        own = Type(kind, (item, len(items)))
    else:
        own = Type("list" if kind == "array" else kind, (NEVER,))

    def spell(wanted: Type) -> CppText:
        if wanted.name == "optional":
            return converted(spell(inside(wanted)), inside(wanted), wanted)
        if wanted.name in LISTED:
            return _struct(wanted, items)
        if wanted.name not in ("list", "array", "tuple"):
            return converted(CppText(""), own, wanted)
        size = size_of(wanted)
        if size is not None and size != len(items):
            raise UnportableError(f"the list has {len(items)} items instead of {size}")
        texts = [item.spell(inside(wanted)).text for item in items]
        return CppText(braced(cpp(wanted), texts, array=size is not None))

    return Term(type=own, spell=spell)


def _struct(wanted: Type, items: list[Term]) -> CppText:
    """A struct that scripts write as a list."""
    fields = FIELDS[wanted.name].values()
    parts = [item.spell(part).text for item, part in zip(items, fields, strict=False)]
    if len(items) == 3 and wanted.name in ("Pose", "Transform"):
        # As in the simulation: without a rotation.
        point = ", ".join(item.spell(Type("float")).text for item in items)
        parts = [f"smachac::Point{{{point}}}", "smachac::Quaternion{}"]
    elif len(items) != len(fields):
        raise UnportableError(f"`{wanted}` has {len(fields)} parts, not {len(items)}")
    return CppText(f"{cpp(wanted)}{{{', '.join(parts)}}}")


def mapped(entries: list[tuple[Term, Term]]) -> Term:
    """`{a: b}`. Among equal keys Python keeps the last one and C++ the first."""
    item = joined([value.type for _, value in entries])
    own = item if item.name == "mixed" else Type("dict", (item,))
    for key, _ in entries:
        if key.type != STR:
            raise UnportableError(f"the keys of a mapping must be `str`, not `{shown(key.type)}`")
    keys = [key.constant for key, _ in entries]
    apart = None not in keys and len(set(keys)) == len(keys)

    def spell(wanted: Type) -> CppText:
        if wanted.name == "optional":
            return converted(spell(inside(wanted)), inside(wanted), wanted)
        if wanted.name == "struct":
            return _struct_of_record(wanted, {str(key.constant): value for key, value in entries})
        if wanted.name in ("PoseStamped", "JointState"):
            return _record(wanted, {str(key.constant): value for key, value in entries})
        if wanted.name != "dict":
            return converted(CppText(""), own, wanted)
        pairs = [f"{{{k.text()}, {v.spell(inside(wanted)).text}}}" for k, v in entries]
        return CppText(braced(cpp(wanted), pairs if apart else pairs[::-1]))

    return Term(type=own, spell=spell)


def _struct_of_record(wanted: Type, given: dict[str, Term]) -> CppText:
    """The struct of a record, from the mapping that scripts write for it."""
    check_fields(given, wanted)
    fields = fields_of(wanted)
    values = [stored(given[name], fields[name]) if name in given else "smachac::None{}"
              for name in sorted(fields)]  # fmt: skip
    return call(f"made<{cpp(wanted)}>", *values)


def stored(term: Term, wanted: Type) -> str:
    """The text of a value that an assignment converts to a type. Raises UnportableError."""
    if present(wanted).name == "struct":
        return term.spell(wanted).text
    if not convertible(term.type, wanted):
        converted(CppText(""), term.type, wanted)  # raises the reason
    if term.type.name in ("list", "tuple") and has(term.type, "never"):
        return EMPTY
    return term.text()


EMPTY = "std::array<std::int64_t, 0>{}"
"""An empty list, for a list of any items."""


def _record(wanted: Type, given: dict[str, Term]) -> CppText:
    """A struct that scripts write as a mapping."""
    fields = FIELDS[wanted.name]
    unknown = [key for key in given if key not in fields]
    if unknown:
        raise UnportableError(f"`{wanted}` has no field `{unknown[0]}`, only {', '.join(fields)}")
    parts = [
        given[key].spell(part).text if key in given else f"{cpp(ground(part))}{{}}"
        for key, part in fields.items()
    ]
    return CppText(f"{cpp(wanted)}{{{', '.join(parts)}}}")
