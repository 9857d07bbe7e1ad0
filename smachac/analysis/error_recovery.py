"""Error recovery for userdata: unknown keys are absorbed, so that one fault gives one finding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Sequence as PathSequence
from collections.abc import Set as AbstractSet
from operator import is_
from typing import cast

from smachac.analysis.accesses import scripted_steps
from smachac.analysis.control_flow import has_no_interface
from smachac.diagnostics.source import NOWHERE
from smachac.ir import nodes
from smachac.ir.leaf import functions
from smachac.ir.nodes import (
    Container,
    Key,
    Leaf,
    Machine,
    Node,
    Preset,
    Remap,
    StateMachine,
    Value,
)
from smachac.ir.script_code import script_code
from smachac.ir.traversal import outcome_names, outer_inputs, outer_outputs
from smachac.ir.types import ANY, Type
from smachac.records import replace


def unknown_remaps(node: Node) -> list[Remap]:
    """The remaps of keys that a state does not have. Those of keys that only code of the script
    uses are reported as such (SM308, SM310)."""
    if not node.remaps or has_no_interface(node):
        return []
    own = {key.name for key in (*node.inputs, *node.outputs)}
    own.update(lacking_inputs(node))
    wrong = [remap for remap in node.remaps if remap.key not in own]
    if wrong and isinstance(node, Leaf):
        own |= {*undeclared_writes(node), *(key for key, _ in undeclared_reads(node))}
    return [remap for remap in wrong if remap.key not in own]


def is_around_open(node: Node) -> bool:
    """Whether a container was made for the sugar of a state whose keys are not known."""
    return (
        not isinstance(node, Leaf)
        and bool(node.sugar)
        and any(map(has_no_interface, node.children))
    )


def lacking_inputs(node: Node) -> tuple[str, ...]:
    """The keys that a container lacks as inputs: its remapping has them, its states read them, and
    nothing in it sets them."""
    if isinstance(node, Leaf) or node.sugar or not node.remaps:
        return ()
    own = {key.name for key in (*node.inputs, *node.outputs)}
    wrong = [remap.key for remap in node.remaps if remap.key not in own]
    read: set[str] = set()
    set_ = {preset.key for preset in node.userdata}
    if isinstance(node, nodes.Iterator):
        set_.add(node.item_key)
    for child in node.children if wrong else ():
        if has_no_interface(child):
            return ()
        read.update(outer_inputs(child))
        set_.update(outer_outputs(child))
    return tuple(key for key in wrong if key in read - set_)


def undeclared_writes(leaf: Leaf) -> tuple[str, ...]:
    """The keys that the script makes a leaf write although they are not among its outputs."""
    if not leaf.variables:
        return ()
    written = sorted(functions(leaf, "callbacks") or ())
    written += [key for _, keys in scripted_steps(leaf) for key in keys]
    outputs = {key.name for key in leaf.outputs}
    return tuple(key for key in dict.fromkeys(written) if key not in outputs)


def undeclared_reads(leaf: Leaf) -> Iterator[tuple[str, nodes.Expression]]:
    """The keys that code of the script reads although they are not among the leaf's inputs."""
    if not leaf.variables:
        return
    called = sorted((functions(leaf, "callbacks") or {}).items())
    conditions = functions(leaf, "conditions")
    if conditions:
        outcomes = outcome_names(leaf)
        called += sorted(item for item in conditions.items() if item[0] in outcomes)
    if not called:
        return
    inputs = {key.name for key in leaf.inputs}
    for _, code in called:
        fields = script_code(code.text).fields
        for key in fields.read if fields is not None else ():
            if key not in inputs:
                inputs.add(key)
                yield key, code


PERHAPS = Type("optional", (ANY,))
"""The type of a key that can be used but is not required."""

UNKNOWN = Value(data=None, span=NOWHERE)
"""A value that is not known."""


def absorbed_machine(
    machine: Machine,
    containers: PathSequence[tuple[str, Container]],
    absorb: Callable[[str, Container], Container],
) -> Machine:
    """The machine with each container as `absorb` returns it by its path. Iterative, so that
    nesting can be deep."""
    # In reversed preorder the containers inside one have just been built, its first child last.
    built: list[Container] = []
    for path, container in reversed(containers):
        children = tuple(
            [child if isinstance(child, Leaf) else built.pop() for child in container.children]
        )
        whole = container
        if not all(map(is_, children, container.children)):
            whole = replace(container, children=children)
        built.append(absorb(path, whole))
    root = cast(StateMachine, built.pop())
    return machine if root is machine.root else replace(machine, root=root)


def absorbed_keys(container: Container) -> Container:
    """A container in which nothing follows from an unknown key: its states have the keys of their
    remappings and of the code of the script, and need no input that such an entry can be meant
    for."""
    raw = isinstance(container, nodes.Iterator)
    children = tuple(
        [
            _absorbed(child, raw=raw and isinstance(child, Leaf))
            if child.remaps or (isinstance(child, Leaf) and child.variables)
            else child
            for child in container.children
        ]
    )
    if all(map(is_, children, container.children)):
        return container
    return replace(container, children=children)


def _absorbed(node: Node, *, raw: bool) -> Node:
    """A state with the keys that it lacks. `raw`: it sees the keys of its container without
    remapping, as the child of an iterator does."""
    inputs = [Key(name=key, span=node.span) for key in lacking_inputs(node)]
    outputs: list[Key] = []
    unknown = unknown_remaps(node)
    for remap in unknown:
        inputs.append(Key(name=remap.key, span=remap.span, type=PERHAPS))
        outputs.append(Key(name=remap.key, span=remap.span))
    if isinstance(node, Leaf) and not raw and not node.open:
        reads = undeclared_reads(node)
        inputs += (Key(name=key, span=code.span, type=PERHAPS) for key, code in reads)
        outputs += (Key(name=key, span=node.span) for key in undeclared_writes(node))
    if unknown:
        node = _without_needs(node, {remap.key for remap in node.remaps})
    if not inputs and not outputs:
        return node
    return replace(node, inputs=(*node.inputs, *inputs), outputs=(*node.outputs, *outputs))


def _without_needs(node: Node, remapped: AbstractSet[str]) -> Node:
    """A state that needs no input but those that are remapped."""
    inputs = tuple(
        key if key.name in remapped else replace(key, type=PERHAPS) for key in node.inputs
    )
    if isinstance(node, Leaf):
        return replace(node, inputs=inputs)
    free = (key for key in node.inputs if key.name not in remapped)
    presets = (Preset(key=key.name, value=UNKNOWN, span=key.span) for key in free)
    return replace(node, inputs=inputs, userdata=(*node.userdata, *presets))
