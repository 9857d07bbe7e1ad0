"""Rules over loops: parts of a machine without a way out, and loops without a limit."""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple, TypeGuard

from smachac.analysis.context import Context
from smachac.analysis.control_flow import (
    MOST_STEPS,
    Linear,
    SiblingSteps,
    circle,
    dead_ends,
    outline,
    regions,
    shortest_paths,
    step_graph,
    steps_of,
    way,
)
from smachac.analysis.error_recovery import undeclared_writes
from smachac.checks.findings import notation
from smachac.checks.findings.help_text import calls, own_name
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, PathStep, Severity
from smachac.diagnostics.wording import listed
from smachac.ir import nodes
from smachac.ir.graph import can_end, reachable
from smachac.ir.leaf import functions, variable_of
from smachac.ir.nodes import Expression, Leaf, Node, StateMachine, Transition
from smachac.ir.outcome_names import PREEMPTED, fails, successes
from smachac.ir.script_code import script_code
from smachac.ir.traversal import leads_to_child, outcome_names, outer_inputs, outer_outputs, walk
from smachac.records import replace

PURE = frozenset(["abs", "bool", "float", "int", "len", "max", "min", "round", "str"])
"""Functions whose result depends on their arguments only."""

NUMBERS = frozenset(["int", "float"])
"""The names of the types of numbers."""

SCALARS = NUMBERS | {"bool", "str"}
"""The names of the types whose values cannot be changed in place."""


@rule(
    "SM202",
    "trap",
    Severity.ERROR,
    effect="the robot repeats the same states, or waits in one, until somebody stops the program",
)
def trap(context: Context) -> Iterator[Finding]:
    """From this state no outcome of the container can be reached.

    The robot repeats the same states, or waits in one of them, until somebody stops it by force.
    A loop over items without an end, such as `itertools.count()`, is a trap too if no outcome of
    its state ends the loop. A machine that must run without end has `forever: true`.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok, far], transitions: {ok: done, far: LOOK}}
          - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: APPROACH}}
          - APPROACH: {template: ScriptedState, outcomes: [near], transitions: {near: LOOK}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [ok, far], transitions: {ok: done, far: LOOK}}
          - LOOK: {template: ScriptedState, outcomes: [seen], transitions: {seen: APPROACH}}
          - APPROACH: {template: ScriptedState, outcomes: [near], transitions: {near: PICK}}
    """
    for path, (container, flow, stuck) in context.traps.items():
        steps = steps_of(flow)
        children = {child.name: child for child in reversed(container.children)}
        graph = step_graph(steps, steps)
        before = shortest_paths(graph, container.initial)
        for region in dead_ends(stuck, steps):
            first = region[0]
            witness = [*way(path, graph, before, first), *circle(path, region, steps)[1:]]
            yield _trapped(path, container, children[first], region, witness)
    for path, loop in context.containers:
        if isinstance(loop, nodes.Iterator) and loop.items is not None:
            yield from _endless_items(path, loop, loop.items.data)


def _endless_items(path: str, loop: nodes.Iterator, data: nodes.Data) -> Iterator[Finding]:
    """A loop over items without an end, in which no outcome of the state ends the loop."""
    if not isinstance(data, Expression) or "itertools." not in data.text:
        return
    going_on = frozenset([*loop.loop_outcomes, PREEMPTED])
    leaving = any(
        (isinstance(child, Leaf) and child.open) or not going_on.issuperset(outcome_names(child))
        for child in loop.children
    )
    if not leaving and _has_no_end(script_code(data.text).tree):
        yield Finding(
            span=loop.items_span,
            message=f"`{loop.name}` never ends: `{data.text}` has no last item, and no outcome of"
            f" {listed([child.name for child in loop.children])} ends the loop",
            arguments=(loop.name, data.text),
            help="write items with an end, such as `range(10)`, or let an outcome end the loop",
            related=calls(loop, loop.items_span),
            node=path,
        )


def _has_no_end(tree: ast.expr | None) -> bool:
    """Whether code computes items without an end: `itertools.count()`, `cycle` or `repeat`."""
    match tree:
        case ast.Lambda(body=body):
            return _has_no_end(body)
        case ast.Call(
            func=ast.Attribute(value=ast.Name(id="itertools"), attr=name),
            args=arguments,
            keywords=named,
        ):
            bounded = len(arguments) > 1 or any(keyword.arg in ("times", None) for keyword in named)
            return name in ("count", "cycle") or (name == "repeat" and not bounded)
    return False


