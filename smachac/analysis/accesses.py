"""Userdata accesses: the keys that each state reads and writes.

The accesses of a leaf follow from its interface and from the functions and steps of the script.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.spelling import guesser
from smachac.ir import nodes
from smachac.ir.leaf import default_outcome, functions, key_names, variable_of
from smachac.ir.nodes import Container, Expression, Leaf, Node, Struct, VariableRole
from smachac.ir.outcome_names import PREEMPTED, fails
from smachac.ir.script_code import Fields, fields_of, script_code
from smachac.ir.traversal import remapping

NONE: frozenset[str] = frozenset()


class Writes(NamedTuple):
    """The keys that are set when a state ends with some outcome.

    `sure`: always. `trusted`: always, if stand-ins and unknown code do what they declare; rules use
    these, so that no finding rests on what is not known. `perhaps`: possibly. `anything`: unknown
    code can set any key.
    """

    sure: frozenset[str] = NONE
    trusted: frozenset[str] = NONE
    perhaps: frozenset[str] = NONE
    anything: bool = False


NOTHING = Writes()
ANYTHING = Writes(anything=True)


def leaf_reads(leaf: Leaf, *, raw: bool = False) -> tuple[str, ...]:
    """The keys, under the leaf's names, that must be set when it is entered.

    These are its declared inputs except optional ones; keys with the role `argument` only if a
    function of the script reads them, or can read them because its code is not known. `raw`: the
    leaf sees every key of its container, as the child of an iterator does (docs/semantics.md,
    Iterator).
    """
    if leaf.open or not (leaf.inputs or raw):
        return ()
    needed = tuple(key.name for key in leaf.inputs if key.type.name != "optional")
    arguments = key_names(leaf.inputs, "argument")
    if not leaf.variables:
        return tuple(key for key in needed if key not in arguments) if arguments else needed
    callbacks, conditions = functions(leaf, "callbacks"), functions(leaf, "conditions")
    if callbacks is None or conditions is None:
        return needed
    order = [(key, callbacks[key]) for key in sorted(callbacks)]
    order += [(name, conditions[name]) for name in _names(leaf) if name in conditions]
    found: dict[str, None] = {}
    written: set[str] = set()
    for fields in _fields_of_functions(leaf) if arguments else ():
        read = needed if fields is None else [key for key in fields.read if key in needed]
        found |= {key: None for key in read if fields is None or key not in fields.tested}
    for name, code in order:
        fields = script_code(code.text).fields
        reads = needed if fields is None else fields.read
        optional = NONE if fields is None else fields.tested
        found |= {
            key: None
            for key in reads
            if key not in written and key not in optional and (raw or key in needed)
        }
        if name in callbacks:
            written.add(name)
    found |= {key: None for key in needed if key not in written and key not in arguments}
    return tuple(found)


def _fields_of_functions(leaf: Leaf) -> Iterator[Fields | None]:
    """The keys that each function of a leaf reads, other than callbacks and conditions; None if
    they are not known."""
    for held in leaf.variables:
        data = held.value.data
        if held.takes_userdata and isinstance(data, str | Expression):
            text = data if isinstance(data, str) else data.text
            tree = script_code(text.strip().strip("`")).tree
            known: Fields | None = None
            if isinstance(tree, ast.Lambda):
                names = [argument.arg for argument in (*tree.args.posonlyargs, *tree.args.args)]
                known = fields_of(tree.body, names[:1]) if names else None
            yield known


def leaf_writes(leaf: Leaf, outcome: str, *, raw: bool = False) -> Writes:
    """The keys, under the leaf's names, that are set when it ends with an outcome.

    An exception can be raised before any of them is written, or after.
    """
    if leaf.open:
        return ANYTHING
    if not (leaf.outputs or raw):
        return NOTHING
    if outcome == leaf.catches:
        begun = {key.name for key in leaf.outputs}
        if raw:
            begun.update(callback_names(leaf), *(keys for _, keys in scripted_steps(leaf)))
        return Writes(perhaps=frozenset(begun))
    outputs = frozenset([key.name for key in leaf.outputs])
    if leaf.stand_in:
        return _scripted(leaf, outcome, outputs, raw)
    called = callback_names(leaf) if raw else callback_names(leaf) & outputs
    if not outputs and not called:
        return NOTHING
    listed = frozenset(key for _, keys in leaf.writes for key in keys)
    here = frozenset(key for name, keys in leaf.writes for key in keys if name == outcome)
    unlisted = outputs - listed
    results = key_names(leaf.outputs, "result")
    unlisted -= unreceived_outputs(leaf)
    trusted = NONE
    if results and functions(leaf, "callbacks") is not None:
        unlisted -= results
        held = variable_of(leaf, "output_function")
        trusted = results if held is not None and held.value.data is not None else NONE
    sure = called | (here & outputs)
    if outcome != PREEMPTED:
        sure |= unlisted - _never_set(leaf, outcome) if not raw else unlisted
    perhaps = unlisted | sure | trusted
    if outcome == PREEMPTED or fails(leaf, outcome):
        trusted = NONE
    return Writes(sure, sure | trusted, perhaps)


def received_part(leaf: Leaf) -> VariableRole | None:
    """What a state with a service or an action receives: the role of the variable that lists the
    output keys for its fields."""
    if variable_of(leaf, "service_type") is not None:
        return "response"
    return "result" if variable_of(leaf, "action_type") is not None else None


def unreceived_outputs(leaf: Leaf) -> frozenset[str]:
    """The outputs of a built-in state with a service or an action that nothing in it sets: they are
    not listed for fields of the response or result, and no function of the script sets them."""
    if not leaf.built_in or not leaf.outputs or leaf.open or leaf.stand_in:
        return NONE
    role = received_part(leaf)
    if role is None:
        return NONE
    held = variable_of(leaf, role)
    listed = () if held is None or held.value.data is None else held.value.data
    if not isinstance(listed, tuple) or None in _fields_of_functions(leaf):
        return NONE  # a function that passes userdata on can set its keys
    names = [text for text in listed if isinstance(text, str)]
    left = [key.name for key in leaf.outputs if key.name not in names]
    if not left or len(names) < len(listed):
        return NONE
    near = guesser(names)
    return frozenset(key for key in left if near(key) is None)


def _never_set(leaf: Leaf, outcome: str) -> frozenset[str]:
    """The outputs that the class of the user does not always set before an outcome. An output that
    it never sets, or not where `writes:` promises it, is SM314."""
    facts = leaf.class_facts
    if facts is None or leaf.built_in:
        return NONE
    outputs = {key.name for key in leaf.outputs}
    if any(word.text not in outputs for word in facts.writes):  # probably misspelt: SM308
        return NONE
    ever = NONE.union(*(ending.written or NONE for ending in facts.endings))
    known = [ending.written for ending in facts.endings if ending.outcome.text == outcome]
    return NONE.union(*(ever - keys for keys in known if keys is not None))


def _scripted(leaf: Leaf, outcome: str, outputs: frozenset[str], raw: bool) -> Writes:
    """What the steps of a stand-in set. A key that no step sets can be set by the real state."""
    steps = list(scripted_steps(leaf))
    ever = frozenset(key for _, keys in steps for key in keys)
    sets = [frozenset(keys) for name, keys in steps if name == outcome]
    if not raw:
        sets = [keys & outputs for keys in sets]
    perhaps = frozenset(outputs if not sets else (outputs - ever)).union(*sets)
    if outcome == PREEMPTED:
        # A request to stop causes it without a step.
        return Writes(NONE, NONE, perhaps)
    sure = frozenset.intersection(*sets) if sets else NONE
    return Writes(sure, sure | (outputs if not sets else outputs - ever), perhaps)


def scripted_steps(leaf: Leaf) -> Iterable[tuple[str, tuple[str, ...]]]:
    """The outcome and the keys of each step of a leaf."""
    held = variable_of(leaf, "steps")
    data = held.value.data if held is not None else ()
    for step in data if isinstance(data, tuple) else ():
        listed = dict(step.entries) if isinstance(step, Struct) else {}
        outcome, sets = listed.get("outcome"), listed.get("set")
        keys = tuple(key for key, _ in sets.entries) if isinstance(sets, Struct) else ()
        yield outcome if isinstance(outcome, str) else default_outcome(leaf), keys


def _names(leaf: Leaf) -> tuple[str, ...]:
    return tuple(outcome.name for outcome in leaf.outcomes)


def callback_names(leaf: Leaf) -> frozenset[str]:
    """The keys for which a leaf has callbacks, also those whose value is no code."""
    held = variable_of(leaf, "callbacks")
    data = held.value.data if held is not None else None
    return frozenset(key for key, _ in data.entries) if isinstance(data, Struct) else NONE


Keys = dict[str, Node]
"""Keys, under the names they have around the state, with the innermost node that accesses each."""


class Accesses(NamedTuple):
    """The keys of the userdata around a state that it can read and can write."""

    reads: Keys
    writes: Keys


NO_ACCESSES = Accesses({}, {})
"""The accesses of a leaf without keys, which many have."""


def accesses(states: Sequence[tuple[str, Node]]) -> dict[str, Accesses]:
    """The accesses of every state, by path.

    A leaf may read and write the keys it declares, at any time. A container copies its inputs when
    it starts, and its outputs when it ends (docs/semantics.md, Userdata); it counts as reading
    the inputs that something in it reads, and as writing the outputs that it takes in or that
    something in it writes.
    """
    found: dict[str, Accesses] = {}
    for path, node in reversed(states):
        has_keys = node.inputs or node.outputs or not isinstance(node, Leaf)
        found[path] = around(node, inside(path, node, found)) if has_keys else NO_ACCESSES
    return found


def inside(path: str, node: Node, known: Mapping[str, Accesses]) -> Accesses:
    """The accesses of the nodes inside a state to the state's own userdata."""
    if isinstance(node, Leaf):
        return Accesses(
            {key.name: node for key in node.inputs}, {key.name: node for key in node.outputs}
        )
    reads: Keys = {}
    writes: Keys = {}
    for child in node.children:
        if isinstance(child, Leaf) and not (child.inputs or child.outputs):
            continue
        own = known[f"{path}/{child.name}"]
        for key, origin in own.reads.items():
            reads.setdefault(key, origin)
        for key, origin in own.writes.items():
            writes.setdefault(key, origin)
    if isinstance(node, nodes.Iterator):
        writes.setdefault(node.item_key, node)
        if node.items_key:
            reads.setdefault(node.items_key, node)
    return Accesses(reads, writes)


