"""The finding about a key that a state reads where it may be unset (SM301): its help, its path, and
the places that belong to it."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.analysis.def_use import written_on
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.type_inference import Types
from smachac.analysis.type_lattice import is_open
from smachac.analysis.unset_reads import Missing, Witness, container_name, reader_at
from smachac.checks.candidate_keys import (
    UnreadOutput,
    fitting_keys,
    keys_of,
    may_be,
    unread_before,
    unread_output,
    written_place,
)
from smachac.checks.initial_presets import counts, initial_value
from smachac.checks.messages import added_remapping, calls, did_you_mean, other_place
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.code_places import python_tree
from smachac.ir.nodes import Container, Node
from smachac.ir.traversal import outcome_names, outer_inputs
from smachac.ir.types import ANY, Type

MOST_RELATED = 3
"""Limit on the related places of one kind in a finding."""


def _item_help(container: Container, reader: Node, key: str) -> str | None:
    """The help for a key that nothing sets in a loop, whose item has another name."""
    if not isinstance(container, nodes.Iterator) or reader is container:
        return None
    item = container.item_key
    read = f"or read `{item}` in place of `{key}`: `{item}` is the item of the loop"
    match container.sugar:
        case "":
            return f"write `it_label: {key}`, {read}"
        case "for_each":
            return f"write `item: {key}` in `for_each`, {read}"
    return None


def _item_name_help(loop: nodes.Iterator, key: str) -> str | None:
    """The help for a state of `for_each` that does not read its item, and a key in place of it."""
    names = {name.name for child in loop.children for name in child.inputs}
    if loop.item_key in names or key not in names:
        return None
    item = loop.item_key
    return f"write `item: {key}` in `for_each`, or read `{item}`, as the loop calls its item"


def _item_place(container: Container, reader: Node) -> tuple[Related, ...]:
    """The place of the name of the item, where the loop around the reader or the reader itself has
    one that the script names."""
    loop = reader if isinstance(reader, nodes.Iterator) else container
    if not isinstance(loop, nodes.Iterator) or loop.sugar == "retry" or not loop.item_key:
        return ()
    if loop is reader and loop.sugar != "for_each":
        return ()
    return other_place(loop.item_span, f"the loop calls its item `{loop.item_key}`")


class Guesses:
    """The guessers for the keys of containers, by the path of the container."""

    def __init__(self) -> None:
        self._known: dict[str, Guesser] = {}

    def of(self, scope: UserdataScope) -> Guesser:
        if scope.path not in self._known:
            self._known[scope.path] = guesser(sorted(keys_of(scope)))
        return self._known[scope.path]


def unset_read(
    flow: DataFlow,
    missing: Missing,
    witness: Witness,
    guesses: Guesses | None,
    types: Types,
) -> Finding:
    """SM301 for a key where a state reads it. Without `guesses` no key is searched that can be
    meant."""
    scope, reader, name = missing.scope, witness.reader, missing.scope.container.name
    why = f"which is unset on {'every path' if witness.always else 'some paths'}"
    value = f"`userdata: {{{missing.key}: {initial_value(types, reader, missing)}}}`"
    where = "on every path" if witness.always else "on this path too,"
    help = (
        f"set `{missing.key}` {where} before `{reader.node.name}`, or give it an initial value in"
    )
    help += f" `{name}`: {value}"
    is_counter = missing.cause == "unset" and counts(missing)
    if is_counter:
        help = f"give `{missing.key}` an initial value in `{name}`: {value}"
    related: tuple[Related, ...] = ()
    if not (is_counter or witness.always) and len(witness.path) > 2 and witness.path[-2].is_outcome:
        before, outcome = witness.path[-3], witness.path[-2].label.strip("()")
        if any(use.path == before.node for use in scope.uses.writers(missing.key)):
            help = f"lead `{outcome}` of `{before.label}` to another state, {help}"
    if missing.cause == "nowhere":
        why = f"which nothing in {container_name(scope, reader.span)} sets"
        if guesses is not None:
            cure, related = _meant_key(missing, witness, guesses, types)
            help = cure or help
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
    )


def _meant_key(
    missing: Missing, witness: Witness, guesses: Guesses, types: Types
) -> tuple[str | None, tuple[Related, ...]]:
    """The help for a key that nothing sets, if another key is probably meant, with the places that
    belong to it."""
    scope, reader = missing.scope, witness.reader
    related: tuple[Related, ...] = ()
    guess = guesses.of(scope)(missing.key)
    node = reader.node
    if isinstance(node, nodes.Iterator) and guess == node.item_key:
        # The item of an iterator is no list of items, although `item` resembles `items`.
        guess = guesser(sorted(keys_of(scope) - {node.item_key}))(missing.key)
    loop = scope.container
    if isinstance(loop, nodes.Iterator) and guess == loop.items_key:
        guess = None  # what its state reads is the item, not the list
    if node is not scope.container and guess in outer_inputs(node):
        guess = guesses.of(scope).sure(missing.key)  # the state reads that key too
    wanted, inside = types.inputs.get((reader.path, reader.key), ANY), witness.inner
    if inside is not None and is_open(wanted):
        wanted = types.inputs.get((inside.path, inside.key), ANY)
    if guess is not None and not may_be(types, scope, guess, wanted):
        guess = None
    of_item = _item_help(scope.container, node, missing.key)
    help = name_help(node, reader.key, missing.key, guess) if guess is not None else None
    help = help or of_item
    unread = _meant_output(missing, witness, guesses, types, guess, wanted)
    fitting = []
    if guess is None and (of_item is None or isinstance(node, nodes.Leaf)):
        fitting = fitting_keys(types, scope, reader, wanted)
    if len(fitting) == 1:
        help = f"{added_remapping(node, reader.key, fitting[0])}, if it must read `{fitting[0]}`"
        if types.keys.get((scope.path, fitting[0])) == wanted:
            help += f": both are of the type `{wanted}`"
    elif fitting and reader.key == missing.key:
        ways = " or ".join(f"`remapping: {{{reader.key}: {key}}}`" for key in fitting)
        help = f"write {ways} in `{node.name}`: these keys have its type"
    if len(fitting) == 1 and missing.cause == "nowhere":
        place = written_place(scope, fitting[0])
        related = other_place(place, f"nothing reads `{fitting[0]}`") if place else ()
    if unread is not None:
        help = unread.help
        related = other_place(unread.place, f"nothing reads `{unread.key}`")
    if isinstance(node, nodes.Iterator) and node.sugar == "for_each":
        help = _item_name_help(node, missing.key) or help
    if isinstance(node, nodes.Iterator) and isinstance(python_tree(missing.key), ast.Lambda):
        help = f"quotes make it the name of a key: write code as '`{missing.key}`'"
    return help, (*related, *_item_place(scope.container, node))


def _meant_output(
    missing: Missing,
    witness: Witness,
    guesses: Guesses,
    types: Types,
    guess: str | None,
    wanted: Type,
) -> UnreadOutput | None:
    """The output that nothing reads and that is probably meant by a missing key of the type
    `wanted`, rather than the key of the nearest name, `guess`."""
    scope, key = missing.scope, missing.key
    near, is_slip = guesses.of(scope)(key), guesses.of(scope).sure(key) is not None
    unread = unread_output(scope, key)
    if guess is not None and unread is not None:
        unread = None if is_slip or unread.key != guess else unread
    if unread is not None or near is None or is_slip:
        return unread
    if guess is None or _is_read_elsewhere(scope, witness, guess):
        return unread_before(types, scope, key, witness, wanted)
    return None


def _is_read_elsewhere(scope: UserdataScope, witness: Witness, key: str) -> bool:
    """Whether another state of a container than the one that reads a missing key reads `key`."""
    reader = witness.reader.node.name
    return any(key in keys for vertex, keys in scope.reads.items() if vertex != reader)


def name_help(node: Node, own: str, outer: str, meant: str) -> str:
    """The help for a state that reads the key `own`, which is `outer` in its container, where the
    key `meant` of the container is the right one: the remapping that the state lacks, if the name
    is that of an interface; else the name itself."""
    key = next((each for each in node.inputs if each.name == own), None)
    if own != outer or key is None or key.span.source is node.span.source:
        return did_you_mean(meant) or ""
    return added_remapping(node, own, meant)


def _readers(missing: Missing, witness: Witness) -> Iterator[Related]:
    """The state inside a container that reads the key, and the other readers of the unset key."""
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
