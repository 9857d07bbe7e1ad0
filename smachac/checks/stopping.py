"""A rule over iterators that are asked to stop."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.hints import PREEMPTED, calls
from smachac.checks.once import containers
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir import nodes
from smachac.ir.graph import stopped_endings
from smachac.ir.nodes import Machine
from smachac.ir.walk import outcome_names
from smachac.problems import listed


@rule("SM208", "no-way-to-stop", Severity.INFO)
def no_way_to_stop(machine: Machine) -> Iterator[Finding]:
    """An iterator that is asked to stop ends with an outcome that it does not have.

    A request to stop, such as Ctrl-C, ends it after the item at hand with the outcome of its
    state, also if that is one on which it goes on else; `final_outcome_map` renames it. What the
    iterator does not declare is an error, and the whole machine ends there instead of with an
    outcome. That is a note, and a warning where the iterator declares `preempted`: somebody counts
    on it.

    Wrong:
        name: sm
        template: Base
        outcomes: [seen, stopped]
        states:
          - EACH:
              template: Iterator
              outcomes: [all, preempted]
              it: [1, 2, 3]
              exhausted_outcome: all
              loop_outcomes: [done]
              states:
                - LOOK: {template: ScriptedState, outcomes: [done]}
              transitions: {all: seen, preempted: stopped}

    Right:
        name: sm
        template: Base
        outcomes: [seen, stopped]
        states:
          - EACH:
              template: Iterator
              outcomes: [all, preempted]
              it: [1, 2, 3]
              exhausted_outcome: all
              loop_outcomes: [done]
              final_outcome_map: {done: preempted}
              states:
                - LOOK: {template: ScriptedState, outcomes: [done]}
              transitions: {all: seen, preempted: stopped}
    """
    for path, container in containers(machine):
        lost = undeclared_stops(container) if isinstance(container, nodes.Iterator) else []
        if not lost:
            continue
        name, counted_on = container.name, PREEMPTED in outcome_names(container)
        renamed = ", ".join(f"{outcome}: {PREEMPTED}" for outcome in lost)
        first = "" if counted_on else f"add `{PREEMPTED}` to its outcomes, and "
        yield Finding(
            span=container.span,
            message=f"when `{name}` is asked to stop it can end with {listed(lost)}, which is none"
            " of its outcomes: an error",
            help=f"{first}rename it: `final_outcome_map: {{{renamed}}}`",
            related=calls(container, container.span),
            severity=Severity.WARNING if counted_on else None,
            node=path,
        )


def undeclared_stops(container: nodes.Iterator) -> list[str]:
    """The looping outcomes of its state with which an iterator that is asked to stop would end
    without having them as its own."""
    own = outcome_names(container)
    ends = stopped_endings(container)
    return [] if container.catches else [each for each, result in ends.items() if result not in own]
