"""Rules over the branches of a concurrence: access to the same key, claims of the same resource."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from smachac.analysis.accesses import Accesses
from smachac.analysis.context import Context
from smachac.analysis.control_flow import children_names
from smachac.analysis.raced_outputs import RacedOutput, raced_output
from smachac.analysis.resource_claims import Held, prefixes
from smachac.analysis.type_lattice import present
from smachac.checks.concurrence.raced_keys import is_never_set, own_key
from smachac.checks.findings import notation
from smachac.checks.findings.edits import likely, with_remapping
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import both, either
from smachac.ir.nodes import Concurrence, Leaf, Machine, Node, Variable

MOST_PLACES = 4
"""Limit on the other branches that a finding shows."""


@rule(
    "SM405",
    "data-race",
    Severity.ERROR,
    effect="the value depends on which branch is faster",
)
def data_race(context: Context) -> Iterator[Finding]:
    """Two branches of a concurrence write the same key, or one writes a key that another reads.

    The branches run at the same time, so the value depends on which one is faster: the arm
    sometimes moves to an old pose.

    Exactly: a leaf writes its output keys and reads its input keys at any time; a container reads
    its input keys when it starts and writes its output keys when it ends. An input key of a
    container that nothing in it reads does not count, nor does an output key that nothing in it
    writes. The keys are those in the userdata of the concurrence, after remapping.

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
    raced = raced_output(path, container, known)
    writers: dict[str, list[tuple[Node, Node]]] = {}
    readers: dict[str, list[tuple[Node, Node]]] = {}
    for child in container.children:
        own = known[f"{path}/{child.name}"]
        for key, origin in own.writes.items():
            if child is origin and is_never_set(child, key):
                continue  # SM306 or SM308
            writers.setdefault(key, []).append((child, origin))
        for key, origin in own.reads.items():
            readers.setdefault(key, []).append((child, origin))
    for key, writing in writers.items():
        names = {child.name for child, _ in writing}
        # A branch that only reads its own values does not race with itself.
        reading = [one for one in readers.get(key, ()) if one[0].name not in names]
        if len(names) > 1 or reading:
            meant = raced if raced is not None and raced.key == key else None
            yield _race(path, container, key, writing, reading, meant)


def _race(
    path: str,
    container: Concurrence,
    key: str,
    writing: list[tuple[Node, Node]],
    reading: list[tuple[Node, Node]],
    raced: RacedOutput | None,
) -> Finding:
    writers = both(child.name for child, _ in writing)
    readers = both(child.name for child, _ in reading)
    if len(writing) == 1:
        message = f"{writers} writes `{key}`"
    else:
        message = f"{writers} write `{key}` at the same time"
    if reading:
        message += f", and {readers} {'reads' if len(reading) == 1 else 'read'} it"
        message += " at the same time" if len(writing) == 1 else ""
    here = writing[:2][-1]
    if raced is not None:
        here = next(pair for pair in writing if pair[0] is raced.child)
    own, span = own_key(here[0], key), here[0].span
    other = notation.mapping(here[0], "remapping", [(own, f"{key}_2")])
    help = f"write `{other}` at `{here[0].name}`, for a key of its own, or"
    help += " run one branch after the other"
    edits: tuple[Edit, ...] = ()
    if raced is not None:
        written = [remap for remap in here[0].remaps if remap.to == key]
        span = written[0].to_span if written and written[0].to_span.source is span.source else span
        help = f"write `{notation.entry(here[0], own, raced.meant)}` in the `remapping` of"
        help += f" `{here[0].name}`: nothing sets `{raced.meant}`, which is an output of"
        help += f" `{container.name}`"
        edits = (Edit(span=span, text=raced.meant),)
        if span == here[0].span:
            edits = with_remapping(here[0], own, raced.meant)
    names = (*sorted(child.name for child, _ in writing), *sorted(one.name for one, _ in reading))
    return Finding(
        span=span,
        message=f"{message}: they are branches of `{container.name}`",
        arguments=(key, *names),
        help=help,
        related=(
            *_places("writes", key, [one for one in writing if one is not here]),
            *_places("reads", key, reading),
            *_inner(here[0], here[1], "writes it"),
            *calls(here[0], span),
        ),
        node=f"{path}/{here[0].name}",
        repairs=likely(edits, "remap the output"),
    )


