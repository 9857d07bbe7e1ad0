"""Rules over waits: states without a time limit, branches and iterators that cannot be stopped."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from collections.abc import Set as AbstractSet
from math import ceil, isfinite

from smachac.analysis.context import Context
from smachac.analysis.durations import Ends, ends_of, shortest_ends, time_limit, time_limit_span
from smachac.analysis.iterator_stops import inverted_renames, undeclared_stops
from smachac.analysis.possible_outcomes import Endings
from smachac.analysis.stop_paths import branch_around, stoppable_branches
from smachac.analysis.watched_branches import Watched, is_limited, time_limits, watched_branches
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, other_place, own_name
from smachac.checks.rule import rule
from smachac.checks.timing.stop_answers import answered_here, way_out, witness
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.leaf import variable_of
from smachac.ir.nodes import Concurrence, Leaf, VariableType
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import name_in_script
from smachac.ir.traversal import outcome_names


@rule("SM207", "no-timeout", Severity.INFO)
def no_timeout(context: Context) -> Iterator[Finding]:
    """A state waits for an external event, and the wait has no time limit.

    If a message is lost, the robot waits forever. In a concurrence the other branches wait as
    well, even when one of them has failed; there it is a warning.

    Exactly: the state type is `blocking` in its interface, has none of the outcomes `timeout` and
    `timed_out`, and the state sets no variable whose name ends with `timeout`. The outcome
    `preempted` is a limit only where something in the script sends a preempt request: a `timeout:`
    around the state, or another branch of a concurrence with `join: any`. A state with several
    outcomes beside `preempted` may limit its wait itself, unless its type has a variable for a time
    limit that is not set. A state with a `duration`, such as a SleepState, ends by itself, and so
    does one with a limit of its `tries`, such as a ConditionState without `max_checks: -1`.

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
        outcomes: [done, failed]
        states:
          - BOTH:
              template: Concurrence
              outcomes: [done, failed]
              default_outcome: failed
              outcome_map: {done: {WAIT: pressed}}
              states:
                - WAIT: {template: WaitForButton, timeout: 20s}
                - BLINK: {template: ScriptedState, outcomes: [ok]}
              transitions: {done: done, failed: failed}
        == templates/WaitForButton.yml ==
        name: WaitForButton
        outcomes: {pressed: {}, preempted: {}}
        blocking: true
        code: {python: my_robot.states:WaitForButton}
    """
    around: dict[str, Concurrence] = {}
    watched = {branch.branch for branch in watched_branches(context)}
    stoppable = stoppable_branches(context.containers, context.endings)
    limits = time_limits(context.machine.state_types)
    for path, node in context.states:
        if not isinstance(node, Leaf):
            outer = node if isinstance(node, Concurrence) else around.get(path)
            if outer is not None:
                around.update((f"{path}/{child.name}", outer) for child in node.children)
        elif not node.blocking or path in watched:
            continue  # SM407 is about the watched ones
        elif not is_limited(node, limits.get(node.type, ())):
            outer = around.get(path)
            answers = PREEMPTED in outcome_names(node)
            timed = outer is not None and outer.sugar == "timeout"
            if (answers and branch_around(path, stoppable)) or (
                variable_of(node, "duration") and not timed
            ):
                continue
            yield Finding(
                span=node.span,
                message=_unlimited(node, outer),
                arguments=(node.name,),
                help=_stop_help(node, context)
                if timed and not answers
                else _time_limit(node, answers, limits.get(node.type, ())),
                effect=None if answers or not timed else "the task waits until the state ends",
                related=calls(node, node.span),
                severity=Severity.WARNING if outer is not None else None,
                node=path,
            )


def _stop_help(leaf: Leaf, context: Context) -> str:
    """The help for a wait that its time limit cannot stop: the outcome and, where the class is not
    known to check for preempt requests, the code for its loop."""
    type_ = context.machine.state_types.get(leaf.type)
    facts = type_.class_facts if type_ is not None else None
    help = f"add the outcome `preempted` to the interface and the code of `{leaf.type}`"
    if facts is None or facts.checks_stop:
        return help
    answer = "if self.preempt_requested(): self.service_preempt(); return 'preempted'"
    return f"{help}, and in the loop of `execute` write `{answer}`"


def _time_limit(leaf: Leaf, answers: bool, limits: Collection[VariableType]) -> str:
    """The help for a wait without a limit."""
    if notation.is_python(leaf):
        return f"limit the time that the code of `{leaf.type}` waits"
    if not answers:
        kind = f"the interface and the code of `{leaf.type}`"
        return f"add the outcome `preempted` to {kind}, and write `timeout: 20s` at `{leaf.name}`"
    own = next((one for one in limits if one.name == "timeout"), None)
    if own is None:
        return f"write a time limit, as in `timeout: 20s`, for `{leaf.name}`"
    if own.ros:
        ros_1 = "put the state into a StateMachine with `timeout: 20s`"
        return f"for ROS 2 write `timeout: 20.0` (seconds); for ROS 1 {ros_1}"
    return f"write a time limit in seconds, as in `timeout: 20.0`, for `{leaf.name}`"


def _unlimited(leaf: Leaf, outer: Concurrence | None) -> str:
    answers = PREEMPTED in outcome_names(leaf)
    if outer is not None and outer.sugar == "timeout":
        limited = f"the time limit of `{name_in_script(outer)}` cannot stop `{leaf.name}`"
        return f"{limited}, which has no outcome `preempted`"
    waits = f"block `{name_in_script(outer)}`" if outer is not None else "wait"
    if answers:
        return f"`{leaf.name}` can {waits} forever: it has no time limit, and nothing preempts it"
    return f"`{leaf.name}` can {waits} forever: it has no time limit and no outcome `preempted`"


@rule(
    "SM407",
    "never-ends",
    Severity.WARNING,
    effect="the concurrence does not end, and the task does not continue",
)
def never_ends(context: Context) -> Iterator[Finding]:
    """A branch of a concurrence never ends, and nothing in the concurrence stops it.

    After the other branches have ended, the concurrence waits for this branch forever, and the
    robot does not continue its task.

    Exactly: at least one other branch ends without a preempt request. With `join: all` this branch
    ends only after a preempt request, which no branch sends. With `join: any` this branch has
    `forever: true`, and does not end after a preempt request either; or a state in it starts again
    after a preempt request, as in SM209, so that the branch ends only by itself. The same holds for
    what a time limit cannot stop. A branch that never ends without `forever: true` is an error of
    SM202; SM207 reports a single state that waits. Such a state is reported here where one rule is
    about it alone and another one about other branches only: they are meant for `join: any`.

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
    yield from map(_without_join, watched_branches(context))
    for path, container in concurrences:
        yield from _lasting(path, container, found, endless)
    yield from _starting_again(context)


