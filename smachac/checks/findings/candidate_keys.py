"""Keys that are meant by one that nothing sets: outputs that nothing reads, and keys of the type
that is read (SM301)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.type_inference import Types
from smachac.analysis.type_lattice import is_unknown, misfit
from smachac.checks.findings.help_text import added_remapping
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import words_of
from smachac.ir import nodes
from smachac.ir.nodes import Container
from smachac.ir.traversal import outer_outputs, remapping
from smachac.ir.types import ANY, Type


def keys_around(container: Container) -> set[str]:
    """The keys of a container that it gets, or that a state in it sets."""
    found = {preset.key for preset in container.userdata} | {key.name for key in container.inputs}
    if isinstance(container, nodes.Iterator):
        return found - {container.item_key}
    for child in container.children:
        found.update(outer_outputs(child))
    return found


class UnreadOutput(NamedTuple):
    """An output that nothing reads, with its name in the container, the place of its state or
    remapping, the help that names it, and the state that sets it."""

    key: str
    place: Span
    help: str
    setter: str


def unread_output(scope: UserdataScope, missing: str) -> UnreadOutput | None:
    """The only output in a container that nothing reads and that has a word of the missing key:
    `pose` for `found_pose`."""
    words = words_of(missing)
    found = [output for output in unread_outputs(scope, missing) if words & words_of(output.key)]
    return found[0] if len(found) == 1 else None


def unread_outputs(scope: UserdataScope, missing: str) -> Iterator[UnreadOutput]:
    """The outputs of states of a container that nothing in it reads."""
    read = {*chain.from_iterable(scope.reads.values()), *scope.outputs}
    for child in scope.container.children:
        names = remapping(child)
        for key in child.outputs:
            outer = names[key.name]
            if outer in read:
                continue
            help = f"nothing reads `{outer}`, which `{child.name}` sets: did you mean it?"
            if key.name not in names:
                help = f"{added_remapping(child, key.name, missing)}, whose `{key.name}` nothing"
                help += " reads"
            place = next((remap.to_span for remap in child.remaps if remap.to == outer), child.span)
            yield UnreadOutput(outer, place, help, child.name)


def may_be(types: Types, scope: UserdataScope, key: str, wanted: Type) -> bool:
    """Whether the type of a key of a container, as far as it is known, is not a wrong one."""
    given = types.keys.get((scope.path, key), ANY)
    return is_unknown(given) or is_unknown(wanted) or misfit(given, wanted) is None


SCALARS = frozenset(["bool", "int", "float", "str"])
"""The names of types that say little about what a value means."""
