"""The plan of an SCXML document: identifiers of states and data, and what all states have: the ways
on after an outcome, the final state after an exception, the content at the entry."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Literal

from smachac.analysis.type_inference import Types, infer
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Span, assert_never
from smachac.ir import nodes
from smachac.ir.nodes import Concurrence, Container, Leaf, Machine, Node, StateMachine, Transition
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.secret_keys import secret_keys
from smachac.ir.traversal import (
    enclosing,
    outcome_names,
    remapping,
    walk,
)
from smachac.ir.types import ANY
from smachac.records import dataclass
from smachac.targets.errors import unsupported_by_target
from smachac.targets.scxml.document import (
    EVENTS,
    Comment,
    Element,
    Identifiers,
    element,
    script,
    taken_data,
)
from smachac.targets.scxml.expressions import Reads, js_member, js_object, js_string

Content = list[Element | Comment]

Extra = Literal["branch", "failed", "next"]
"""The region of a branch; the final state after an exception that no state catches; the first state
of an iterator."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Way:
    """A way on after an outcome of a state: the state of the document that follows, and the guard,
    empty if there is none. `to` is the target in traces; empty in a concurrence, whose branches
    have no transitions."""

    target: str
    to: str = ""
    guard: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Scope:
    """A container: its state, the name of its userdata, and its states by name."""

    path: str
    node: Container
    id: str
    data: str
    children: Mapping[str, Node]


class Plan:
    """A machine with the identifiers of its states and data, and the report of what SCXML cannot
    express of it. `traced`: the document logs each event of a trace."""

    def __init__(self, machine: Machine, report: Report, *, traced: bool) -> None:
        self.machine = machine
        self.report = report
        self.traced = traced
        self.types: Types = infer(machine)
        self.around = enclosing(machine.root)
        self.secret = secret_keys(machine) if traced else {}
        self._states = Identifiers([FAULT])
        data = Identifiers(taken_data(), joiner="_")
        self.ids: dict[str, str] = {}
        self.scopes: dict[str, Scope] = {}
        self._edges: dict[str, dict[str, Transition]] = {}
        self._finals: dict[str, dict[str, str]] = {}
        self._extras: dict[tuple[str, Extra], str] = {}
        for path, node in walk(machine.root):
            around = path.rpartition("/")[0] if path not in self.around else self.around[path][0]
            self._edges[path] = {edge.outcome: edge for edge in node.transitions}
            outer = self.ids.get(around, "")
            self.ids[path] = self._states.new(node.name, outer, avoided=EVENTS)
            if not isinstance(node, Leaf):
                name = data.new(node.name, self.scopes[around].data if outer else "")
                children = {child.name: child for child in node.children}
                self.scopes[path] = Scope(
                    path=path, node=node, id=self.ids[path], data=name, children=children
                )

        for outcome in outcome_names(machine.root):
            self.final(machine.root.name, outcome)

    def refuse(self, span: Span, message: str, help: str | None = None, *names: str) -> None:
        self.report.append(unsupported_by_target(span, "SCXML", message, help, names))

    def edge(self, path: str, outcome: str) -> Transition | None:
        """The transition of a state of a state machine for an outcome."""
        return self._edges[path].get(outcome)

    def final(self, path: str, outcome: str) -> str:
        """The final state of a container, or of the region of a branch, for an outcome."""
        found = self._finals.setdefault(path, {})
        if outcome not in found:
            name = outcome if path == self.machine.root.name else f"{self.ids[path]}-{outcome}"
            found[outcome] = self._states.new(name)
        return found[outcome]

    def finals(self, path: str) -> dict[str, str]:
        """The final states that were named so far for a container or branch, by outcome."""
        return dict(self._finals.get(path, {}))

    def extra(self, path: str, what: Extra) -> str:
        """A state that the document has beside those of the machine, for one of these."""
        if (path, what) not in self._extras:
            inner = f"{self.ids[path]}-{what}"
            is_fault = path == self.machine.root.name
            self._extras[path, what] = FAULT if is_fault else self._states.new(inner)
        return self._extras[path, what]

    def failed(self, path: str) -> str | None:
        """The final state after an exception that nothing catches, if one was named so far."""
        return self._extras.get((path, "failed"))

    def log(self, event: str, path: str, **fields: str) -> Element | None:
        """A trace event; the fields are expressions."""
        if not self.traced:
            return None
        named = {"event": js_string(event), "path": js_string(path), **fields}
        return element("log", label="trace", expr=f"JSON.stringify({js_object(named.items())})")

    def logged(self, path: str, outcome: str, way: Way) -> Content:
        """The trace events of the exit of a leaf or concurrence and of its transition."""
        return present(
            self.log("exit", path, outcome=js_string(outcome)), *self.moved(path, outcome, way)
        )

    def moved(self, path: str, outcome: str, way: Way) -> Content:
        if not way.to:
            return []
        moved = self.log("transition", path, outcome=js_string(outcome), to=js_string(way.to))
        return present(moved)


FAULT = "fault"
"""The final state of a document after an exception that no state catches; no other has this
name."""


def present(*found: Element | Comment | None) -> Content:
    return [item for item in found if item is not None]


def ways(plan: Plan, path: str, outcome: str) -> list[Way]:
    """The ways on after an outcome of a state, the guarded ones first; none if there is no
    transition."""
    where, around = plan.around[path]
    match around:
        case StateMachine() | nodes.Sequence():
            return _step(plan, where, path, outcome)
        case Concurrence():
            return [Way(target=plan.final(path, outcome))]
        case nodes.Iterator():
            return _iteration(plan, where, around, path, outcome)
    return assert_never(around)