def _trapped(
    path: str, container: Linear, child: Node, region: list[str], witness: list[PathStep]
) -> Finding:
    what = f"no outcome of `{container.name}` can be reached from {listed(region)}"
    help = f"lead an outcome of `{child.name}` to an outcome of `{container.name}`"
    own = outcome_names(child)
    if container.outcomes and own:
        help += f", as in `{own[-1]}: {container.outcomes[0].name}`"
    once = [step.node for step in witness].count(f"{path}/{child.name}") == 1
    if once and isinstance(child, Leaf):
        what = f"`{child.name}` has no outcomes, so `{container.name}` never ends after entering it"
        help = f"add an outcome to `{child.name}`"
    elif once:
        what = f"`{child.name}` never ends, so `{container.name}` never ends after entering it"
        help = f"make `{child.name}` end with an outcome"
    if isinstance(container, StateMachine) and not notation.is_python(container):
        help += f", or write `forever: true` if `{container.name}` must run without end"
    return Finding(
        span=child.span,
        message=what,
        arguments=tuple(sorted(region)),
        help=help,
        related=calls(child, child.span),
        path=tuple(witness) if len(witness) > 1 else (),
        node=f"{path}/{child.name}",
    )


class _Loop(NamedTuple):
    """A region that does not end while its states fail. `step` is the transition for a failure of
    `child` that stays inside; None where a success stays inside as well."""

    region: list[str]
    child: Node
    step: Transition | None


@rule("SM204", "unbounded-loop", Severity.WARNING)
def unbounded_loop(context: Context) -> Iterator[Finding]:
    """A loop of retries has no limit, or a loop without end contains no state that waits.

    A robot that retries without a limit can damage itself or what it holds. A loop without a wait
    uses all the time of a processor.

    Exactly: a state retries when an outcome of failure (`aborted`, `failed`, `error`, `timeout`)
    leads back to that state, directly or through other states. The retries have no limit if no
    outcome of the container can be reached while every such state fails each time and no preempt
    request comes, but could be reached after a success. A way out of any other state in the loop
    is a limit. An exception (`on_error`, `error:`) counts if it leads back to its state without a
    choice on the way, while no other state raises one and no other failure of the state leaves the
    loop. Where a success does not leave the loop either (`forever: true`, or a loop that runs until
    a preempt request), every cycle must contain a state that can wait: a blocking state, a
    SleepState, or a state whose type has no interface.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: picked, failed: OPEN}
          - OPEN: {template: ScriptedState, outcomes: [done], transitions: {done: PICK}}

    Right:
        name: sm
        template: Base
        outcomes: [picked, lost]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: picked, failed: COUNT}
          - COUNT:
              template: ScriptedState
              outcomes: [again, enough]
              transitions: {again: OPEN, enough: lost}
          - OPEN: {template: ScriptedState, outcomes: [done], transitions: {done: PICK}}
    """
    endless = context.endless
    looping = [
        (path, item)
        for path, item in context.linear
        if context.of_container(_goes_back, path, item)
    ]
    waiting = _waiting(context) if looping else frozenset()
    for path, container in looping:
        forever = isinstance(container, StateMachine) and container.forever
        whole = outline(path, container, endless)
        trapped = frozenset(context.traps[path].stuck if path in context.traps else ())
        flow = _unpreempted(whole)
        steps = steps_of(flow)
        waits = frozenset(
            child.name for child in container.children if f"{path}/{child.name}" in waiting
        )
        for loop in _unbounded(flow, reachable(whole), steps):
            if not trapped.isdisjoint(loop.region):
                continue
            if loop.step is not None and not forever:
                yield _retries(path, container, loop, loop.step, steps)
            elif spin := _spin(path, loop.region, steps, waits):
                yield _spins(path, container, spin)


def _goes_back(container: Linear) -> bool:
    """Whether a transition leads to its own state or to one above it, as every loop needs."""
    above: set[str] = set()
    for child in container.children:
        above.add(child.name)
        if not above.isdisjoint([step.target for step in child.transitions]):
            return True
    return False


def _waiting(context: Context) -> frozenset[str]:
    """The paths of the states that wait, or may wait."""
    found: set[str] = set()
    for path, node in reversed(context.states):
        if isinstance(node, Leaf):
            waits = node.blocking or node.open
        else:
            waits = any(f"{path}/{child.name}" in found for child in node.children)
        if waits:
            found.add(path)
    return frozenset(found)


