"""Keys that nothing reads, and the keys that are probably meant by them: read, but not set."""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.expression_types import type_of_data
from smachac.analysis.type_lattice import misfit
from smachac.analysis.unset_reads import Missing, Reader, provided_keys, reader_at
from smachac.checks.help_text import other_place
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import MOST_COMPARED, MOST_EXPLAINED, guesser, respelt
from smachac.ir import nodes
from smachac.ir.graph import START
from smachac.ir.nodes import Data, Leaf
from smachac.ir.traversal import outer_inputs, remapping
from smachac.ir.types import ANY, Type

SHORTEST_WORD = 3
"""Shorter words of two names say nothing about them."""


class MeantKey(NamedTuple):
    """A key that nothing sets, and the only preset or input of its container that nothing reads,
    which is probably meant for it: by a remapping or, if `looped`, by a `for_each` over its items;
    if `iterated`, the key is the list of a loop, which probably means it. `word` is the name of
    that preset or input, `state` the path of the state that reads the key."""

    missing: Missing
    word: Word
    state: str
    looped: bool
    iterated: bool = False


def meant_keys(context: Context) -> dict[str, MeantKey]:
    """The keys that are probably meant for keys that nothing sets, by path of the container. Only
    where one key is unset and one is unread, and where the type of the reader fits, or is not known
    and the names have a word in common."""
    missing: dict[str, list[Missing]] = {}
    for each in context.missing_keys("nowhere"):
        missing.setdefault(each.scope.path, []).append(each)
    found: dict[str, MeantKey] = {}
    for path, (first, *others) in missing.items():
        scope = first.scope
        if others:
            continue
        if context.of_container(sees_everything, path, scope):
            continue
        read = context.of_container(used_in, path, scope)
        unread = [
            (Word(preset.key, preset.span), type_of_data(preset.value.data), preset.value.data)
            for preset in scope.container.userdata
            if preset.key not in read
        ]
        unread += [
            (Word(key.name, key.span), key.type, None)
            for key in scope.container.inputs
            if key.name not in read
        ]
        reader = reader_at(scope, first.vertices[0], first.key)
        wanted = context.types.inputs.get((reader.path, reader.key), ANY)
        if len(unread) != 1 or reader.key != first.key or reader.node is scope.container:
            continue
        word, given, data = unread[0]
        looped = not isinstance(reader.node, nodes.Iterator) and _has_items_of(
            data, word.text, first.key, wanted
        )
        alike = not set(word.text.split("_")).isdisjoint(first.key.split("_"))
        fits = alike if ANY in (wanted, given) else misfit(given, wanted) is None
        iterated = isinstance(reader.node, nodes.Iterator) and reader.node.items_key == first.key
        fits = fits or (iterated and isinstance(data, tuple))
        if not fits:
            if looped:
                found[path] = MeantKey(first, word, reader.path, looped=True)
        else:
            found[path] = MeantKey(first, word, reader.path, looped=False, iterated=iterated)
    return found


def _has_items_of(data: Data, name: str, key: str, wanted: Type) -> bool:
    """Whether a value is a list whose items a key is probably meant for: `parts` for `part`, or
    items that are no numbers and can have the type of the key."""
    if not isinstance(data, tuple) or not data:
        return False
    words = [word for word in name.split("_") if len(word) >= SHORTEST_WORD]
    others = [word for word in key.split("_") if len(word) >= SHORTEST_WORD]
    if any(one.startswith(other) or other.startswith(one) for one in words for other in others):
        return True
    item = type_of_data(data[0])
    if item.name in ("int", "float"):
        return False
    return ANY in (item, wanted) or misfit(item, wanted) is None


class Misnamed(NamedTuple):
    """A preset or input of a container that nothing reads, and the key that is meant by it, which
    is read, and unset without it. `reader` reads that one. `turned`: the key is the value of the
    preset. `declared`: the declaration is the slip, not its reader, as the key has more uses."""

    word: Word
    meant: str
    reader: Reader
    turned: bool = False
    declared: bool = True


