"""Rules over the flow of userdata: what is read has to be set before, and get there."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

from smachac.analysis.context import Context
from smachac.analysis.def_use import Use, place_of, uses_by_key
from smachac.analysis.definite_assignment import DataFlow, UserdataScope
from smachac.analysis.error_recovery import unknown_remaps
from smachac.analysis.unset_reads import (
    Missing,
    Searches,
    Witness,
    container_name,
    reader_at,
)
from smachac.checks.edits import with_input, with_output
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Edit, Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import Guesser, guesser, respelt
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Node

MOST_RELATED = 3
"""More places beside the fault than these help nobody."""


@rule("SM301", "read-before-write", Severity.ERROR)
def read_before_write(context: Context) -> Iterator[Finding]:
    """A state reads a userdata key that nothing has set on the way to it.

    The machine stops there with an error, with the robot wherever it happens to be. If every path
    leads to that it is an error, if only some do it is a warning.

    An output of a state counts as set on every outcome but `preempted`, unless its interface says
    otherwise (`writes:`). What a state of an unknown type does is not judged.

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
    flow = context.mended_flow
    searches = Searches(flow)
    guesses = _Guesses()
    used = cache(lambda path: uses_by_key(flow, path))
    for missing in context.missing_keys("unset", "nowhere"):
        for witness in searches.witnesses(missing):
            users = used(missing.scope.path).get(missing.key, [])
            yield _unset(missing, witness, users, guesses)


class _Guesses:
    """What was meant by a name that no key of a container has."""

    def __init__(self) -> None:
        self._known: dict[str, Guesser] = {}

    def of(self, scope: UserdataScope) -> Guesser:
        if scope.path not in self._known:
            self._known[scope.path] = guesser(sorted(_keys_of(scope)))
        return self._known[scope.path]


def _unset(missing: Missing, witness: Witness, users: list[Use], guesses: _Guesses) -> Finding:
    scope, reader, name = missing.scope, witness.reader, missing.scope.container.name
    why = "before anything has set it"
    help = f"set it on the way, or give `{name}` a first value: `userdata: {{{missing.key}: ...}}`"
    if missing.cause == "nowhere":
        why = f"which nothing in {container_name(scope, reader.span)} sets"
        help = did_you_mean(guesses.of(scope)(missing.key)) or help
    elif not witness.always:
        why = "which not every way to it has set"
    words = reader.words if why.startswith("before") else f"{reader.words},"
    return Finding(
        span=reader.span,
        message=f"{words} {why}",
        help=help,
        related=(
            *_readers(missing, witness),
            *_writers(users),
            *calls(reader.node, reader.span),
        ),
        path=witness.path if len(witness.path) > 1 else (),
        severity=None if witness.always else Severity.WARNING,
        node=reader.path,
    )


def _keys_of(scope: UserdataScope) -> set[str]:
    """The keys that a container has, for those that misspell them."""
    keys = {*scope.held, *scope.inputs}
    for steps in scope.steps.values():
        for step in steps:
            keys |= step.writes.perhaps
    return keys


def _readers(missing: Missing, witness: Witness) -> Iterator[Related]:
    """What reads the key inside the place of a finding, and other places that miss it as well."""
    if witness.inner is not None:
        yield from other_place(witness.inner.span, f"{witness.inner.words} there")
    for vertex in witness.also[:MOST_RELATED]:
        reader = reader_at(missing.scope, vertex, missing.key)
        yield from other_place(reader.span, f"{reader.words} as well")


def _writers(users: list[Use]) -> Iterator[Related]:
    """What sets the key, only elsewhere or only sometimes."""
    writers = [use for use in users if use.kind not in ("reads", "takes in")]
    for use in writers[:MOST_RELATED]:
        name = use.path.rpartition("/")[2]
        when = ""
        if not use.always and use.outcomes:
            when = f", but only with {listed(use.outcomes)}"
        elif not use.always:
            when = " at most sometimes"
        yield from other_place(use.span, f"`{name}` sets it{when}")