def _places(verb: str, key: str, accesses: list[tuple[Node, Node]]) -> Iterator[Related]:
    for child, origin in accesses[:MOST_PLACES]:
        yield from other_place(child.span, f"`{child.name}` {verb} `{key}`")
        yield from _inner(child, origin, f"{verb} it")


def _inner(branch: Node, origin: Node, verb: str) -> tuple[Related, ...]:
    """The node inside a branch that makes its access."""
    if origin.span == branch.span:
        return ()
    return other_place(origin.span, f"in `{branch.name}`, `{origin.name}` {verb}")


@rule(
    "SM406",
    "resource-clash",
    Severity.ERROR,
    effect="both states command the same part of the robot: each command can interrupt the other",
)
def resource_clash(context: Context) -> Iterator[Finding]:
    """Two branches of a concurrence claim the same resource.

    Two commands reach one arm at the same time: the arm follows neither, or jumps between them.

    Exactly: `claims` of a state, and of its type, lists the resources that it holds while it runs,
    as names with dots: `arm` covers `arm.left`. A name in braces, as in `arm.{limb}`, stands for
    the value of that variable (it is left out if the value is null), or for the value of that input
    key if it is a constant of the userdata, also of an outer container. A claim whose value is not
    known before the run does not count.

    Wrong:
        name: sm
        template: Base
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
        template: Base
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
    concurrences = [
        (path, one)
        for path, one in context.containers
        if isinstance(one, Concurrence) and len(children_names(one)) == len(one.children)  # SM106
    ]
    held = context.claims if concurrences else {}
    for path, container in concurrences:
        for clash in _clashes(path, container, held):
            yield _clash_finding(context.machine, path, container, clash)


class _Clash(NamedTuple):
    """Resources that branches of a concurrence claim together.

    `holding` are the branches with their claims of the first resource and the nodes inside that
    make them, `child` is the branch that is reported, with its claim and that node. `chosen` is the
    variable of the node that chooses the resources, such as a limb. `claimed` are the claims of all
    branches.
    """

    resources: tuple[str, ...]
    holding: tuple[tuple[Node, str, Node], ...]
    child: Node
    claim: str
    origin: Node
    chosen: Variable | None
    claimed: Collection[str]


def _clashes(path: str, container: Concurrence, held: Held) -> Iterable[_Clash]:
    """The clashes in a concurrence: one for the resources of the same branches that the same value
    chooses, such as an arm and its gripper."""
    branches = [(child, held[f"{path}/{child.name}"]) for child in container.children]
    named = {claim for _, claims in branches for claim in claims}
    holders: dict[str, list[tuple[Node, str, Node]]] = {}
    for child, claims in branches:
        for claim, origin in claims.items():
            widest = next(part for part in prefixes(claim) if part in named)
            holders.setdefault(widest, []).append((child, claim, origin))
    found: dict[tuple[object, ...], _Clash] = {}
    for resource, holding in holders.items():
        first = holding[0][0]
        other = next((one for one in holding if one[0] is not first), None)
        if other is None or "{" in resource:
            continue
        child, claim, origin = other
        chosen = _choice(origin, claim)
        names = tuple(sorted({one.name for one, _, _ in holding}))
        same = (names, chosen.value.span if chosen is not None else None)
        known = found.get(same)
        resources = (*(known.resources if known is not None else ()), resource)
        clash = known or _Clash((), tuple(holding), child, claim, origin, chosen, named)
        found[same] = clash._replace(resources=resources)
    return found.values()


def _choice(origin: Node, claim: str) -> Variable | None:
    """The variable whose value chooses the resource of a claim: `limb` for `arm.left`."""
    if not isinstance(origin, Leaf):
        return None
    parts = claim.split(".")
    named = [variable for variable in origin.variables if variable.value.data in parts]
    return named[0] if len(named) == 1 else None


def _free(machine: Machine, clash: _Clash) -> list[str]:
    """The other values of the variable that chooses a resource that no branch claims."""
    if not isinstance(clash.origin, Leaf) or clash.chosen is None:
        return []
    type_ = present(clash.chosen.type)
    choices: Iterable[object] = type_.args if type_.name == "one_of" else ()
    if clash.chosen.name == "limb" and machine.robot is not None:
        choices = machine.robot.limb_names
    taken = {part for claim in clash.claimed for part in claim.split(".")}
    return [choice for choice in choices if isinstance(choice, str) and choice not in taken]


def _clash_finding(machine: Machine, path: str, container: Concurrence, clash: _Clash) -> Finding:
    """The finding, at the value that chooses the resource where another one is free."""
    child, chosen = clash.child, clash.chosen
    names = sorted({one.name for one, _, _ in clash.holding})
    others = [row for row in clash.holding if row[0] is not child][:MOST_PLACES]
    places = [
        place
        for one, what, inner in others
        for place in (
            *other_place(one.span, f"`{one.name}` claims {_claimed(clash, what)}"),
            *(_inner(one, inner, f"claims `{what}`") if inner.span != clash.origin.span else ()),
        )
    ]
    free = _free(machine, clash)
    span, use = child.span, "let one of them use another resource"
    if chosen is not None and free:
        span = chosen.value.span
        use = f"write {either(free)} in place of `{chosen.value.data}`"
        if any(_same_choice(inner, what, span) for _, what, inner in others):
            span, use = child.span, f"give one of them another `{chosen.name}`: {either(free)}"
    elif chosen is not None:
        use = f"give one of them another `{chosen.name}`"
    order = f"put {both(names)} into one StateMachine, one after the other"
    return Finding(
        span=span,
        message=f"{both(names)} claim {both(clash.resources)} at the same time: they are branches"
        f" of `{container.name}`",
        arguments=(_as_written(clash.claim, clash.origin), *names),
        help=f"{use}, or {order}" if span != child.span else f"{order}, or {use}",
        related=(*places, *_inner_claim(clash, others), *calls(child, span)),
        node=f"{path}/{child.name}",
    )


def _claimed(clash: _Clash, claim: str) -> str:
    """The resources of a clash, for a branch that claims the first one as `claim`."""
    return both(clash.resources) if claim in clash.resources else f"`{claim}`"


def _inner_claim(clash: _Clash, others: Sequence[tuple[Node, str, Node]]) -> Iterable[Related]:
    """The state inside the reported branch that makes its claim; branches that call one sub-script
    can have it at one place."""
    child, origin = clash.child, clash.origin
    same = [one.name for one, _, inner in others if inner.span == origin.span != one.span]
    if origin.span == child.span or not same:
        return _inner(child, origin, f"claims `{clash.claim}`")
    names = both(sorted([*same, child.name]))
    return other_place(origin.span, f"in {names}, `{origin.name}` claims `{clash.claim}`")


def _same_choice(origin: Node, claim: str, span: Span) -> bool:
    """Whether the value with a place chooses also the resource of another branch."""
    chosen = _choice(origin, claim)
    return chosen is not None and chosen.value.span == span


def _as_written(claim: str, origin: Node) -> str:
    """A claim with its names in braces, as the script or the state type has it: their values can
    depend on the caller of a sub-script."""
    same = (text for text in origin.claims if claim.startswith(text.partition("{")[0]))
    return claim if claim in origin.claims else next(same, claim)