def misnamed_keys(context: Context) -> dict[tuple[str, str], Misnamed]:
    """The presets and inputs that mean a key of a similar name, by the path of their container and
    that key; for the first MOST_EXPLAINED missing keys of a container."""
    found: dict[tuple[str, str], Misnamed] = {}
    presets = context.of_machine(meant_keys)
    searched: Counter[str] = Counter()
    for each in context.missing_keys("unset", "nowhere", "outside"):
        scope = each.scope
        searched[scope.path] += 1
        if searched[scope.path] > MOST_EXPLAINED:
            continue
        if context.of_container(sees_everything, scope.path, scope) or scope.container.sugar:
            continue
        if loop_in_a_body(each) is not None:
            continue  # SM303
        read = context.of_container(used_in, scope.path, scope)
        words = {Word(preset.key, preset.span): preset.value.data
                 for preset in scope.container.userdata if preset.key not in read}  # fmt: skip
        turned = [word for word, data in words.items() if data == each.key]
        inputs = [Word(key.name, key.span) for key in scope.container.inputs]
        unread = [*words, *(word for word in inputs if word.text not in read)]
        guess = guesser([each.key])
        compared = unread if len(unread) <= MOST_COMPARED else []
        alike = turned or [word for word in compared if guess(word.text) is not None]
        if not alike and each.cause == "outside":
            alike = _unset_input(context, each, read)
        if len(alike) != 1:
            continue
        declared = each.cause == "outside" or bool(turned) or _uses_in_text(scope, each.key) > 1
        preset = presets.get(scope.path)
        if preset is not None and preset.missing is each and not turned:
            continue  # SM301 names both
        if declared or each.cause == "unset":
            reader = reader_at(scope, each.vertices[0], each.key)
            found[scope.path, each.key] = Misnamed(
                alike[0], each.key, reader, bool(turned), declared
            )
    return found


def _unset_input(context: Context, missing: Missing, read: set[str]) -> list[Word]:
    """The input of a container that nothing in it reads and that nothing around it sets, where it
    has one such input and lacks one."""
    scope, flow = missing.scope, context.corrected_flow
    lacking = [each for each in context.missing_keys("outside") if each.scope is scope]
    around = flow.scopes.get(scope.path.rpartition("/")[0])
    if around is None or len(lacking) != 1 or scope.container.sugar or around.container.sugar:
        return []
    given = provided_keys(around)
    return [
        Word(key.name, key.span)
        for key in scope.container.inputs
        if key.name not in read and not given.has(scope.inputs[key.name])
    ]


def loop_in_a_body(missing: Missing) -> nodes.Iterator | None:
    """The `for_each` of a state in a container that has the item as an input in place of the list,
    where nothing else in it reads an input of that name: the loop was meant around the container,
    or the list as its input."""
    scope = missing.scope
    inputs = {each.name for each in scope.container.inputs}
    for vertex in missing.vertices if missing.cause == "outside" else ():
        node = scope.children.get(str(vertex)) if vertex != START else None
        if not isinstance(node, nodes.Iterator) or node.sugar != "for_each":
            continue
        others = (each for each in scope.container.children if each is not node)
        read = {key for each in others for key in outer_inputs(each)}
        if node.item_key in inputs - read and missing.key not in inputs:
            return node
    return None


def _uses_in_text(scope: UserdataScope, key: str) -> int:
    """How often the text names a key in a container. A key that an interface names counts twice:
    it cannot be misspelt."""
    count = sum(each.name == key for each in scope.container.outputs)
    for node in scope.children.values():
        names = remapping(node)
        own = {each.name: each for each in (*node.inputs, *node.outputs)}
        count += sum(remap.to == key for remap in node.remaps)
        if key in own and key not in names:
            given = own[key].span.source is not node.span.source
            lists = (node.inputs, node.outputs)
            count += 2 if given else sum(key in {each.name for each in one} for one in lists)
    return count


def misnamed_finding(found: Misnamed, path: str, where: str) -> Finding:
    """The finding on a declaration whose name is the slip."""
    word, meant, reader, turned, _ = found
    return Finding(
        span=word.span,
        message=f"nothing in {where} reads `{word.text}`: `{reader.node.name}` reads `{meant}`",
        arguments=(word.text, meant),
        help=f"write `{meant}: {word.text}`: the name of the key comes first"
        if turned
        else f"did you mean `{meant}`?",
        effect=f"`{meant}` is unset: `{reader.node.name}` fails when it reads it",
        related=other_place(reader.span, f"`{meant}` is read here"),
        severity=Severity.ERROR,
        node=path,
        edits=() if turned else respelt(word, guesser([meant]).sure(word.text)),
    )


def sees_everything(scope: UserdataScope) -> bool:
    """Whether a state in a container can read any key."""
    raw = isinstance(scope.container, nodes.Iterator)
    for child in scope.container.children:
        if isinstance(child, Leaf):
            if raw or child.open:
                return True
        elif isinstance(child, nodes.Iterator) and not child.item_key:
            return True
    return False


def used_in(scope: UserdataScope) -> set[str]:
    """The keys that a state in a container declares as inputs, that its class reads, or over which
    it iterates, and the outputs of the container."""
    found = {*scope.uses.read, *scope.outputs}
    for child in scope.container.children:
        if isinstance(child, Leaf) and child.class_facts is not None:
            found.update(word.text for word in child.class_facts.reads)
    return found
