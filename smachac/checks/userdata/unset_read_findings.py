"""The finding about a key that a state reads where it may be unset (SM301): its help, its path, and
the places that belong to it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from itertools import islice

from smachac.analysis.def_use import written_on
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.type_inference import Types
from smachac.analysis.type_lattice import is_unknown
from smachac.analysis.unset_reads import Missing, Witness, container_name, reader_at
from smachac.checks.findings import notation
from smachac.checks.findings.candidate_keys import may_be, unread_output
from smachac.checks.findings.edits import likely, listing, with_field, with_input, with_remapping
from smachac.checks.findings.help_text import added_remapping, calls, other_place
from smachac.checks.userdata.initial_presets import counts, initial_value
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.spelling import guesser, words_of
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import Container, Node
from smachac.ir.script_code import script_code
from smachac.ir.traversal import outcome_names, outer_inputs
from smachac.ir.types import ANY, Type

MOST_RELATED = 3
"""Limit on the related places of one kind in a finding."""


def _item_place(container: Container, reader: Node) -> tuple[Related, ...]:
    """The place of the name of the item, where the loop around the reader or the reader itself has
    one that the script names."""
    loop = reader if isinstance(reader, nodes.Iterator) else container
    if not isinstance(loop, nodes.Iterator) or loop.sugar == "retry" or not loop.item_key:
        return ()
    if loop is reader and loop.sugar != "for_each":
        return ()
    return other_place(loop.item_span, f"the loop calls its item `{loop.item_key}`")


def unset_read(
    flow: DataFlow,
    missing: Missing,
    witness: Witness,
    types: Types,
    *,
    is_searched: bool,
) -> Finding:
    """SM301 for a key where a state reads it. `is_searched`: an output that nothing reads is
    searched in the whole container."""
    scope, reader, name = missing.scope, witness.reader, missing.scope.container.name
    why = f"which is unset on {'every path' if witness.always else 'some paths'}"
    initial = (missing.key, initial_value(types, reader, missing))
    value = f"`{notation.initial_values(scope.container, [initial])}`"
    where = "on every path" if witness.always else "on this path too,"
    help = (
        f"set `{missing.key}` {where} before `{reader.node.name}`, or give it an initial value in"
    )
    help += f" `{name}`: {value}"
    is_counter = missing.cause == "unset" and counts(missing)
    if is_counter:
        help = f"give `{missing.key}` an initial value in `{name}`: {value}"
    related: tuple[Related, ...] = ()
    fitting: list[str] = []
    if not (is_counter or witness.always) and len(witness.path) > 2 and witness.path[-2].is_outcome:
        before, outcome = witness.path[-3], witness.path[-2].label.strip("()")
        if any(use.path == before.node for use in scope.uses.writers(missing.key)):
            help = f"lead `{outcome}` of `{before.label}` to another state, {help}"
    if missing.cause == "nowhere":
        why = f"which nothing in {container_name(scope, reader.span)} sets"
        unread = unread_output(scope, missing.key) if is_searched else None
        fitting = _fitting_keys(missing, witness, types) if is_searched else []
        if isinstance(reader.node, nodes.Iterator) and isinstance(
            script_code(missing.key).tree, ast.Lambda
        ):
            help = f"quotes make it the name of a key: write code as '`{missing.key}`'"
        elif unread is not None:
            help, related = unread.help, other_place(unread.place, f"nothing reads `{unread.key}`")
        elif fitting:
            help = ", or ".join(added_remapping(reader.node, reader.key, key) for key in fitting)
        related += _item_place(scope.container, reader.node)
    repairs = [
        repair
        for key in fitting
        for repair in likely(with_remapping(reader.node, reader.key, key), "remap a key")
    ]
    if _has_outer_value(flow, missing):
        help = f"{listing([scope.container], 'input_keys', missing.key)}, or {help}"
        repairs += likely(with_input(scope.container, missing.key), "take the key in")
    is_sugared = missing.cause == "nowhere" and not fitting and not notation.is_python(reader.node)
    for items in _unread_lists(scope) if is_sugared else ():
        field = f"for_each: {{item: {missing.key}, in: {items}}}"
        help = f"write `{field}` in `{reader.node.name}`, or {help}"
        repairs += likely(with_field(reader.node.span, field), "run for each item")
    return Finding(
        span=reader.span,
        message=f"{reader.words}, {why}",
        arguments=(reader.key,),
        help=help,
        related=(
            *_readers(missing, witness),
            *_writers(flow, missing),
            *related,
            *calls(reader.node, reader.span),
        ),
        path=witness.path if len(witness.path) > 1 else (),
        severity=None if witness.always else Severity.WARNING,
        node=reader.path,
        repairs=tuple(repairs),
    )


def _has_outer_value(flow: DataFlow, missing: Missing) -> bool:
    """Whether a key is an output of its container, and the container around has a value for it."""
    scope, outer = missing.scope, missing.scope.outputs.get(missing.key)
    if missing.key in scope.inputs:
        return False
    around = flow.scopes.get(scope.path.rpartition("/")[0])
    while around is not None and around.container.sugar:
        outer = around.outputs.get(outer or "")
        around = flow.scopes.get(around.path.rpartition("/")[0])
    return around is not None and outer in around.held


def _unread_lists(scope: UserdataScope) -> list[str]:
    """The presets of a container that are lists and that nothing reads."""
    lists = [preset.key for preset in scope.container.userdata
             if isinstance(preset.value.data, tuple) and preset.value.data]  # fmt: skip
    return [key for key in lists if key not in scope.uses.read and key not in scope.outputs]


MOST_PROPOSED = 3
"""Of more keys that can be read in place of one, none is proposed."""


def _fitting_keys(missing: Missing, witness: Witness, types: Types) -> list[str]:
    """The keys that a state can read in place of a key of its interface which nothing sets."""
    reader = witness.reader
    declared = next((key for key in reader.node.inputs if key.name == missing.key), None)
    if declared is None or declared.span.source is reader.node.span.source:
        return []
    wanted = types.inputs.get((reader.path, reader.key), ANY)
    if witness.inner is not None and is_unknown(wanted):
        wanted = types.inputs.get((witness.inner.path, witness.inner.key), ANY)
    return fitting_keys(types, missing, reader.node, wanted)


def fitting_keys(types: Types, missing: Missing, node: Node, wanted: Type) -> list[str]:
    """The keys that a state can read in place of one that nothing sets: those that are known to
    have the wanted type, those that nothing reads first, or else those that nothing reads and that
    can have it. A near name that nothing reads is a slip in its declaration, which the search
    itself corrects."""
    scope, near, own = missing.scope, guesser([missing.key]), outer_inputs(node)
    known: list[str] = []
    unread: list[str] = []
    both: list[str] = []
    for key in sorted(scope.uses.provided.difference(own)):
        is_read = key in scope.uses.read or key in scope.outputs
        if not may_be(types, scope, key, wanted) or (not is_read and near(key) is not None):
            continue
        if not is_unknown(wanted) and not is_unknown(types.keys.get((scope.path, key), ANY)):
            (known if is_read else both).append(key)
        elif not is_read:
            unread.append(key)
    words = words_of(node.name)
    found = sorted(both or known or unread, key=lambda key: not words & words_of(key))
    return found if len(found) <= MOST_PROPOSED else []


def _readers(missing: Missing, witness: Witness) -> Iterator[Related]:
    """The place of the code that reads the key, the state inside a container that does, and the
    other readers of the unset key."""
    node = witness.reader.node
    if isinstance(node, nodes.Leaf) and notation.is_python(node) and node.class_facts is not None:
        reads = (word.span for word in node.class_facts.reads if word.text == witness.reader.key)
        for span in islice(reads, 1):
            yield from other_place(span, f"{notation.code_of(node)} reads it here")
    if witness.inner is not None:
        yield from other_place(witness.inner.span, f"{witness.inner.words} here")
    for vertex in witness.also[:MOST_RELATED]:
        reader = reader_at(missing.scope, vertex, missing.key)
        yield from other_place(reader.span, f"{reader.words} as well")


def _writers(flow: DataFlow, missing: Missing) -> Iterator[Related]:
    """The states that set the key, on other paths or on some outcomes only."""
    for use in missing.scope.uses.writers(missing.key)[:MOST_RELATED]:
        name, outcomes = use.node.name, written_on(flow, missing.scope, use)
        text = f"`{name}` sets it here"
        if outcomes != outcome_names(use.node):
            text = f"`{name}` can set it, but no outcome guarantees that it does"
            if outcomes:
                text = f"`{name}` sets it only on {listed(outcomes)}"
        yield from other_place(use.span, text)
