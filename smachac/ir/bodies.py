"""What the containers do: generators that yield the time at which they can go on."""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

from smachac.ir.nodes import (
    Concurrence,
    Container,
    Expression,
    Iterator,
    Leaf,
    Node,
    Sequence,
    StateMachine,
)
from smachac.ir.result import NO_OUTCOME, Failure, Fault, RunError
from smachac.ir.userdata import BehaviourError, called, python_data
from smachac.ir.walk import leads_to_child, outcome_names

if TYPE_CHECKING:
    from smachac.ir.run import Interpreter

Run: TypeAlias = "Generator[float, None, str | None]"
"""A state on its way to its outcome; None where a leaf gave none."""


def body(run: Interpreter, node: Container, path: str, own: dict[str, object]) -> Run:
    """What a container does between its entry and its end, over its own userdata."""
    if isinstance(node, Iterator):
        return _iterator(run, node, path, own)
    if not node.children:
        run.fail("no-state", path, "has no states", node.span)
    if isinstance(node, Concurrence):
        return _concurrence(run, node, path, own)
    return _machine(run, node, path, own)


def _machine(
    run: Interpreter, node: StateMachine | Sequence, path: str, own: dict[str, object]
) -> Run:
    routes = run.routes.get(path) or run.routes.setdefault(path, _routes(node))
    name, inside, here = node.initial or node.children[0].name, True, None
    if name not in routes.children:
        run.fail("no-target", path, f"has no state `{name}` to start with", node.span)
    while inside:
        child, previous, here = routes.children[name], here, f"{path}/{name}"
        run.preemption.before_next(path, previous, here)
        run.preemption.running[path] = [here]
        outcome = yield from run.visit(child, here, own)
        if outcome is None:
            raise RunError(no_outcome(child, here, "undeclared-outcome"))
        if outcome not in outcome_names(child) and not (isinstance(child, Leaf) and child.open):
            message = f"ended with `{outcome}`, which is not one of its outcomes"
            run.fail("undeclared-outcome", here, message, child.span)
        if outcome not in routes.targets[name]:
            message = f"no transition for outcome `{outcome}`"
            run.fail("no-transition", here, message, child.span)
        name, inside = routes.targets[name][outcome]
        if not inside and name not in outcome_names(node):
            message = f"`{name}` is neither a state nor an outcome of `{path}`"
            run.fail("no-target", here, message, child.span)
        to = f"{path}/{name}" if inside else f"{path}:{name}"
        run.emit("transition", here, outcome=outcome, to=to)
    run.preemption.after_last(path, here or path)
    return name


def no_outcome(node: Node, path: str, kind: Fault) -> Failure:
    """Why the container of a state that ended without an outcome cannot go on; already told."""
    return Failure(kind=kind, path=path, message=NO_OUTCOME, span=node.span)


@dataclass(frozen=True, slots=True)
class Routes:
    """A machine's children by name, and for each child where its outcomes lead.

    The flag says whether the target is a child.
    """

    children: dict[str, Node]
    targets: dict[str, dict[str, tuple[str, bool]]]


def _routes(node: StateMachine | Sequence) -> Routes:
    children = {child.name: child for child in node.children}
    names = frozenset(children)
    targets = {
        name: {
            edge.outcome: (edge.target, leads_to_child(edge, names)) for edge in child.transitions
        }
        for name, child in children.items()
    }
    return Routes(children, targets)


def _concurrence(run: Interpreter, node: Concurrence, path: str, own: dict[str, object]) -> Run:
    children = {f"{path}/{child.name}": child for child in node.children}
    live = {here: _Branch(_branch(run, child, here, own)) for here, child in children.items()}
    run.preemption.wake.update((here, branch.wake) for here, branch in live.items())
    running = run.preemption.running[path] = list(live)
    if path in run.preemption.asked:
        for here in children:
            run.preemption.request(here)
    starting = list(live)
    ended: dict[str, str | Failure] = {}
    told = False
    while live:
        turn = starting.pop(0) if starting else _choose(run, live)
        if turn is None:
            yield min(branch.ready_at for branch in live.values())
            continue
        end = _advance(live[turn])
        if end is None:
            if not starting:
                yield run.clock
            continue
        del live[turn], run.preemption.wake[turn]
        running.remove(turn)
        ended[children[turn].name] = end
        if isinstance(end, Failure) and end.kind == "no-end":
            break
        if not told and (node.join == "any" or isinstance(end, Failure)):
            told = True
            for other in live:
                run.preemption.request(other)
    run.preemption.after_all(path, children)
    for end in ended.values():
        if isinstance(end, Failure):
            raise RunError(end)
    return _outcome_of(node, ended)


