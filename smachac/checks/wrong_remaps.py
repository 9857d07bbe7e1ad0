"""Remappings to a key of another type, where the right key is known (SM304): other states read the
key that the remapping names, and one other key of the container has the type."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.type_inference import Clash
from smachac.analysis.type_lattice import widened
from smachac.checks.candidate_keys import keys_of_type
from smachac.checks.messages import calls
from smachac.diagnostics.diagnostic import Finding
from smachac.ir.nodes import Container, Leaf, Remap
from smachac.ir.traversal import outer_inputs
from smachac.ir.types import Type


class WrongRemap(NamedTuple):
    """A remapping whose key does not fit, and the key that is meant."""

    clash: Clash
    node: Leaf
    remap: Remap
    meant: str


def wrong_remaps(context: Context, clashes: Sequence[Clash]) -> Iterator[WrongRemap]:
    """Those among values of a wrong type. A value that fits several readers badly is wrong
    itself."""
    origins = Counter(clash.flow.origin for clash in clashes)
    counts: dict[str, Counter[str]] = {}
    of_type: dict[tuple[str, Type], list[str]] = {}
    for clash in clashes:
        node, cell = clash.cell.node, clash.cell
        if cell.role != "input" or not isinstance(node, Leaf) or origins[clash.flow.origin] > 1:
            continue
        remap = next((each for each in node.remaps if each.key == cell.key), None)
        scope = context.corrected_flow.scopes.get(cell.path.rpartition("/")[0])
        if remap is None or scope is None:
            continue
        if scope.path not in counts:
            counts[scope.path] = _readers(scope.container)
        place = scope.path, cell.declared
        if place not in of_type:
            of_type[place] = keys_of_type(context.types, scope, cell.declared)
        own = {each.to for each in node.remaps}
        meant = [each for each in of_type[place] if each not in own]
        if counts[scope.path][remap.to] > 1 and len(meant) == 1:
            yield WrongRemap(clash, node, remap, meant[0])


def _readers(container: Container) -> Counter[str]:
    """How many states of a container read each key."""
    found: Counter[str] = Counter()
    for child in container.children:
        found.update({*outer_inputs(child)})
    return found


def wrong_remap_finding(found: WrongRemap) -> Finding:
    """SM304 at the remapping."""
    clash, node, remap, meant = found
    given, wanted = widened(clash.flow.type), clash.cell.declared
    return Finding(
        span=remap.to_span,
        message=f"`{remap.key}` of `{node.name}` is remapped to `{remap.to}`, which is `{given}`,"
        f" but `{node.name}` reads `{remap.key}` as `{wanted}`",
        arguments=(remap.key, str(given), str(wanted)),
        help=f"write `{remap.key}: {meant}`: only `{meant}` has this type",
        related=calls(node, remap.span),
        node=clash.cell.path,
    )
