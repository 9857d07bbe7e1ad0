"""Rules on the flow of userdata: unset keys, remappings, keys that do not cross a container."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache

from smachac.analysis.context import Context
from smachac.analysis.def_use import Use, place_of, uses_by_key
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.error_recovery import unknown_remaps
from smachac.analysis.type_inference import Types
from smachac.analysis.unset_reads import (
    Missing,
    Searches,
    Witness,
    container_name,
    reader_at,
)
from smachac.checks.candidate_keys import fitting_key, unread_output
from smachac.checks.declarations import MeantKey, loop_in_a_body, meant_keys, swapped_loop
from smachac.checks.edits import with_input, with_output
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.races import raced_keys
from smachac.checks.rule import rule
from smachac.checks.type_words import placeholder
from smachac.checks.unwritten_keys import read_unwritten, unwritten_keys
from smachac.diagnostics.diagnostic import Edit, Finding, Related, Severity
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import Guesser, guesser, respelt
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.code_places import python_tree
from smachac.ir.nodes import Container, Key, Node
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import remapping
from smachac.ir.types import ANY

MOST_RELATED = 3
"""Limit on the related places of one kind in a finding."""

UNSET = "the state cannot read an unset key: it fails, or the machine stops with KeyError"


@rule(
    "SM301",
    "read-before-write",
    Severity.ERROR,
    effect=UNSET,
)
def read_before_write(context: Context) -> Iterator[Finding]:
    """A state reads a userdata key that is unset on at least one path to the state.

    On that path the machine stops with an error, and the robot stops in the middle of its task.

    Exactly: an error if the key is unset on every path, a warning if it is unset on some paths
    only. An output of a state counts as set on every outcome except `preempted`, unless `writes:`
    in the interface defines other outcomes. States of an unknown type are not checked.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - LOOK:
              template: ScriptedState
              outcomes: [seen, hidden]
              output_keys: [pose]
              steps: [{outcome: seen, set: {pose: 0.5}}, {outcome: hidden}]
              transitions: {seen: GRASP, hidden: GRASP}
          - GRASP:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pose]
              transitions: {done: held}

    Right:
        name: sm
        template: Base
        outcomes: [held, lost]
        states:
          - LOOK:
              template: ScriptedState
              outcomes: [seen, hidden]
              output_keys: [pose]
              steps: [{outcome: seen, set: {pose: 0.5}}, {outcome: hidden}]
              transitions: {seen: GRASP, hidden: lost}
          - GRASP:
              template: ScriptedState
              outcomes: [done]
              input_keys: [pose]
              transitions: {done: held}
    """
    flow = context.corrected_flow
    searches = Searches(flow)
    guesses = _Guesses()
    used = cache(lambda path: uses_by_key(flow, path))
    presets = meant_keys(context)
    moved = {each.path for each in context.misplaced}
    unwritten = set(read_unwritten(context, unwritten_keys(context)).values())
    unwritten |= raced_keys(context)
    for missing in context.missing_keys("unset", "nowhere"):
        if missing.cause == "nowhere" and _is_dropped(missing):
            continue  # SM308 reports the cause
        if (missing.scope.path, missing.key) in unwritten:
            continue  # SM306 or SM405 reports the cause
        swapped = swapped_loop(missing)
        if swapped is not None:
            yield _swapped(missing, swapped)
            continue
        meant = presets.get(missing.scope.path)
        for witness in searches.witnesses(missing):
            if witness.reader.path in moved:
                continue  # SM101: the state is in a wrong container
            users = used(missing.scope.path).get(missing.key, [])
            finding = _unset(missing, witness, users, guesses, context.types)
            if meant is not None and meant.missing is missing:
                finding = _with_meant_key(finding, witness, meant)
            elif missing.cause != "nowhere":
                finding = _with_outer_key(finding, missing, flow.scopes)
            yield finding


def _with_outer_key(
    finding: Finding, missing: Missing, scopes: Mapping[str, UserdataScope]
) -> Finding:
    """The finding on an output of a container that is read before it is set, where the container
    around it has a value for it: the key is probably meant as an input too."""
    scope, key = missing.scope, missing.key
    if key in scope.inputs or key not in scope.outputs:
        return finding
    outer = scope.outputs[key]
    around = scopes.get(scope.path.rpartition("/")[0])
    while around is not None and around.container.sugar and outer in around.outputs:
        outer = around.outputs[outer]
        around = scopes.get(around.path.rpartition("/")[0])
    if around is None or outer not in around.held:
        return finding
    name = scope.container.name
    help = f"add `{key}` to the `input_keys` of `{name}`: `{around.container.name}` has a value"
    return replace(finding, help=f"{help} for it")


def _with_meant_key(finding: Finding, witness: Witness, meant: MeantKey) -> Finding:
    """The finding on a key that nothing sets, where a loop over a preset, or a remapping from a
    preset or input is missing."""
    name, key, other = witness.reader.node.name, meant.missing.key, meant.word.text
    purpose, text = f"must read `{other}`", f"remapping: {{{key}: {other}}}"
    if meant.looped:
        purpose = f"must run for each item of `{other}`"
        text = f"for_each: {{item: {key}, in: {other}}}"
    if not meant.looped and guesser([key]).sure(other) is not None:
        help = f"rename `{other}` to `{key}`, or write `{text}` in `{name}`"
        related = other_place(meant.word.span, f"nothing reads `{other}`")
        return replace(finding, help=help, related=(*related, *finding.related))
    return replace(
        finding,
        help=f"if `{name}` {purpose}, write `{text}` in `{name}`; otherwise give `{key}` an initial"
        f" value in {container_name(meant.missing.scope, finding.span)}",
        related=(*other_place(meant.word.span, f"nothing reads `{other}`"), *finding.related),
    )


def _swapped(missing: Missing, loop: nodes.Iterator) -> Finding:
    """The finding on a loop whose items and item have changed places."""
    items, item = missing.key, loop.item_key
    names = ("item", "in") if loop.sugar else ("it_label", "it")
    right = f"{names[0]}: {items}, {names[1]}: {item}"
    help = f"`for_each: {{{right}}}`" if loop.sugar else f"`{right}`".replace(", ", "` and `")
    return Finding(
        span=loop.item_span,
        message=f"`{names[0]}` and `{names[1]}` of `{loop.name}` are swapped: the states in it read"
        f" the item as `{items}`, and the list is in `{item}`",
        arguments=(items,),
        help=f"swap them: write {help}",
        effect=f"the loop cannot begin: nothing sets `{items}` before it",
        related=(*other_place(loop.items_span, "the item"), *calls(loop, loop.item_span)),
        node=missing.scope.path
        if loop is missing.scope.container
        else f"{missing.scope.path}/{loop.name}",
    )


def _is_dropped(missing: Missing) -> bool:
    """Whether the code of a state sets the key, which its interface does not declare."""
    return any(
        word.text == missing.key
        for child in missing.scope.container.children
        if isinstance(child, nodes.Leaf) and child.class_facts is not None
        for word in child.class_facts.writes
    )


def _item_help(container: Container, reader: Node, key: str) -> str | None:
    """The help for a key that nothing sets in a loop, whose item has another name."""
    if not isinstance(container, nodes.Iterator) or reader is container:
        return None
    read = f"read `{container.item_key}` in place of `{key}`"
    match container.sugar:
        case "":
            return f"write `it_label: {key}`, or {read}: the loop calls its item so"
        case "for_each":
            return f"write `item: {key}` in `for_each`, or {read}: the loop calls its item so"
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


class _Guesses:
    """The guessers for the keys of containers, by the path of the container."""

    def __init__(self) -> None:
        self._known: dict[str, Guesser] = {}

    def of(self, scope: UserdataScope) -> Guesser:
        if scope.path not in self._known:
            self._known[scope.path] = guesser(sorted(_keys_of(scope)))
        return self._known[scope.path]


def _unset(
    missing: Missing,
    witness: Witness,
    users: list[Use],
    guesses: _Guesses,
    types: Types,
) -> Finding:
    scope, reader, name = missing.scope, witness.reader, missing.scope.container.name
    why = f"which is unset on {'every path' if witness.always else 'some paths'}"
    wanted = types.inputs.get((reader.path, reader.key), ANY)
    value = f"`userdata: {{{missing.key}: {placeholder(wanted)}}}`"
    where = "on every path" if witness.always else "on this path too,"
    help = (
        f"set `{missing.key}` {where} before `{reader.node.name}`, or give it an initial value in"
    )
    help += f" `{name}`: {value}"
    related: tuple[Related, ...] = ()
    if not witness.always and len(witness.path) > 2 and witness.path[-2].is_outcome:
        before, outcome = witness.path[-3], witness.path[-2].label.strip("()")
        if any(use.path == before.node for use in users if use.kind not in ("reads", "copies in")):
            help = f"lead `{outcome}` of `{before.label}` to another state, {help}"
    if missing.cause == "nowhere":
        why = f"which nothing in {container_name(scope, reader.span)} sets"
        guess = guesses.of(scope)(missing.key)
        node = reader.node
        if isinstance(node, nodes.Iterator) and guess == node.item_key:
            # The item of an iterator is no list of items, although `item` resembles `items`.
            guess = guesser(sorted(_keys_of(scope) - {node.item_key}))(missing.key)
        names = remapping(node)
        own = {names.get(key.name, key.name) for key in node.inputs}
        if node is not scope.container and guess in own:
            guess = guesses.of(scope).sure(missing.key)  # the state reads that key too
        help = did_you_mean(guess) or _item_help(scope.container, node, missing.key) or help
        unread = unread_output(scope, missing.key) if guess is None else None
        fitting = fitting_key(types, scope, reader) if guess is None else None
        if fitting is not None:
            help = f"write `remapping: {{{reader.key}: {fitting}}}` in `{node.name}`, if it must"
            help += f" read `{fitting}`, which has this type"
        if unread is not None:
            help = unread.help
            related = other_place(unread.place, f"nothing reads `{unread.key}`")
        if isinstance(node, nodes.Iterator) and node.sugar == "for_each":
            help = _item_name_help(node, missing.key) or help
        if isinstance(node, nodes.Iterator) and isinstance(python_tree(missing.key), ast.Lambda):
            help = f"quotes make it the name of a key: write code as '`{missing.key}`'"
        related = (*related, *_item_place(scope.container, node))
    return Finding(
        span=reader.span,
        message=f"{reader.words}, {why}",
        arguments=(reader.key,),
        help=help,
        related=(
            *_readers(missing, witness),
            *_writers(users),
            *related,
            *calls(reader.node, reader.span),
        ),
        path=witness.path if len(witness.path) > 1 else (),
        severity=None if witness.always else Severity.WARNING,
        node=reader.path,
    )


def _keys_of(scope: UserdataScope) -> set[str]:
    """The keys of a container: the candidates for a misspelt name."""
    keys = {*scope.held, *scope.inputs}
    for steps in scope.steps.values():
        for step in steps:
            keys |= step.writes.perhaps
    return keys


def _readers(missing: Missing, witness: Witness) -> Iterator[Related]:
    """The state inside a container that reads the key, and the other readers of the unset key."""
    if witness.inner is not None:
        yield from other_place(witness.inner.span, f"{witness.inner.words} here")
    for vertex in witness.also[:MOST_RELATED]:
        reader = reader_at(missing.scope, vertex, missing.key)
        yield from other_place(reader.span, f"{reader.words} as well")


def _writers(users: list[Use]) -> Iterator[Related]:
    """The states that set the key, on other paths or on some outcomes only."""
    writers = [use for use in users if use.kind not in ("reads", "copies in")]
    for use in writers[:MOST_RELATED]:
        name = use.path.rpartition("/")[2]
        text = f"`{name}` sets it here"
        if not use.always and use.outcomes:
            text = f"`{name}` sets it only on {listed(use.outcomes)}"
        elif not use.always:
            text = f"`{name}` can set it, but this is not guaranteed on any outcome"
        yield from other_place(use.span, text)


@rule("SM302", "unknown-remap", Severity.ERROR)
def unknown_remap(context: Context) -> Iterator[Finding]:
    """A remapping contains a userdata key that does not exist.

    SMACH ignores such an entry without a message: the state uses the key of its own name, which has
    another value than intended, or is not set at all.

    Exactly: in `remapping: {a: b}`, `a` is not a key of the state, or nothing in the container
    sets `b`.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.0, block_pose: 0.5}
        output_keys: [pose]
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              remapping: {psoe: block_pose}
              transitions: {succeeded: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.0, block_pose: 0.5}
        output_keys: [pose]
        states:
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              remapping: {pose: block_pose}
              transitions: {succeeded: held}
    """
    yield from context.at_states(_unknown_remaps)
    guesses = _Guesses()
    for missing in context.missing_keys("remapped"):
        yield from _remapped(missing, guesses)


def _ignored(node: Node, meant: str | None) -> str:
    """What happens without the entry of an unknown key in a remapping."""
    optional = any(key.name == meant and key.type.name == "optional" for key in node.inputs)
    if optional:
        return f"SMACH ignores the entry: the optional key `{meant}` stays unset"
    return "SMACH ignores the entry: the state uses the keys under its own names"


def _unknown_remaps(path: str, node: Node) -> Iterator[Finding]:
    if not node.remaps or path == node.name:  # the machine has no userdata around it
        return
    own = list(dict.fromkeys(key.name for key in (*node.inputs, *node.outputs)))
    unknown = unknown_remaps(node)
    turned = [remap for remap, _, _ in unknown if remap.to in own]
    for remap, meant, certain in unknown:
        known = f"use one of its keys: {listed(own)}" if own else "remove it: the state has no keys"
        if remap in turned:
            if remap is not turned[0]:
                continue
            right = ", ".join(f"{each.to}: {each.key}" for each in turned)
            right = f"{{{right}}}" if len(turned) > 1 else right
            known = f"the key of the state comes first: write `{right}`"
        yield Finding(
            span=remap.span,
            message=f"`{remap.key}` in the remapping of `{node.name}` is not one of its userdata"
            " keys",
            arguments=(remap.key, remap.to),
            help=known if remap in turned else did_you_mean(meant) or known,
            effect=_ignored(node, meant),
            related=calls(node, remap.span),
            node=path,
            edits=() if remap in turned else respelt(Word(remap.key, remap.span), certain),
        )


def _remapped(missing: Missing, guesses: _Guesses) -> Iterator[Finding]:
    """The remaps to a key that nothing sets."""
    scope, key = missing.scope, missing.key
    around = scope.container.name
    for child in scope.container.children:
        for remap in child.remaps:
            if remap.to != key or child.name not in missing.vertices:
                continue
            guess = guesses.of(scope)(key)
            unread = unread_output(scope, key) if guess is None else None
            yield Finding(
                span=remap.to_span,
                message=f"`{remap.key}` of `{child.name}` is remapped to `{key}`, which nothing in"
                f" {container_name(scope, remap.span)} sets",
                arguments=(remap.key, key),
                help=did_you_mean(guess)
                or (unread.help if unread is not None else None)
                or f"set `{key}` before this state, or give it an initial value in `{around}`:"
                f" `userdata: {{{key}: ...}}`",
                effect=UNSET,
                related=calls(child, remap.span),
                node=f"{scope.path}/{child.name}",
            )


@rule(
    "SM303",
    "undeclared-container-key",
    Severity.ERROR,
    effect="only `input_keys` are copied into a container: the state finds the key unset",
)
def undeclared_container_key(context: Context) -> Iterator[Finding]:
    """A state reads a key of an outer container, but it is not an input of its own container.

    A container has its own userdata: only the keys in its `input_keys` are copied into it. The
    state finds the key unset, and the machine stops with an error in the middle of the task.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5}
        output_keys: [pose]
        states:
          - PICK:
              template: StateMachine
              outcomes: [done]
              states:
                - GRASP:
                    template: PrintUserdataState
                    input_keys: [pose]
                    transitions: {succeeded: done}
              transitions: {done: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        userdata: {pose: 0.5}
        output_keys: [pose]
        states:
          - PICK:
              template: StateMachine
              outcomes: [done]
              input_keys: [pose]
              states:
                - GRASP:
                    template: PrintUserdataState
                    input_keys: [pose]
                    transitions: {succeeded: done}
              transitions: {done: held}
    """
    flow = context.corrected_flow
    for missing in context.missing_keys("outside"):
        scope, key = missing.scope, missing.key
        reader = reader_at(scope, missing.vertices[0], key)
        holder = flow.scopes[missing.other].container
        between = _between(flow, scope.path, missing.other)
        others = tuple(reader_at(scope, vertex, key) for vertex in missing.vertices[1:])
        held = name_in_script(holder)
        why = f"which is a key of `{held}` but not an input of {listed(between)}"
        help = f"add `{key}` to the `input_keys` of {listed(between)}"
        loop = loop_in_a_body(missing)
        if loop is not None:
            help = f"write `{key}` in place of `{loop.item_key}` in the `input_keys` of"
            help += f" {listed(between)}: the `for_each` of `{loop.name}` sets `{loop.item_key}`;"
            help += f" or move the `for_each` to {listed(between)}"
        if isinstance(holder, nodes.Iterator) and holder.item_key == key:
            why = f"which the loop `{held}` provides, but which is not an input of"
            why += " its state" if list(between) == [held] else f" {listed(between)}"
        yield Finding(
            span=reader.span,
            message=f"{reader.words}, {why}",
            arguments=(reader.key,),
            help=help,
            related=(
                *(
                    _list_of(scope.container, scope.container.inputs, "input_keys")
                    or other_place(scope.container.span, f"`{between[-1]}` is defined here")
                ),
                *(
                    related
                    for each in others[:MOST_RELATED]
                    for related in other_place(each.span, f"{each.words} as well")
                ),
                *calls(reader.node, reader.span),
            ),
            node=reader.path,
            edits=_taken_in(flow, scope.path, missing.other, key),
        )


def _list_of(container: Container, keys: Sequence[Key], field: str) -> tuple[Related, ...]:
    """The last name in a list of keys of a container, where its text has the list."""
    if not keys or keys[-1].span.source is not container.span.source:
        return ()
    return other_place(keys[-1].span, f"the `{field}` of `{container.name}`")


def _taken_in(flow: DataFlow, path: str, holder: str, key: str) -> tuple[Edit, ...]:
    """The edits that make the key an input of every container between its holder and its reader."""
    edits: list[Edit] = []
    while path != holder:
        added = with_input(flow.scopes[path].container, key)
        if not added:
            return ()
        edits += added
        path = path.rpartition("/")[0]
    return tuple(edits)


def _between(flow: DataFlow, path: str, holder: str) -> list[str]:
    """The names in the script of the containers between the holder of a key and its reader,
    outermost first."""
    names = path[len(holder) + 1 :].split("/")
    paths = ["/".join([holder, *names[: at + 1]]) for at in range(len(names))]
    return list(dict.fromkeys(name_in_script(flow.scopes[each].container) for each in paths))


@rule("SM307", "lost-output", Severity.WARNING)
def lost_output(context: Context) -> Iterator[Finding]:
    """A key is set inside a container and read outside, but is not an output key of the container.

    Only the keys in `output_keys` are copied out of a container. The state that reads the key
    outside works with an older value, or finds the key unset, and then the machine stops.

    Exactly: an error if the key is unset outside, a warning if it has an older value. The reader
    can be the container itself, where it runs again, in a loop or for the next item of `for_each`,
    if no state in it reads the key after it is set.

    Wrong:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - FIND:
              template: StateMachine
              outcomes: [found]
              states:
                - LOOK:
                    template: ScriptedState
                    outcomes: [seen]
                    output_keys: [pose]
                    steps: [{outcome: seen, set: {pose: 0.5}}]
                    transitions: {seen: found}
              transitions: {found: GRASP}
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}

    Right:
        name: sm
        template: Base
        outcomes: [held]
        states:
          - FIND:
              template: StateMachine
              outcomes: [found]
              output_keys: [pose]
              states:
                - LOOK:
                    template: ScriptedState
                    outcomes: [seen]
                    output_keys: [pose]
                    steps: [{outcome: seen, set: {pose: 0.5}}]
                    transitions: {seen: found}
              transitions: {found: GRASP}
          - GRASP:
              template: PrintUserdataState
              input_keys: [pose]
              transitions: {succeeded: held}
    """
    shown: set[tuple[Span, str]] = set()
    for lost in context.lost_outputs:
        keeper, written = lost.keeper.container, place_of(lost.writer, lost.written)
        called = bool(keeper.via) and written.source is not keeper.span.source
        if called and (written, lost.own) in shown:
            continue  # another call of the same sub-script
        shown.add((written, lost.own))
        inner = f"`{lost.own}`" + (f" (`{lost.key}` outside)" * (lost.own != lost.key))
        gets = "an unset key" if lost.is_missing else "an older value"
        wrong, reader = lost.misspelt, lost.reader.node.name
        itself = reader == keeper.name
        happens = "it is lost at the end of each run" if itself else f"`{reader}` reads {gets}"
        effect = f"`{reader}` works with a value that was set before"
        if lost.is_missing:
            effect = f"`{reader}` stops when it reads the key"
        elif itself:
            effect = f"each run of `{reader}` begins with the value that was set before the first"
        fix = f"write `{lost.own}` in place of `{wrong.name}`" if wrong is not None else ""
        yield Finding(
            span=wrong.span if wrong is not None else written if called else keeper.span,
            message=f"{inner}, set by `{lost.writer.name}`, is not an output of"
            f" `{keeper.name}`: {happens}",
            arguments=(lost.own,),
            help=fix
            or f"add `{lost.own}` to the `output_keys` of"
            + (
                f" the outermost state in `{written.source.name}`"
                if called
                else f" `{keeper.name}`"
            ),
            related=(
                *(other_place(written, f"`{lost.writer.name}` sets it here") if not called else ()),
                *other_place(lost.reader.span, lost.reader.words),
                *_list_of(keeper, keeper.outputs, "output_keys"),
                *calls(keeper, keeper.span),
            ),
            effect=effect,
            severity=Severity.ERROR if lost.is_missing else None,
            node=lost.keeper.path,
            edits=()
            if called or wrong is not None or not lost.is_missing
            else with_output(keeper, lost.own),
        )
