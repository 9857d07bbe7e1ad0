"""Two variables or inputs of a state whose values have changed places: each value fits the type of
the other one only (SM304)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import combinations
from typing import NamedTuple

from smachac.analysis.type_inference import Cell, Clash
from smachac.analysis.type_lattice import is_open, misfit
from smachac.checks.messages import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import NOWHERE, Span
from smachac.ir.nodes import Leaf, Remap
from smachac.ir.types import Type

MOST_CLASHES = 50
"""With more clashes, no swapped values are searched."""


class SwappedValues(NamedTuple):
    """Two clashes of one state whose values have changed places."""

    one: Clash
    other: Clash


def swapped_values(clashes: Iterable[Clash]) -> list[SwappedValues]:
    """The pairs of clashes whose values have changed places."""
    by_state: dict[tuple[str, str], dict[Cell, list[Clash]]] = {}
    every = list(clashes)
    for each in every if len(every) <= MOST_CLASHES else ():
        cell = each.cell
        if cell.role in ("variable", "input") and isinstance(cell.node, Leaf):
            by_state.setdefault((cell.path, cell.role), {}).setdefault(cell, []).append(each)
    found: list[SwappedValues] = []
    for unsorted in by_state.values():
        cells = {cell: unsorted[cell] for cell in sorted(unsorted, key=_position)}
        pairs = [
            SwappedValues(cells[one][0], cells[other][0])
            for one, other in combinations(cells, 2)
            if _fit(cells[one], other) and _fit(cells[other], one)
        ]
        found += pairs if len(pairs) == 1 and _text(pairs[0]) is not None else []
    return found


def _position(cell: Cell) -> int:
    """The place of a variable or of the entry of a remapping in its text."""
    remaps = cell.node.remaps if cell.node is not None else ()
    return next((each.span.start for each in remaps if each.key == cell.key), cell.span.start)


def _fit(clashes: list[Clash], other: Cell) -> bool:
    """Whether nothing that arrives at a cell fits its type, and all of it fits another's."""
    own = clashes[0].cell
    accepted = (flow for alike in own.flows.values() for flow in alike)
    return all(flow.origin.cell is own for flow in accepted) and all(
        _only_there(each.flow.type, own.declared, other.declared) for each in clashes
    )


def _only_there(given: Type, own: Type, other: Type) -> bool:
    known = not (is_open(given) or is_open(other))
    return known and misfit(given, own) is not None and misfit(given, other) is None


def swapped_findings(found: Iterable[SwappedValues]) -> Iterator[Finding]:
    """One finding for each pair, and of inputs without remappings one for each state type."""
    seen: set[Span] = set()
    for each in found:
        cell, other = each.one.cell, each.other.cell
        node, text = cell.node, _text(each)
        if text is None or node is None:
            continue
        span, what, help = text
        if span in seen:
            continue
        seen.add(span)
        yield Finding(
            span=span,
            message=f"{what} of `{cell.key}` and `{other.key}` have changed places",
            arguments=("swapped", cell.key, other.key),
            help=help,
            related=calls(node, span),
            node=cell.path,
        )


def _text(found: SwappedValues) -> tuple[Span, str, str] | None:
    """The place of two swapped values, what they are, and the help; None if it is not known where
    they are written."""
    cell, other = found.one.cell, found.other.cell
    node = cell.node
    assert isinstance(node, Leaf)
    if cell.role == "variable":
        one, two = found.one.flow.origin, found.other.flow.origin
        texts = one.span.text, two.span.text
        if one.how != "value" or two.how != "value" or "\n" in "".join(texts):
            return None
        help = f"write `{cell.key}: {texts[1]}, {other.key}: {texts[0]}`"
        return one.span, f"the values in `{node.name}`", help
    remaps = {remap.key: remap for remap in node.remaps}
    declared = _in_interface(node, cell.key, other.key)
    types = f"`{cell.key}: {other.declared}, {other.key}: {cell.declared}`"
    first, second = remaps.get(cell.key), remaps.get(other.key)
    if first is not None and second is not None:
        help = f"write {_swapped(first, second)}"
        if declared is not None:
            help += f", or {types} in the interface `{node.type}`"
        return first.to_span, f"the keys in the remapping of `{node.name}`", help
    if declared is None or first is not None or second is not None:
        return None
    return declared, f"the types in the interface `{node.type}`", f"write {types}"


def _swapped(one: Remap, other: Remap) -> str:
    return f"`{one.key}: {other.to}, {other.key}: {one.to}`"


def _in_interface(node: Leaf, *names: str) -> Span | None:
    """The place of the first of some input keys in the user's interface of a state."""
    spans = {key.name: key.span for key in node.inputs}
    places = [spans[name] for name in names if name in spans]
    theirs = all(each.source not in (node.span.source, NOWHERE.source) for each in places)
    return places[0] if places and theirs and not node.built_in else None
