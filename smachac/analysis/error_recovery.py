"""Error recovery: misspelt names are corrected, so that one fault gives one finding."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from collections.abc import Sequence as PathSequence
from dataclasses import replace
from operator import is_
from typing import NamedTuple, cast

from smachac.analysis.accesses import scripted_steps, userdata_fields
from smachac.analysis.control_flow import is_open
from smachac.diagnostics.spelling import guesser
from smachac.ir import nodes
from smachac.ir.leaf import functions, variable_of
from smachac.ir.nodes import Container, Key, Leaf, Machine, Node, Remap, StateMachine
from smachac.ir.traversal import outcome_names, outer_inputs, outer_outputs
from smachac.ir.types import ANY, Type


class UnknownRemap(NamedTuple):
    """A remap of an unknown key, the nearest known key, and that key again if it is certain."""

    remap: Remap
    meant: str | None
    certain: str | None


MOST_STATES = 200
"""In a container of more states, no key is meant because no other one is left: each search looks at
all states."""


def unknown_remaps(node: Node, around: Container | None = None) -> list[UnknownRemap]:
    """The remaps of keys that a state does not have. With the container `around` it, one that is
    like none of its keys means the only key of the state that can be meant."""
    if is_open(node) or not node.remaps:
        return []
    own = {key.name for key in (*node.inputs, *node.outputs)}
    own.update(lacking_inputs(node))
    wrong = [remap for remap in node.remaps if remap.key not in own]
    if wrong and isinstance(node, Leaf):  # SM308 and SM310 report keys that only the code uses
        used = {*undeclared_writes(node), *(key for key, _ in undeclared_reads(node))}
        wrong = [remap for remap in wrong if remap.key not in used]
    if not wrong:
        return []
    taken = {remap.key for remap in node.remaps}
    guess = guesser(sorted(own - taken))
    found = [UnknownRemap(each, guess(each.key), guess.sure(each.key)) for each in wrong]
    is_alone = len(found) == 1 and found[0].meant is None
    if is_alone and around is not None and len(around.children) <= MOST_STATES:
        return [found[0]._replace(meant=_lone_key(node, found[0].remap, around))]
    return found


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
        if is_open(child):
            return ()
        read.update(outer_inputs(child))
        set_.update(outer_outputs(child))
    return tuple(key for key in wrong if key in read - set_)


def _lone_key(node: Node, remap: Remap, around: Container) -> str | None:
    """The key of a state that an unknown name in a remapping is meant for: its only input that
    nothing in the container sets, if the container has the key that it is remapped to; its only
    output that nothing reads, if another state reads that key and nothing sets it."""
    taken = {each.key for each in node.remaps}
    set_ = {preset.key for preset in around.userdata} | {key.name for key in around.inputs}
    if isinstance(around, nodes.Iterator):
        set_.add(around.item_key)
    read = {key.name for key in around.outputs}
    for child in around.children:
        if is_open(child):
            return None
        set_.update(outer_outputs(child))
        if child is not node:
            read.update(outer_inputs(child))
    if remap.to in {key.name for key in (*node.inputs, *node.outputs)}:
        return None  # the entry is turned round
    if remap.to in set_:
        keys = [key.name for key in node.inputs if key.name not in set_]
    elif remap.to in read:
        keys = [key.name for key in node.outputs if key.name not in read]
    else:
        return None
    left = [key for key in dict.fromkeys(keys) if key not in taken]
    return left[0] if len(left) == 1 else None


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
        fields = userdata_fields(code.text)
        for key in fields.read if fields is not None else ():
            if key not in inputs:
                inputs.add(key)
                yield key, code


PERHAPS = Type("optional", (ANY,))
"""The type of a key that code reads without a declaration: used but not required (SM310)."""


def corrected_machine(
    machine: Machine,
    containers: PathSequence[tuple[str, Container]],
    correct: Callable[[str, Container], Container],
) -> Machine:
    """The machine with each container as `correct` returns it by its path. Iterative, so that
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
        built.append(correct(path, whole))
    root = cast(StateMachine, built.pop())
    return machine if root is machine.root else replace(machine, root=root)


def with_meant_keys(container: Container) -> Container:
    """A container with misspelt remaps of its states corrected, and with the keys declared that
    code of the script reads and writes in them."""
    raw = isinstance(container, nodes.Iterator)
    children = tuple(
        [
            _meant(child, container, raw=raw and isinstance(child, Leaf))
            if child.remaps or (isinstance(child, Leaf) and child.variables)
            else child
            for child in container.children
        ]
    )
    if all(map(is_, children, container.children)):
        return container
    return replace(container, children=children)


def _with_meant_writes(leaf: Leaf, wrong: tuple[str, ...]) -> Leaf:
    """A leaf with the misspelt keys of its callbacks corrected, where it has such an output that no
    callback sets."""
    held = variable_of(leaf, "callbacks")
    if held is None or not isinstance(held.value.data, nodes.Struct):
        return leaf
    entries = held.value.data.entries
    set_ = {key for key, _ in entries}
    guess = guesser([key.name for key in leaf.outputs if key.name not in set_])
    meant = {key: near for key in wrong if (near := guess(key)) is not None}
    if not meant:
        return leaf
    data = nodes.Struct(entries=tuple((meant.get(key, key), code) for key, code in entries))
    renamed = replace(held, value=replace(held.value, data=data))
    variables = tuple(renamed if each is held else each for each in leaf.variables)
    return replace(leaf, variables=variables)


def _meant(node: Node, around: Container, *, raw: bool) -> Node:
    """A state in a container with its remaps corrected and its keys declared. `raw`: it sees the
    keys of its container without remapping, as the child of an iterator does."""
    remaps = unknown_remaps(node, around) if node.remaps else []
    lacking = lacking_inputs(node)
    if lacking:
        more = (Key(name=key, span=node.span) for key in lacking)
        node = replace(node, inputs=(*node.inputs, *more))
    if remaps:
        own = {key.name for key in (*node.inputs, *node.outputs)}
        wrong = {
            each.remap: replace(each.remap, key=each.remap.to, to=each.remap.key)
            if each.remap.to in own and each.certain is None
            else replace(each.remap, key=each.meant or each.remap.key)
            for each in remaps
        }
        kept = (wrong.get(each, each) for each in node.remaps)
        node = replace(node, remaps=tuple(kept))
    if isinstance(node, Leaf) and not raw and not node.open:
        reads = tuple(
            Key(name=key, span=code.span, type=PERHAPS) for key, code in undeclared_reads(node)
        )
        dropped = undeclared_writes(node)
        if dropped:
            node = _with_meant_writes(node, dropped)
            dropped = undeclared_writes(node)
        writes = tuple(Key(name=key, span=node.span) for key in dropped)
        if reads or writes:
            node = replace(node, inputs=(*node.inputs, *reads), outputs=(*node.outputs, *writes))
    return node