def _unpreempted(container: Linear) -> Linear:
    """The container without the outcome `preempted` of its states."""

    def child(node: Node) -> Node:
        outcomes = tuple(one for one in node.outcomes if one.name != PREEMPTED)
        steps = tuple(step for step in node.transitions if step.outcome != PREEMPTED)
        if len(outcomes) == len(node.outcomes) and len(steps) == len(node.transitions):
            return node
        return replace(node, outcomes=outcomes, transitions=steps)

    return replace(container, children=tuple(map(child, container.children)))


def _failing(node: Node) -> Node:
    """A state that fails each time; the undeclared outcomes of an open leaf stay."""
    declared = frozenset(outcome_names(node))
    steps = [s for s in node.transitions if fails(node, s.outcome) or s.outcome not in declared]
    outcomes = [one for one in node.outcomes if fails(node, one.name)]
    return replace(node, outcomes=tuple(outcomes), transitions=tuple(steps))


def _unbounded(flow: Linear, entered: frozenset[str], steps: SiblingSteps) -> Iterator[_Loop]:
    """The loops that do not end while every state that retries fails."""
    part = {name: part for part, names in enumerate(regions(steps, steps)) for name in names}
    retrying = {
        child.name
        for child in flow.children
        if any(
            outcome != child.catches and fails(child, outcome) and part[to] == part[child.name]
            for outcome, to in steps[child.name]
        )
    }
    children = tuple(
        _failing(child) if child.name in retrying else child for child in flow.children
    )
    failing = replace(flow, children=children)
    left_at_all, left = can_end(flow), can_end(failing)
    stuck = [name for name in steps if name in entered and name not in left]
    by_name = {child.name: child for child in reversed(flow.children)}
    found: set[str] = set()
    for region in dead_ends(stuck, steps_of(failing)):
        inside = frozenset(region)
        found |= inside
        tries = [by_name[name] for name in region if name in retrying and name in left_at_all]
        child = next((child for child in tries if _could_leave(child, inside)), None)
        yield _Loop(region, child or by_name[region[0]], _closing_step(child, inside))
    for loop in _exceptional(flow.children, by_name):
        if loop.child.name in entered & left_at_all and found.isdisjoint(loop.region):
            yield loop


def _exceptional(children: Iterable[Node], by_name: Mapping[str, Node]) -> Iterator[_Loop]:
    """The loops that do not end while one state raises an exception each time, and no other does:
    after the exception each state on the way back has one way, and the state has no other failure
    that leads out. One for each target."""
    ways: dict[str, list[str]] = {}
    looping: set[str] = set()
    for child in children:
        step = next((step for step in child.transitions if step.outcome == child.catches), None)
        if step is None or step.target not in by_name or step.target in looping:
            continue
        if step.target not in ways:
            ways[step.target] = _only_way(step.target, by_name)
        there = ways[step.target]
        if child.name not in there:
            continue
        region = there[: there.index(child.name) + 1]
        failures = (
            transition for transition in child.transitions if fails(child, transition.outcome)
        )
        if all(failure.target in region for failure in failures):
            looping.add(step.target)
            yield _Loop(region, child, step)


def _only_way(start: str, by_name: Mapping[str, Node]) -> list[str]:
    """The states that follow one after the other, without exceptions, up to a choice."""
    names = [start]
    while len(names) < MOST_STEPS:
        node = by_name[names[-1]]
        targets = {step.target for step in node.transitions if step.outcome != node.catches}
        name = targets.pop() if len(targets) == 1 else None
        if name is None or name not in by_name or name in names:
            break
        names.append(name)
    return names


def _could_leave(child: Node, inside: frozenset[str]) -> bool:
    return any(
        not fails(child, step.outcome) and not leads_to_child(step, inside)
        for step in child.transitions
    )


def _closing_step(child: Node | None, inside: frozenset[str]) -> Transition | None:
    if child is None:
        return None
    steps = (step for step in child.transitions if fails(child, step.outcome))
    return next((step for step in steps if leads_to_child(step, inside)), None)


def _retries(
    path: str, container: Linear, loop: _Loop, step: Transition, steps: SiblingSteps
) -> Finding:
    child = loop.child
    region = [child.name, *(name for name in loop.region if name != child.name)]
    kept = {name: steps[name] for name in region}
    kept[child.name] = [(step.outcome, step.target)]
    return Finding(
        span=step.span,
        message=f"the retries of `{child.name}` have no limit: while it ends with"
        f" `{step.outcome}`, `{container.name}` does not end",
        arguments=(own_name(child, step.span), step.outcome),
        help=_limited(container, child, step),
        related=calls(child, step.span),
        path=tuple(circle(path, region, kept)),
        node=f"{path}/{child.name}",
    )


