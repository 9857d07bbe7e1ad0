"""Rules over types: what is written must fit what is read (ir/fitting.py says what fits)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from smachac.analysis.context import Context
from smachac.analysis.type_inference import Cell, Clash, TypeFlow
from smachac.analysis.type_lattice import FLOAT, fits, inside, is_open, items, widened
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import guesser
from smachac.ir.types import Type


@rule("SM304", "type-mismatch", Severity.ERROR)
def type_mismatch(context: Context) -> Iterator[Finding]:
    """A value is written as one type and read as another.

    Types are those of the interfaces and of the script, of literals and of what functions return,
    followed through remaps and containers. An `int` fits a `float`, a `T` a `T?`, an enumeration
    one with more choices; `any` fits all. What does not fit fails in the middle of the task, or
    worse, is taken for something else.

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
    yield from clash_findings(context.clashes["type"])


MOST_PLACES = 6
"""So many of the other places one finding shows."""


def clash_findings(clashes: list[Clash]) -> Iterator[Finding]:
    """One finding for each value that fits none of its readers, else for each reader."""
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
        help=_help(clash),
        related=(*related, *(calls(about.node, span) if about.node is not None else ())),
        node=about.path,
    )


def _owner(cell: Cell) -> str:
    return f"`{cell.node.name}`" if cell.node is not None else "the base"


def _read(cell: Cell) -> str:
    """The type that a cell requires, in words."""
    wanted = f"`{cell.declared}`"
    match cell.role:
        case "input":
            return f"{_owner(cell)} reads `{cell.key}` as {wanted}"
        case "output":
            return f"{_owner(cell)} writes `{cell.key}` as {wanted}"
        case "variable":
            return f"the variable `{cell.key}` of {_owner(cell)} is {wanted}"
    return f"{_owner(cell)} holds `{cell.key}` as {wanted}"


def written(flow: TypeFlow) -> str:
    """What comes, and from whom, in words."""
    cell = flow.cell
    if flow.how == "declared":
        match cell.role:
            case "output":
                return f"{_owner(cell)} writes `{cell.key}` as `{flow.type}`"
            case "scope":
                return f"{_owner(cell)} holds `{cell.key}` as `{flow.type}`"
    what = in_words(flow.type)
    if flow.how == "computed":
        return f"`{cell.key}` of {_owner(cell)} becomes {what}"
    return f"`{cell.key}` is {what}"


def in_words(type_: Type) -> str:
    """A type as messages name it; literals as they are written."""
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
    """Which part does not fit, where it is not the whole."""
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if given == clash.flow.type or clash.misfit.kind == "unit":
        return ""
    return f": {in_words(given)} is no `{wanted}`"


HELP = {
    "Pose": "write a pose as `[[x, y, z], [qx, qy, qz, qw]]`",
    "Transform": "write a transform as `[[x, y, z], [qx, qy, qz, qw]]`",
    "Point": "write a point as `[x, y, z]`",
    "Quaternion": "write a rotation as `[qx, qy, qz, qw]`",
}


def _help(clash: Clash) -> str:
    given, wanted = clash.misfit.given, clash.misfit.wanted
    if clash.misfit.kind == "unit":
        return f"convert `{given}` to `{wanted}` on the way, or say the right unit at both places"
    if wanted.name == "one_of" and given.name == "literal":
        choices = [str(choice) for choice in wanted.args]
        guess = did_you_mean(guesser(choices)(str(given.args[0])))
        return guess or f"it is one of {', '.join(f'`{choice}`' for choice in choices)}"
    if clash.flow.how == "value" and wanted.name in HELP:
        return HELP[wanted.name]
    if given.name == "none":
        return f"give it a value, or let the reader take `{wanted}?`"
    if given.name == "optional" and fits(inside(given), wanted):
        return f"it may be absent: let the reader take `{given}`"
    if given.name == "float" and wanted.name == "int":
        return "a float fits no int: read it as `float`, or round it on the way"
    return f"write what fits `{wanted}`, or say another type where it is read"


def _remaps(clash: Clash) -> Iterator[tuple[Span, str]]:
    """The remaps that the value went through."""
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
                    text = f"`{remap.key}` of `{node.name}` is `{remap.to}` of `{around}`"
                    yield remap.span, text
