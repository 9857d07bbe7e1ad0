"""The rule on types: a value must fit the type with which it is read (see type_lattice.py)."""

from __future__ import annotations

import json
import math
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise
from types import MappingProxyType

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import kinds
from smachac.analysis.expression_types import type_of_data
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
from smachac.checks.classes.class_values import wrong_loops, wrong_writes
from smachac.checks.help_text import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.checks.type_words import HELP, example, in_words, named, place_in_words
from smachac.checks.types.number_help import (
    decimal_commas,
    list_meant,
    number_meant,
    rotation_meant,
    sizes_of,
)
from smachac.checks.types.record_fields import (
    missing_fields,
    misspelt_fields,
    misspelt_help,
    swapped_fields_help,
    without_fields,
)
from smachac.checks.types.value_places import part_at, place_of_part, steps_to_misfit, type_at
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.meanings import of_same_meaning
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Container, Expression, Leaf, StateType, Struct, is_number
from smachac.ir.traversal import outcome_names


@rule(
    "SM304",
    "type-mismatch",
    Severity.ERROR,
    effect="the state that reads the value fails, or uses it with a wrong meaning",
)
def type_mismatch(context: Context) -> Iterator[Finding]:
    """A value does not fit the type with which it is read.

    The state that reads it fails in the middle of the task, or uses the value with a wrong meaning.

    Exactly: types come from interfaces, from the script, from literals and from the results of
    functions, and are followed through remappings and containers. Literals, lists and dictionaries
    that the Python class of a state type writes to an output key are checked against its interface,
    and the steps of a ScriptedState against the fields of a step. The default of a variable in an
    interface must fit its type. An `int` fits a `float`, a `T` fits a `T?`, an enumeration fits one
    with more choices, and `any` fits every type.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: str}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: Pose}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}
    """
    clashes = [each for each in context.clashes["type"] if not _is_function(each)]
    yield from clash_findings(clashes, context.machine.aliases)
    yield from _lists_for_items(context)
    yield from _without_items(context)
    yield from _wrong_steps(context)
    yield from wrong_writes(context)
    yield from wrong_loops(context)
    for type_ in context.machine.state_types.values():
        yield from _wrong_defaults(type_)


def _lists_for_items(context: Context) -> Iterator[Finding]:
    """The states in a loop that read its list where they need its item."""
    seen: set[tuple[str, str]] = set()
    containers = dict(context.containers) if context.item_reads else {}
    for each in context.item_reads:
        around = containers.get(each.path.rpartition("/")[0])
        if isinstance(around, nodes.Iterator) and not around.sugar:
            continue  # SM004: the state of an Iterator has no remapping
        if (each.path, each.key) in seen:
            continue
        seen.add((each.path, each.key))
        help = f"write `{each.key}: {each.item}`"
        for name in each.lacking:
            help += f", and add `{each.item}` to the `input_keys` of `{name}`"
        cell = each.clash.cell
        yield Finding(
            span=each.span,
            message=f"`{each.node.name}` reads the list `{each.items}` as `{each.key}`, but the"
            f" loop gives its item under `{each.item}`",
            arguments=(each.key, each.items, "item"),
            help=help,
            effect=f"`{_owner(cell)[1:-1]}` gets the whole list in place of {named_item(cell)}",
            related=calls(each.node, each.span),
            node=each.path,
        )


def named_item(cell: Cell) -> str:
    """The value that a reader needs, in words."""
    return f"one `{widened(cell.declared)}`"


def _without_items(context: Context) -> Iterator[Finding]:
    """The loops over a key whose value is a number, which has no items."""
    for path, container in context.containers:
        if not isinstance(container, nodes.Iterator) or not container.items_key:
            continue
        key = container.items_key
        cell = context.types.cells.get((path, key))
        if cell is None or kinds(cell.holds or cell.declared) != {"number"}:
            continue
        origins = {alike[0].origin: None for alike in cell.flows.values()}
        type_ = cell.holds or cell.declared
        lists = [
            name
            for name in (each.name for each in container.inputs)
            if (other := context.types.cells.get((path, name))) is not None
            and kinds(other.holds or other.declared) == {"list"}
        ]
        yield Finding(
            span=container.items_span,
            message=f"`{container.name}` needs a list of items in `{key}`, but `{key}` is"
            f" {in_words(type_)}",
            arguments=(key, str(widened(type_)), "list"),
            help=f"did you mean `{lists[0]}`, the only list here?"
            if len(lists) == 1
            else f"write a list for `{key}`, such as `[1, 2, 3]`",
            related=(
                *(place for each in origins for place in other_place(each.span, written(each))),
                *calls(container, container.items_span),
            ),
            node=path,
        )