def _limited(container: Linear, child: Node, step: Transition) -> str:
    """The help for retries without a limit: where the failure leads straight back, the field."""
    if notation.is_python(child):
        return (
            "count the tries in a key of the userdata, and leave the loop after the last one; or"
            f" lead `{step.outcome}` out of the loop"
        )
    if step.target != child.name or step.origin != "written":
        return (
            f"count the tries in `userdata: {{tries: 0}}` of `{container.name}`: add to the loop a"
            " CallbacksState with `callbacks: {tries: 'lambda ud: ud.tries + 1'}`, and a"
            " ConditionalOutcomeState that leaves the loop unless `lambda ud: ud.tries < 3`; or"
            f" lead `{step.outcome}` out of the loop"
        )
    retry = f"retry: {{on: [{step.outcome}], max: 3}}"
    return f"remove this transition, write `{retry}`, and lead `exhausted` out of the loop"


def _spin(
    path: str, region: list[str], steps: SiblingSteps, waits: frozenset[str]
) -> list[PathStep]:
    """A cycle in a region on which no state waits; empty if there is none."""
    without_wait = [name for name in region if name not in waits]
    circles = (circle(path, part, steps) for part in regions(without_wait, steps))
    return next(filter(None, circles), [])


def _spins(path: str, container: Linear, spin: list[PathStep]) -> Finding:
    child = next(child for child in container.children if child.name == spin[0].label)
    states = {step.label for step in spin[::2]}
    names = listed(step.label for step in spin[::2])
    left = any(step.target not in states for child in container.children if child.name in states
               for step in child.transitions if step.outcome != PREEMPTED)  # fmt: skip
    ends = "" if left else "has no end and "
    return Finding(
        span=child.span,
        message=f"the loop of {names} {ends}contains no state that waits",
        arguments=tuple(sorted(states)),
        help="add a state that waits to the loop, such as a SleepState",
        effect="the loop uses all the time of a processor core",
        related=calls(child, child.span),
        path=tuple(spin),
        node=f"{path}/{child.name}",
    )


@rule(
    "SM213",
    "unchanging-condition",
    Severity.WARNING,
    effect="the machine leaves the loop in the first round or never",
)
def unchanging_condition(context: Context) -> Iterator[Finding]:
    """The condition of a loop reads only keys that nothing in the loop sets.

    The robot leaves the loop in the first round or never, for example because a counter is not
    increased.

    Exactly: a state with conditions, such as a ConditionalOutcomeState, is in a cycle and can leave
    it. It reads at least one key. All keys that it reads are numbers, strings or booleans, and no
    state in the cycle has an output of such a key; its conditions use nothing but these keys and
    functions such as `abs` and `len`, and no state in the cycle has an unknown interface. If the
    loop can also end by another state that does not fail, at least one key must be a number: a
    string or a boolean can be a setting of the task.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, lost]
        userdata: {tries: 0}
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: picked, failed: AGAIN}
          - AGAIN:
              template: ConditionalOutcomeState
              input_keys: [tries]
              outcomes: [again]
              callbacks: {again: 'lambda ud: ud.tries < 3'}
              default_outcome: enough
              transitions: {again: PICK, enough: lost}

    Right:
        name: sm
        template: Base
        outcomes: [picked, lost]
        userdata: {tries: 0}
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, failed]
              transitions: {done: picked, failed: COUNT}
          - COUNT:
              template: CallbacksState
              input_keys: [tries]
              output_keys: [tries]
              callbacks: {tries: 'lambda ud: ud.tries + 1'}
              transitions: {succeeded: AGAIN}
          - AGAIN:
              template: ConditionalOutcomeState
              input_keys: [tries]
              outcomes: [again]
              callbacks: {again: 'lambda ud: ud.tries < 3'}
              default_outcome: enough
              transitions: {again: PICK, enough: lost}
    """
    for (path, container), whole in zip(context.linear, context.absorbed, strict=True):
        if not context.of_container(_goes_back, path, container):
            continue
        deciding = list(filter(_is_condition, container.children))
        if not deciding:
            continue
        flow = _unpreempted(container)
        steps = steps_of(flow)
        by_name = {child.name: child for child in reversed(flow.children)}
        for region in regions(steps, steps):
            names = frozenset(region)
            inside = [child for child in deciding if child.name in names]
            if inside and any(target in names for name in region for _, target in steps[name]):
                states = [by_name[name] for name in region]
                for child, keys in _unchanging(context, path, inside, states, steps):
                    if not _is_set_by_hidden(context, path, whole, keys):
                        yield _unchanged(path, child, keys, states, steps)


