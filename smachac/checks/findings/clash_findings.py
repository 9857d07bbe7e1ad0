"""Findings on values that do not fit the type with which they are read (SM304)."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType

from smachac.analysis.expression_errors import kinds
from smachac.analysis.type_inference import Cell, Clash, TypeFlow
from smachac.analysis.type_lattice import (
    BOOL,
    fields,
    fits,
    inside,
    length_of,
    misfit,
    present,
    unit_of,
    widened,
)
from smachac.analysis.units import conversion
from smachac.checks.findings.help_text import calls, did_you_mean, other_place
from smachac.checks.findings.number_help import (
    decimal_commas,
    sizes_of,
    suggested_list,
    suggested_number,
    suggested_rotation,
)
from smachac.checks.findings.record_fields import (
    missing_fields,
    misspelt_fields,
    misspelt_help,
    without_fields,
)
from smachac.checks.findings.type_origins import cell_owner, is_promised, written
from smachac.checks.findings.type_words import HELP, example, in_words, named, place_in_words
from smachac.checks.findings.value_places import part_at, place_of_part, steps_to_misfit, type_at
from smachac.diagnostics.diagnostic import Finding, Related
from smachac.diagnostics.meanings import of_same_meaning
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import guesser
from smachac.ir.nodes import Container, Leaf, Struct, is_number

MOST_PLACES = 6
"""Limit on the related places of a finding."""


def clash_findings(
    clashes: list[Clash], aliases: Mapping[str, str] = MappingProxyType({})
) -> Iterator[Finding]:
    """One finding for each value that fits none of its readers, and else one for each reader.
    `aliases` are the names that the script gives to types."""
    origins = Counter(map(_root, clashes))
    readers = Counter(clash.cell for clash in clashes)
    groups: dict[tuple[str, TypeFlow | Cell], list[Clash]] = {}
    for clash in clashes:
        origin, reader = _root(clash), clash.cell
        literal = origin.how == "value"
        if origins[origin] > readers[reader] or (literal and origins[origin] == readers[reader]):
            groups.setdefault(("origin", origin), []).append(clash)
        else:
            groups.setdefault(("reader", reader), []).append(clash)
    for (side, _), group in groups.items():
        yield _finding(group, aliases, at_origin=side == "origin")


def _root(clash: Clash) -> TypeFlow:
    return clash.flow.origin


def _finding(group: list[Clash], aliases: Mapping[str, str], *, at_origin: bool) -> Finding:
    clash = group[0]
    origin, cell = clash.flow.origin, clash.cell
    about = origin.cell if at_origin else cell
    span = _place(clash) if at_origin else cell.span
    shown = {span, origin.span} if at_origin else {span}
    related: list[Related] = []

    def show(where: Span, message: str) -> None:
        if where not in shown and len(related) < MOST_PLACES:
            shown.add(where)
            related.extend(other_place(where, message))

    for other in group[:1] if at_origin else group:
        if not at_origin:
            show(_place(other), written(other.flow.origin))
        for where, message in _remaps(other):
            show(where, message)
        if at_origin:
            show(other.cell.span, _read(other.cell, aliases))
        declared = _in_interface(other.cell)
        if declared is not None:
            show(declared, f"the interface declares `{other.cell.key}` here")
    lacking = without_fields(clash)
    first = lacking or written(origin) + _part(clash)
    second = _read(cell, aliases)
    message = f"{first}, but {second}" if at_origin else f"{second}, but {first}"
    owner = named(clash.misfit.wanted, aliases)
    if lacking and at_origin and owner in aliases:
        message = f"{lacking}, which its type `{owner}` requires"
    special = _wrong_rotation(clash, aliases) or _wrong_part(clash, aliases) if at_origin else ""
    special = special or _unit_in_record(clash, aliases)
    return Finding(
        span=span,
        message=special or message,
        arguments=(about.key, str(widened(clash.misfit.given)), str(clash.misfit.wanted)),
        help=_field_type_help(clash, aliases) or _help(clash),
        effect=_effect(clash),
        related=(*related, *(calls(about.node, span) if about.node is not None else ())),
        node=about.path,
    )


def _field_type_help(clash: Clash, aliases: Mapping[str, str]) -> str | None:
    """The help for a number with a fraction in a record of a type of the script, whose field is a
    whole number."""
    value, (given, wanted) = clash.flow.value, (clash.misfit.given, clash.misfit.wanted)
    if (given.name, wanted.name) != ("float", "int") or not isinstance(value, (tuple, Struct)):
        return None
    steps = steps_to_misfit(value, clash.cell.declared)
    data = part_at(value, steps)
    if not isinstance(data, float) or not math.isfinite(data):
        return None
    help = f"write a whole number, such as `{round(data)}`"
    owner = named(type_at(clash.cell.declared, steps[:-1]), aliases)
    return f"{help}; or write `{steps[-1]}: float` in `{owner}`" if owner in aliases else help


def _effect(clash: Clash) -> str | None:
    """What the type leads to in Python, where that is certain."""
    wanted, given = present(clash.misfit.wanted), clash.misfit.given
    for name in missing_fields(clash):
        return f"Python raises a KeyError where code reads the field `{name}`"
    if wanted.name == "one_of":
        return "the interface allows these values only: the code may fail with another one"
    node = clash.cell.node
    if clash.cell.role == "variable" and isinstance(node, Leaf) and node.built_in:
        return "the state fails at its first visit"
    if wanted.name in ("int", "float") and kinds(given) == {"text"}:
        return "the state gets a text, not a number: arithmetic with it raises a TypeError"
    if wanted.name == "int" and kinds(given) == {"number"} and clash.flow.type == given:
        return "a number with a fraction raises a TypeError as an index and in `range`"
    if wanted.name == "str" and kinds(given) == {"number"}:
        return "a number has no operations of a text: they raise an error in the run"
    if wanted.name == "bool" and kinds(given) == {"text"}:
        return "each text that is not empty counts as true in Python"
    return None


def _place(clash: Clash) -> Span:
    """The place of a value, or of the part of a literal that does not fit."""
    origin, value = clash.flow.origin, clash.flow.value
    if not isinstance(value, (tuple, Struct)):
        return origin.span
    steps = steps_to_misfit(value, clash.cell.declared)
    near = next((near for _, near in misspelt_fields(clash)), None)
    return place_of_part(origin.span, (*steps, *([near] if near else ())), key=near is not None)


def _in_interface(cell: Cell) -> Span | None:
    """The place of an input key in an interface of the user."""
    node = cell.node
    if not isinstance(node, Leaf) or node.built_in or cell.role != "input":
        return None
    spans = [key.span for key in node.inputs if key.name == cell.key]
    outside = [span for span in spans if span.source is not node.span.source]
    return outside[0] if outside and outside[0].source is not NOWHERE.source else None


def _read(cell: Cell, aliases: Mapping[str, str]) -> str:
    """The type that a cell requires, as part of a message."""
    wanted = f"`{named(cell.declared, aliases)}`"
    match cell.role:
        case "input":
            return f"{cell_owner(cell)} reads `{cell.key}` as {wanted}"
        case "output":
            return f"{cell_owner(cell)} writes `{cell.key}` as {wanted}"
        case "variable":
            return f"the variable `{cell.key}` of {cell_owner(cell)} has the type {wanted}"
    return f"{cell_owner(cell)} declares `{cell.key}` as {wanted}"


def _part(clash: Clash) -> str:
    """The part of the value that does not fit; empty if it is the whole value."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if given == clash.flow.type or clash.misfit.kind == "unit":
        return ""
    return f" (in it, {in_words(given)} is in place of `{wanted}`)"


