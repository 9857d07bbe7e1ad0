"""The reference interpreter: what a machine does, in one thread, step by step.

The rules are those of SMACH where the graph can express them (M*, V*, R*, P*, N*, I*: ids of the
rules); its hangs, stale flags and lost requests are not copied. Branches of a concurrence take
turns, one leaf at a time, in an order that a seed or a schedule settles (schedule.py); time is
virtual. Every state is a generator that yields the time at which it can go on.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import PurePath
from typing import NoReturn, TypeAlias

from smachac.diagnostics.source import NOWHERE, Span
from smachac.interpreter.preemption import Preemption
from smachac.interpreter.result import (
    NO_OUTCOME,
    Behaviour,
    Event,
    Failure,
    Fault,
    Result,
    RunError,
)
from smachac.interpreter.scheduler import Schedule
from smachac.interpreter.userdata import (
    BehaviourError,
    Userdata,
    UserdataError,
    called,
    copy_in,
    copy_out,
    python_data,
    trace_value,
)
from smachac.ir import nodes
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Expression,
    Iterator,
    Leaf,
    Machine,
    Node,
    StateMachine,
)
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import PREEMPTED, containers, leads_to_child, outcome_names, walk

MOST_STEPS = 1_000_000


def run(
    machine: Machine,
    behaviour: Behaviour,
    observe: Callable[[Event], None] | None = None,
    *,
    seed: int = 0,
    schedule: Sequence[str] | None = None,
    max_steps: int = MOST_STEPS,
    userdata: Mapping[str, object] | None = None,
    preempt_at: Collection[int] = (),
) -> Result:
    """Run a machine once, from its start to an outcome or an error.

    Where several branches of concurrences can go on, `schedule` names the one whose turn it is, as
    the `choices` of a result do; what it leaves open goes to the first branch, and without a
    schedule `seed` settles it. Raises ScheduleError for a turn of a branch that cannot go on.
    `userdata` is put into the outermost container over its presets. `preempt_at`: a request to
    stop reaches the machine while it is in its n-th leaf; 0 is before the start. It is an error
    to enter more than `max_steps` states.
    """
    interpreter = Interpreter(
        machine,
        behaviour,
        observe,
        seed=seed,
        schedule=schedule,
        max_steps=max_steps,
        userdata=userdata,
        preempt_at=preempt_at,
    )
    return interpreter.execute()


class Interpreter:
    """A machine with what it keeps between runs: userdata, counts of visits, requests to stop.

    The arguments are those of `run`. What has no underscore serves the bodies of containers.
    """

    def __init__(
        self,
        machine: Machine,
        behaviour: Behaviour,
        observe: Callable[[Event], None] | None = None,
        *,
        seed: int = 0,
        schedule: Sequence[str] | None = None,
        max_steps: int = MOST_STEPS,
        userdata: Mapping[str, object] | None = None,
        preempt_at: Collection[int] = (),
    ) -> None:
        self._root = machine.root
        self._behaviour = behaviour
        self._observe = observe
        self._max_steps = max_steps
        self._preempt_at = frozenset(preempt_at)
        self.schedule = Schedule(seed, schedule)
        self.preemption = Preemption(lambda path: self.emit("preempt", path))
        self.clock = 0.0
        self._steps = self._leaves = self._events = 0
        self._visits: dict[str, int] = {}
        self.routes: dict[str, Routes] = {}
        self.items: dict[str, object] = {}
        self._scopes: dict[str, dict[str, object]] = {
            path: {preset.key: python_data(preset.value.data) for preset in node.userdata}
            for path, node in containers(self._root)
        }
        self._scopes[self._root.name].update(userdata or {})
        places = walk(self._root) if observe else ()
        self._places = {path: _place(node.span) for path, node in places}

    def execute(self, parent: dict[str, object] | None = None) -> Result:
        """Run once more. `parent` is userdata around the machine, as if it were a state in it."""
        root, path = self._root, self._root.name
        own = self._scopes[path]
        self.preemption.running.clear()
        self.preemption.wake.clear()
        self._steps = self._leaves = 0
        self.schedule.choices = []
        self.emit("start", path)
        if 0 in self._preempt_at:
            self._stop_machine()
        if parent is not None:
            copy_in(root, parent, own)
        outcome, failure = None, None
        try:
            going = body(self, root, path, own)
            with deep_recursion():
                while True:
                    self.clock = max(self.clock, next(going))
        except StopIteration as end:
            outcome = end.value
        except RunError as failed:
            failure = failed.failure
        if failure is None:
            if parent is not None:
                copy_out(root, own, parent)
            if outcome is not None:
                self.emit("finish", path, outcome=outcome)
        scopes = {where: dict(scope) for where, scope in self._scopes.items()}
        return Result(
            outcome=outcome,
            userdata=scopes[path],
            error=failure,
            scopes=scopes,
            steps=self._steps,
            time=self.clock,
            choices=tuple(self.schedule.choices),
        )

    def emit(self, event: str, path: str, **more: object) -> None:
        """Tell the observer."""
        if self._observe is None:
            return
        self._events += 1
        line: Event = {"seq": self._events, "event": event, "path": path, **more, "t": self.clock}
        if self._places[path]:
            line["src"] = self._places[path]
        self._observe(line)

    def fail(self, kind: Fault, path: str, message: str, span: Span) -> NoReturn:
        """End the branch with an error; raises RunError."""
        self.emit("error", path, message=message)
        raise RunError(Failure(kind=kind, path=path, message=message, span=span))

    def visit(self, node: Node, path: str, around: dict[str, object], loose: bool = False) -> Run:
        """A state from its entry to its end."""
        if self._steps >= self._max_steps:
            self.fail("no-end", path, f"did not end after {self._max_steps} states", node.span)
        self._steps += 1
        self.emit("enter", path)
        own = self._scopes.get(path, {})
        try:
            if isinstance(node, Leaf):
                outcome = yield from self._leaf(node, path, around, loose or node.open)
            else:
                copy_in(node, around, own)
                outcome = yield from body(self, node, path, own)
        except RunError as failed:
            if not node.catches or failed.failure.kind == "no-end":
                raise
            self.emit("exit", path, outcome=node.catches)
            return node.catches
        if outcome is not None:
            self.emit("exit", path, outcome=outcome)
        elif isinstance(node, Leaf):
            self.emit("error", path, message=NO_OUTCOME)
        if not isinstance(node, Leaf):
            copy_out(node, own, around)
        return outcome

    def _leaf(self, leaf: Leaf, path: str, around: dict[str, object], loose: bool) -> Run:
        visit = self._visits[path] = self._visits.get(path, 0) + 1
        self._leaves += 1
        if self._leaves in self._preempt_at:
            self._stop_machine()
        yield self.clock
        asked = self.preemption.asked

        def written(key: str, value: object) -> None:
            if self._observe is not None:
                self.emit("write", path, key=key, value=trace_value(value))

        view = Userdata(
            leaf, path, around, asked, written, loose=loose, stop_machine=self._stop_machine
        )
        try:
            outcome = self._behaviour(path, leaf, visit, view)
        except UserdataError as error:
            self.fail(error.kind, path, str(error), leaf.span)
        except BehaviourError as error:
            self.fail("behaviour", path, str(error), leaf.span)
        except Exception as error:
            self.fail("behaviour", path, f"{type(error).__name__}: {error}", leaf.span)
        if view.slept and (yield from self._sleep(leaf, path, view.slept)):
            asked.discard(path)
            return PREEMPTED
        return outcome

    def _stop_machine(self) -> None:
        self.preemption.request(self._root.name)

    def _sleep(self, leaf: Leaf, path: str, seconds: float) -> Generator[float, None, bool]:
        """Wait; whether a request to stop, which the leaf can answer, cut that short."""
        until = self.clock + seconds
        answers = PREEMPTED in outcome_names(leaf)
        while self.clock < until:
            if answers and path in self.preemption.asked:
                return True
            yield until
        return False


def _place(span: Span) -> str:
    """A place as a trace shows it: file name without folder, and line."""
    if span.source is NOWHERE.source:
        return ""
    return f"{_file_name(span.source.name)}:{span.line}"


@lru_cache(maxsize=1000)
def _file_name(name: str) -> str:
    return PurePath(name).name


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
    run: Interpreter, node: StateMachine | nodes.Sequence, path: str, own: dict[str, object]
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


def _routes(node: StateMachine | nodes.Sequence) -> Routes:
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
