"""Parts of findings about preempt requests: the state that answers, the help, the witness path."""

from __future__ import annotations

from smachac.analysis.control_flow import MOST_STEPS
from smachac.analysis.stop_paths import Resumed
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import other_place
from smachac.diagnostics.diagnostic import PathStep, Related, ended, entered
from smachac.ir.nodes import Container
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names


def answered_here(found: Resumed) -> tuple[Related, ...]:
    """The place of the state that answers a request, if it is inside another one."""
    origin, child = found.stop.origin, found.stop.child
    if origin is child or origin.span == child.span:
        return ()
    return other_place(origin.span, "this state answers the preempt request")


def way_out(found: Resumed) -> str:
    """What to do where a state starts again after a request."""
    _, container, child, step, _ = found.stop
    if step.outcome == PREEMPTED:
        return led_out(container, PREEMPTED)
    return (
        f"let `{child.name}` end with an outcome of its own after a preempt request, such as"
        f" `preempted`, and lead that to an outcome of `{container.name}`"
    )


def led_out(container: Container, outcome: str) -> str:
    """The help that leads an outcome of a stopped state out of its container."""
    written = f"write `{notation.entry(container, outcome, PREEMPTED)}`"
    if PREEMPTED in outcome_names(container):
        return written
    return f"add `{PREEMPTED}` to the outcomes of `{container.name}`, and {written}"


def witness(found: Resumed) -> tuple[PathStep, ...]:
    """The witness path: the state that answers, and the states that follow."""
    path, _, child, step, _ = found.stop
    leads = [(step.outcome, step.target)]
    if step.target == found.end and not found.way:
        return (
            entered(child.name, f"{path}/{child.name}"),
            ended(step.outcome),
            entered(found.end, None),
        )
    steps = [entered(child.name, f"{path}/{child.name}")]
    for outcome, target in [*leads, *found.way][-MOST_STEPS:]:
        steps += [ended(outcome), entered(target, f"{path}/{target}")]
    return tuple(steps)