def _wrong_rotation(clash: Clash, aliases: Mapping[str, str]) -> str:
    """The message on a pose whose rotation has a wrong number of numbers; empty for others."""
    given, wanted, value = clash.misfit.given, clash.misfit.wanted, clash.flow.value
    count = length_of(given)
    if wanted.name != "Quaternion" or count is None or not isinstance(value, tuple | Struct):
        return ""
    steps = steps_to_misfit(value, clash.cell.declared)[:-1]
    whole = type_at(clash.cell.declared, steps)
    if whole.name not in ("Pose", "Transform"):
        return ""
    numbers = f"{count} number{'s' if count != 1 else ''}"
    needs = f"a `{whole.name}` needs 4 (a quaternion)"
    place = place_in_words(clash.flow.origin.cell.key, steps)
    reader = "" if steps else f": {_read(clash.cell, aliases)}"
    return f"the rotation in {place} has {numbers}, but {needs}{reader}"


def _unit_in_record(clash: Clash, aliases: Mapping[str, str]) -> str:
    """The message on the only field of a record whose number has another unit than that of the
    reader; empty for other clashes."""
    given, wanted = present(clash.flow.type), present(clash.cell.declared)
    if clash.misfit.kind != "unit" or (given.name, wanted.name) != ("record", "record"):
        return ""
    theirs = fields(wanted)
    found = [name for name, type_ in fields(given).items()
             if name in theirs and misfit(type_, theirs[name]) is not None]  # fmt: skip
    if len(found) != 1:
        return ""
    (name,) = found
    if present(fields(given)[name]) != present(clash.misfit.given):
        return ""
    units = unit_of(clash.misfit.given), unit_of(clash.misfit.wanted)
    owner = named(given, aliases)
    where = f" in the type `{owner}`" if owner in aliases else ""
    reader = f"{cell_owner(clash.cell)} reads it in `{units[1]}`"
    return f"`{name}` of `{clash.cell.key}` is in `{units[0]}`{where}, but {reader}"


