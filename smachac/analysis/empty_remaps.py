"""Remappings to a key that nothing sets, of keys that a state can work without: its optional input
keys. The others are unset reads (unset_reads.py)."""

from __future__ import annotations

from functools import cache

from smachac.analysis.def_use import around
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.unset_reads import Missing, provided_keys
from smachac.ir import nodes
from smachac.ir.nodes import Node, Remap
from smachac.records import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class EmptyRemap:
    """A remapping in a container to a key that nothing in it sets. `other` is the path of the
    nearest container around that has a key of this name; empty if there is none."""

    scope: UserdataScope
    child: Node
    remap: Remap
    other: str


def empty_remaps(flow: DataFlow, missing: tuple[Missing, ...]) -> tuple[EmptyRemap, ...]:
    """The empty remappings of states that can be entered, in the order of the script. `missing`
    are the unset reads, about which other findings are."""
    known = {(each.scope.path, each.key) for each in missing}
    provided = cache(lambda path: provided_keys(flow.scopes[path]))
    found = []
    for path, scope in flow.scopes.items():
        if path not in flow.entered or isinstance(scope.container, nodes.Iterator):
            continue
        for child in scope.children.values():
            if not child.remaps or child.name not in scope.vertices:
                continue
            for remap in child.remaps:
                if remap.to in scope.held or remap.to in scope.inputs or (path, remap.to) in known:
                    continue
                if all(key.name != remap.key for key in child.inputs):
                    continue
                if provided(path).has(remap.to):
                    continue
                outer = around(flow, path)
                while outer is not None and remap.to not in provided(outer).keys:
                    outer = around(flow, outer)
                found.append(EmptyRemap(scope=scope, child=child, remap=remap, other=outer or ""))
    return tuple(found)
