"""The events of a run from the statuses that its node publishes (docs/ros.md, Live status).

A status has the active states of one container. Statuses as JSON also have the outcomes of the
states that have ended, and the values of keys; those of smach_msgs have neither. An outcome that is
not in a status is that of the only edge of the script that fits, else the event has none.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

from smachac.ir import graph
from smachac.ir.nodes import Concurrence, Iterator, Leaf, Machine, Node
from smachac.ir.script_paths import script_paths
from smachac.ir.secret_keys import SecretKeys, secret_keys
from smachac.ir.traversal import outputs_to, walk
from smachac.runtime.tracing.writer import SECRET, Event, with_shown_paths
from smachac.verify.status_conformance import NO_STATE, status_of


class Report(NamedTuple):
    """A status: its time (s), the full path of the container and its active states.

    `outcome` is that of a container that has ended. `repeated`: no change of the container has
    caused the status. `ended` are the outcomes of states that have ended, None if the status has
    none of them; `values` are those of keys.
    """

    stamp: float
    path: str
    active: tuple[str, ...]
    outcome: str | None = None
    repeated: bool = False
    ended: Mapping[str, str] | None = None
    values: Mapping[str, object] = {}


def report_of(fields: Mapping[str, Any]) -> Report | None:
    """The status in the fields of a message with its `stamp`; None if they are not those of one."""
    try:
        stamp = float(fields["stamp"])
        status = status_of(fields, stamp)
        active = tuple(map(str, fields["active_states"]))
        ended: Mapping[str, str] | None = fields.get("ended")
        path = str(fields["path"]).strip("/")
        return Report(
            stamp=stamp,
            path=path,
            active=tuple(text for text in active if text != NO_STATE),
            outcome=None if status is None else status.outcome,
            repeated=status is None,
            ended=None if ended is None else {label: text for label, text in ended.items() if text},
            values=dict(fields.get("userdata", ())),
        )
    except (KeyError, TypeError, ValueError, AttributeError):
        return None


class _Held(NamedTuple):
    """The start of the child of an iterator, after the `transitions` of its last end. It is held
    until the next status: an iterator reports its start, and each end of its child, before it looks
    for an item."""

    transitions: list[Event]
    first: bool


class StatusEvents:
    """Makes events of statuses. Paths are those that the script of the machine shows.

    It keeps the active states of each container that runs, and follows what arrives: where a status
    is missing, states are entered and left without a transition. A repeated status counts only if
    nothing is known of its container, or if it is the second one that differs: the first one may
    have been made before a change that is known already.
    """

    def __init__(self) -> None:
        self._machine: Machine | None = None
        self._nodes: dict[str, Node] = {}
        self._shown: Mapping[str, str] = {}
        self._secret: SecretKeys = {}
        self._outcomes: dict[tuple[str, str, str], list[str]] = {}
        self._known: set[str] = set()
        self._active: dict[str, tuple[str, ...]] = {}
        self._ended: dict[str, str] = {}
        self._differing: dict[str, tuple[str, ...]] = {}
        self._values: dict[str, dict[str, object]] = {}
        self._held: dict[str, _Held] = {}
        self._events: list[Event] = []
        self._began = self._t = 0.0
        self._number = 0

    def use(self, machine: Machine) -> None:
        """Take the machine of the script as it is now."""
        if machine is self._machine:
            return
        self._machine = machine
        self._nodes = dict(walk(machine.root))
        self._shown = script_paths(machine.root)
        self._secret = secret_keys(machine)
        self._outcomes = {}
        for path, node in self._nodes.items():
            for edge in () if isinstance(node, Leaf) else graph.edges(node):
                target = edge.target if isinstance(edge.target, str) else f":{edge.target[1]}"
                key = path, str(edge.source), target
                self._outcomes.setdefault(key, []).append(edge.outcome)

    def events(self, reports: Iterable[Report]) -> Sequence[Event]:
        """The events of the next statuses, which are taken in the order of their time."""
        self._events = []
        waiting = dict(self._held)
        for report in sorted(reports, key=lambda report: report.stamp):
            self._accept(report)
        for path, held in waiting.items():
            if self._held.get(path) is held:
                self._release(path)
        numbered = [{"seq": self._number + index, **event}
                    for index, event in enumerate(self._events, 1)]  # fmt: skip
        self._number += len(numbered)
        return numbered

    def _accept(self, report: Report) -> None:
        path = report.path
        parent, _, label = path.rpartition("/")
        if parent in self._held:
            self._release(parent)
        if parent and label not in self._active.get(parent, ()):
            return  # it does not run, or not any more
        if report.repeated and not self._is_news(report):
            return
        self._known.add(path)
        self._differing.pop(path, None)
        self._t = report.stamp - self._began
        if path not in self._active:
            if report.active and report.outcome is None:
                if path in self._ended:  # the transition back to it did not arrive
                    self._enter(path)
                self._start(report)
            return
        self._write(report)
        if report.outcome is not None or (report.repeated and not report.active):
            self._end(report)
        else:
            self._go_on(report)

    def _is_news(self, report: Report) -> bool:
        """Whether a repeated status counts."""
        path, active = report.path, report.active
        if path not in self._known:
            return True
        if active == self._active.get(path, ()):
            self._differing.pop(path, None)
            return False
        is_second = self._differing.get(path) == active
        self._differing[path] = active
        return is_second

    def _start(self, report: Report) -> None:
        path = report.path
        if "/" not in path:
            for known in self._active, self._ended, self._values, self._held:
                known.clear()
            self._began, self._t = report.stamp, 0.0
            self._emit("start", path)
        self._write(report)
        self._active[path] = report.active
        if isinstance(self._nodes.get(path), Iterator):
            self._held[path] = _Held([], first=True)
            return
        for label in report.active:
            self._enter(f"{path}/{label}")

    def _go_on(self, report: Report) -> None:
        """The container has a transition, or a branch of it has started or ended."""
        path, before, active = report.path, self._active[report.path], report.active
        node = self._nodes.get(path)
        if isinstance(node, Concurrence) or len(before) != 1 or len(active) != 1:
            for label in before:
                if label not in active:
                    self._leave(report, label, "")
            self._active[path] = active
            for label in active:
                if label not in before:
                    self._enter(f"{path}/{label}")
            return
        (label,) = active
        if active == before and (report.repeated or (path, label, label) not in self._outcomes):
            return
        if path in self._held:
            self._release(path)
        transitions = self._leave(report, before[0], label)
        self._active[path] = active
        if isinstance(node, Iterator):
            self._held[path] = _Held(transitions, first=False)
            return
        self._events += transitions
        self._enter(f"{path}/{label}")

    def _release(self, path: str) -> None:
        """The child of an iterator has started."""
        self._events += self._held.pop(path).transitions
        for label in self._active.get(path, ()):
            self._enter(f"{path}/{label}")

    def _end(self, report: Report) -> None:
        path, outcome = report.path, report.outcome
        target = "" if outcome is None else f":{outcome}"
        held = self._held.get(path)
        if held is not None and self._ran_again(report, target, first=held.first):
            self._release(path)
        held = self._held.pop(path, None)
        for label in self._active[path] if held is None else ():
            self._events += self._leave(report, label, target)
        for transition in held.transitions if held is not None and target else ():
            self._events.append({**transition, "to": self._place(path) + target})
        del self._active[path]
        if "/" in path:
            self._exit(path, outcome)
        else:
            self._emit("finish", path, **({} if outcome is None else {"outcome": outcome}))

    def _ran_again(self, report: Report, target: str, *, first: bool) -> bool:
        """Whether the child of an iterator that has ended has run since the last status."""
        path, (label, *_) = report.path, self._active[report.path]
        loops = set(self._outcomes.get((path, label, label), ()))
        if report.ended is not None:
            last = report.ended.get(label)
            return last is not None and (first or last not in loops)
        fitting = set(self._outcomes.get((path, label, target), ()))
        return first or (bool(fitting) and not fitting & loops)

    def _enter(self, path: str) -> None:
        self._ended.pop(path, None)
        self._emit("enter", path)

    def _exit(self, path: str, outcome: str | None) -> None:
        for label in self._active.pop(path, ()):  # their ends did not arrive
            if f"{path}/{label}" not in self._ended:
                self._exit(f"{path}/{label}", None)
        self._held.pop(path, None)
        self._ended[path] = outcome or ""
        self._emit("exit", path, **({} if outcome is None else {"outcome": outcome}))

    def _leave(self, report: Report, label: str, target: str) -> list[Event]:
        """A state has ended. Its transition to the target, a label or `:outcome`, where it is
        certain."""
        around, path = report.path, f"{report.path}/{label}"
        fitting = self._outcomes.get((around, label, target), [])
        outcome = (report.ended or {}).get(label) or self._ended.get(path)
        if not outcome and len(fitting) == 1:
            (outcome,) = fitting
        if path not in self._ended:
            self._exit(path, outcome or None)
        if outcome not in fitting or isinstance(self._nodes.get(around), Concurrence):
            return []
        to = f"{around}{target}" if target.startswith(":") else f"{around}/{target}"
        return [self._event("transition", path, outcome=outcome, to=to)]

    def _write(self, report: Report) -> None:
        """The keys of a container that have changed since its last status: as written by the state
        that has ended, else by the container itself."""
        before = self._values.setdefault(report.path, {})
        for key, value in report.values.items():
            if key not in before or before[key] != value:
                before[key] = value
                path, name = self._writer(report, key)
                hidden = key in self._secret.get(report.path, ())
                self._emit("write", path, key=name, value=SECRET if hidden else value)

    def _writer(self, report: Report, key: str) -> tuple[str, str]:
        for label in self._active.get(report.path, ()):
            path = f"{report.path}/{label}"
            if label in (report.ended or ()) and (node := self._nodes.get(path)) is not None:
                for output in outputs_to(node, key):
                    return path, output.name
        return report.path, key

    def _place(self, path: str) -> str:
        return self._shown.get(path, path)

    def _event(self, event: str, path: str, **more: object) -> Event:
        shown = with_shown_paths({"event": event, "path": path, **more}, self._shown)
        return {**shown, "t": round(self._t, 6)}

    def _emit(self, event: str, path: str, **more: object) -> None:
        self._events.append(self._event(event, path, **more))