def _is_condition(node: Node) -> TypeGuard[Leaf]:
    """Whether a state ends as its conditions say, which have no effect of their own."""
    if not isinstance(node, Leaf) or node.open or not node.inputs:
        return False
    conditions = functions(node, "conditions") if variable_of(node, "conditions") else None
    if not conditions:
        return False
    return all(_is_pure(code.text) for code in conditions.values())


def _is_pure(text: str) -> bool:
    """Whether code computes its value from userdata alone."""
    from smachac.ir.expressions import Lambda, Name, parse_expression, parts

    expr = parse_expression(text)
    if expr is None:
        return False
    known = {"ud", "userdata", *PURE}
    todo = [expr]
    while todo:
        each = todo.pop()
        if isinstance(each, Lambda) and each.parameter is not None:
            known.add(each.parameter)
        if isinstance(each, Name) and each.name not in known:
            return False
        todo += parts(each)
    return True


def _unchanging(
    context: Context, path: str, deciding: list[Leaf], region: list[Node], steps: SiblingSteps
) -> Iterator[tuple[Leaf, set[str]]]:
    """The states of a region with conditions that never change, with the keys that they read."""
    names = frozenset(child.name for child in region)
    written = _written_in(region)
    if written is None:
        return
    fixed: list[tuple[Leaf, set[str], set[str]]] = []
    for child in deciding:
        keys = {*outer_inputs(child)}
        types = {
            context.types.inputs[f"{path}/{child.name}", key.name].name for key in child.inputs
        }
        if written.isdisjoint({*keys, *(key.name for key in child.inputs)}) and types <= SCALARS:
            fixed.append((child, keys, types))
    constant = {child.name for child, _, _ in fixed}
    ways_out = {child.name for child in region if _leaves(child, names)}
    for child, keys, types in fixed:
        if child.name not in ways_out or not steps[child.name]:
            continue
        if ways_out <= constant or not types.isdisjoint(NUMBERS):
            yield child, keys


def _is_set_by_hidden(context: Context, path: str, container: Linear, keys: set[str]) -> bool:
    """Whether a state that cannot be reached sets one of some keys: it was meant to be in the loop,
    and SM201 reports the cause."""
    seen = context.of_container(reachable, path, container)
    hidden = [child for child in container.children if child.name not in seen]
    written = _written_in(hidden)
    return written is None or not written.isdisjoint(keys)


def _written_in(region: Iterable[Node]) -> frozenset[str] | None:
    """The keys that states can set, under all names they have; None where that is not known."""
    found: set[str] = set()
    for child in region:
        for _, node in walk(child):
            if isinstance(node, Leaf) and node.open:
                return None
            found.update(key.name for key in node.outputs)
            found.update(outer_outputs(node))
            if isinstance(node, Leaf):  # SM308
                found.update(undeclared_writes(node))
            if isinstance(node, Leaf) and node.class_facts is not None:
                found.update(word.text for word in node.class_facts.writes)
    return frozenset(found)


def _leaves(child: Node, names: frozenset[str]) -> bool:
    """Whether a state leads out of a region; by a failure, only if it has no success."""
    succeeds = bool(successes(child))
    return any(
        not leads_to_child(step, names) and not (succeeds and fails(child, step.outcome))
        for step in child.transitions
    )


def _unchanged(
    path: str, child: Node, keys: Iterable[str], region: list[Node], steps: SiblingSteps
) -> Finding:
    names = [child.name, *(one.name for one in region if one is not child)]
    names = list(dict.fromkeys(names))
    first = min(keys)
    return Finding(
        span=child.span,
        message=f"the condition of `{child.name}` never changes in the loop of {listed(names)}:"
        f" nothing in the loop sets {listed(keys)}",
        arguments=(own_name(child, child.span), *sorted(keys)),
        help=f"set {listed(keys)} in the loop, for example in a CallbacksState with `callbacks:"
        f" {{{first}: 'lambda ud: ud.{first} + 1'}}`, or move `{child.name}` out of the loop",
        related=calls(child, child.span),
        path=tuple(circle(path, names, steps)),
        node=f"{path}/{child.name}",
    )
