"""Rules on requests to stop. SM209 and SM211: after a state has serviced a request, the task goes
on. SM210: the machine ends with a success. The paths are those of analysis/stop_paths.py."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.possible_outcomes import Judged, results
from smachac.analysis.stop_paths import (
    Resumed,
    branch_around,
    stoppable_branches,
    stopped_space,
    task_successes,
)
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, other_place, own_name
from smachac.checks.rule import rule
from smachac.checks.timing.stop_answers import answered_here, led_out, way_out, witness
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.graph import stopped_endings
from smachac.ir.nodes import Leaf
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names


@rule(
    "SM209",
    "ignored-stop",
    Severity.WARNING,
    effect="the preempt request is lost: the robot continues its work",
)
def ignored_stop(context: Context) -> Iterator[Finding]:
    """After a preempt request the state that was stopped starts again.

    The first answer to a request counts for the whole machine, so the robot continues its work as
    if nobody had pressed Ctrl-C.

    Exactly: the transition for `preempted` leads back to its state, directly or through states that
    neither fail nor are preempted. A state that has no success may fail. The way back does not
    count if it leads through a state that has several ways out and runs only after a preempt
    request; or only after failures and preempt requests, if it is `blocking` and claims nothing, as
    one in which an operator decides. For a container, the transitions for the outcomes with which
    it ends after a preempt request count. In a concurrence with `join: any`, or under a time limit,
    SM407 reports such a loop.

    Wrong:
        name: sm
        template: Base
        outcomes: [arrived, stopped]
        states:
          - WAIT:
              template: SleepState
              time: 1
              transitions: {succeeded: DRIVE, preempted: WAIT}
          - DRIVE:
              template: ScriptedState
              outcomes: [there, blocked]
              transitions: {there: arrived, blocked: stopped}

    Right:
        name: sm
        template: Base
        outcomes: [arrived, stopped]
        states:
          - WAIT:
              template: SleepState
              time: 1
              transitions: {succeeded: DRIVE, preempted: stopped}
          - DRIVE:
              template: ScriptedState
              outcomes: [there, blocked]
              transitions: {there: arrived, blocked: stopped}
    """
    again = context.stop_paths.again
    branches = stoppable_branches(context.containers, context.endings) if again else {}
    for found in again:
        path, container, child, step, _ = found.stop
        if branch_around(path, branches):
            continue
        yield Finding(
            span=step.span,
            message=f"after a preempt request{_inside(found)} `{child.name}` starts again, and"
            f" `{container.name}` continues",
            arguments=(own_name(child, step.span), step.outcome),
            help=way_out(found),
            related=(*answered_here(found), *calls(child, step.span)),
            path=witness(found),
            node=f"{path}/{child.name}",
        )


@rule("SM210", "stop-as-success", Severity.WARNING)
def stop_as_success(context: Context) -> Iterator[Finding]:
    """A container that is stopped ends with a success, as if its task were done.

    The operator stops the robot, and the machine reports that it has done its task. In a nested
    container it is worse: the next state of the task starts.

    Exactly: the transition for `preempted` leads to a success of the container, directly or through
    states that neither fail nor are preempted and lead to no other outcome. For a container inside,
    the transitions for the outcomes with which it ends after a preempt request count. A success is
    `succeeded`, or `done`, `ok` or similar if the container also has an outcome of failure or the
    outcome `preempted`. It counts only if the container also ends with it without a preempt
    request: a machine that works until it is stopped may end so with a success. A concurrence is
    reported if it ends with a success after all its branches have been preempted, and an iterator
    if it ends after an item as it does after the last one. Not reported: a way through a state to
    which a failure of the same state leads as well, and a container that has itself called the stop
    a success.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded, failed]
        states:
          - DRIVE:
              template: ScriptedState
              outcomes: [there, blocked]
              transitions: {there: WAIT, blocked: failed}
          - WAIT:
              template: SleepState
              time: 5
              transitions: {succeeded: succeeded, preempted: succeeded}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded, failed, preempted]
        states:
          - DRIVE:
              template: ScriptedState
              outcomes: [there, blocked]
              transitions: {there: WAIT, blocked: failed}
          - WAIT:
              template: SleepState
              time: 5
              transitions: {succeeded: succeeded, preempted: preempted}
    """
    for found in context.stop_paths.praised:
        path, container, child, step, _ = found.stop
        yield Finding(
            span=step.span,
            message=f"after a preempt request in `{child.name}`, `{container.name}` ends with"
            f" `{found.end}`, as if its task were done",
            arguments=(own_name(child, step.span), step.outcome, found.end),
            help=led_out(container, step.outcome),
            related=(*answered_here(found), *calls(child, step.span)),
            path=witness(found),
            node=f"{path}/{child.name}",
        )
    for judged in context.judged:
        yield from _stopped_branches(context, judged)
    for inner, loop in context.containers:
        if isinstance(loop, nodes.Iterator):
            yield from _stopped_loop(context, inner, loop)


def _stopped_branches(context: Context, each: Judged) -> Iterator[Finding]:
    """A concurrence that ends with a success when all its branches are preempted."""
    node, found = each.concurrence.node, context.stop_paths
    good = task_successes(node) - found.only.get(each.path, frozenset())
    space = stopped_space(each, found)
    if not good or not space:
        return
    for name in sorted(good & results(node, each.concurrence, [space])):
        default = name == node.default_outcome
        span = node.default_span
        if not default:
            span = next(one.span for one in node.rules if one.outcome == name)
        place = "as default outcome" if default else "in this rule"
        yield Finding(
            span=span,
            message=f"after a preempt request `{node.name}` ends with `{name}`, although its"
            " branches were stopped",
            arguments=(own_name(node, span), name),
            help=f"use an outcome that does not mean success {place}, such as `preempted`",
            related=calls(node, span),
            node=each.path,
        )


def _stopped_loop(context: Context, path: str, container: nodes.Iterator) -> Iterator[Finding]:
    """An iterator of the script that ends after one item as it does after all of them."""
    if container.sugar or _has_one_item(container):
        return
    for child in container.children:
        if context.stop_paths.answers_of(f"{path}/{child.name}", child):
            return
    renamed = dict(container.final_map)
    last = renamed.get(container.exhausted_outcome, container.exhausted_outcome)
    for name, end in stopped_endings(container).items():
        if end != last or end not in task_successes(container):
            continue
        yield Finding(
            span=container.span,
            message=f"after a preempt request `{container.name}` ends with `{end}` after one item,"
            " as if it had done all of them",
            arguments=(container.name, name, end),
            help=_other_ends(container, name, end),
            related=calls(container, container.span),
            node=path,
        )


def _has_one_item(container: nodes.Iterator) -> bool:
    items = container.items.data if container.items is not None else None
    return isinstance(items, tuple) and len(items) < 2


def _other_ends(container: nodes.Iterator, name: str, end: str) -> str:
    """How an iterator ends differently after a stop and after the last item."""
    add = "" if PREEMPTED in outcome_names(container) else "add the outcome `preempted`, and "
    if name != container.exhausted_outcome:
        renaming = notation.entry(container, name, PREEMPTED)
        return f"{add}write `{renaming}` in the `final_outcome_map`"
    last = notation.name(container, "exhausted_outcome", "exhausted")
    pairs = [(name, PREEMPTED), ("exhausted", end)]
    ends = notation.mapping(container, "final_outcome_map", pairs)
    return f"{add}write `{last}` and `{ends}`"


@rule(
    "SM211",
    "task-after-stop",
    Severity.WARNING,
    effect="the robot can move although somebody stopped it",
)
def task_after_stop(context: Context) -> Iterator[Finding]:
    """After a preempt request the robot continues its task with a state that holds a resource.

    Somebody stops the robot because it is about to do damage, and the arm moves on.

    Exactly: the transition for `preempted` leads to a state of the ordinary task that `claims` a
    resource, directly or through states that neither fail nor are preempted. The ordinary task are
    the states that can run without a failure and without a preempt request. A state that runs only
    after a failure or a preempt request is there to make the robot safe, such as one that opens the
    gripper or moves the arm home; it is not reported, and neither is a state to which a failure of
    the same state leads. A way through a state in which an operator decides, as SM209 describes
    it, does not count. Where a state of the
    task also makes the robot safe, write a second state for the stop, or allow the transition:
    `# smachac: allow SM211 home is safe from everywhere`.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded, failed]
        states:
          - WAIT:
              template: SleepState
              time: 5
              transitions: {succeeded: LIFT, preempted: LIFT}
          - LIFT:
              template: ScriptedState
              outcomes: [lifted, failed]
              claims: [arm]
              transitions: {lifted: succeeded, failed: failed}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded, failed, preempted]
        states:
          - WAIT:
              template: SleepState
              time: 5
              transitions: {succeeded: LIFT, preempted: LOWER}
          - LIFT:
              template: ScriptedState
              outcomes: [lifted, failed]
              claims: [arm]
              transitions: {lifted: succeeded, failed: failed}
          - LOWER:
              template: ScriptedState
              outcomes: [lowered]
              claims: [arm]
              transitions: {lowered: preempted}
    """
    for found in context.stop_paths.moving:
        path, container, child, step, _ = found.stop
        mover = found.mover
        assert mover is not None
        held = context.claims[f"{path}/{mover.name}"]
        yield Finding(
            span=step.span,
            message=f"after a preempt request in `{child.name}` the task continues: `{mover.name}`"
            f" holds {listed(held)}",
            arguments=(own_name(child, step.span), step.outcome, mover.name),
            help=f"{led_out(container, step.outcome)}, or lead `{step.outcome}` to a state that"
            " only makes the robot safe",
            related=(
                *answered_here(found),
                *other_place(mover.span, "this state of the task starts"),
                *calls(child, step.span),
            ),
            path=witness(found),
            node=f"{path}/{child.name}",
        )


def _inside(found: Resumed) -> str:
    """Where the request is answered, if that is inside the state that starts again."""
    origin, child = found.stop.origin, found.stop.child
    return "" if isinstance(child, Leaf) or origin is child else f" in `{origin.name}`"