def _wrong_part(clash: Clash, aliases: Mapping[str, str]) -> str:
    """The message for a literal of which a part does not fit; empty for other clashes."""
    value, (given, wanted) = clash.flow.value, (clash.misfit.given, clash.misfit.wanted)
    is_part = isinstance(value, (tuple, Struct)) and clash.flow.origin is clash.flow
    if not is_part or not _part(clash) or missing_fields(clash):
        return ""
    steps = steps_to_misfit(value, clash.cell.declared)
    data = part_at(value, steps)
    if not steps or (given.name == "literal" and len(given.args) != 1):
        return ""
    what = f"`{json.dumps(data)}`" if isinstance(data, int | float) else in_words(given)
    what = f"the text `{data}`" if isinstance(data, str) else what
    owner = named(type_at(clash.cell.declared, steps[:-1]), aliases)
    first = f"{place_in_words(clash.flow.cell.key, steps)} is {what}"
    if owner in aliases:
        return f"{first}, but `{owner}` has `{steps[-1]}: {wanted}`"
    return f"{first}, but {_read(clash.cell, aliases)}"


FLAGS = {
    **dict.fromkeys(("true", "yes", "on", "1"), "true"),
    **dict.fromkeys(("false", "no", "off", "0"), "false"),
}
"""Words and numbers that are meant as booleans, which are `true` and `false` in YAML 1.2."""


KEY_FIELDS = frozenset(["type", "value", "doc", "secret", "default", "min", "max", "unit"])
"""The fields of a key in userdata and in interfaces."""


