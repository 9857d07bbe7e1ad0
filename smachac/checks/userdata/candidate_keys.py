"""Keys that are meant by one that nothing sets: outputs that nothing reads, and keys of the type
that is read (SM301)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import UserdataScope
from smachac.analysis.type_inference import Types
from smachac.analysis.type_lattice import fits, is_open, misfit, widened
from smachac.analysis.unset_reads import Missing
from smachac.checks.help_text import added_remapping
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import Guesser, guesser, words_of
from smachac.ir import nodes
from smachac.ir.nodes import Container, Node, Remap
from smachac.ir.traversal import outer_outputs, outputs_to, remapping
from smachac.ir.types import ANY, Type


def keys_around(container: Container) -> set[str]:
    """The keys of a container that it gets, or that a state in it sets."""
    found = {preset.key for preset in container.userdata} | {key.name for key in container.inputs}
    if isinstance(container, nodes.Iterator):
        return found - {container.item_key}
    for child in container.children:
        found.update(outer_outputs(child))
    return found


def outer_value(missing: Missing, scopes: Mapping[str, UserdataScope]) -> tuple[str, str] | None:
    """The key of a container around, with the path of that one, that has an initial value for an
    output of a container which is read in it before it is set, and is no input of it."""
    scope, key = missing.scope, missing.key
    if key in scope.inputs or key not in scope.outputs:
        return None
    outer = scope.outputs[key]
    around = scopes.get(scope.path.rpartition("/")[0])
    while around is not None and around.container.sugar and outer in around.outputs:
        outer = around.outputs[outer]
        around = scopes.get(around.path.rpartition("/")[0])
    return (around.path, outer) if around is not None and outer in around.held else None


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
    found = [each for each in unread_outputs(scope, missing) if words & words_of(each.key)]
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
            place = next((each.to_span for each in child.remaps if each.to == outer), child.span)
            yield UnreadOutput(outer, place, help, child.name)


MOST_FITTING = 3
"""More keys of one type are no help."""


def may_be(types: Types, scope: UserdataScope, key: str, wanted: Type) -> bool:
    """Whether the type of a key of a container, as far as it is known, is not a wrong one."""
    given = types.keys.get((scope.path, key), ANY)
    return is_open(given) or is_open(wanted) or misfit(given, wanted) is None


def keys_of(scope: UserdataScope) -> set[str]:
    """The keys of a container: the candidates for a misspelt name."""
    keys = {*scope.held, *scope.inputs}
    for steps in scope.steps.values():
        for step in steps:
            keys |= step.writes.perhaps
    return keys


class MeantByRemap(NamedTuple):
    """The key that a remapping means in place of one that nothing sets. `place`: where it is set,
    if nothing reads it and its type fits; `setter` is the state that sets it there, if one does."""

    key: str
    place: Span | None = None
    setter: str = ""


def meant_by_remap(
    types: Types, scope: UserdataScope, child: Node, remap: Remap, guess: Guesser
) -> MeantByRemap | None:
    """The key that the remapping of an input to a key that nothing sets probably means: one that is
    one slip away; else one that nothing reads and that has the type of the input; else the one with
    the nearest name. Never one that is known to have another type. `guess` is the guesser for the
    keys of the container."""
    wanted = types.inputs.get((f"{scope.path}/{child.name}", remap.key), ANY)
    near = guess.sure(remap.to)
    if near is not None and may_be(types, scope, near, wanted):
        return MeantByRemap(near)
    near = guess(remap.to)
    if near is not None and not may_be(types, scope, near, wanted):
        others = (key for key in sorted(keys_of(scope)) if may_be(types, scope, key, wanted))
        near = guesser(others)(remap.to)
    unread = _unread_of_type(types, scope, child, remap, wanted)
    if near in unread:
        return MeantByRemap(near)
    key = unread[0] if len(unread) == 1 else guesser(unread)(remap.to)
    place = written_place(scope, key) if key is not None else None
    if key is None or place is None:
        near = near or _named_by_state(types, scope, child, wanted)
        return MeantByRemap(near) if near is not None else None
    setters = [each.name for each in scope.container.children if outputs_to(each, key)]
    return MeantByRemap(key, place, setters[0] if setters and key not in scope.held else "")


def keys_of_type(types: Types, scope: UserdataScope, wanted: Type) -> list[str]:
    """The keys of a container whose values have a type. Empty if the type is unknown or a plain
    number, text or boolean: many keys with other meanings have these types."""
    if is_open(wanted) or wanted.name in SCALARS:
        return []
    return [
        key
        for key in sorted(keys_of(scope))
        for given in [types.keys.get((scope.path, key), ANY)]
        if not is_open(given) and widened(given) != ANY and fits(given, wanted)
    ]


def _named_by_state(types: Types, scope: UserdataScope, child: Node, wanted: Type) -> str | None:
    """The only key that an input can have and that shares a word with the name of the state."""
    words = words_of(child.name)
    near = [key for key in sorted(keys_of(scope)) if words_of(key) & words]
    found = [key for key in near if may_be(types, scope, key, wanted)]
    return found[0] if len(found) == 1 else None


def meant_by_remaps(context: Context) -> set[tuple[str, str]]:
    """The keys that nothing reads and that are meant by remappings to a key that nothing sets
    (SM302), each with the path of its container."""
    guessers: dict[str, Guesser] = {}
    found: set[tuple[str, str]] = set()
    for missing in context.missing_keys("remapped"):
        scope = missing.scope
        if scope.path not in guessers:
            guessers[scope.path] = guesser(sorted(keys_of(scope)))
        for child in scope.container.children:
            for remap in child.remaps:
                if remap.to == missing.key and child.name in missing.vertices:
                    meant = meant_by_remap(context.types, scope, child, remap, guessers[scope.path])
                    if meant is not None and written_place(scope, meant.key) is not None:
                        found.add((scope.path, meant.key))
    return found


def _unread_of_type(
    types: Types, scope: UserdataScope, child: Node, remap: Remap, wanted: Type
) -> list[str]:
    """The keys of a container that nothing reads, that another state than `child` sets, and that
    have the type of one of its inputs; of a number, text or boolean only those with a word of the
    remapping. If the type is unknown, the only initial value that nothing reads, if it is none of
    these."""
    read = {*chain.from_iterable(scope.reads.values()), *scope.outputs}
    if is_open(wanted):
        held = sorted(scope.held - read)
        simple = any(
            widened(types.keys.get((scope.path, key), ANY)).name in SCALARS for key in held
        )
        return held if len(held) == 1 and not simple else []
    own = {*outer_outputs(child)}
    found = [
        key
        for key in sorted(keys_of(scope) - read - own)
        for given in [types.keys.get((scope.path, key), ANY)]
        if not is_open(given) and widened(given) != ANY and fits(given, wanted)
    ]
    if wanted.name in SCALARS:
        words = words_of(remap.key, remap.to)
        found = [key for key in found if words & words_of(key)]
    return found


SCALARS = frozenset(["bool", "int", "float", "str"])
"""The names of types that say little about what a value means."""


def written_place(scope: UserdataScope, key: str) -> Span | None:
    """Where the script names a key that nothing in a container reads: in its presets, or at the
    state that sets it; None if something reads it."""
    if key in {*chain.from_iterable(scope.reads.values()), *scope.outputs}:
        return None
    for preset in scope.container.userdata:
        if preset.key == key:
            return preset.span
    return next((use.span for use in scope.uses.writers(key)), None)
