"""The rule on types: a value must fit the type with which it is read (see type_lattice.py)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from smachac.analysis.context import Context
from smachac.analysis.expression_errors import kinds
from smachac.analysis.expression_types import type_of_data
from smachac.analysis.type_inference import Cell, Clash, TypeFlow
from smachac.analysis.type_lattice import (
    BOOL,
    FLOAT,
    fields,
    fits,
    inside,
    is_open,
    items,
    misfit,
    present,
    widened,
)
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.number_help import decimal_commas, number_meant, sizes_of
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import Leaf, StateType
from smachac.ir.types import Type


@rule("SM304", "type-mismatch", Severity.ERROR)
def type_mismatch(context: Context) -> Iterator[Finding]:
    """A value does not fit the type with which it is read.

    The state that reads it fails in the middle of the task, or uses the value with a wrong meaning.

    Exactly: types come from interfaces, from the script, from literals and from the results of
    functions, and are followed through remappings and containers. The default of a variable in an
    interface must fit its type. An `int` fits a `float`, a `T`
    fits a `T?`, an enumeration fits one with more choices, and `any` fits every type.

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
    yield from clash_findings([each for each in context.clashes["type"] if not _is_function(each)])
    yield from _without_items(context)
    for type_ in context.machine.state_types.values():
        yield from _wrong_defaults(type_)


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
        yield Finding(
            span=container.items_span,
            message=f"`{container.name}` needs a list of items in `{key}`, but `{key}` is"
            f" {in_words(type_)}",
            arguments=(key, str(widened(type_)), "list"),
            help=f"write a list for `{key}`, such as `[1, 2, 3]`",
            related=(
                *(place for each in origins for place in other_place(each.span, written(each))),
                *calls(container, container.items_span),
            ),
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
        yield Finding(
            span=held.default.span,
            message=f"the default of `{held.name}` is {in_words(type_of_data(data))}, but its type"
            f" is `{held.type}`",
            arguments=(held.name, str(widened(found.given)), str(found.wanted)),
            help=help,
        )


MOST_PLACES = 6
"""Limit on the related places of a finding."""


def clash_findings(clashes: list[Clash]) -> Iterator[Finding]:
    """One finding for each value that fits none of its readers, and else one for each reader."""
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
        yield _finding(group, at_origin=side == "origin")


def _root(clash: Clash) -> TypeFlow:
    return clash.flow.origin


def _finding(group: list[Clash], *, at_origin: bool) -> Finding:
    clash = group[0]
    origin, cell = clash.flow.origin, clash.cell
    about = origin.cell if at_origin else cell
    span = origin.span if at_origin else cell.span
    shown = {span}
    related: list[Related] = []

    def show(where: Span, message: str) -> None:
        if where not in shown and len(related) < MOST_PLACES:
            shown.add(where)
            related.extend(other_place(where, message))

    for each in group:
        if not at_origin:
            show(each.flow.origin.span, written(each.flow.origin))
        for where, message in _remaps(each):
            show(where, message)
        if at_origin:
            show(each.cell.span, _read(each.cell))
    first, second = written(origin), _read(cell)
    message = f"{first}, but {second}" if at_origin else f"{second}, but {first}"
    return Finding(
        span=span,
        message=message + _part(clash),
        arguments=(about.key, str(widened(clash.misfit.given)), str(clash.misfit.wanted)),
        help=_help(clash),
        related=(*related, *(calls(about.node, span) if about.node is not None else ())),
        node=about.path,
    )


def _owner(cell: Cell) -> str:
    return f"`{cell.node.name}`" if cell.node is not None else "the base"


def _read(cell: Cell) -> str:
    """The type that a cell requires, as part of a message."""
    wanted = f"`{cell.declared}`"
    match cell.role:
        case "input":
            return f"{_owner(cell)} reads `{cell.key}` as {wanted}"
        case "output":
            return f"{_owner(cell)} writes `{cell.key}` as {wanted}"
        case "variable":
            return f"the variable `{cell.key}` of {_owner(cell)} has the type {wanted}"
    return f"{_owner(cell)} holds `{cell.key}` as {wanted}"


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
                return f"{_owner(cell)} holds `{cell.key}` as `{flow.type}`"
    what = in_words(flow.type)
    if flow.how == "computed":
        return f"{_owner(cell)} computes `{cell.key}` as {what}"
    return f"`{cell.key}` is {what}"


def is_promised(cell: Cell) -> bool:
    """Whether a key is an input of the outermost machine: its caller provides the value."""
    node = cell.node
    outermost = node is not None and cell.path == node.name
    return outermost and node is not None and any(key.name == cell.key for key in node.inputs)


def in_words(type_: Type) -> str:
    """A type as part of a message; literals as in the script."""
    match type_.name:
        case "literal":
            texts = (f'"{each}"' if isinstance(each, str) else str(each) for each in type_.args)
            return " or ".join(f"`{text}`" for text in texts)
        case "none":
            return "nothing (`null`)"
        case "tuple" if all(fits(item, FLOAT) and not is_open(item) for item in items(type_)):
            count = len(type_.args)
            return f"a list of {count} number{'s' if count != 1 else ''}"
    return f"`{widened(type_)}`"


def _part(clash: Clash) -> str:
    """The part of the value that does not fit; empty if it is the whole value."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    missing = _missing_fields(clash)
    if missing:
        return f": it lacks the field{'s' if len(missing) > 1 else ''} {listed(missing)}"
    if given == clash.flow.type or clash.misfit.kind == "unit":
        return ""
    return f": {in_words(given)} does not fit `{wanted}`"


def _missing_fields(clash: Clash) -> list[str]:
    """The fields of a record that a mapping or another record lacks."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if wanted.name != "record" or given.name not in ("mapping", "record"):
        return []
    return [name for name, type_ in fields(wanted).items()
            if name not in fields(given) and type_.name != "optional"]  # fmt: skip


FLAGS = {
    **dict.fromkeys(("true", "yes", "on", "1"), "true"),
    **dict.fromkeys(("false", "no", "off", "0"), "false"),
}
"""Words and numbers that are meant as booleans, which are `true` and `false` in YAML 1.2."""

HELP = {
    "Pose": "write a pose as `[[x, y, z], [qx, qy, qz, qw]]`",
    "Transform": "write a transform as `[[x, y, z], [qx, qy, qz, qw]]`",
    "Point": "write a point as `[x, y, z]`",
    "Quaternion": "write a rotation as `[qx, qy, qz, qw]`",
}


def _help(clash: Clash) -> str:
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if clash.misfit.kind == "unit":
        return f"convert `{given}` to `{wanted}`, or correct the unit at one of the two places"
    if wanted.name == "one_of" and given.name == "literal":
        choices = [str(choice) for choice in wanted.args]
        guess = did_you_mean(guesser(choices)(str(given.args[0])))
        return guess or f"use one of {', '.join(f'`{choice}`' for choice in choices)}"
    for name in _missing_fields(clash):
        others = [each for each in fields(given) if each not in fields(wanted)]
        near = guesser(others)(name)
        if near is not None:
            return f"did you mean `{name}` in place of `{near}`?"
        return (
            f"add `{name}`, or make it optional where it is read: `{name}: {fields(wanted)[name]}?`"
        )
    if clash.flow.how == "value":
        meant = _meant(clash)
        if meant is not None:
            return meant
    if clash.flow.how == "value" and wanted.name in HELP:
        return HELP[wanted.name]
    if given.name == "none":
        return f"give it a value, or declare it as `{wanted}?` where it is read"
    if given.name == "optional" and fits(inside(given), wanted):
        return f"declare it as `{given}` where it is read, because it can be absent"
    if given.name == "float" and wanted.name == "int":
        return "declare it as `float` where it is read, or convert it with `round(...)`"
    if clash.flow.origin.how == "declared" and is_promised(clash.flow.origin.cell):
        owner = _owner(clash.flow.origin.cell)
        return f"change the type in the `input_keys` of {owner}, or where it is read"
    return f"write a value that fits `{wanted}`, or change the type where it is read"


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
