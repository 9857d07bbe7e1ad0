"""Targets of transitions that are words for the control of a loop: `continue` and `break`.

A loop has no such targets: it continues after the outcomes in `on` of `for_each`, or in
`loop_outcomes` of an Iterator, and ends after the others.
"""

from __future__ import annotations

from collections.abc import Mapping

from smachac.diagnostics.spelling import written_name
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.nodes import Container, Node, Transition
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names

CONTINUES = frozenset(["continue", "loop", "next", "next_item"])
BREAKS = frozenset(["break", "break_loop", "end_loop", "exit_loop"])
WORDS = CONTINUES | BREAKS


def loop_target(
    path: str,
    container: Container,
    child: Node,
    step: Transition,
    meant: str | None,
    containers: Mapping[str, Node],
) -> str | None:
    """The help for a transition to `continue` or `break`: of a state with `for_each`, or of a state
    in a container that a loop runs. `path` is that of the container, `meant` the target that is
    probably meant; `containers` are all by path.
    """
    word = step.target.casefold()
    if word not in WORDS:
        return None
    if isinstance(child, nodes.Iterator) and child.sugar == "for_each":
        return _of_loop(container, child, step, meant, again=word in CONTINUES)
    around = containers.get(path.rpartition("/")[0])
    if isinstance(around, nodes.Iterator) and around.sugar in ("", "for_each"):
        return _of_body(container, around, step, again=word in CONTINUES)
    return None


def _of_loop(
    container: Container, loop: nodes.Iterator, step: Transition, meant: str | None, *, again: bool
) -> str:
    outcome, on = written_name(step.outcome), loop.loop_outcomes
    if again and outcome not in on:
        more = ", ".join((*on, outcome))
        return (
            f"write `on: [{more}]` in `for_each`, and remove this transition: the loop continues"
            " after the outcomes in `on`"
        )
    states = [each.name for each in container.children if each is not loop]
    names = listed([*states, *outcome_names(container)])
    where = f"write `{outcome}: TARGET` with one of {names}"
    if meant is not None:
        where = f"write `{outcome}: {meant}`"
    if again:
        return (
            f"{where}: the loop continues by itself after `{outcome}`, and this transition is taken"
            " after the last item"
        )
    if outcome in on:
        where = f"{where}, and remove `{outcome}` from `on`"
    return f"{where}: the loop ends after each outcome that is not in `on`"


def _of_body(body: Container, loop: nodes.Iterator, step: Transition, *, again: bool) -> str | None:
    field = "`on` of `for_each`" if loop.sugar else "`loop_outcomes`"
    outcome = written_name(step.outcome)
    names = [name for name in outcome_names(body) if name != PREEMPTED and name != body.catches]
    fits = [name for name in names if (name in loop.loop_outcomes) == again]
    if not fits:
        return None
    why = "the loop ends after each outcome that is not in"
    if again:
        why = "the loop runs for the next item after each outcome in"
    if len(fits) == 1:
        return f"write `{outcome}: {fits[0]}`: {why} {field}"
    return f"write `{outcome}: OUTCOME` with one of {listed(fits)}: {why} {field}"