def _without_join(watched: Watched) -> Finding:
    container, name = watched.container, watched.leaf.name
    other = watched.other
    ended = " and ".join(
        f"`{part.child}: {part.outcome}`" for part in other.when if part.child != name
    )
    return Finding(
        span=container.span,
        message=f"`{container.name}` has no `join: any`: after {ended} it still waits for `{name}`",
        arguments=(container.name, name),
        help=f"write `join: any` in `{container.name}`: then the first branch that ends stops the"
        " others",
        related=(
            *other_place(watched.leaf.span, f"`{name}` has no time limit, and nothing preempts it"),
            *other_place(other.span, f"this rule is meant to hold while `{name}` runs"),
            *calls(container, container.span),
        ),
        node=watched.path,
    )


def _lasting(
    path: str, container: Concurrence, found: Endings, endless: AbstractSet[str]
) -> Iterator[Finding]:
    ever, unstopped = found
    ends = any(unstopped[f"{path}/{child.name}"] for child in container.children)
    for child in container.children if ends else ():
        here, name = f"{path}/{child.name}", name_in_script(child)
        around = name_in_script(container)
        if container.join == "all" and ever[here] and not unstopped[here]:
            why = f"ends only after a preempt request, and nothing in `{around}` sends one"
            help = (
                "write `join: any`, so that the first branch to end stops the others, or make"
                f" `{name}` end"
            )
        elif container.join == "any" and not ever[here] and here in endless:
            why = f"runs forever, also after a preempt request, so `{around}` cannot end"
            help = (
                f"add the outcome `preempted` to a state in `{name}`, with a transition to an"
                f" outcome of `{name}`"
            )
        else:
            continue
        yield Finding(
            span=child.span,
            message=f"`{name}` {why}",
            arguments=(name,),
            help=help,
            related=calls(child, child.span),
            node=here,
        )


