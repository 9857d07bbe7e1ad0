"""Rules over concurrences: whether there is something to run, and rules that can match."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.combinations import UndecidedError, bits
from smachac.checks.endings import Judged, judged
from smachac.checks.hints import calls, did_you_mean, guesser, other_place
from smachac.checks.once import containers
from smachac.checks.outline import is_open
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Machine, Node
from smachac.ir.walk import outcome_names
from smachac.problems import listed


@rule("SM403", "dead-rule", Severity.ERROR, firm=True)
def dead_rule(machine: Machine) -> Iterator[Finding]:
    """A rule can never decide: it names a child or an outcome that does not exist, or nothing, or
    larger rules always win over it.

    The case it was written for ends otherwise; the robot goes on as if that case had never been
    thought of. SMACH does not even run a concurrence whose rule names an unknown child, and its
    versions disagree on a rule without conditions.

    A warning where in each combination in which the rule holds, a rule that lists more children
    holds as well. An outcome that a container declares but never ends with is not told again
    here.

    Wrong:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, failed]
              default_outcome: failed
              outcome_map:
                ready: {LEFT: done, RIHGT: done}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done]}
              transitions: {ready: ready, failed: failed}

    Right:
        name: sm
        template: Base
        outcomes: [ready, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [ready, failed]
              default_outcome: failed
              outcome_map:
                ready: {LEFT: done, RIGHT: done}
              states:
                - LEFT: {template: ScriptedState, outcomes: [done]}
                - RIGHT: {template: ScriptedState, outcomes: [done]}
              transitions: {ready: ready, failed: failed}
    """
    for path, container in containers(machine):
        match container:
            case Concurrence():
                yield from _dead_rules(path, container)
            case nodes.Iterator(sugar=""):
                yield from _dead_renames(path, container)
    for each in judged(machine):
        yield from _shadowed_rules(each)


def _dead_rules(path: str, container: Concurrence) -> Iterator[Finding]:
    children = {child.name: child for child in container.children}
    guess = guesser(children)
    states = f"its states are {listed(children)}" if children else "it has no states"
    for entry in container.rules:
        if not entry.when:
            yield Finding(
                span=entry.span,
                message=f"the rule for `{entry.outcome}` names no child, so it says nothing",
                help="name the children and their outcomes, or drop the rule",
                related=calls(container, entry.span),
                node=path,
            )
        for condition in entry.when:
            child = children.get(condition.child)
            if child is None:
                message = f"`{condition.child}` is no state of `{container.name}`"
                help = did_you_mean(guess(condition.child)) or states
            elif is_open(child) or condition.outcome in outcome_names(child):
                continue
            else:
                message = f"`{child.name}` has no outcome `{condition.outcome}`"
                help = _other_outcome(child, condition.outcome)
            related = calls(container, condition.span)
            yield Finding(
                span=condition.span, message=message, help=help, related=related, node=path
            )


def _other_outcome(child: Node, outcome: str) -> str:
    names = outcome_names(child)
    known = f"its outcomes are {listed(names)}" if names else "it has no outcomes"
    return did_you_mean(guesser(names)(outcome)) or known


def _shadowed_rules(each: Judged) -> Iterator[Finding]:
    """The rules over which larger ones win in every combination."""
    read, rules, whole = each.read, each.read.rules, each.whole
    for number, entry in enumerate(read.written):
        given, larger = rules.conditions[number], read.larger(number)
        rivals = larger & rules.compatible(number)
        if not rivals or any(end not in whole[child] for child, end in given.items()):
            continue
        try:
            if rules.find(whole, given, larger) is not None:
                continue
        except UndecidedError:
            return
        winners = [read.written[rival] for rival in bits(rivals)]
        yield Finding(
            span=entry.span,
            message=f"the rule for `{entry.outcome}` never decides: whenever it holds, so does one"
            f" that lists more children, for {listed(winner.outcome for winner in winners)}",
            help="take it out, or let it list the children that make it differ",
            related=(
                *(part for one in winners[:3] for part in other_place(one.span, "wins over it")),
                *calls(read.node, entry.span),
            ),
            severity=Severity.WARNING,
            node=each.path,
        )


def _dead_renames(path: str, container: nodes.Iterator) -> Iterator[Finding]:
    """The entries of an iterator's final map that rename what never comes. Outcomes on which it
    goes on do come, when it is asked to stop (smach-semantics P9)."""
    if any(is_open(child) for child in container.children):
        return
    endings = [name for child in container.children for name in outcome_names(child)]
    for name, _ in container.final_map if endings else ():
        if name == container.exhausted_outcome or name in endings:
            continue
        yield Finding(
            span=container.span,
            message=f"the final outcome map of `{container.name}` renames `{name}`,"
            " with which its child never ends",
            help=f"its child ends with {listed(endings)}",
            related=calls(container, container.span),
            node=path,
        )


@rule("SM408", "empty-concurrence", Severity.ERROR, firm=True)
def empty_concurrence(machine: Machine) -> Iterator[Finding]:
    """A concurrence has no states.

    SMACH for ROS 2 waits for ever for the first child to end, SMACH for Noetic fails.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done]
              default_outcome: done
              states: []
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
              states:
                - LEFT: {template: ScriptedState, outcomes: [ok]}
                - RIGHT: {template: ScriptedState, outcomes: [ok]}
              transitions: {done: done}
    """
    for path, container in containers(machine):
        if isinstance(container, Concurrence) and not container.children:
            yield Finding(
                span=container.span,
                message=f"the concurrence `{container.name}` has no states to start",
                help="add states, or take it out",
                related=calls(container, container.span),
                node=path,
            )