def _branch(
    run: Interpreter, child: Node, here: str, own: dict[str, object]
) -> Generator[float, None, str]:
    """A child of a concurrence: any outcome will do, but there must be one."""
    outcome = yield from run.visit(child, here, own)
    if outcome is None:
        raise RunError(no_outcome(child, here, "no-outcome"))
    return outcome


@dataclass(slots=True)
class _Branch:
    """A child of a concurrence that has not ended, and when it can go on."""

    body: Generator[float, None, str]
    ready_at: float = 0.0

    def wake(self) -> None:
        self.ready_at = 0.0


def _advance(branch: _Branch) -> str | Failure | None:
    """Let a branch go on until it is in its next leaf; how it ended, if it did."""
    try:
        branch.ready_at = next(branch.body)
    except StopIteration as end:
        outcome: str = end.value
        return outcome
    except RunError as failed:
        return failed.failure
    return None


def _choose(run: Interpreter, live: Mapping[str, _Branch]) -> str | None:
    """Whose turn it is among the branches that can go on now."""
    ready = [path for path, branch in live.items() if branch.ready_at <= run.clock]
    return run.schedule.choose(ready) if len(ready) > 1 else next(iter(ready), None)


def _outcome_of(node: Concurrence, ended: Mapping[str, str | Failure]) -> str:
    """The outcome of the matching rule with most conditions, the last among equals (N5, N6)."""
    best, most = node.default_outcome, 0
    for rule in node.rules:
        holds = all(ended.get(one.child) == one.outcome for one in rule.when)
        if holds and len(rule.when) >= most:
            best, most = rule.outcome, len(rule.when)
    return best


def _iterator(run: Interpreter, node: Iterator, path: str, own: dict[str, object]) -> Run:
    """Item after item; a request to stop ends it after the item that runs then (P9)."""
    result: str | None = node.exhausted_outcome
    outcome, here = None, path
    children = [replace(child, remaps=()) for child in node.children]  # own keys, as they are (I7)
    items = _items_of(run, node, path, own)
    position = 0
    while position < len(items):
        own[node.item_key] = items[position]
        position += 1
        if not children:
            run.fail("no-state", path, "has no states", node.span)
        child = children[0]
        here = f"{path}/{child.name}"
        run.preemption.running[path] = [here]
        outcome = yield from run.visit(child, here, own, loose=True)
        if path in run.preemption.asked or outcome not in node.loop_outcomes:
            run.preemption.recall(path)
            result = outcome
            break
        if position < len(items):
            run.emit("transition", here, outcome=outcome, to=here)
    run.preemption.running.pop(path, None)
    if result is not None:
        result = dict(node.final_map).get(result, result)
    if outcome is not None:
        run.emit("transition", here, outcome=outcome, to=f"{path}:{result}")
    return result


def _items_of(
    run: Interpreter, node: Iterator, path: str, own: Mapping[str, object]
) -> list[object]:
    """What an iterator goes through, found as it starts."""
    span = node.items.span if node.items else node.span
    items: object
    if node.items_key:
        if node.items_key not in own:
            message = f"finds no items: its userdata has no `{node.items_key}`"
            run.fail("no-items", path, message, span)
        items = own[node.items_key]
    elif node.items and isinstance(node.items.data, Expression):
        try:
            items = called(node.items.data, own)
        except BehaviourError as error:
            run.fail("no-items", path, str(error), span)
    else:
        if node.items and path not in run.items:
            run.items[path] = python_data(node.items.data)
        items = run.items.get(path)
    if not isinstance(items, Iterable):
        run.fail("no-items", path, f"its items cannot be gone through: {items!r}", span)
    return items if isinstance(items, list) else list(items)