STEP = ("outcome", "set")
"""The fields of a step."""


def _wrong_steps(context: Context) -> Iterator[Finding]:
    """The steps of ScriptedStates that are no list of mappings with the fields of a step."""
    for path, leaf in context.leaves_with_variables:
        held = variable_of(leaf, "steps")
        if held is None or isinstance(held.value.data, Expression):
            continue
        whole, data = held.value.span, held.value.data
        shown = f"`{held.name}` of `{leaf.name}`"
        one = "write each step as a mapping: `- {outcome: NAME, set: {KEY: VALUE}}`"
        faults: list[tuple[Span, str, str, str]] = []
        if not isinstance(data, tuple):
            faults = [(whole, f"{shown} must be a list of steps", one, "")]
            if isinstance(data, Struct) and "\n" not in whole.text:
                faults = [
                    (whole, f"{shown} must be a list of steps", f"write `[{whole.text}]`", "")
                ]
        for at, step in enumerate(data if isinstance(data, tuple) else ()):
            if isinstance(step, Struct):
                for name, value in step.entries:
                    if name in STEP:
                        continue
                    place = place_of_part(whole, (at, name), key=True)
                    help = did_you_mean(guesser(STEP)(name)) or f"its fields are {listed(STEP)}"
                    if value in STEP:
                        help = f"write `{value}: {name}`: the name of the field comes first"
                    faults.append(
                        (place, f"a step of `{leaf.name}` has no field `{name}`", help, name)
                    )
            elif not isinstance(step, Expression):
                place = place_of_part(whole, (at,))
                known = isinstance(step, str) and step in outcome_names(leaf)
                help = f"write `{{outcome: {step}}}`" if known else one
                faults.append(
                    (place, f"step {at + 1} of `{leaf.name}` is not a mapping", help, str(at))
                )
        for span, message, help, name in faults:
            yield Finding(
                span=span,
                message=message,
                arguments=(held.name, name, "step"),
                help=help,
                related=calls(leaf, span),
                node=path,
            )


def _is_function(clash: Clash) -> bool:
    """Whether a value is the text of a function where one is allowed, which is SM316."""
    value, node = clash.flow.value, clash.cell.node
    if clash.cell.role != "variable" or not isinstance(node, Leaf) or not isinstance(value, str):
        return False
    roles = {each.role for each in node.variables if each.name == clash.cell.key}
    return value.lstrip().startswith("lambda") and not roles.isdisjoint(("duration", "function"))


def _wrong_defaults(type_: StateType) -> Iterator[Finding]:
    """The defaults of an interface that do not fit their own types."""
    for held in type_.variables.values():
        data = held.default.data if held.default is not None else None
        found = misfit(type_of_data(data), held.type) if data is not None else None
        if held.default is None or found is None:
            continue
        help = f"write a default that fits `{held.type}`, or correct the type"
        if found.given.name == "literal" and present(found.wanted).name in ("int", "float"):
            help = number_meant(str(found.given.args[0]), present(found.wanted)) or help
        if isinstance(data, str) and data.lower() in ("none", "nil"):
            help = f"write `null` for no value: `{data}` is a text"
        yield Finding(
            span=held.default.span,
            message=f"the default of `{held.name}` is {in_words(type_of_data(data))}, but its type"
            f" is `{held.type}`",
            arguments=(held.name, str(widened(found.given)), str(found.wanted)),
            help=help,
        )


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

    for each in group[:1] if at_origin else group:
        if not at_origin:
            show(_place(each), written(each.flow.origin))
        for where, message in _remaps(each):
            show(where, message)
        if at_origin:
            show(each.cell.span, _read(each.cell, aliases))
        declared = _in_interface(each.cell)
        if declared is not None:
            show(declared, f"the interface declares `{each.cell.key}` here")
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
    outside = [each for each in spans if each.source is not node.span.source]
    return outside[0] if outside and outside[0].source is not NOWHERE.source else None


def _owner(cell: Cell) -> str:
    return f"`{cell.node.name}`" if cell.node is not None else "the base"


