"""The reference interpreter: container semantics as coroutines that yield wake-up times.

The semantics are those of SMACH (docs/semantics.md), except that its deadlocks, stale preemption
flags and lost requests are not reproduced. Branches of a concurrence take turns, one leaf at a
time, in an order given by a seed or a schedule (scheduler.py). Time is virtual.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Generator, Iterable, Mapping, Sequence
from itertools import islice
from operator import eq
from typing import NoReturn, TypeAlias

from smachac.diagnostics.source import NOWHERE, Span, assert_never
from smachac.interpreter.preemption import Preemption
from smachac.interpreter.result import (
    NO_OUTCOME,
    Behaviour,
    ErrorKind,
    Event,
    InterpreterResult,
    RunError,
    RunFailure,
)
from smachac.interpreter.scheduler import Scheduler
from smachac.interpreter.userdata import (
    BehaviourError,
    Userdata,
    UserdataError,
    call_function,
    copy_in,
    copy_out,
    python_data,
    trace_value,
)
from smachac.ir import nodes
from smachac.ir.concurrence_rules import matching_rule, outcome_of
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
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.recursion import deep_recursion
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import containers, leads_to_child, outcome_names, walk
from smachac.records import dataclass, replace
from smachac.runtime.tracing.gate import Gate
from smachac.runtime.tracing.writer import SECRET

MAX_STEPS = 10_000
"""Default limit on the states that one run enters."""

MOST_RECENT = 1_000
"""The last states entered, among which a run without end has its cycle."""

Coroutine: TypeAlias = "Generator[float, None, str | None]"
"""A running state: yields the time at which it can continue, returns its outcome (None if a leaf
returned none)."""


def run(
    machine: Machine,
    behaviour: Behaviour,
    on_event: Callable[[Event], None] | None = None,
    *,
    seed: int = 0,
    schedule: Sequence[str] | None = None,
    max_steps: int = MAX_STEPS,
    userdata: Mapping[str, object] | None = None,
    preempt_at: Collection[int] = (),
    gate: Gate | None = None,
) -> InterpreterResult:
    """Run a machine once, from its start to an outcome or an error.

    `on_event` receives each event of the trace. `schedule` names the branch that continues at each
    choice between concurrent branches, as the `choices` of a result do; when it is used up the
    first branch continues. Without a schedule the choice is random, seeded by `seed`. `userdata`
    overrides the presets of the outermost container. `preempt_at` holds numbers of leaf visits: a
    request to stop arrives during the n-th visit, 0 is before the start. A run that enters more
    than `max_steps` states ends with an error. `gate` lets a debugger stop the run between two
    states. Raises ScheduleError if the schedule names a branch that cannot continue.
    """
    interpreter = Interpreter(
        machine,
        behaviour,
        on_event,
        seed=seed,
        schedule=schedule,
        max_steps=max_steps,
        userdata=userdata,
        preempt_at=preempt_at,
        gate=gate,
    )
    return interpreter.execute()


class Interpreter:
    """A machine and its state between runs: userdata, visit counts, requests to stop.

    The arguments are those of `run`. Attributes without an underscore are used by the coroutines of
    containers below.
    """

    def __init__(
        self,
        machine: Machine,
        behaviour: Behaviour,
        on_event: Callable[[Event], None] | None = None,
        *,
        seed: int = 0,
        schedule: Sequence[str] | None = None,
        max_steps: int = MAX_STEPS,
        userdata: Mapping[str, object] | None = None,
        preempt_at: Collection[int] = (),
        gate: Gate | None = None,
    ) -> None:
        self._root = machine.root
        self._secret = secret_keys(machine) if on_event else {}
        self._behaviour = behaviour
        self._on_event = on_event
        self._max_steps = max_steps
        self._preempt_at = frozenset(preempt_at)
        self._gate = gate
        self._stop_asked = False
        self.schedule = Scheduler(seed, schedule)
        self.preemption = Preemption(lambda path: self.emit("preempt", path))
        self.clock = 0.0
        self._steps = self._leaves = self._events = 0
        self._visits: dict[str, int] = {}
        self._recent: deque[str] = deque(maxlen=MOST_RECENT)
        self.transition_tables: dict[str, TransitionTable] = {}
        self.items: dict[str, object] = {}
        self._scopes: dict[str, dict[str, object]] = {
            path: {preset.key: python_data(preset.value.data) for preset in node.userdata}
            for path, node in containers(self._root)
        }
        self._scopes[self._root.name].update(userdata or {})
        self._sources = _trace_sources(self._root) if on_event else {}
        if gate is not None:
            gate.opened(self._ask_to_stop)

    def execute(self, parent: dict[str, object] | None = None) -> InterpreterResult:
        """Run the machine once more. `parent` is the userdata around it, as if it were a nested
        state."""
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
            coroutine = container_coroutine(self, root, path, own)
            with deep_recursion():
                while True:
                    self.clock = max(self.clock, next(coroutine))
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
        return InterpreterResult(
            outcome=outcome,
            userdata=scopes[path],
            error=failure,
            scopes=scopes,
            steps=self._steps,
            time=self.clock,
            choices=tuple(self.schedule.choices),
        )

    def emit(self, event: str, path: str, **more: object) -> None:
        """Send an event to `on_event`."""
        if self._on_event is None:
            return
        self._events += 1
        line: Event = {"seq": self._events, "event": event, "path": path, **more, "t": self.clock}
        if self._sources[path]:
            line["src"] = self._sources[path]
        self._on_event(line)

    def fail(
        self, kind: ErrorKind, path: str, message: str, span: Span, cycle: tuple[str, ...] = ()
    ) -> NoReturn:
        """Emit an error and raise RunError, which ends the branch."""
        self.emit("error", path, message=message)
        raise RunError(RunFailure(kind=kind, path=path, message=message, span=span, cycle=cycle))

    def visit(
        self, node: Node, path: str, around: dict[str, object], unrestricted: bool = False
    ) -> Coroutine:
        """Run one state from its entry to its exit."""
        if self._steps >= self._max_steps:
            message = f"did not end after {self._max_steps} states"
            self.fail("no-end", path, message, node.span, repeated_states(self._recent))
        self._steps += 1
        self._recent.append(path)
        forced = self._pass_gate(node, path)
        self.emit("enter", path)
        if forced is not None:
            self.emit("exit", path, outcome=forced, forced=True)
            return forced
        own = self._scopes.get(path, {})
        try:
            if isinstance(node, Leaf):
                outcome = yield from self._leaf(node, path, around, unrestricted or node.open)
            else:
                copy_in(node, around, own)
                outcome = yield from container_coroutine(self, node, path, own)
        except RunError as failed:
            if not node.catches or failed.failure.kind == "no-end":
                raise
            self.emit("exit", path, outcome=node.catches)
            return node.catches
        if outcome is not None and self._gate is not None and self._gate.armed:
            ended, outcome = outcome, self._gate.after(path, outcome, outcome_names(node))
            forced = outcome if outcome != ended else None
        if outcome is not None:
            self.emit("exit", path, outcome=outcome, **({"forced": True} if forced else {}))
        elif isinstance(node, Leaf):
            self.emit("error", path, message=NO_OUTCOME)
        if not isinstance(node, Leaf):
            copy_out(node, own, around)
        return outcome

    def _pass_gate(self, node: Node, path: str) -> str | None:
        """Wait for a debugger; the outcome that it forces, if any."""
        if self._gate is None:
            return None
        forced = self._gate.before(path, outcome_names(node)) if self._gate.armed else None
        if self._stop_asked:
            self._stop_asked = False
            self._stop_machine()
        return forced

    def _ask_to_stop(self) -> None:
        """Make a request to stop at the start of the next state; for other threads."""
        self._stop_asked = True

    def _leaf(
        self, leaf: Leaf, path: str, around: dict[str, object], unrestricted: bool
    ) -> Coroutine:
        visit = self._visits[path] = self._visits.get(path, 0) + 1
        self._leaves += 1
        if self._leaves in self._preempt_at:
            self._stop_machine()
        yield self.clock
        requested = self.preemption.requested

        def on_write(key: str, value: object) -> None:
            if self._on_event is not None:
                hidden = key in self._secret.get(path, ())
                shown = SECRET if hidden else trace_value(value)
                self.emit("write", path, key=key, value=shown)

        view = Userdata(
            leaf,
            path,
            around,
            requested,
            on_write,
            unrestricted=unrestricted,
            stop_machine=self._stop_machine,
        )
        try:
            outcome = self._behaviour(path, leaf, visit, view)
        except UserdataError as error:
            self.fail(error.kind, path, str(error), leaf.span)
        except BehaviourError as error:
            self.fail("behaviour", path, str(error), leaf.span)
        except Exception as error:
            self.fail("behaviour", path, f"{type(error).__name__}: {error}", leaf.span)
        if view.slept and (yield from self._sleep(leaf, path, view.slept, waits=view.waits)):
            requested.discard(path)
            return PREEMPTED
        return outcome

    def _stop_machine(self) -> None:
        self.preemption.request(self._root.name)

    def _sleep(
        self, leaf: Leaf, path: str, seconds: float, *, waits: bool
    ) -> Generator[float, None, bool]:
        """Wait. True if a request to stop, which the leaf can serve, ended the wait early. If the
        leaf `waits` for a request, one that it cannot serve ends the wait as well."""
        until = self.clock + seconds
        answers = PREEMPTED in outcome_names(leaf)
        while self.clock < until:
            if (answers or waits) and path in self.preemption.requested:
                return answers
            yield until
        return False


def repeated_states(paths: Iterable[str]) -> tuple[str, ...]:
    """The states that a run repeats at its end, by path: one round, without the containers around
    others of it. Without a round, as with branches in random order, each state once."""
    recent = list(paths)
    periods = (
        period
        for period in range(1, len(recent) // 2 + 1)
        if all(map(eq, islice(recent, period, None), recent))
    )
    period = next(periods, 0)
    found = recent[-period:] if period else list(dict.fromkeys(recent))
    around = {path.rpartition("/")[0] for path in found}
    return tuple(path for path in found if path not in around)


def _trace_sources(root: Node) -> dict[str, str]:
    """The place of each state as traces show it: file name without folder, and line. Empty for
    machines that no script describes."""
    return {
        path: f"{node.span.source.file_name}:{node.span.line}"
        if node.span.source is not NOWHERE.source
        else ""
        for path, node in walk(root)
    }


def container_coroutine(
    run: Interpreter, node: Container, path: str, own: dict[str, object]
) -> Coroutine:
    """The coroutine of a container between its entry and its exit, over its own userdata."""
    if not node.children and not isinstance(node, Iterator):
        run.fail("no-state", path, "has no states", node.span)
    match node:
        case StateMachine() | nodes.Sequence():
            return _machine(run, node, path, own)
        case Concurrence():
            return _concurrence(run, node, path, own)
        case Iterator():
            return _iterator(run, node, path, own)
    return assert_never(node)


def _machine(
    run: Interpreter, node: StateMachine | nodes.Sequence, path: str, own: dict[str, object]
) -> Coroutine:
    """A state machine or sequence: one state after the other along transitions."""
    transition_tables = run.transition_tables.get(path) or run.transition_tables.setdefault(
        path, _transition_table(node)
    )
    name, inside, here = node.initial or node.children[0].name, True, None
    if name not in transition_tables.children:
        run.fail("no-target", path, f"has no state `{name}` to start with", node.span)
    while inside:
        child, previous, here = transition_tables.children[name], here, f"{path}/{name}"
        run.preemption.before_state(path, previous, here)
        run.preemption.running[path] = [here]
        outcome = yield from run.visit(child, here, own)
        if outcome is None:
            raise RunError(_no_outcome_failure(child, here, "undeclared-outcome"))
        if outcome not in outcome_names(child) and not (isinstance(child, Leaf) and child.open):
            message = f"ended with `{outcome}`, which is not one of its outcomes"
            run.fail("undeclared-outcome", here, message, child.span)
        if outcome not in transition_tables.targets[name]:
            message = f"no transition for outcome `{outcome}`"
            run.fail("no-transition", here, message, child.span)
        name, inside = transition_tables.targets[name][outcome]
        if not inside and name not in outcome_names(node):
            message = f"`{name}` is neither a state nor an outcome of `{path}`"
            run.fail("no-target", here, message, child.span)
        to = f"{path}/{name}" if inside else f"{path}:{name}"
        run.emit("transition", here, outcome=outcome, to=to)
    run.preemption.after_machine(path, here or path)
    return name


def _no_outcome_failure(node: Node, path: str, kind: ErrorKind) -> RunFailure:
    """The failure of a state that ended without an outcome. Its error event is emitted already."""
    return RunFailure(kind=kind, path=path, message=NO_OUTCOME, span=node.span)


@dataclass(frozen=True, slots=True)
class TransitionTable:
    """The children of a machine by name, and for each child the targets of its outcomes.

    The flag is true if the target is a child.
    """

    children: dict[str, Node]
    targets: dict[str, dict[str, tuple[str, bool]]]


def _transition_table(node: StateMachine | nodes.Sequence) -> TransitionTable:
    children = {child.name: child for child in node.children}
    names = frozenset(children)
    targets = {
        name: {
            edge.outcome: (edge.target, leads_to_child(edge, names)) for edge in child.transitions
        }
        for name, child in children.items()
    }
    return TransitionTable(children, targets)


def _concurrence(
    run: Interpreter, node: Concurrence, path: str, own: dict[str, object]
) -> Coroutine:
    """A concurrence: branches take turns until all have ended or, with `join: any`, have been
    preempted."""
    children = {f"{path}/{child.name}": child for child in node.children}
    live = {here: _Branch(_branch(run, child, here, own)) for here, child in children.items()}
    run.preemption.wake.update((here, branch.wake) for here, branch in live.items())
    running = run.preemption.running[path] = list(live)
    run.preemption.pass_on(path, children)
    starting = list(live)
    ended: dict[str, str | RunFailure] = {}
    stopping = False
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
        if isinstance(end, RunFailure) and end.kind == "no-end":
            break
        decides = node.join == "any" or (node.join == "rule" and matching_rule(node, ended) >= 0)
        if not stopping and (decides or isinstance(end, RunFailure)):
            stopping = True
            if path not in run.preemption.requested:  # else every branch has a request already
                for other in live:
                    run.preemption.request(other)
        if live and not starting:
            yield run.clock  # also after the end of a branch: branches further out may be next
    stopped = node.sugar and path in run.preemption.requested
    run.preemption.after_concurrence(path, children)
    for end in ended.values():
        if isinstance(end, RunFailure):
            raise RunError(end)
    if stopped:
        run.preemption.requested.discard(path)
        return PREEMPTED
    return outcome_of(node, ended)


def _branch(
    run: Interpreter, child: Node, here: str, own: dict[str, object]
) -> Generator[float, None, str]:
    """A child of a concurrence. It may end with any outcome, but needs one."""
    outcome = yield from run.visit(child, here, own)
    if outcome is None:
        raise RunError(_no_outcome_failure(child, here, "no-outcome"))
    return outcome


@dataclass(slots=True)
class _Branch:
    """A child of a concurrence that has not ended, and the time at which it can continue."""

    coroutine: Generator[float, None, str]
    ready_at: float = 0.0

    def wake(self) -> None:
        """Continue at once: a request to stop has arrived."""
        self.ready_at = 0.0


def _advance(branch: _Branch) -> str | RunFailure | None:
    """Continue a branch until its next wait. Its outcome or failure, or None while it runs."""
    try:
        branch.ready_at = next(branch.coroutine)
    except StopIteration as end:
        outcome: str = end.value
        return outcome
    except RunError as failed:
        return failed.failure
    return None


def _choose(run: Interpreter, live: Mapping[str, _Branch]) -> str | None:
    """The branch that continues among those that can continue now; None if all of them wait."""
    ready = [path for path, branch in live.items() if branch.ready_at <= run.clock]
    return run.schedule.choose(ready) if len(ready) > 1 else next(iter(ready), None)


def _iterator(run: Interpreter, node: Iterator, path: str, own: dict[str, object]) -> Coroutine:
    """An iterator: item after item. A request to stop ends it after the current item, or after the
    first one if it came before."""
    result: str | None = node.exhausted_outcome
    outcome, here = None, path
    # The child sees the keys of the iterator under their own names (docs/semantics.md, Iterator).
    children = [replace(child, remaps=()) for child in node.children]
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
        run.preemption.pass_on(path, [here])
        outcome = yield from run.visit(child, here, own, unrestricted=True)
        if path in run.preemption.requested or not _loops(node, child, outcome):
            result = outcome
            break
        if position < len(items):
            run.emit("transition", here, outcome=outcome, to=here)
    run.preemption.running.pop(path, None)
    if result is not None:
        result = dict(node.final_map).get(result, result)
    if path in run.preemption.requested and (node.sugar or outcome is not None):
        run.preemption.recall(path)
        result = PREEMPTED if node.sugar else result
    if outcome is not None:
        run.emit("transition", here, outcome=outcome, to=f"{path}:{result}")
    return result


def _loops(node: Iterator, child: Node, outcome: str | None) -> bool:
    """Whether an outcome of its state leads to the next item. An iterator without looping outcomes
    goes on after an outcome that its state does not declare (docs/semantics.md, Iterator)."""
    if node.loop_outcomes or (isinstance(child, Leaf) and child.open):
        return outcome in node.loop_outcomes
    return outcome not in outcome_names(child)


def _items_of(
    run: Interpreter, node: Iterator, path: str, own: Mapping[str, object]
) -> list[object]:
    """The items of an iterator, computed when it starts."""
    span = node.items.span if node.items else node.span
    items: object
    if node.items_key:
        if node.items_key not in own:
            message = f"finds no items: its userdata has no `{node.items_key}`"
            run.fail("no-items", path, message, span)
        items = own[node.items_key]
    elif node.items and isinstance(node.items.data, Expression):
        try:
            items = call_function(node.items.data, own)
        except BehaviourError as error:
            run.fail("no-items", path, str(error), span)
    else:
        if node.items and path not in run.items:
            run.items[path] = python_data(node.items.data)
        items = run.items.get(path)
    if not isinstance(items, Iterable):
        run.fail("no-items", path, f"its items cannot be gone through: {items!r}", span)
    return items if isinstance(items, list) else list(items)
