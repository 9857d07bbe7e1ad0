"""Rules over branches that get in each other's way: keys that both write, resources both hold."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.analysis.accesses import Accesses
from smachac.analysis.context import Context
from smachac.analysis.resource_claims import Held, prefixes
from smachac.checks.messages import calls, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import listed
from smachac.ir.nodes import Concurrence, Node

MOST_PLACES = 4
"""So many other places a finding shows."""


@rule("SM405", "data-race", Severity.ERROR)
def data_race(context: Context) -> Iterator[Finding]:
    """Two branches that run at the same time write one key, or one writes what another reads.

    Which value is there in the end, or is read, depends on which branch is faster that day: the
    arm moves to a pose that is sometimes the old one.

    Exactly: leaves write their output keys and read their input keys at any time; a container
    takes its inputs when it starts and gives its outputs when it ends. What a container takes in
    but nothing in it reads does not count, nor what it declares as output but nothing sets. Keys
    count under the names they have in the userdata of the concurrence, after remapping.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              output_keys: [pose]
              states:
                - LOOK_LEFT: {template: ScriptedState, outcomes: [ok], output_keys: [pose]}
                - LOOK_RIGHT: {template: ScriptedState, outcomes: [ok], output_keys: [pose]}
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              output_keys: [left_pose, right_pose]
              states:
                - LOOK_LEFT:
                    template: ScriptedState
                    outcomes: [ok]
                    output_keys: [pose]
                    remapping: {pose: left_pose}
                - LOOK_RIGHT:
                    template: ScriptedState
                    outcomes: [ok]
                    output_keys: [pose]
                    remapping: {pose: right_pose}
              transitions: {done: done}
    """
    for path, container in context.containers:
        if isinstance(container, Concurrence) and len(container.children) > 1:
            yield from _races(path, container, context.accesses)


def _races(path: str, container: Concurrence, known: Mapping[str, Accesses]) -> Iterator[Finding]:
    writers: dict[str, list[tuple[Node, Node]]] = {}
    readers: dict[str, list[tuple[Node, Node]]] = {}
    for child in container.children:
        own = known[f"{path}/{child.name}"]
        for key, origin in own.writes.items():
            writers.setdefault(key, []).append((child, origin))
        for key, origin in own.reads.items():
            readers.setdefault(key, []).append((child, origin))
    for key, writing in writers.items():
        names = {child.name for child, _ in writing}
        # Who reads what it writes itself is no reader for the others if it is the only writer.
        reading = [one for one in readers.get(key, ()) if one[0].name not in names]
        if len(writing) > 1 or reading:
            yield _race(path, container, key, writing, reading)


def _race(
    path: str,
    container: Concurrence,
    key: str,
    writing: list[tuple[Node, Node]],
    reading: list[tuple[Node, Node]],
) -> Finding:
    writers = listed(child.name for child, _ in writing)
    readers = listed(child.name for child, _ in reading)
    if len(writing) == 1:
        message = f"{writers} writes `{key}` while {readers} reads it"
    else:
        message = f"{writers} write `{key}` at the same time"
        message += f", and {readers} reads it" if reading else ""
    here = writing[:2][-1]
    span = here[0].span
    return Finding(
        span=span,
        message=f"{message}: they run together in `{container.name}`",
        help="remap it, so that each has a key of its own, or let one run after the other",
        related=(
            *_places("writes", key, [one for one in writing if one is not here]),
            *_places("reads", key, reading),
            *_inner(span, here[1], "here"),
            *calls(here[0], span),
        ),
        node=f"{path}/{here[0].name}",
    )


def _places(verb: str, key: str, accesses: list[tuple[Node, Node]]) -> Iterator[Related]:
    for child, origin in accesses[:MOST_PLACES]:
        yield from other_place(child.span, f"`{child.name}` {verb} `{key}`")
        yield from _inner(child.span, origin, f"for `{child.name}`")


def _inner(span: Span, origin: Node, whose: str) -> tuple[Related, ...]:
    """The place inside a branch that is behind its access."""
    if origin.span == span:
        return ()
    return other_place(origin.span, f"`{origin.name}` does it {whose}")


@rule("SM406", "resource-clash", Severity.ERROR)
def resource_clash(context: Context) -> Iterator[Finding]:
    """Two branches that run at the same time hold the same resource.

    Two commands reach one arm at once: it follows neither, or jumps between them.

    Exactly: `claims` of a state, and of its type, name what it holds while it runs, in parts with
    dots: `arm` covers `arm.left`. A part in braces, `arm.{limb}`, is filled in from the variable
    of that name (left out where that is null), or from the key that the state reads, as long as
    the key is a constant of the userdata, handed through containers as it may be. What cannot be
    known before the run is not judged.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785], up: [0, 0, 0, -2, 0, 2, 0]}
        states:
          - BOTH:
              template: Concurrence
              outcomes: [succeeded, aborted]
              input_keys: [home, up]
              default_outcome: aborted
              outcome_map: {succeeded: {HOME: succeeded, UP: succeeded}}
              states:
                - HOME:
                    template: MoveToJointPositionsState
                    limb: left
                    remapping: {positions: home}
                - UP: {template: MoveToJointPositionsState, limb: left, remapping: {positions: up}}
              transitions: {succeeded: succeeded, aborted: aborted}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785], up: [0, 0, 0, -2, 0, 2, 0]}
        states:
          - BOTH:
              template: Concurrence
              outcomes: [succeeded, aborted]
              input_keys: [home, up]
              default_outcome: aborted
              outcome_map: {succeeded: {HOME: succeeded, UP: succeeded}}
              states:
                - HOME:
                    template: MoveToJointPositionsState
                    limb: left
                    remapping: {positions: home}
                - UP: {template: MoveToJointPositionsState, limb: right, remapping: {positions: up}}
              transitions: {succeeded: succeeded, aborted: aborted}
    """
    concurrences = [(path, one) for path, one in context.containers if isinstance(one, Concurrence)]
    held = context.claims if concurrences else {}
    for path, container in concurrences:
        yield from _clashes(path, container, held)


def _clashes(path: str, container: Concurrence, held: Held) -> Iterator[Finding]:
    branches = [(child, held[f"{path}/{child.name}"]) for child in container.children]
    named = {claim for _, claims in branches for claim in claims}
    holders: dict[str, list[tuple[Node, str, Node]]] = {}
    for child, claims in branches:
        for claim, origin in claims.items():
            widest = next(part for part in prefixes(claim) if part in named)
            holders.setdefault(widest, []).append((child, claim, origin))
    for resource, holding in holders.items():
        first = holding[0][0]
        other = next((one for one in holding if one[0] is not first), None)
        if other is None or "{" in resource:
            continue
        child, _, origin = other
        names = listed(one.name for one, _, _ in holding)
        places = [
            place
            for one, what, inner in holding[:MOST_PLACES]
            if one is not child
            for place in (
                *other_place(one.span, f"`{one.name}` claims `{what}`"),
                *_inner(one.span, inner, f"for `{one.name}`"),
            )
        ]
        yield Finding(
            span=child.span,
            message=f"{names} claim `{resource}` at the same time: they run together in"
            f" `{container.name}`",
            help="let one run after the other",
            related=(*places, *_inner(child.span, origin, "here"), *calls(child, child.span)),
            node=f"{path}/{child.name}",
        )
