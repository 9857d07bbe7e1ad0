"""Rules over waits without an end: branches that nothing stops, states without a time limit."""

from __future__ import annotations

from collections.abc import Iterator
from collections.abc import Set as AbstractSet

from smachac.analysis.context import Context
from smachac.analysis.possible_outcomes import Endings
from smachac.checks.messages import calls
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.graph import stopped_endings
from smachac.ir.nodes import Concurrence, Leaf
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names

TIMEOUTS = frozenset(["timeout", "timed_out"])


@rule("SM207", "no-timeout", Severity.INFO)
def no_timeout(context: Context) -> Iterator[Finding]:
    """A state waits for the outside world, and nothing limits the wait.

    A person who does not come, or a message that is lost, stops the robot for good. In a
    concurrence, where it is a warning, it keeps all other branches waiting as well, and nobody
    can call it off when one of them has failed.

    Exactly: the interface says that the state is `blocking`, and it has no outcome `timeout`,
    `timed_out` or `preempted`, and no variable that ends with `timeout` is set. The `timeout:`
    of a script preempts the state, so it needs that outcome as well.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states:
                - WAIT: {template: WaitForButton}
                - BLINK: {template: ScriptedState, outcomes: [ok]}
              transitions: {done: done}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}}
        blocking: true
        code: {python: my_robot.states:WaitForButton}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states:
                - WAIT: {template: WaitForButton}
                - BLINK: {template: ScriptedState, outcomes: [ok]}
              transitions: {done: done}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, preempted: {}}
        blocking: true
        code: {python: my_robot.states:WaitForButton}
    """
    around: dict[str, Concurrence] = {}
    for path, node in context.states:
        outer = around.get(path)
        if not isinstance(node, Leaf):
            outer = node if isinstance(node, Concurrence) else outer
            if outer is not None:
                around.update((f"{path}/{child.name}", outer) for child in node.children)
        elif node.blocking and not _is_limited(node):
            yield Finding(
                span=node.span,
                message=_unlimited(node, outer),
                help=f"give its type `{node.type}` an outcome `preempted`, or `timeout`",
                related=calls(node, node.span),
                severity=Severity.WARNING if outer is not None else None,
                node=path,
            )


def _unlimited(leaf: Leaf, outer: Concurrence | None) -> str:
    if outer is not None and outer.sugar == "timeout":
        limited = f"the time limit of `{outer.name}` cannot end `{leaf.name}`"
        return f"{limited}, which has no outcome `preempted`"
    waits = f", and all of `{outer.name}` waits for it" if outer is not None else ""
    return (
        f"`{leaf.name}` may wait for ever{waits}: it has neither a time limit nor an outcome"
        " `preempted`"
    )


def _is_limited(leaf: Leaf) -> bool:
    names = frozenset(outcome_names(leaf))
    if leaf.open or PREEMPTED in names or not TIMEOUTS.isdisjoint(names):
        return True
    return any(
        one.name.endswith("timeout") and one.value.data is not None for one in leaf.variables
    )


@rule("SM407", "never-ends", Severity.WARNING)
def never_ends(context: Context) -> Iterator[Finding]:
    """A branch of a concurrence has no end, and nobody, or nothing, can stop it.

    The other branches end, and the robot stands still for ever while the concurrence waits for
    this one.

    Exactly: some other branch ends by itself. With `join: all` this branch ends only when it is
    preempted, which nothing in the concurrence does; with `join: any` it is meant to go on for
    ever (`forever: true`) and ends not even when it is preempted. A branch that is never done,
    without being meant so, is told by SM202; a single state that waits by SM207.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - DRIVE:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states:
                - MOVE: {template: ScriptedState, outcomes: [there, blocked]}
                - WATCH:
                    template: StateMachine
                    outcomes: [stopped]
                    states:
                      - WAIT: {template: SleepState, time: 1, transitions: {succeeded: LOOK,
                          preempted: stopped}}
                      - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: WAIT}}
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - DRIVE:
              template: Concurrence
              join: any
              outcomes: [done]
              default_outcome: done
              states:
                - MOVE: {template: ScriptedState, outcomes: [there, blocked]}
                - WATCH:
                    template: StateMachine
                    outcomes: [stopped]
                    states:
                      - WAIT: {template: SleepState, time: 1, transitions: {succeeded: LOOK,
                          preempted: stopped}}
                      - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: WAIT}}
              transitions: {done: done}
    """
    concurrences = [(path, one) for path, one in context.containers if isinstance(one, Concurrence)]
    if not concurrences:
        return
    found = context.endings
    endless = context.endless
    for path, container in concurrences:
        yield from _lasting(path, container, found, endless)


def _lasting(
    path: str, container: Concurrence, found: Endings, endless: AbstractSet[str]
) -> Iterator[Finding]:
    ever, calm = found
    ending = [child.name for child in container.children if calm[f"{path}/{child.name}"]]
    for child in container.children if ending else ():
        here = f"{path}/{child.name}"
        if container.join == "all" and ever[here] and not calm[here]:
            why = f"ends only when it is asked to stop, and nothing in `{container.name}` asks"
            help = "write `join: any`, so that the first to end stops the others, or let it end"
        elif container.join == "any" and not ever[here] and here in endless:
            why = f"goes on for ever, also after {listed(ending)} would end `{container.name}`"
            help = "let a state in it answer with `preempted`, and lead that out"
        else:
            continue
        yield Finding(
            span=child.span,
            message=f"`{child.name}` {why}",
            help=help,
            related=calls(child, child.span),
            node=here,
        )


@rule("SM208", "no-way-to-stop", Severity.INFO)
def no_way_to_stop(context: Context) -> Iterator[Finding]:
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
    for path, container in context.containers:
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
