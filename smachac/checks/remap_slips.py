"""Entries of a remapping whose keys of the container have changed places, and those of keys that a
container reads but does not declare."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import PurePath

from smachac.analysis.unset_reads import Missing
from smachac.checks.messages import calls, other_place
from smachac.diagnostics.diagnostic import Finding
from smachac.diagnostics.source import NOWHERE
from smachac.diagnostics.spelling import words_of
from smachac.diagnostics.wording import both
from smachac.ir.nodes import Container, Node, Remap
from smachac.ir.traversal import inputs_from, outer_inputs, outer_outputs


def swapped_remap(missing: Missing, child: Node, remap: Remap) -> Remap | None:
    """The entry of an output of a state that has changed its place with `remap`, the entry of an
    input, to a key that nothing sets: the container sets the key of the other entry without this
    state, and another state reads the missing key, or the names belong to each other."""
    scope = missing.scope
    outputs = {key.name for key in child.outputs}
    if remap.key in outputs:
        return None
    set_ = {*scope.held, *scope.inputs}
    read = {*scope.outputs}
    for each in scope.container.children:
        if each is not child:
            set_.update(outer_outputs(each))
            read.update(outer_inputs(each))
    found = [
        each
        for each in child.remaps
        if each.key in outputs and each.to in set_
        if missing.key in read or _belong_crosswise(remap, each)
    ]
    return found[0] if len(found) == 1 else None


def _belong_crosswise(one: Remap, other: Remap) -> bool:
    first, second = words_of(one.key), words_of(other.key)
    return bool(first & words_of(other.to) and second & words_of(one.to))


def keys_of_swapped(missing: Iterable[Missing]) -> set[tuple[str, str]]:
    """The keys of the other entries of swapped ones, each with the path of its container."""
    return {
        (each.scope.path, other.to)
        for each in missing
        for child in each.scope.container.children
        for remap in child.remaps
        if remap.to == each.key and (other := swapped_remap(each, child, remap)) is not None
    }


def lacking_finding(path: str, node: Container, keys: Sequence[str]) -> Finding:
    """SM302 for keys in the remapping of a container that it lacks as inputs."""
    first = next(each for each in node.remaps if each.key in keys)
    source = node.children[0].span.source
    file = PurePath(source.name).name
    owner = f"`{node.name}`" if source is first.span.source else f"the state of `{file}`"
    inputs = [key.name for key in node.inputs if key.span.source is not NOWHERE.source]
    names = ", ".join([*inputs, *keys])
    readers = [(child, key) for child in node.children for key in inputs_from(child, first.key)]
    return Finding(
        span=first.span,
        message=f"`{node.name}` lacks the input key{'s' if len(keys) > 1 else ''} {both(keys)},"
        " which its states read",
        arguments=(first.key, first.to),
        help=f"write `input_keys: [{names}]` in {owner}",
        effect="a container gets only the keys that it declares: its states find the others unset",
        related=(
            *other_place(readers[0][0].span, f"`{readers[0][0].name}` reads `{first.key}`"),
            *calls(node, first.span),
        ),
        node=path,
    )