def _starting_again(context: Context) -> Iterator[Finding]:
    """The loops that a sibling, or a time limit, cannot stop."""
    again = context.stop_paths.again
    branches = stoppable_branches(context.containers, context.endings) if again else {}
    for found in again:
        path, _, child, step, _ = found.stop
        branch = branch_around(path, branches)
        if not branch or (branch in context.endless and not context.endings.ever[branch]):
            continue
        around, name = branches[branch], branch.rpartition("/")[2]
        if around.sugar == "timeout":
            what = f"the time limit of `{name_in_script(around)}` cannot stop it"
        else:
            what = f"`{name}` does not stop when another branch of `{around.name}` ends"
        yield Finding(
            span=step.span,
            message=f"{what}: after the preempt request `{child.name}` starts again",
            arguments=(own_name(child, step.span), step.outcome),
            help=way_out(found),
            related=(*answered_here(found), *calls(child, step.span)),
            path=witness(found),
            node=f"{path}/{child.name}",
        )


@rule(
    "SM208",
    "no-way-to-stop",
    Severity.INFO,
    effect="the outcome has no transition: the machine then stops with an error",
)
def no_way_to_stop(context: Context) -> Iterator[Finding]:
    """After a preempt request an iterator ends with an outcome that it does not declare.

    The machine then stops with an error instead of an outcome, and the robot does not reach a safe
    state.

    Exactly: after a preempt request, such as Ctrl-C, an iterator ends after the current item with
    the outcome of its child, even if that outcome is in `loop_outcomes`; `final_outcome_map`
    renames it. It is a note if the iterator does not declare the result, and a warning if the
    iterator also declares `preempted`, because then it is probably meant to end with that.

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
        inverted = {result for _, result in inverted_renames(container)} if lost else {}
        lost = [text for text in lost if text not in inverted]  # SM403 reports these
        if not lost:
            continue
        name, counted_on = container.name, PREEMPTED in outcome_names(container)
        pairs = [(outcome, PREEMPTED) for outcome in lost]
        renaming = notation.mapping(container, "final_outcome_map", pairs)
        first = "" if counted_on else f"add `{PREEMPTED}` to the outcomes of `{name}`, and "
        yield Finding(
            span=container.span,
            message=f"after a preempt request `{name}` can end with {listed(lost)}, which is not"
            " one of its outcomes",
            arguments=(name, *sorted(lost)),
            help=f"{first}write `{renaming}`",
            related=calls(container, container.span),
            severity=Severity.WARNING if counted_on else None,
            node=path,
        )


@rule(
    "SM212",
    "short-time-limit",
    Severity.WARNING,
    effect="the time limit ends the state first; with equal times, either can be first",
)
def short_time_limit(context: Context) -> Iterator[Finding]:
    """A time limit is over before the state inside it can end.

    The state is always preempted, and the machine always continues as after a timeout.

    Exactly: the shortest way through the state to one of its outcomes takes as long as its time
    limit, or longer. Only times that stand in the script count: the `time` of a SleepState (a
    variable with the role `duration`), the items of a loop and the tries and delays of a `retry:`
    where their number is known. If both times are the same, two threads race.

    Wrong:
        name: sm
        template: Base
        outcomes: [settled, moving]
        states:
          - SETTLE:
              template: SleepState
              time: 3
              timeout: 2s
              transitions: {succeeded: settled, preempted: moving, timeout: moving}

    Right:
        name: sm
        template: Base
        outcomes: [settled, moving]
        states:
          - SETTLE:
              template: SleepState
              time: 3
              timeout: 5s
              transitions: {succeeded: settled, preempted: moving, timeout: moving}
    """
    limited = [
        (path, one)
        for path, one in context.containers
        if isinstance(one, Concurrence) and one.sugar == "timeout"
    ]
    known = shortest_ends(context.containers) if limited else {}
    for path, container in limited:
        yield from _short_limit(path, container, known)


def _short_limit(path: str, container: Concurrence, known: Mapping[str, Ends]) -> Iterator[Finding]:
    limit = time_limit(container)
    inner = next((child for child in container.children if child.name == container.name), container)
    ends = ends_of(f"{path}/{container.name}", inner, known)
    late = {name: ends[name] for name in outcome_names(inner) if ends.get(name, -1.0) >= limit}
    if not late:
        return
    span = time_limit_span(container)
    longest = max(late.values())
    yield Finding(
        span=span,
        message=f"`{container.name}` takes {min(late.values()):g} s or more to end with"
        f" {listed(late)}, but its time limit is {limit:g} s",
        arguments=(own_name(container, span), *late),
        help=f"write a time limit of more than {longest:g} s"
        + (f", such as `timeout: {ceil(longest * 1.5)}s`" if isfinite(longest) else ""),
        related=calls(container, span),
        node=path,
    )
