"""The rule over the order of grasps: a gripper that is closed when the tool comes to a body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

from smachac.analysis.context import Context
from smachac.checks.findings.help_text import calls, names_apart, other_place
from smachac.checks.robot.gripper_effects import (
    MOST_VISITS,
    Effect,
    comes_to_body,
    grip_of,
    keeps_gripper,
)
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.meanings import of_same_meaning
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import words_of
from smachac.diagnostics.wording import listed
from smachac.ir.graph import Event
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import fails, successes


@rule(
    "SM513",
    "closed-gripper",
    Severity.WARNING,
    effect="the closed fingers push the body away, and the grasp fails",
)
def closed_gripper(context: Context) -> Iterator[Finding]:
    """The tool comes to a body with a closed gripper, which then closes again.

    The closed fingers push the body away or break it, and the grasp fails.

    Exactly: on every path to a state that closes the gripper, the gripper was closed before with
    success, and since then it was not opened and the tool moved to a grasp pose: a state with
    `role: grasp` and without an offset. A gripper whose grasp was checked may be closed again where
    a later state opens it before another one closes it. Whether a state opens or closes a gripper
    is the fact `role: grip` of its type. A path with a state that may do something else to the
    gripper decides nothing: a stand-in, a type without an interface, one of the user without that
    fact.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {cup: [[0.5, 0.1, 0.03], [0, 0, 0, 1]], box: [[0.5, -0.1, 0.03], [0, 0, 0, 1]]}
        states:
          - TO_CUP:
              template: MoveAlongState
              grasp: true
              remapping: {pose: cup}
              transitions: {succeeded: HOLD_CUP, aborted: aborted, preempted: aborted}
          - HOLD_CUP:
              template: GripperState
              command: close
              transitions: {succeeded: TO_BOX, aborted: aborted, preempted: aborted}
          - TO_BOX:
              template: MoveAlongState
              grasp: true
              remapping: {pose: box}
              transitions: {succeeded: HOLD_BOX, aborted: aborted, preempted: aborted}
          - HOLD_BOX:
              template: GripperState
              command: close
              transitions: {succeeded: succeeded, aborted: aborted, preempted: aborted}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [succeeded, aborted]
        userdata: {cup: [[0.5, 0.1, 0.03], [0, 0, 0, 1]], box: [[0.5, -0.1, 0.03], [0, 0, 0, 1]]}
        states:
          - TO_CUP:
              template: MoveAlongState
              grasp: true
              remapping: {pose: cup}
              transitions: {succeeded: HOLD_CUP, aborted: aborted, preempted: aborted}
          - HOLD_CUP:
              template: GripperState
              command: close
              transitions: {succeeded: LET_GO, aborted: aborted, preempted: aborted}
          - LET_GO:
              template: GripperState
              command: open
              transitions: {succeeded: TO_BOX, aborted: aborted, preempted: aborted}
          - TO_BOX:
              template: MoveAlongState
              grasp: true
              remapping: {pose: box}
              transitions: {succeeded: HOLD_BOX, aborted: aborted, preempted: aborted}
          - HOLD_BOX:
              template: GripperState
              command: close
              transitions: {succeeded: succeeded, aborted: aborted, preempted: aborted}
    """
    closing = [path for path, leaf in context.leaves_with_variables if grip_of(leaf) == "close"]
    if len(closing) < 2:
        return
    leaves = {path: node for path, node in context.states if isinstance(node, Leaf)}
    if not any(map(comes_to_body, leaves.values())):
        return
    visits = 0
    for path in closing:
        found = _closed_before(context, leaves, path)
        visits += found.visits
        if visits > MOST_VISITS:
            return
        held = variable_of(leaves[path], "grip")
        if found.closed and found.checked and held is not None:
            if not _opened_after(context, leaves, path):
                yield _held_finding(leaves, path, found, held.value.span)
        elif found.closed:
            yield _closed_finding(context, leaves[path], path, found)


class _Closed(NamedTuple):
    """The states that have closed a gripper on all paths to a state, and the motions between; none
    where a path decides nothing. `checked` is a state between that checks the grasp."""

    closed: tuple[str, ...]
    moved: tuple[str, ...]
    visits: int
    checked: str = ""


def _closed_finding(context: Context, leaf: Leaf, path: str, found: _Closed) -> Finding:
    """The finding on a state that closes a closed gripper at a body."""
    own, *names = names_apart((path, *found.closed, *found.moved))
    places = [context.routes.nodes[text].span for text in (found.closed[0], found.moved[0])]
    held = variable_of(leaf, "grip")
    releases = held is not None and _is_to_release(leaf.name)
    help = (
        "open the gripper before the tool moves to the body: add a state with"
        " `template: GripperState` and `command: open` before"
        f" `{names[len(found.closed)]}`"
    )
    if releases and held is not None:
        help = f"write `{held.name}: open` in `{own}`"
    return Finding(
        span=held.value.span if releases and held is not None else leaf.span,
        message=f"`{own}` closes a gripper that is already closed:"
        f" {listed(names[: len(found.closed)])} closed it before the tool moved to the body"
        f" ({listed(names[len(found.closed) :])})",
        arguments=(leaf.name, *sorted(set(names))),
        help=help,
        effect="the gripper never releases the body here" if releases else None,
        related=(
            *other_place(places[0], "the gripper is closed here"),
            *other_place(places[1], "the tool moves to the body here"),
            *calls(leaf, leaf.span),
        ),
        node=path,
    )


def _is_to_release(name: str) -> bool:
    """Whether the name of a state means that it opens a gripper: OPEN_HAND, RELEASE, LET_GO."""
    words = words_of(name)
    return {"let", "go"} <= words or any(
        of_same_meaning(word, ("open", "close")) == "open" for word in words
    )


def _held_finding(leaves: Mapping[str, Leaf], path: str, found: _Closed, span: Span) -> Finding:
    """The finding on a state that closes a gripper which holds a body: a check of the grasp has
    succeeded before."""
    leaf, first, check = leaves[path], leaves[found.closed[0]], leaves[found.checked]
    names = names_apart((path, found.closed[0], found.checked))
    return Finding(
        span=span,
        message=f"`{names[0]}` closes the gripper, which holds a body since `{names[1]}`",
        arguments=(leaf.name, first.name),
        help="write `command: open` here, or open the gripper before the next grasp",
        effect="the gripper never releases the body here",
        related=(
            *other_place(first.span, "the gripper is closed here"),
            *other_place(check.span, f"`{names[2]}` has checked the grasp"),
            *calls(leaf, span),
        ),
        node=path,
    )


def _opened_after(context: Context, leaves: Mapping[str, Leaf], path: str) -> bool:
    """Whether a state may open the gripper after the state that closes it, before another closes
    it, and without a failure between: then it is only closed more firmly."""
    succ = context.routes.graph.succ
    todo: list[Event] = [*succ[path, ""]]
    seen = {*todo}
    for event in todo:
        leaf = leaves.get(event[0])
        if leaf is not None and fails(leaf, event[1]):
            continue
        if leaf is not None and event[0] != path and event[1]:
            grip = grip_of(leaf)
            if grip in ("open", "unknown") or (grip is None and not keeps_gripper(leaf)):
                return True
            if grip == "close":
                continue
        new = [item for item in succ[event] if item not in seen]
        seen.update(new)
        todo += new
    return False


def _closed_before(context: Context, leaves: Mapping[str, Leaf], path: str) -> _Closed:
    """The search backwards from the entry of a state that closes a gripper."""
    graph = context.routes.graph
    resources = set(context.claims.get(path, {}))
    start: tuple[Event, bool] = ((path, ""), False)
    seen: set[tuple[Event, bool]] = {start}
    todo: list[tuple[Event, bool]] = [start]
    closed: dict[str, None] = {}
    moved: dict[str, None] = {}
    checked = ""
    for event, has_moved in todo:
        where, outcome = event
        leaf = leaves.get(where)
        comes = has_moved
        if leaf is not None and outcome:
            known = _effect(leaf, outcome)
            same = known is None or set(context.claims.get(where, {})) == resources
            if known == "close" and same and has_moved:
                closed[where] = None
                continue
            if known is not None or not keeps_gripper(leaf):
                return _Closed((), (), len(seen))
            type_ = context.machine.state_types.get(leaf.type)
            if type_ is not None and type_.checks_grasp and outcome in successes(leaf):
                checked = where
            if comes_to_body(leaf) and outcome in successes(leaf):
                moved[where] = None
                comes = True
        before = list(graph.pred[event])
        if not before:
            return _Closed((), (), len(seen))
        for item in before:
            if (item, comes) not in seen:
                seen.add((item, comes))
                todo.append((item, comes))
    return _Closed(tuple(closed), tuple(moved) if closed else (), len(seen), checked)


def _effect(leaf: Leaf, outcome: str) -> Effect | None:
    """What a state has done to its gripper when it ends with an outcome."""
    found = grip_of(leaf)
    return found if found is None or outcome in successes(leaf) else "unknown"