def _read(cell: Cell, aliases: Mapping[str, str]) -> str:
    """The type that a cell requires, as part of a message."""
    wanted = f"`{named(cell.declared, aliases)}`"
    match cell.role:
        case "input":
            return f"{_owner(cell)} reads `{cell.key}` as {wanted}"
        case "output":
            return f"{_owner(cell)} writes `{cell.key}` as {wanted}"
        case "variable":
            return f"the variable `{cell.key}` of {_owner(cell)} has the type {wanted}"
    return f"{_owner(cell)} declares `{cell.key}` as {wanted}"


def written(flow: TypeFlow) -> str:
    """A value and its origin, as part of a message."""
    cell = flow.cell
    if flow.how == "declared":
        match cell.role:
            case "output":
                return f"{_owner(cell)} writes `{cell.key}` as `{flow.type}`"
            case "scope" if is_promised(cell):
                return f"the caller of {_owner(cell)} provides `{cell.key}` as `{flow.type}`"
            case "scope":
                return f"{_owner(cell)} declares `{cell.key}` as `{flow.type}`"
    what = in_words(flow.type)
    if flow.how == "value" and isinstance(flow.value, bool | float):
        return f"`{cell.key}` is `{json.dumps(flow.value)}`"
    if flow.how == "computed" and isinstance(cell.node, nodes.Iterator):
        return f"{_owner(cell)} provides `{cell.key}` as {what}"
    if flow.how == "computed":
        return f"{_owner(cell)} computes `{cell.key}` as {what}"
    return f"`{cell.key}` is {what}"


def is_promised(cell: Cell) -> bool:
    """Whether a key is an input of the outermost machine: its caller provides the value."""
    node = cell.node
    outermost = node is not None and cell.path == node.name
    return outermost and node is not None and any(key.name == cell.key for key in node.inputs)


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
    reader = f"{_owner(clash.cell)} reads it in `{units[1]}`"
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
    meant = misspelt_help(clash) or swapped_fields_help(clash)
    if meant is not None:
        return meant
    for name in missing_fields(clash):
        type_ = fields(wanted)[name]
        return f"add `{name}`, or make it optional where it is read: `{name}: {type_}?`"
    if clash.flow.how == "value":
        meant = _meant(clash)
        if meant is not None:
            return meant
    if clash.flow.how == "value" and wanted.name in HELP:
        steps = steps_to_misfit(clash.flow.value, clash.cell.declared)
        part = part_at(clash.flow.value, steps) if wanted.name == "Quaternion" else None
        return rotation_meant(part) or HELP[wanted.name]
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
        owner = _owner(clash.flow.origin.cell)
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
    for each in presets:
        if each.key == key and each.type == clash.misfit.given and is_number(each.value.data):
            number = f"{each.value.data * factor:.6g}"
            new = f'`{key}: {{type: "{type_}", value: {number}}}`'
            return f"write {new} in the `userdata` of {_owner(origin.cell)}{correct}"
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
            place = f"in the `userdata` of {_owner(origin.cell)}"
            return f"declare `{key}` as `{wanted}` {place}, if that is its type{change}"
        keys = "input_keys" if key in {key.name for key in node.inputs} else "output_keys"
        declared = f"`{key}: {wanted}` in the `{keys}` of {_owner(origin.cell)}"
        return f"write {declared}, if that is its type{change}"
    number = _number_in_list(clash)
    if number:
        return f"write the number without brackets: `{number}`"
    if origin.how != "value":
        return f"let {_owner(origin.cell)} write {value}{change}"
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
    return f"{change} at {_owner(cell)}" if node is not None else change


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
        f"write `{clash.cell.key}: {wanted['type']}` in the `input_keys` of {_owner(clash.cell)}:"
        " only userdata and interfaces have the fields `type` and `value`"
    )


def _meant(clash: Clash) -> str | None:
    """The help for a literal that was meant as a number, or as a list of numbers."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    number = present(wanted)
    if given.name == "literal" and number == BOOL:
        flag = FLAGS.get(str(given.args[0]).casefold())
        return f"write `{flag}`" if flag else None
    if given.name == "literal" and number.name in ("int", "float"):
        texts = [each for each in given.args if isinstance(each, str)]
        return number_meant(texts[0], number) if texts else None
    if given.name == "literal" and (number.name in ("list", "array") or number.name in HELP):
        return list_meant(str(given.args[0]))
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