@rule("SM302", "unknown-remap", Severity.ERROR)
def unknown_remap(context: Context) -> Iterator[Finding]:
    """A remapping names a key that the state does not have, or leads to one that nothing has.

    SMACH passes over the entry in silence: the state goes on with the key of its own name, another
    value than the one meant, or finds nothing.

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
    for path, node in context.states:
        if path != context.machine.root.name:
            yield from _unknown_remaps(path, node)
    guesses = _Guesses()
    for missing in context.missing_keys("remapped"):
        yield from _remapped(missing, guesses)


def _unknown_remaps(path: str, node: Node) -> Iterator[Finding]:
    own = list(dict.fromkeys(key.name for key in (*node.inputs, *node.outputs)))
    for remap, meant, certain in unknown_remaps(node):
        known = f"its keys are {listed(own)}" if own else "it has no keys"
        yield Finding(
            span=remap.span,
            message=f"`{node.name}` has no key `{remap.key}` that could stand for `{remap.to}`",
            help=did_you_mean(meant) or known,
            related=calls(node, remap.span),
            node=path,
            edits=respelt(Word(remap.key, remap.span), certain),
        )


def _remapped(missing: Missing, guesses: _Guesses) -> Iterator[Finding]:
    """The remaps that lead to a key that nothing has."""
    scope, key = missing.scope, missing.key
    around = scope.container.name
    for child in scope.container.children:
        for remap in child.remaps:
            if remap.to != key or child.name not in missing.vertices:
                continue
            guess = guesses.of(scope)(key)
            yield Finding(
                span=remap.span,
                message=f"`{child.name}` takes its `{remap.key}` from `{key}`, which nothing in"
                f" {container_name(scope, remap.span)} sets",
                help=did_you_mean(guess)
                or f"set `{key}` before, or give `{around}` a first value of it",
                related=calls(child, remap.span),
                node=f"{scope.path}/{child.name}",
            )


@rule("SM303", "undeclared-container-key", Severity.ERROR)
def undeclared_container_key(context: Context) -> Iterator[Finding]:
    """A state needs a key that its container does not take in, though one around it has the key.

    A container has userdata of its own; what its `input_keys` do not name stays outside. The
    state finds nothing, and the machine stops there with an error.

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
    flow = context.mended_flow
    for missing in context.missing_keys("outside"):
        scope, key = missing.scope, missing.key
        reader = reader_at(scope, missing.vertices[0], key)
        holder = flow.scopes[missing.other].container
        between = _between(scope.path, missing.other)
        others = tuple(reader_at(scope, vertex, key) for vertex in missing.vertices[1:])
        yield Finding(
            span=reader.span,
            message=f"{reader.words}, which `{holder.name}` has but {listed(between)}"
            f" {'do' if len(between) > 1 else 'does'} not take in",
            help=f"add `{key}` to the `input_keys` of {listed(between)}",
            related=(
                *other_place(scope.container.span, f"`{between[-1]}` begins here"),
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


def _taken_in(flow: DataFlow, path: str, holder: str, key: str) -> tuple[Edit, ...]:
    """What makes every container between the key and its reader take it in."""
    edits: list[Edit] = []
    while path != holder:
        added = with_input(flow.scopes[path].container, key)
        if not added:
            return ()
        edits += added
        path = path.rpartition("/")[0]
    return tuple(edits)


def _between(path: str, holder: str) -> list[str]:
    """The names of the containers from below the one that holds a key to the one that lacks it."""
    return path[len(holder) + 1 :].split("/")


@rule("SM307", "lost-output", Severity.WARNING)
def lost_output(context: Context) -> Iterator[Finding]:
    """A key is written inside a container and read outside, but the container does not hand it out.

    What its `output_keys` do not name stays inside. Who reads the key outside finds nothing, which
    is an error, or the value from before.

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
    for lost in context.lost_outputs:
        keeper, written = lost.keeper.container, place_of(lost.writer, lost.written)
        inner = f"`{lost.own}`" + (f" (`{lost.key}` outside)" * (lost.own != lost.key))
        finds = "so it finds nothing" if lost.is_missing else "so it finds an older value"
        yield Finding(
            span=keeper.span,
            message=f"`{keeper.name}` does not hand out {inner}, which `{lost.writer.name}` writes"
            f" in it; `{lost.reader.node.name}` reads it outside, {finds}",
            help=f"add `{lost.own}` to the `output_keys` of `{keeper.name}`",
            related=(
                *other_place(written, f"`{lost.writer.name}` writes it"),
                *other_place(lost.reader.span, lost.reader.words),
                *calls(keeper, keeper.span),
            ),
            severity=Severity.ERROR if lost.is_missing else None,
            node=lost.keeper.path,
            edits=with_output(keeper, lost.own) if lost.is_missing else (),
        )
