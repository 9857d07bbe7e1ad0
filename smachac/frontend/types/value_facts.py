"""Readers of the facts about values in an interface: `min`, `max`, `exclusive`, `unit`, `one_of`,
`names`, and the check of the field names beside them (docs/state_types.md, Facts)."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping

from smachac.diagnostics.diagnostic import Report, Severity, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import Guesser
from smachac.diagnostics.wording import listed
from smachac.frontend.errors.script import Owner, unknown_variable, wrong_shape
from smachac.frontend.text.fields import as_flag, kind_of
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree
from smachac.frontend.types.type_annotations import as_record
from smachac.ir.nodes import NATIVE, Limits, is_number
from smachac.ir.types import ANY, Type, parse_type, unknown_words

NAMES = ("joint", "frame", "limb", "model", "body")
"""What the values of a variable or key can be names of; each is a role."""

_ITEMS = ("optional", "list", "array", "dict")


def check_fields(tree: Tree, owner: str, known: Collection[str], report: Report) -> set[str]:
    """Reports the unknown fields of an entry of an interface, whose name in messages is `owner`.
    The result are the fields that they seem to mean."""
    meant = set()
    if isinstance(tree, Map) and _is_record(tree, known):
        text = tree.span.text
        message = f"{owner} is a record, whose fields are written under `type`"
        help = f"write `{{type: {text if chr(10) not in text else '{...}'}}}`"
        report.append(wrong_shape(tree.span, message, help, arguments=("record", owner)))
        return {"type"}
    for entry in tree.entries if isinstance(tree, Map) else ():
        word = Word(str(entry.key.value), entry.key.span)
        if word.text not in known:
            report.append(unknown_variable(word, Owner(owner, owner, "field"), known))
            meant.add(Guesser(known)(word.text) or "")
    return meant


def _is_record(tree: Map, known: Collection[str]) -> bool:
    """Whether a mapping has the form of a record type, and none of the known fields; where
    each of its names resembles one, it is probably misspelt."""
    names = {str(entry.key.value) for entry in tree.entries}
    if not names or not names.isdisjoint(known):
        return False
    guess = Guesser(known)
    if all(guess(name) is not None for name in names):
        return False
    record = as_record(tree)
    type_ = parse_type(str(record.value)) if isinstance(record, Scalar) else None
    return type_ is not None and not unknown_words(type_)


def named(tree: Tree, report: Report) -> str:
    """What the values are names of (one of NAMES); empty if they are not."""
    entry = tree.get("names") if isinstance(tree, Map) else None
    if entry is None:
        return ""
    text = entry.value.value if isinstance(entry.value, Scalar) else None
    if text in NAMES:
        return str(text)
    help = did_you_mean(str(text), NAMES) or f"write one of {listed(NAMES)}"
    message = f"values cannot be names of `{entry.value.span.text}`"
    report.append(wrong_shape(entry.value.span, message, help, arguments=("names", str(text))))
    return ""


def described(type_: Type, tree: Tree, role: str, report: Report) -> Type:
    """The type with the unit and the choices of an entry. An entry without a type that describes
    numbers or names is a `float`, a `str`; that of a waiting time is in seconds."""
    if type_ == ANY and role == "duration":
        type_ = Type("float", ("s",))
    if type_ == ANY and role in NAMES:
        type_ = Type("str")
    if not isinstance(tree, Map) or unknown_words(type_):
        return type_
    if type_ == ANY and any(tree.get(name) for name in ("min", "max", "unit")):
        type_ = Type("float")
    return _chosen(_in_unit(type_, tree, report), tree, report)


def _in_unit(type_: Type, tree: Map, report: Report) -> Type:
    entry = tree.get("unit")
    if entry is None:
        return type_
    span, number = entry.value.span, _number(type_)
    unit = str(entry.value.value) if isinstance(entry.value, Scalar) else ""
    quantity = parse_type(f"float<{unit}>")
    if number is None:
        message, help = f"the type `{type_}` has no unit", "remove the unit, or write a number type"
    elif quantity is None or quantity.args != (unit,):
        message, help = f"`{span.text}` is not a unit", "write it like `m`, `rad/s` or `m/s^2`"
    elif number.args not in ((), (unit,)):
        message = f"the type is in `{number.args[0]}`, but the unit is `{unit}`"
        help = "write the unit once"
    else:
        return _replaced(type_, Type(number.name, (unit,)))
    report.append(wrong_shape(span, message, help, arguments=("unit", unit)))
    return type_


def _chosen(type_: Type, tree: Map, report: Report) -> Type:
    """The type with its choices, if they are words or whole numbers."""
    entry = tree.get("one_of")
    if entry is None:
        return type_
    choices = _scalars(entry.value)
    if choices is None:
        message = f"expected a list of words or numbers, found {kind_of(entry.value)}"
        help = "write it as `[open, close]`"
        report.append(wrong_shape(entry.value.span, message, help, arguments=("one_of", "list")))
        return type_
    if type_ not in (ANY, Type("str"), Type("int")):
        return type_
    kind = int if type_ == Type("int") else str if type_ == Type("str") else int | str
    kept = [
        choice for choice in choices if isinstance(choice, int | str) and isinstance(choice, kind)
    ]
    return Type("one_of", tuple(kept)) if kept and len(kept) == len(choices) else type_


def _scalars(tree: Tree) -> list[int | float | str] | None:
    """The words and numbers of a list; None for anything else."""
    items = tree.items if isinstance(tree, Seq) else ()
    values = [item.value if isinstance(item, Scalar) else None for item in items]
    found = [v for v in values if isinstance(v, int | float | str) and not isinstance(v, bool)]
    return found if found and len(found) == len(values) else None


def limits_of(tree: Tree, type_: Type, role: str, report: Report) -> Limits | None:
    """The limits that an entry of an interface gives for its values; None without any. A waiting
    time is not negative."""
    least = 0.0 if role == "duration" else -math.inf
    if not isinstance(tree, Map):
        return Limits(least=least) if role == "duration" else None
    if unknown_words(type_):
        return None  # reported
    bounds = {name: _bound(tree, name, type_, report) for name in ("min", "max")}
    exclusive = tree.get("exclusive")
    choices = tree.get("one_of")
    numbers = _scalars(choices.value) if choices is not None and _number(type_) else None
    found = Limits(
        least=least if bounds["min"] is None else bounds["min"],
        most=math.inf if bounds["max"] is None else bounds["max"],
        exclusive=exclusive is not None and as_flag(exclusive.value, report),
        choices=tuple(number for number in numbers or () if isinstance(number, int | float)),
    )
    highest = tree.get("max")
    if found.least > found.most and highest is not None:
        message = f"`min` is {found.least:g}, which is greater than `max`, {found.most:g}"
        help = f"write `min: {found.most:g}, max: {found.least:g}`, or correct one of them"
        if bounds["min"] is None:
            message = f"`max` is {found.most:g}, but no value is less than {found.least:g}"
            help = f"write a number greater than {found.least:g}"
        report.append(wrong_shape(highest.value.span, message, help, arguments=("max", "min")))
        return None
    return found if found != Limits(exclusive=found.exclusive) else None


def _bound(tree: Map, name: str, type_: Type, report: Report) -> float | None:
    """The number under `min` or `max`; None without one."""
    entry = tree.get(name)
    if entry is None:
        return None
    value = entry.value.value if isinstance(entry.value, Scalar) else None
    if _number(type_) is None and type_ != ANY:
        message = f"`{name}` is for numbers, but the type is `{type_}`"
        help = f"remove `{name}`, or write a number type such as `float`"
    elif is_number(value):
        return float(value)
    else:
        message = f"expected a number, found {kind_of(entry.value)}"
        meant = _number_in(entry.value)
        which = "smallest" if name == "min" else "largest"
        help = f"write `{name}: {meant}`" if meant else f"write the {which} number that is allowed"
    report.append(wrong_shape(entry.value.span, message, help, arguments=(name, str(value))))
    return None


_DIGITS = r"[-+]?\d*\.?\d+"


def _number_in(tree: Tree) -> str:
    """The number that begins a text, or is the only item of a list; empty without one."""
    if isinstance(tree, Seq) and len(tree.items) == 1:
        tree = tree.items[0]
    found = (
        re.match(_DIGITS, str(tree.value).replace(",", ".")) if isinstance(tree, Scalar) else None
    )
    return found[0] if found is not None else ""


def _number(type_: Type) -> Type | None:
    """The number type in a type: itself, or that of the items; None if it has none."""
    while type_.name in _ITEMS and type_.args and isinstance(type_.args[0], Type):
        type_ = type_.args[0]
    return type_ if type_.name in ("int", "float") else None


def _replaced(type_: Type, number: Type) -> Type:
    """A type with another number type in it."""
    if type_.name not in _ITEMS:
        return number
    inner = type_.args[0]
    assert isinstance(inner, Type)
    return Type(type_.name, (_replaced(inner, number), *type_.args[1:]))


LANGUAGES: Mapping[str, tuple[str, ...]] = {
    "python": ("py", "python2", "python3"),
    "cpp": ("c++", "cc", "cxx", "cplusplus", "c"),
    **dict.fromkeys(NATIVE, ()),
}
"""The languages of code, with other names for them."""


def check_language(word: Word, report: Report) -> None:
    """Reports code in an unknown language. A language that is like none of them can be that of a
    target that is installed beside smachac, so it is a warning."""
    if word.text in LANGUAGES:
        return
    names = {other: name for name, others in LANGUAGES.items() for other in (name, *others)}
    meant = names.get(word.text.casefold()) or Guesser(LANGUAGES).unique_match(word.text)
    owner = Owner("code", "the code of a state type", "language")
    severity = None if meant else Severity.WARNING
    known = [meant] if meant else [*LANGUAGES]
    report.append(unknown_variable(word, owner, known, severity=severity))