def _help(clash: Clash) -> str:
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if wanted.name == "record" and (long_form := _long_form(clash)) is not None:
        return long_form
    if clash.misfit.kind == "unit":
        return _in_wanted_unit(clash)
    if clash.misfit.kind == "length" and given == clash.flow.type:
        more = _of_wanted_length(clash)
        if more is not None:
            return more
    if wanted.name == "one_of" and given.name == "literal":
        choices, word = [str(choice) for choice in wanted.args], str(given.args[0])
        meant = of_same_meaning(word, choices) or guesser(choices)(word)
        return did_you_mean(meant) or f"use one of {', '.join(f'`{choice}`' for choice in choices)}"
    meant = misspelt_help(clash)
    if meant is not None:
        return meant
    for name in missing_fields(clash):
        type_ = fields(wanted)[name]
        return f"add `{name}`, or make it optional where it is read: `{name}: {type_}?`"
    if clash.flow.how == "value":
        meant = _suggested(clash)
        if meant is not None:
            return meant
    if clash.flow.how == "value" and wanted.name in HELP:
        steps = steps_to_misfit(clash.flow.value, clash.cell.declared)
        part = part_at(clash.flow.value, steps) if wanted.name == "Quaternion" else None
        return suggested_rotation(part) or HELP[wanted.name]
    if given.name == "none":
        return f"give it a value, or declare it as `{wanted}?` where it is read"
    if given.name == "optional" and fits(inside(given), wanted):
        cell = clash.flow.origin.cell
        first = f"set `{cell.key}` on each path to the read, or " if cell.role == "scope" else ""
        return f"{first}declare it as `{given}` where it is read, because it can be absent"
    if given.name == "float" and wanted.name == "int":
        value = clash.flow.origin.value
        if isinstance(value, float) and math.isfinite(value):
            return f"write a whole number, such as `{round(value)}`"
        return "declare it as `float` where it is read, or convert it with `round(...)`"
    if clash.flow.origin.how == "declared" and is_promised(clash.flow.origin.cell):
        owner = cell_owner(clash.flow.origin.cell)
        return f"change the type in the `input_keys` of {owner}, or where it is read"
    return _rewrite(clash)


def _of_wanted_length(clash: Clash) -> str | None:
    """The help for a literal list that has too many or too few items."""
    value, sizes = clash.flow.origin.value, sizes_of(clash.misfit.wanted)
    if not isinstance(value, tuple) or not value or len(sizes) != 1 or len(value) == sizes[0]:
        return None
    if clash.misfit.wanted.name in HELP:
        return None
    meant = decimal_commas(clash.flow.origin.span.text, sizes)
    if meant is not None:
        return meant
    lack = sizes[0] - len(value)
    items = f"{abs(lack)} item{'s' * (abs(lack) > 1)}"
    change = f"{'add' if lack > 0 else 'remove'} {items}: {sizes[0]} are needed"
    return f"{change}{_other_change(clash)}"


def _in_wanted_unit(clash: Clash) -> str:
    """The help for a number in another unit than that of its reader."""
    given, wanted = unit_of(clash.misfit.given), unit_of(clash.misfit.wanted)
    factor = conversion(given, wanted)
    correct = _other_change(clash)
    if factor is None:
        return f"use a number in `{wanted}`{correct}"
    origin, type_ = clash.flow.origin, clash.misfit.wanted
    if is_number(origin.value):
        number = f"{origin.value * factor:.6g}"
        return f"write it in `{wanted}`: `{number}` of the type `{type_}`{correct}"
    node, key = origin.cell.node, origin.cell.key
    presets = () if node is None or isinstance(node, Leaf) else node.userdata
    for preset in presets:
        if preset.key == key and preset.type == clash.misfit.given and is_number(preset.value.data):
            number = f"{preset.value.data * factor:.6g}"
            new = f'`{key}: {{type: "{type_}", value: {number}}}`'
            return f"write {new} in the `userdata` of {cell_owner(origin.cell)}{correct}"
    return f"multiply it by {factor:.6g}, which makes `{wanted}` of `{given}`{correct}"


def _rewrite(clash: Clash) -> str:
    """The help for a value of a wrong type: how the script writes a right one, and the other place
    that can be changed, if there is one."""
    wanted = clash.misfit.wanted
    found = example(wanted)
    value = f"a value of the type `{wanted}`" + (f", such as `{found}`" if found else "")
    change = _other_change(clash)
    origin = clash.flow.origin
    if origin.how == "declared" and isinstance(origin.cell.node, Container):
        node, key = origin.cell.node, origin.cell.key
        if key not in {key.name for key in (*node.inputs, *node.outputs)}:
            place = f"in the `userdata` of {cell_owner(origin.cell)}"
            return f"declare `{key}` as `{wanted}` {place}, if that is its type{change}"
        keys = "input_keys" if key in {key.name for key in node.inputs} else "output_keys"
        declared = f"`{key}: {wanted}` in the `{keys}` of {cell_owner(origin.cell)}"
        return f"write {declared}, if that is its type{change}"
    number = _number_in_list(clash)
    if number:
        return f"write the number without brackets: `{number}`"
    if origin.how != "value":
        return f"let {cell_owner(origin.cell)} write {value}{change}"
    return f"write {value}{change}"


