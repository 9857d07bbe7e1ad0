"""Trace conformance: whether a recorded run is one that the machine allows.

The events of a trace (docs/semantics.md, Traces) are accepted one by one, in time linear in their
number. Values are left out: a state may end with each of its outcomes, whatever its conditions are.
Branches of a concurrence may interleave in any order. A trace that ends early, as that of a killed
run, is allowed up to its end.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import quote
from smachac.interpreter.result import Event
from smachac.ir import nodes
from smachac.ir.concurrence_rules import outcome_of
from smachac.ir.nodes import Concurrence, Container, Iterator, Leaf, Machine, Node, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.script_paths import script_paths
from smachac.ir.traversal import ends_preempted, leads_to_child, outcome_names, walk
from smachac.ir.written import Written, written
from smachac.records import dataclass, field
from smachac.runtime.tracing.writer import shown_path
from smachac.verify.guidance import possible_leaf_outcomes


class Violation(NamedTuple):
    """The first event of a trace that the machine does not allow: its number, counted from 0, the
    reason, and the place of its state in the script."""

    at: int
    message: str
    span: Span


@dataclass(slots=True)
class _Run:
    """One run of a state, from its entry to its end.

    `running` are the children that have not ended, `ended` the outcomes of those of a concurrence,
    `previous` the child that ended last with its outcome, `target` the name to which the last
    transition leads and whether it is a child. `failed`: an exception inside it was not caught.
    """

    running: set[str] = field(default_factory=set)
    ended: dict[str, str] = field(default_factory=dict)
    previous: tuple[str, str] | None = None
    target: tuple[str, bool] | None = None
    failed: bool = False


class _NotAllowedError(Exception):
    """The event is not allowed; the message gives the reason."""


def first_violation(machine: Machine, events: Iterable[Event]) -> Violation | None:
    """The first event of a trace that the machine does not allow, or None.

    Paths in the events are those that the script shows (ir/script_paths.py).
    """
    acceptor = Acceptor(machine, written(machine))
    for at, event in enumerate(events):
        violation = acceptor.accept(at, acceptor.full(event))
        if violation is not None:
            return violation
    return None


class Acceptor:
    """The runs that a machine allows, after the events of a trace so far.

    `view` has the states that messages name. `outcome` is that of the machine, or None if it has
    not ended; `finished` counts its runs.
    """

    def __init__(self, machine: Machine, view: Written) -> None:
        self._root = machine.root
        self._nodes = dict(walk(machine.root))
        shown = script_paths(machine.root)
        self._full = {path: full for full, path in shown.items()}
        self._view = view
        self._runs: dict[str, _Run] = {}
        self._asked: set[str] = set()
        self.outcome: str | None = None
        self.finished = 0

    def full(self, event: Event) -> Event:
        """An event with full paths."""
        if not self._full:
            return event
        changed = {**event, "path": self._full.get(event["path"], event["path"])}
        if "to" in event:
            changed["to"] = shown_path(event["to"], self._full)
        return changed

    def accept(self, at: int, event: Event) -> Violation | None:
        """Accept the next event, with full paths, or the reason why it is not allowed."""
        kind, path = event["event"], event["path"]
        node = self._nodes.get(path)
        if node is None:
            near = path
            while near not in self._nodes and "/" in near:
                near = near.rpartition("/")[0]
            span = self._nodes.get(near, self._root).span
            return Violation(at, f"the script has no state {quote(path)}", span)
        try:
            if node is self._root and kind in ("enter", "exit", "transition"):
                raise _NotAllowedError(
                    f"{self._name(path)} is the whole machine, not a state in it"
                )
            _ACCEPT[kind](self, path, node, event)
        except _NotAllowedError as error:
            return Violation(at, str(error), node.span)
        return None

    def _name(self, path: str) -> str:
        return self._view.in_words(path)

    def _target(self, to: str) -> str:
        """The target of a transition: a state as a whole, or an outcome of a container."""
        return quote(self._view.traced_state(to))

    def _run(self, path: str) -> _Run:
        run = self._runs.get(path)
        if run is None:
            raise _NotAllowedError(f"{self._name(path)} is not running")
        return run

    def _start(self, path: str, node: Node, event: Event) -> None:
        if node is not self._root or self._runs:
            raise _NotAllowedError(f"{self._name(path)} cannot start here")
        self.outcome = None
        self._runs[path] = _Run()

    def _finish(self, path: str, node: Node, event: Event) -> None:
        if node is not self._root:
            raise _NotAllowedError(f"{self._name(path)} is not the whole machine")
        self._end(path, node, event["outcome"])
        self.outcome = event["outcome"]
        self.finished += 1

    def _enter(self, path: str, node: Node, event: Event) -> None:
        parent, _, name = path.rpartition("/")
        around, run = self._nodes.get(parent), self._run(parent)
        if around is None or name in run.running:
            raise _NotAllowedError(f"{self._name(path)} is running already")
        match around:
            case StateMachine() | nodes.Sequence():
                expected = run.target
                if run.previous is None:
                    expected = around.initial or around.children[0].name, True
                if run.running or expected != (name, True):
                    raise _NotAllowedError(self._instead(path, parent, run, expected))
            case Concurrence():
                if name in run.ended:
                    raise _NotAllowedError(f"the branch {self._name(path)} has ended already")
            case Iterator():
                expected = run.target if run.previous is not None else (name, True)
                if run.running or expected != (name, True):
                    raise _NotAllowedError(self._instead(path, parent, run, expected))
        run.running.add(name)
        run.target = None
        self._runs[path] = _Run()

    def _instead(self, path: str, parent: str, run: _Run, expected: tuple[str, bool] | None) -> str:
        """Why a state of a machine cannot be entered now."""
        entered = f"{self._name(path)} cannot be entered here"
        if run.running:
            return f"{entered}: {self._name(f'{parent}/{min(run.running)}')} is still running"
        if expected is None:
            return f"{entered}: no transition leads to it"
        name, inside = expected
        if not inside:
            return f"{entered}: {self._name(parent)} ends with `{name}`"
        kind = "initial" if run.previous is None else "next"
        return f"{entered}: {self._target(f'{parent}/{name}')} is the {kind} state"

    def _exit(self, path: str, node: Node, event: Event) -> None:
        self._end(path, node, event["outcome"])
        parent, _, name = path.rpartition("/")
        around = self._run(parent)
        around.running.discard(name)
        around.previous = name, event["outcome"]
        around.ended[name] = event["outcome"]
        if around.failed:
            self._fail(parent)

    def _end(self, path: str, node: Node, outcome: str) -> None:
        """The end of a state with an outcome, or of the whole machine."""
        run = self._run(path)
        allowed = self._outcomes(path, node, run)
        if outcome not in allowed:
            raise _NotAllowedError(_outcome_words(self._name(path), outcome, allowed))
        del self._runs[path]
        self._asked.discard(path)

    def _outcomes(self, path: str, node: Node, run: _Run) -> frozenset[str]:
        """The outcomes with which a running state can end now."""
        if run.failed and not run.running:
            return frozenset([node.catches] if node.catches else [])
        if isinstance(node, Leaf):
            return frozenset(possible_leaf_outcomes(node))
        if run.running:
            inner = ", ".join(self._name(f"{path}/{name}") for name in sorted(run.running))
            raise _NotAllowedError(f"{self._name(path)} ends while {inner} is still running")
        stopped = {PREEMPTED} if ends_preempted(node) and path in self._asked else set()
        match node:
            case Concurrence():
                missing = [child.name for child in node.children if child.name not in run.ended]
                if missing:
                    name = self._name(f"{path}/{missing[0]}")
                    raise _NotAllowedError(f"{self._name(path)} ends, but {name} has not ended")
                return frozenset(stopped or {outcome_of(node, run.ended)})
            case Iterator():
                if run.previous is None:
                    exhausted = node.exhausted_outcome
                    return frozenset(stopped | {dict(node.final_map).get(exhausted, exhausted)})
        if run.target is None or run.target[1]:
            raise _NotAllowedError(f"{self._name(path)} ends before a transition leads out of it")
        return frozenset([run.target[0]])

    def _transition(self, path: str, node: Node, event: Event) -> None:
        parent, _, name = path.rpartition("/")
        around, run, outcome = self._nodes[parent], self._run(parent), event["outcome"]
        if isinstance(around, Concurrence | Leaf):
            raise _NotAllowedError(f"{self._name(path)} is a branch: it has no transitions")
        if run.previous != (name, outcome) or run.running:
            raise _NotAllowedError(f"{self._name(path)} has not ended with {quote(outcome)}")
        targets = self._targets(parent, around, node, outcome)
        found = {
            f"{parent}/{target}" if inside else f"{parent}:{target}": (target, inside)
            for target, inside in targets
        }
        if event["to"] not in found:
            right = " or ".join(map(self._target, sorted(found)))
            raise _NotAllowedError(
                f"{quote(outcome)} of {self._name(path)} leads to {self._target(event['to'])},"
                f" in the script to {right or 'nothing'}"
            )
        run.target = found[event["to"]]

    def _targets(
        self, parent: str, around: Container, child: Node, outcome: str
    ) -> set[tuple[str, bool]]:
        """The targets of an outcome of a child: names, with whether they are children."""
        if isinstance(around, Iterator):
            return self._iterator_targets(parent, around, child, outcome)
        names = frozenset(child.name for child in around.children)
        return {
            (edge.target, leads_to_child(edge, names))
            for edge in child.transitions
            if edge.outcome == outcome
        }

    def _iterator_targets(
        self, parent: str, around: Iterator, child: Node, outcome: str
    ) -> set[tuple[str, bool]]:
        """The next item or the end; how many items there are is not known."""
        final = dict(around.final_map)
        asked = parent in self._asked
        found: set[tuple[str, bool]] = set()
        if asked and around.sugar:
            found.add((PREEMPTED, False))
        if around.loop_outcomes or (isinstance(child, Leaf) and child.open):
            loops = outcome in around.loop_outcomes
        else:
            loops = outcome not in outcome_names(child)
        if loops:
            exhausted = around.exhausted_outcome
            found |= {(child.name, True), (final.get(exhausted, exhausted), False)}
        if asked or not loops:
            found.add((final.get(outcome, outcome), False))
        return found

    def _write(self, path: str, node: Node, event: Event) -> None:
        self._run(path)
        outputs = [key.name for key in node.outputs]
        unrestricted = isinstance(node, Leaf) and node.open
        around = self._nodes.get(path.rpartition("/")[0])
        if event["key"] in outputs or unrestricted or isinstance(around, Iterator):
            return
        raise _NotAllowedError(f"{quote(event['key'])} is not an output key of {self._name(path)}")

    def _preempt(self, path: str, node: Node, event: Event) -> None:
        parent = path.rpartition("/")[0]
        self._asked.add(path)
        if not parent:
            return
        run, around = self._run(parent), self._nodes[parent]
        ended = bool(run.ended) or run.failed
        if parent in self._asked or (isinstance(around, Concurrence) and ended):
            return
        raise _NotAllowedError(f"nothing stops {self._name(path)} here")

    def _fault(self, path: str, node: Node, event: Event) -> None:
        """An injected fault of the simulation is allowed at any time."""

    def _error(self, path: str, node: Node, event: Event) -> None:
        """An exception of a state, or of its container after the state has ended."""
        here = path if path in self._runs else path.rpartition("/")[0]
        self._run(here)
        self._fail(here)

    def _fail(self, path: str) -> None:
        """End a state by an exception, and the states around it up to one that catches it. A
        concurrence fails when all its branches have ended."""
        node, run = self._nodes[path], self._runs[path]
        run.failed = True
        waits = isinstance(node, Concurrence) and len(run.ended) < len(node.children)
        if node.catches or waits:
            return
        del self._runs[path]
        self._asked.discard(path)
        parent, _, name = path.rpartition("/")
        if parent:
            around = self._run(parent)
            around.running.discard(name)
            around.ended[name] = ""
            self._fail(parent)


def _outcome_words(name: str, outcome: str, allowed: frozenset[str]) -> str:
    if not allowed:
        return f"{name} ends with {quote(outcome)}, but an exception has ended it"
    if len(allowed) == 1:
        return f"{name} ends with {quote(outcome)}, in the script with `{min(allowed)}`"
    names = ", ".join(f"`{text}`" for text in sorted(allowed))
    return f"{name} ends with {quote(outcome)}, which is none of its outcomes: {names}"


_ACCEPT = {
    "start": Acceptor._start,
    "finish": Acceptor._finish,
    "enter": Acceptor._enter,
    "exit": Acceptor._exit,
    "transition": Acceptor._transition,
    "write": Acceptor._write,
    "preempt": Acceptor._preempt,
    "error": Acceptor._error,
    "fault": Acceptor._fault,
}
"""By the kind of an event, the method that accepts it."""
