"""The rule over checks of a grasp: a check of a gripper that nothing has closed."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.robot.gripper_effects import MOST_VISITS, comes_to_body, grip_of, keeps_gripper
from smachac.checks.robot.simulated_world import is_simulated
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.ir.graph import Event
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Concurrence, Leaf
from smachac.ir.outcome_names import GOOD_OUTCOMES, fails, is_failure, successes


@rule(
    "SM516",
    "open-gripper",
    Severity.WARNING,
    effect="the check of the grasp always ends with `aborted`, although the arm did its motions",
)
def open_gripper(context: Context) -> Iterator[Finding]:
    """A state checks a grasp, but on every path to it the gripper is open.

    The check never succeeds: the task ends with a failure in every run.

    Exactly: in the simulation, on every path to a state whose type has `checks_grasp: true` the
    gripper of its limb was opened, or the machine begins, and nothing closed it since then. Without
    such a state: a gripper that is opened is opened again after the tool came to a body, and no
    state closes a gripper. Reported are two slips: a second state opens the gripper again after a
    motion of the arm, and a state closes the gripper of another limb. A path with a state that may
    do something else to the gripper decides nothing: a stand-in, a type without an interface, one
    of the user without `role: grip`. A check that leads to a failure if it succeeds is not
    reported: it makes sure that the gripper is empty.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {cup: [[0.5, 0.1, 0.03], [0, 0, 0, 1]]}
        states:
          - OPEN:
              template: GripperState
              command: open
              transitions: {succeeded: TO_CUP, aborted: aborted, preempted: aborted}
          - TO_CUP:
              template: MoveAlongState
              grasp: true
              remapping: {pose: cup}
              transitions: {succeeded: HOLD, aborted: aborted, preempted: aborted}
          - HOLD:
              template: GripperState
              command: open
              transitions: {succeeded: HELD, aborted: aborted, preempted: aborted}
          - HELD:
              template: CheckGraspState
              transitions: {succeeded: succeeded, aborted: aborted}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {cup: [[0.5, 0.1, 0.03], [0, 0, 0, 1]]}
        states:
          - OPEN:
              template: GripperState
              command: open
              transitions: {succeeded: TO_CUP, aborted: aborted, preempted: aborted}
          - TO_CUP:
              template: MoveAlongState
              grasp: true
              remapping: {pose: cup}
              transitions: {succeeded: HOLD, aborted: aborted, preempted: aborted}
          - HOLD:
              template: GripperState
              command: close
              transitions: {succeeded: HELD, aborted: aborted, preempted: aborted}
          - HELD:
              template: CheckGraspState
              transitions: {succeeded: succeeded, aborted: aborted}
    """
    if not is_simulated(context):
        return
    leaves = {path: node for path, node in context.states if isinstance(node, Leaf)}
    types = context.machine.state_types
    checking = {name for name, type_ in types.items() if type_.checks_grasp}
    checks = [path for path, leaf in leaves.items() if leaf.type in checking]
    if not checks:
        yield from _never_closed(context, leaves)
    visits, reported = 0, set()
    for path in checks:
        if _expects_nothing(leaves[path]) or (path, "") not in context.routes.before:
            continue
        found = _before(context, leaves, path, path)
        visits += found.visits
        if visits > MOST_VISITS:
            return
        finding = _finding(context, leaves, path, found) if found.open else None
        if finding is not None and finding.span not in reported:
            reported.add(finding.span)
            yield finding


def _expects_nothing(leaf: Leaf) -> bool:
    """Whether the success of a check leads to a failure at once: the gripper has to be empty."""
    good = successes(leaf)
    return any(
        is_failure(step.target)
        if step.outcome in good
        else fails(leaf, step.outcome) and step.target in GOOD_OUTCOMES
        for step in leaf.transitions
    )


class _Before(NamedTuple):
    """The paths to a state, backwards to where the gripper of a limb was opened.

    `open`: on all of them it is open. `opened` are the states that opened it, `started`: a path
    begins with the machine. `others` are the states that close the gripper of another limb,
    `moved`: an arm moves on some path; `reached`: it comes to a body.
    """

    open: bool
    opened: tuple[str, ...] = ()
    started: bool = False
    others: tuple[str, ...] = ()
    moved: bool = False
    visits: int = 0
    reached: bool = False


def _before(context: Context, leaves: Mapping[str, Leaf], path: str, check: str) -> _Before:
    """The search backwards from the entry of a state for the gripper of the limb of a check."""
    if _changes_beside(context, leaves, path, check):
        return _Before(open=False)
    graph = context.routes.graph
    start: Event = (path, "")
    todo, seen = [start], {start}
    opened: dict[str, None] = {}
    others: dict[str, None] = {}
    started = moved = reached = False
    for event in todo:
        where, outcome = event
        leaf = leaves.get(where)
        if leaf is not None and outcome:
            same = _same_limb(context, leaf, leaves[check])
            grip = grip_of(leaf)
            if grip == "open" and same and outcome in successes(leaf):
                opened[where] = None
                continue
            if (grip is not None and same is not False) or (
                grip is None and not keeps_gripper(leaf)
            ):
                return _Before(open=False, visits=len(seen))
            if grip == "close":
                others[where] = None
            reached = reached or comes_to_body(leaf)
            moved = moved or any(claim.startswith("arm") for claim in leaf.claims)
        before = list(graph.pred[event])
        started = started or not before
        for item in before:
            if item not in seen:
                seen.add(item)
                todo.append(item)
    return _Before(True, tuple(opened), started, tuple(others), moved, len(seen), reached)


def _never_closed(context: Context, leaves: Mapping[str, Leaf]) -> Iterator[Finding]:
    """The state that opens an open gripper after the tool came to a body, if no state of the script
    closes a gripper: the first one of them, where only one is the first."""
    opening = [path for path, leaf in leaves.items() if grip_of(leaf) == "open"]
    known = all(keeps_gripper(leaf) or grip_of(leaf) == "open" for leaf in leaves.values())
    if len(opening) < 2 or not known or any(grip_of(leaf) == "close" for leaf in leaves.values()):
        return
    visits, found = 0, dict[str, _Before]()
    for path in opening:
        before = _before(context, leaves, path, path)
        visits += before.visits
        if visits > MOST_VISITS:
            return
        if before.open and before.opened and before.reached and not before.started:
            found[path] = before
    first = [path for path, before in found.items() if found.keys().isdisjoint(before.opened)]
    held = variable_of(leaves[first[0]], "grip") if len(first) == 1 else None
    if held is None:
        return
    leaf, earlier = leaves[first[0]], leaves[found[first[0]].opened[0]]
    yield Finding(
        span=held.value.span,
        message=f"`{leaf.name}` opens a gripper that is open already, and no state closes it",
        arguments=(leaf.name,),
        help=f"write `{held.name}: close`",
        effect="the arm grasps nothing, although it does its motions",
        related=(
            *other_place(earlier.span, f"`{earlier.name}` opens it here"),
            *calls(leaf, held.value.span),
        ),
        node=first[0],
    )


def _changes_beside(context: Context, leaves: Mapping[str, Leaf], path: str, check: str) -> bool:
    """Whether a state that runs beside a state, in a branch of a concurrence, may close the
    gripper."""
    parts = path.split("/")
    around = ["/".join(parts[:end]) for end in range(1, len(parts))]
    beside = [text for text in around if isinstance(context.routes.nodes.get(text), Concurrence)]
    if not beside:
        return False
    return any(
        where.startswith(f"{beside[0]}/")
        and (
            not keeps_gripper(leaf)
            if grip_of(leaf) is None
            else _same_limb(context, leaf, leaves[check]) is not False
        )
        for where, leaf in leaves.items()
        if where != path
    )


def _same_limb(context: Context, one: Leaf, other: Leaf) -> bool | None:
    """Whether two states use the same limb; None: not known."""
    first, second = _limb(one), _limb(other)
    robot = context.machine.robot
    limbs = robot.limb_names if robot is not None else ()
    if first == second or None in (first, second):
        return True if (first == second and (first or len(limbs) < 2)) or len(limbs) == 1 else None
    texts = isinstance(first, str) and isinstance(second, str)
    return False if texts and {first, second} <= {*limbs} else None


def _limb(leaf: Leaf) -> object:
    held = variable_of(leaf, "limb")
    return held.value.data if held is not None else None


def _is_used(leaves: Mapping[str, Leaf], path: str, limb: object, check: Leaf) -> bool:
    """Whether another state than the one at a path opens, closes or checks the gripper of a
    limb."""
    return any(
        _limb(leaf) == limb and (grip_of(leaf) is not None or leaf.type == check.type)
        for where, leaf in leaves.items()
        if where != path
    )


def _finding(
    context: Context, leaves: Mapping[str, Leaf], check: str, found: _Before
) -> Finding | None:
    """The finding on the state with the wrong word: one that opens the gripper for the second time,
    or one that closes that of another limb."""
    name = leaves[check].name
    if len(found.others) == 1:
        leaf = leaves[found.others[0]]
        limb, wanted = variable_of(leaf, "limb"), _limb(leaves[check])
        if limb is None or _is_used(leaves, found.others[0], limb.value.data, leaves[check]):
            return None
        return Finding(
            span=limb.value.span,
            message=f"`{leaf.name}` closes the gripper of `{limb.value.data}`, but `{name}` checks"
            f" that of `{wanted}`, which nothing closes before it",
            arguments=(leaf.name, name),
            help=f"write `{limb.name}: {wanted}`",
            related=(
                *other_place(leaves[check].span, f"`{name}` checks the grasp here"),
                *calls(leaf, limb.value.span),
            ),
            node=found.others[0],
        )
    if len(found.opened) != 1 or found.others or found.started:
        return None
    leaf = leaves[found.opened[0]]
    earlier = _before(context, leaves, found.opened[0], check)
    held = variable_of(leaf, "grip")
    if not earlier.open or earlier.started or not earlier.opened or not earlier.moved or not held:
        return None
    first = leaves[earlier.opened[0]]
    return Finding(
        span=held.value.span,
        message=f"`{leaf.name}` opens a gripper that is open already, and nothing closes it before"
        f" `{name}` checks the grasp",
        arguments=(leaf.name, name),
        help=f"write `{held.name}: close`",
        related=(
            *other_place(first.span, f"`{first.name}` opens it here"),
            *other_place(leaves[check].span, f"`{name}` checks the grasp here"),
            *calls(leaf, held.value.span),
        ),
        node=found.opened[0],
    )