def _number_in_list(clash: Clash) -> str:
    """The number that is the only item of a list in place of a number; empty for other values."""
    value = clash.flow.value
    if clash.misfit.wanted.name not in ("float", "int") or not isinstance(value, (tuple, Struct)):
        return ""
    data = part_at(value, steps_to_misfit(value, clash.cell.declared))
    is_one = isinstance(data, tuple) and len(data) == 1 and is_number(data[0])
    return f"{data[0]}" if isinstance(data, tuple) and is_one else ""


def _other_change(clash: Clash) -> str:
    """The change of the type where a value is read, as the end of a help; empty if the type is
    built in."""
    cell = clash.cell
    node, change = cell.node, f", or change the type of `{cell.key}`"
    own = node.inputs if cell.role == "input" and node is not None else ()
    listed_here = any(
        key.name == cell.key and node is not None and key.span.source is node.span.source
        for key in own
    )
    if isinstance(node, Leaf) and not listed_here:
        return "" if node.built_in else f"{change} in the interface `{node.type}`"
    return f"{change} at {cell_owner(cell)}" if node is not None else change


def _long_form(clash: Clash) -> str | None:
    """The help for a reader whose record has the fields of an interface, such as `{type: float}`,
    while the value is no mapping, or has no field `type`: the type was meant."""
    wanted = fields(clash.misfit.wanted)
    if "type" not in wanted or not KEY_FIELDS.issuperset(wanted) or clash.cell.role != "input":
        return None
    value = clash.flow.value
    names = {name for name, _ in value.entries} if isinstance(value, Struct) else {"type"}
    if clash.misfit.given.name in ("mapping", "record", "dict") and "type" in names:
        return None
    return (
        f"write `{clash.cell.key}: {wanted['type']}` in the `input_keys` of"
        f" {cell_owner(clash.cell)}: only userdata and interfaces have the fields"
        " `type` and `value`"
    )


def _suggested(clash: Clash) -> str | None:
    """The help for a literal that was meant as a number, or as a list of numbers."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    number = present(wanted)
    if given.name == "literal" and number == BOOL:
        flag = FLAGS.get(str(given.args[0]).casefold())
        return f"write `{flag}`" if flag else None
    if given.name == "literal" and number.name in ("int", "float"):
        texts = [argument for argument in given.args if isinstance(argument, str)]
        return suggested_number(texts[0], number) if texts else None
    if given.name == "literal" and (number.name in ("list", "array") or number.name in HELP):
        return suggested_list(str(given.args[0]))
    return decimal_commas(clash.flow.origin.span.text, sizes_of(clash.cell.declared))


def _remaps(clash: Clash) -> Iterator[tuple[Span, str]]:
    """The remaps on the path of the value, with a text for each."""
    chain: list[Cell] = [clash.cell]
    flow: TypeFlow | None = clash.flow.before
    while flow is not None:
        chain.append(flow.cell)
        flow = flow.before
    for inner, outer in pairwise(chain):
        for cell, other in ((inner, outer), (outer, inner)):
            node = cell.node
            if node is None or len(cell.path) <= len(other.path):
                continue
            for remap in node.remaps:
                if remap.key == cell.key and remap.span.source is not NOWHERE.source:
                    around = other.node.name if other.node is not None else "the base"
                    text = (
                        f"`{remap.key}` of `{node.name}` is remapped to `{remap.to}` of `{around}`"
                    )
                    yield remap.span, text