def _step(plan: Plan, where: str, path: str, outcome: str) -> list[Way]:
    edge = plan.edge(path, outcome)
    if edge is None:
        return []
    if edge.origin != "implicit" and edge.target in plan.scopes[where].children:
        target = f"{where}/{edge.target}"
        return [Way(target=plan.ids[target], to=target)]
    return [Way(target=plan.final(where, edge.target), to=f"{where}:{edge.target}")]


def _iteration(
    plan: Plan, where: str, around: nodes.Iterator, path: str, outcome: str
) -> list[Way]:
    scope, renamed = plan.scopes[where], dict(around.final_map)
    (child,) = around.children

    def end(result: str, guard: str = "") -> Way:
        return Way(target=plan.final(where, result), to=f"{where}:{result}", guard=guard)

    own = renamed.get(outcome, outcome)
    stopped = requested(scope.id)
    after_stop = PREEMPTED if around.sugar else own
    if outcome in around.loop_outcomes or (
        not around.loop_outcomes
        and outcome not in outcome_names(child)
        and not (isinstance(child, Leaf) and child.open)
    ):
        more = f"{scope.data}_at < {scope.data}_items.length"
        exhausted = renamed.get(around.exhausted_outcome, around.exhausted_outcome)
        return [
            Way(target=plan.ids[path], to=path, guard=f"!{stopped} && {more}"),
            end(exhausted, f"!{stopped}"),
            end(after_stop),
        ]
    return [end(PREEMPTED, stopped), end(own)] if around.sugar else [end(own)]


def fault_target(plan: Plan, path: str) -> str:
    """The final state after an exception in a state machine or iterator that no state in it
    catches."""
    node = plan.scopes[path].node
    while not node.catches:
        if path not in plan.around or isinstance(plan.around[path][1], Concurrence):
            return plan.extra(path, "failed")
        path, node = plan.around[path]
    return plan.final(path, node.catches)


def faults(
    plan: Plan, path: str, node: Node, event: str, *, guard: str = "", message: str = ""
) -> Content:
    """The transitions after an exception in a leaf or concurrence. `message` is an expression."""
    error = [plan.log("error", path, message=message)] if message else []
    if node.catches:
        return [
            transition(
                event,
                way,
                *present(*error, *plan.logged(path, node.catches, way)),
                guard=guard,
            )
            for way in ways(plan, path, node.catches)
        ]
    where, around = plan.around[path]
    target = (
        plan.extra(path, "failed") if isinstance(around, Concurrence) else fault_target(plan, where)
    )
    return [transition(event, Way(target=target), *present(*error), guard=guard)]


def transition(
    event: str | None, way: Way, *content: Element | Comment, guard: str = ""
) -> Element:
    guards = [text for text in (guard, way.guard) if text]
    several = [f"({guard})" if "||" in guard else guard for guard in guards]
    cond = " && ".join(several if len(guards) > 1 else guards)
    return element("transition", *content, event=event, cond=cond or None, target=way.target)


def requested(id: str) -> str:
    return js_member("requested", id)


def entry(plan: Plan, path: str) -> Content:
    """The content at the entry of any state: requests to stop, the item of an iterator."""
    found: Content = []
    id = plan.ids[path]
    if path in plan.around:
        where, around = plan.around[path]
        outer = plan.scopes[where]
        match around:
            case StateMachine() | nodes.Sequence():
                found.append(script(f"enter({js_string(outer.id)}, {js_string(id)});"))
            case nodes.Iterator():
                at, items = f"{outer.data}_at", f"{outer.data}_items"
                item = js_member(outer.data, around.item_key)
                code = f"{item} = {items}[{at}]; {at} = {at} + 1;"
                found.append(script(f"{code} start({js_string(outer.id)}, [{js_string(id)}]);"))
    return found + present(plan.log("enter" if path in plan.around else "start", path))


def names_object(names: Mapping[str, str]) -> str:
    return js_object((key, js_string(to)) for key, to in names.items())


def keys_outside(plan: Plan, path: str, node: Node) -> Callable[[str], str]:
    """The name of a key of a state in its container: the child of an iterator has no remapping."""
    around = plan.around[path][1]
    names = {} if isinstance(around, nodes.Iterator) else remapping(node)
    return lambda key: names.get(key, key)


def onentry(content: Content) -> Element | None:
    return element("onentry", *content) if content else None


def reads_of(plan: Plan, scope: Scope) -> Reads:
    """What code reads that may read every key of a container."""
    known = {key: js_member(scope.data, key) for key in keys_of(plan, scope)}
    return Reads(
        keys={
            key: (text, plan.types.keys.get((scope.path, key), ANY)) for key, text in known.items()
        },
        other=lambda key: js_member(scope.data, key),
    )


def keys_of(plan: Plan, scope: Scope) -> list[str]:
    """The keys of a container of which something is known."""
    node = scope.node
    found = [preset.key for preset in node.userdata]
    found += [key.name for key in (*node.inputs, *node.outputs)]
    if isinstance(node, nodes.Iterator):
        found.append(node.item_key)
    for child in node.children:
        names = keys_outside(plan, f"{scope.path}/{child.name}", child)
        found += [names(key.name) for key in (*child.inputs, *child.outputs)]
    return list(dict.fromkeys(found))
