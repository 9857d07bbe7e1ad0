"""Conformance of recorded status messages: whether a run on a robot is one that the machine allows.

Generated nodes of ROS 2 with live status (docs/ros.md, Live status) publish the status of each
container at its start, at each transition and at its end. A status has the active states and the
outcome of a container, but no outcomes of the states in it: a state may follow another one if one
of its outcomes leads there. Recordings that begin in the middle of a run are allowed. SMACH's own
server reports no starts and ends: of its statuses only the names of the states are judged.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import quote
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Iterator, Leaf, Machine, Node
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import ends_preempted, leads_to_child, outcome_names, walk
from smachac.ir.written import Written
from smachac.verify.coverage import Coverage, CoverageItem
from smachac.verify.guidance import possible_leaf_outcomes
from smachac.verify.trace_report import JudgedTrace

REPEATED = frozenset(["HEARTBEAT", "Initial state", "REMOTE_INIT"])
"""The `info` of statuses that no change of a container has caused."""

LONGEST_INFO = 100_000
"""The most characters of an `info` that is read."""

NO_STATE = "None"
"""The label that a StateMachine has as its active state while it does not run."""


class Status(NamedTuple):
    """A status that a change of a container has caused: its time (s), the full path of the
    container, its active states, and its outcome if it has ended.

    `complete`: the server reports starts and ends too. SMACH's own one reports transitions alone.
    """

    stamp: float
    path: str
    active: tuple[str, ...]
    outcome: str | None = None
    complete: bool = True


def status_of(fields: Mapping[str, Any], stamp: float) -> Status | None:
    """The status in the fields of a message; None if no change has caused it. Raises KeyError and
    TypeError if it has not the fields of a status."""
    info = str(fields["info"])
    if info in REPEATED:
        return None
    try:  # the arguments of the callback: `(['A'],)`, at the end `(['A'], 'done')`
        arguments = ast.literal_eval(info) if len(info) <= LONGEST_INFO else None
    except (ValueError, SyntaxError, RecursionError, MemoryError):
        arguments = None  # SMACH's own server writes them in another form
    outcome = None
    if isinstance(arguments, tuple) and len(arguments) == 2:
        outcome = str(arguments[1])
    return Status(
        stamp=stamp,
        path=str(fields["path"]).strip("/"),
        active=tuple(map(str, fields["active_states"])),
        outcome=outcome,
        complete=isinstance(arguments, tuple),
    )


def in_order(statuses: Sequence[Status]) -> list[Status]:
    """The statuses by their time, because those of different containers may arrive in any order; in
    the order of arrival if the clock was set back."""
    by_path: dict[str, list[float]] = {}
    for status in statuses:
        by_path.setdefault(status.path, []).append(status.stamp)
    is_back = any(a > b for stamps in by_path.values() for a, b in pairwise(stamps))
    return list(statuses) if is_back else sorted(statuses, key=lambda status: status.stamp)


def judge_statuses(
    machine: Machine, name: str, statuses: Iterable[Status], taken: Coverage, view: Written
) -> JudgedTrace:
    """Judge the statuses of one run or more, in their order; `taken` receives the transitions that
    they certainly take, `view` has the states that messages name."""
    acceptor = _Acceptor(machine, taken, view)
    events = 0
    fault: tuple[int, str, Span | None] | None = None
    for number, status in enumerate(statuses, 1):
        try:
            acceptor.accept(status)
        except _NotAllowedError as error:
            fault = number, str(error), error.span
            break
        events += 1
    outcome = acceptor.outcomes.get(machine.root.name)
    return JudgedTrace(name=name, events=events, outcome=outcome, fault=fault)


class _NotAllowedError(Exception):
    """The status is not allowed; the message gives the reason, `span` the place in the script."""

    def __init__(self, message: str, span: Span) -> None:
        super().__init__(message)
        self.span = span


class _Acceptor:
    """The state of a machine after the statuses so far.

    `active` has the active states of containers by path: none, if the container does not run; a
    container that is not in it has had no status yet. `outcomes` are those of containers that have
    ended since they were entered, `repeats` the ends of the children of iterators.
    """

    def __init__(self, machine: Machine, taken: Coverage, view: Written) -> None:
        self._nodes = dict(walk(machine.root))
        self._root = machine.root
        self._view = view
        self._taken = taken
        self._items: dict[tuple[str, str, str], list[CoverageItem]] = {}
        for item in taken.items:
            self._items.setdefault((item.path, item.kind, item.target), []).append(item)
        self._active: dict[str, tuple[str, ...]] = {}
        self._repeats: dict[str, int] = {}
        self.outcomes: dict[str, str] = {}

    def accept(self, status: Status) -> None:
        """Accept the next status. Raises _NotAllowedError."""
        path, node = status.path, self._nodes.get(status.path)
        if node is None or isinstance(node, Leaf):
            message = f"the script has no container {quote(path)}"
            raise _NotAllowedError(message, self._root.span)
        names = [child.name for child in node.children]
        active = tuple(text for text in status.active if text in names or text != NO_STATE)
        for label in active:
            if label not in names:
                message = f"the script has no state {quote(f'{path}/{label}')}"
                raise _NotAllowedError(message, node.span)
        if not status.complete:
            return
        if status.outcome is not None:
            self._end(path, node, status.outcome)
        elif active and self._active.get(path) == ():
            self._start(path, node, active)
        elif active:
            self._go_on(path, node, active)

    def _name(self, path: str) -> str:
        return self._view.in_words(path)

    def _start(self, path: str, node: Container, active: tuple[str, ...]) -> None:
        parent, _, name = path.rpartition("/")
        if parent and name not in self._active.get(parent, (name,)):
            now = " and ".join(self._name(f"{parent}/{text}") for text in self._active[parent])
            message = f"{self._name(path)} starts, but {now or 'nothing'} is active"
            raise _NotAllowedError(message, node.span)
        if parent and path in self.outcomes:
            raise _NotAllowedError(f"{self._name(path)} has ended already", node.span)
        if not isinstance(node, Concurrence | Iterator):
            initial = node.initial or node.children[0].name
            if active != (initial,):
                first = self._name(f"{path}/{initial}")
                message = f"{self._name(f'{path}/{active[0]}')} is active first, in the script"
                raise _NotAllowedError(f"{message} {first} is", node.span)
        self.outcomes.pop(path, None)
        self._repeats[path] = 0
        self._enter(path, active)

    def _enter(self, path: str, active: tuple[str, ...]) -> None:
        """States become active: the containers among them have not started yet."""
        self._active[path] = active
        for label in active:
            below = f"{path}/{label}"
            if not isinstance(self._nodes[below], Leaf):
                self._active[below] = ()
                self.outcomes.pop(below, None)

    def _go_on(self, path: str, node: Container, active: tuple[str, ...]) -> None:
        """A container that runs, or of which nothing is known, has a transition."""
        before = self._active.get(path)
        if isinstance(node, Concurrence):
            self._active[path] = active
            return
        if isinstance(node, Iterator):
            self._repeats[path] = self._repeats.get(path, 0) + 1
            if self._repeats[path] > 1:  # the last end of the child may not lead to a repetition
                self._cover(f"{path}/{active[0]}", "loop", f"{path}/{active[0]}")
        elif before is not None:
            self._leave(path, before[0], f"{path}/{active[0]}")
        self._enter(path, active[:1])

    def _end(self, path: str, node: Container, outcome: str) -> None:
        before = self._active.get(path)
        stopped = {PREEMPTED} if ends_preempted(node) else set()
        target = f"{path}:{outcome}"
        if outcome not in {*outcome_names(node), *stopped}:
            message = (
                f"{self._name(path)} ends with {quote(outcome)}, which is none of its outcomes"
            )
            raise _NotAllowedError(message, node.span)
        if before == () and path in self.outcomes:
            raise _NotAllowedError(f"{self._name(path)} has ended already", node.span)
        if isinstance(node, Concurrence):
            self._cover(path, "rule", target)
        elif isinstance(node, Iterator):
            self._cover(f"{path}/{node.children[0].name}", "exhausted", target)
            self._cover(f"{path}/{node.children[0].name}", "break", target)
        elif before and outcome != node.catches:
            self._leave(path, before[0], target)
        self._active[path] = ()
        self.outcomes[path] = outcome

    def _leave(self, path: str, label: str, target: str) -> None:
        """A state of a StateMachine or Sequence has ended, and a transition leads to a target."""
        left, around = f"{path}/{label}", self._nodes[path]
        child = self._nodes[left]
        edges = self._edges(path, around, child)
        ended = self.outcomes.get(left)
        possible = {ended} if ended is not None else set(edges)
        found = [edge for edge in edges if edge in possible and edges[edge] == target]
        if self._active.get(left) and child.catches not in found:
            message = f"{self._name(left)} is left before its end"
            raise _NotAllowedError(message, child.span)
        if not found:
            reached = self._view.traced_state(target)
            what = quote(ended) if ended is not None else "no outcome"
            verb = "does not lead" if ended is not None else "leads"
            message = f"{what} of {self._name(left)} {verb} to {quote(reached)}"
            raise _NotAllowedError(message, child.span)
        if len(found) == 1:
            self._cover(left, "transition", target)

    def _edges(self, path: str, around: Node, child: Node) -> dict[str, str]:
        """The targets of a child by its outcomes, as traces write them."""
        assert isinstance(around, nodes.StateMachine | nodes.Sequence)
        names = frozenset(child.name for child in around.children)
        own = possible_leaf_outcomes(child) if isinstance(child, Leaf) else outcome_names(child)
        return {
            edge.outcome: f"{path}{'/' if leads_to_child(edge, names) else ':'}{edge.target}"
            for edge in child.transitions
            if edge.outcome in own
        }

    def _cover(self, path: str, kind: str, target: str) -> None:
        """Cover a coverage item, if only one fits."""
        fit = self._items.get((path, kind, target), ())
        if len(fit) == 1:
            self._taken.covered.update(fit)