def around(node: Node, own: Accesses) -> Accesses:
    """The accesses to a state's own userdata that are also accesses to the userdata around it."""
    if isinstance(node, Leaf):
        if not node.remaps:
            return own
        return Accesses(_renamed(node, own.reads), _renamed(node, own.writes))
    inputs = {key.name for key in node.inputs}
    held = {*inputs, *(preset.key for preset in node.userdata)}
    outputs = [key.name for key in node.outputs]
    reads = {key.name: own.reads[key.name] for key in node.inputs if key.name in own.reads}
    written = (key for key in outputs if key in own.writes or key in held)
    writes = {key: own.writes.get(key, node) for key in written}
    return Accesses(_renamed(node, reads), _renamed(node, writes))


def _renamed(node: Node, keys: Keys) -> Keys:
    if not node.remaps:
        return keys
    names = remapping(node)
    found: Keys = {}
    for key, origin in keys.items():
        found.setdefault(names[key], origin)
    return found


def leaves_with_code(path: str, container: Container) -> Iterator[tuple[str, Leaf]]:
    """The leaves in a container that have variables and can use only declared keys: all but open
    ones and the children of iterators that the script writes."""
    raw = isinstance(container, nodes.Iterator) and not container.sugar
    for child in container.children if not raw else ():
        if isinstance(child, Leaf) and child.variables and not child.open:
            yield f"{path}/{child.name}", child
