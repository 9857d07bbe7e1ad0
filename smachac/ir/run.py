"""The reference interpreter: what a machine does, in one thread, step by step.

The rules are those of SMACH where the graph can express them (M*, V*, R*, P*, N*, I*: ids of the
rules); its hangs, stale flags and lost requests are not copied. Branches of a concurrence take
turns, one leaf at a time, in an order that a seed or a schedule settles (schedule.py); time is
virtual. Every state is a generator that yields the time at which it can go on.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Generator, Mapping, Sequence
from functools import lru_cache
from pathlib import PurePath
from typing import NoReturn

from smachac.ir.bodies import Routes, Run, body
from smachac.ir.depth import deep_recursion
from smachac.ir.nodes import Leaf, Machine, Node
from smachac.ir.preemption import Preemption
from smachac.ir.result import NO_OUTCOME, Behaviour, Event, Failure, Fault, Result, RunError
from smachac.ir.schedule import Schedule
from smachac.ir.userdata import (
    BehaviourError,
    Userdata,
    UserdataError,
    copy_in,
    copy_out,
    python_data,
    trace_value,
)
from smachac.ir.walk import PREEMPTED, containers, outcome_names, walk
from smachac.source import NOWHERE, Span

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
