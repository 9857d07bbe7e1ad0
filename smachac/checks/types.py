"""Rules over types: what is written must fit what is read (ir/fitting.py says what fits)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import pairwise

from smachac.analysis.context import once, types_of
from smachac.analysis.reaching_values import Arrivals
from smachac.analysis.type_inference import Clash, Flow, Place
from smachac.analysis.type_lattice import FLOAT, Kind, fits, inside, is_open, items, widened
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.diagnostics.diagnostic import Finding, Related, Severity, rule
from smachac.diagnostics.source import NOWHERE, Span
from smachac.diagnostics.spelling import guesser
from smachac.ir.nodes import Machine
from smachac.ir.types import Type


@once
def _arriving(machine: Machine) -> dict[Kind, list[Clash]]:
    arrivals = Arrivals()
    found: dict[Kind, list[Clash]] = {"type": [], "length": [], "unit": []}
    for clash in types_of(machine).clashes:
        arrived = arrivals.arrived(clash)
        if arrived is not None:
            found[clash.misfit.kind].append(arrived)
    return found


def clashes_of(machine: Machine, kind: Kind) -> list[Clash]:
    """The clashes of one kind whose value can be there when it is read."""
    return _arriving(machine)[kind]


@rule("SM304", "type-mismatch", Severity.ERROR)
def type_mismatch(machine: Machine) -> Iterator[Finding]:
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
    yield from clash_findings(clashes_of(machine, "type"))


MOST_PLACES = 6
"""So many of the other places one finding shows."""


def clash_findings(clashes: list[Clash]) -> Iterator[Finding]:
    """One finding for each value that fits none of its readers, else for each reader."""
    origins = Counter(id(_root(clash)) for clash in clashes)
    readers = Counter(id(clash.place) for clash in clashes)
    groups: dict[tuple[str, int], list[Clash]] = {}
    for clash in clashes:
        origin, reader = id(_root(clash)), id(clash.place)
        literal = _root(clash).how == "value"
        if origins[origin] > readers[reader] or (literal and origins[origin] == readers[reader]):
            groups.setdefault(("origin", origin), []).append(clash)
        else:
            groups.setdefault(("reader", reader), []).append(clash)
    for (side, _), group in groups.items():
        yield _finding(group, at_origin=side == "origin")


def _root(clash: Clash) -> Flow:
    return clash.flow.origin


def _finding(group: list[Clash], *, at_origin: bool) -> Finding:
    clash = group[0]
    origin, place = clash.flow.origin, clash.place
    about = origin.place if at_origin else place
    span = origin.span if at_origin else place.span
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
            show(each.place.span, _read(each.place))
    first, second = written(origin), _read(place)
    message = f"{first}, but {second}" if at_origin else f"{second}, but {first}"
    return Finding(
        span=span,
        message=message + _part(clash),
        help=_help(clash),
        related=(*related, *(calls(about.node, span) if about.node is not None else ())),
        node=about.path,
    )


def _owner(place: Place) -> str:
    return f"`{place.node.name}`" if place.node is not None else "the base"


def _read(place: Place) -> str:
    """What a place asks for, in words."""
    wanted = f"`{place.declared}`"
    match place.role:
        case "input":
            return f"{_owner(place)} reads `{place.key}` as {wanted}"
        case "output":
            return f"{_owner(place)} writes `{place.key}` as {wanted}"
        case "variable":
            return f"the variable `{place.key}` of {_owner(place)} is {wanted}"
    return f"{_owner(place)} holds `{place.key}` as {wanted}"


def written(flow: Flow) -> str:
    """What comes, and from whom, in words."""
    place = flow.place
    if flow.how == "declared":
        match place.role:
            case "output":
                return f"{_owner(place)} writes `{place.key}` as `{flow.type}`"
            case "scope":
                return f"{_owner(place)} holds `{place.key}` as `{flow.type}`"
    what = in_words(flow.type)
    if flow.how == "computed":
        return f"`{place.key}` of {_owner(place)} becomes {what}"
    return f"`{place.key}` is {what}"


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
    chain: list[Place] = [clash.place]
    flow: Flow | None = clash.flow.before
    while flow is not None:
        chain.append(flow.place)
        flow = flow.before
    for inner, outer in pairwise(chain):
        for place, other in ((inner, outer), (outer, inner)):
            node = place.node
            if node is None or len(place.path) <= len(other.path):
                continue
            for remap in node.remaps:
                if remap.key == place.key and remap.span.source is not NOWHERE.source:
                    around = other.node.name if other.node is not None else "the base"
                    text = f"`{remap.key}` of `{node.name}` is `{remap.to}` of `{around}`"
                    yield remap.span, text
