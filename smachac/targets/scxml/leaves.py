"""Leaves: the work of a host, which `<invoke>` starts; expressions and delays of the document."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from smachac.ir import nodes
from smachac.ir.leaf import default_outcome, functions, type_text, variable, variable_of
from smachac.ir.nodes import Expression, Leaf, VariableRole
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import own_outcomes, remapping
from smachac.ir.types import ANY
from smachac.records import dataclass
from smachac.runtime.tracing.writer import SECRET
from smachac.targets.scxml.document import Comment, Element, element, script
from smachac.targets.scxml.expressions import (
    Reads,
    UnsupportedError,
    js_function,
    js_member,
    js_object,
    js_string,
    js_truth,
    js_value,
)
from smachac.targets.scxml.plan import (
    Content,
    Plan,
    Scope,
    entry,
    faults,
    names_object,
    onentry,
    reads_of,
    requested,
    transition,
    ways,
)

INVOKED = "smachac"
"""The type of `<invoke>`: the host runs a function for the state type in `src`."""


def leaf(plan: Plan, path: str, node: Leaf) -> Element:
    """The state of a leaf."""
    one = _Leaf(plan=plan, path=path, node=node, id=plan.ids[path])
    found = _BUILT_IN.get(node.built_in, _invoked)(one)
    return Element(found.tag, {"id": one.id, **found.attributes}, found.content)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Leaf:
    plan: Plan
    path: str
    node: Leaf
    id: str

    @property
    def scope(self) -> Scope:
        return self.plan.scopes[self.plan.around[self.path][0]]

    @property
    def in_iterator(self) -> bool:
        """Whether the leaf uses every key of its container, without remapping."""
        return isinstance(self.scope.node, nodes.Iterator)

    @property
    def in_concurrence(self) -> bool:
        """Whether other states run at the same time: an error can be that of another state."""
        path = self.path
        while path in self.plan.around:
            path, around = self.plan.around[path]
            if isinstance(around, nodes.Concurrence):
                return True
        return False

    @property
    def outcomes(self) -> tuple[str, ...]:
        """The outcomes that its code can return; those of an open type have a transition."""
        own = own_outcomes(self.node)
        if not self.node.open:
            return own
        edges = (edge.outcome for edge in self.node.transitions)
        return tuple(dict.fromkeys([*own, *(edge for edge in edges if edge != self.node.catches)]))

    def outer(self, key: str) -> str:
        return key if self.in_iterator else remapping(self.node)[key]

    def read(self, key: str) -> str:
        return js_member(self.scope.data, self.outer(key))

    def writes(self, key: str) -> bool:
        return self.in_iterator or any(output.name == key for output in self.node.outputs)

    def reads(self) -> Reads:
        """What functions of the leaf read."""
        if self.in_iterator:
            return reads_of(self.plan, self.scope)
        types = self.plan.types.inputs
        return Reads(
            keys={
                key.name: (self.read(key.name), types.get((self.path, key.name), ANY))
                for key in self.node.inputs
            },
            other=lambda key: f"undeclared({js_string(key)})",
        )

    def code(self, expression: Expression, make: Callable[[Expression, Reads], str]) -> str:
        """An expression of the leaf; what JavaScript cannot express is reported."""
        try:
            return make(expression, self.reads())
        except UnsupportedError as error:
            self.plan.refuse(expression.span, str(error), error.help, self.node.name)
            return "null"

    def value(self, expression: Expression) -> str:
        return self.code(expression, lambda code, reads: js_function(code, reads).text)

    def functions(self, role: VariableRole) -> Mapping[str, Expression]:
        """The functions in the variable with a role, by name; other values are reported."""
        held, found = variable_of(self.node, role), functions(self.node, role)
        data = held.value.data if held is not None else None
        if held is None or data is None:
            return {}
        whole = isinstance(data, nodes.Struct) and len(found or ()) == len(data.entries)
        if found is None or not whole:
            message = f"`{held.name}` is not a mapping of names to functions"
            self.plan.refuse(held.span, message, None, self.node.name)
        return found or {}

    def exits(self, outcome: str, event: str, *content: Element | Comment) -> Content:
        """The transitions after an outcome."""
        return [
            transition(event, way, *content, *self.plan.logged(self.path, outcome, way))
            for way in ways(self.plan, self.path, outcome)
        ]

    def written(self, key: str) -> list[Element]:
        """The trace event of a write."""
        hidden = key in self.plan.secret.get(self.path, ())
        value = js_string(SECRET) if hidden else self.read(key)
        found = self.plan.log("write", self.path, key=js_string(key), value=value)
        return [] if found is None else [found]

    def calls(self) -> list[Element]:
        """The functions of `callbacks`, whose results are written to the keys of their names."""
        found = []
        callbacks = self.functions("callbacks")
        for key in sorted(callbacks):
            value = self.value(callbacks[key])
            if self.writes(key):
                found.append(element("assign", location=self.read(key), expr=value))
                found += self.written(key)
            else:  # SMACH drops the value
                found.append(script(f"{value};"))
        return found

    def computed(self, *content: Element) -> tuple[Element | None, Content]:
        """The entry of a state of expressions, and its transitions after an error in them. In a
        concurrence every state gets the event of an error: the state notes that it has none."""
        ready = js_member("ready", self.id)
        message = "_event.data.reason"
        if not self.in_concurrence:
            found = faults(self.plan, self.path, self.node, "error.execution", message=message)
            return onentry([*entry(self.plan, self.path), *content]), found
        reset = element("assign", location=ready, expr="false")
        done = element("assign", location=ready, expr="true")
        found = faults(
            self.plan, self.path, self.node, "error.execution", guard=f"!{ready}", message=message
        )
        return onentry([*entry(self.plan, self.path), reset, *content, done]), found


def _callbacks(leaf: _Leaf) -> Element:
    outcome = default_outcome(leaf.node)
    event = f"{leaf.id}.{outcome}"
    calls = leaf.calls()
    raised = element("raise", event=event)
    if not calls:
        return element(
            "state", onentry([*entry(leaf.plan, leaf.path), raised]), *leaf.exits(outcome, event)
        )
    begin, after = leaf.computed(*calls, raised)
    return element("state", begin, *leaf.exits(outcome, event), *after)


def _conditional(leaf: _Leaf) -> Element:
    conditions = leaf.functions("conditions")
    otherwise = variable(leaf.node, "default_outcome")
    own = own_outcomes(leaf.node)
    if not isinstance(otherwise, str) or otherwise not in own:
        leaf.plan.refuse(leaf.node.span, "the state has no `default_outcome` among its outcomes")
        otherwise = own[0] if own else ""
    tests = [
        (outcome, leaf.code(conditions[outcome], js_truth))
        for outcome in own
        if outcome in conditions
    ]
    names = [*(outcome for outcome, _ in tests), otherwise]

    def choice(word: Callable[[str], str]) -> str:
        choices = [f"{test} ? {js_string(word(outcome))} : " for outcome, test in tests]
        return f"{''.join(choices)}{js_string(word(otherwise))}"

    content: list[Element] = []
    if any(key.name == "outcome" for key in leaf.node.outputs):
        content.append(element("assign", location=leaf.read("outcome"), expr=choice(str)))
        content += leaf.written("outcome")
        event = f"{js_string(leaf.id + '.')} + {leaf.read('outcome')}"
    else:
        event = choice(lambda name: f"{leaf.id}.{name}")
    begin, after = leaf.computed(*content, element("send", target="#_internal", eventexpr=event))
    exits = [
        exit_ for name in dict.fromkeys(names) for exit_ in leaf.exits(name, f"{leaf.id}.{name}")
    ]
    return element("state", begin, *exits, *(after if tests else ()))


def _sleep(leaf: _Leaf) -> Element:
    time, id = variable(leaf.node, "time"), leaf.id
    outcome = default_outcome(leaf.node)
    calls = leaf.calls()
    if isinstance(time, Expression):
        sent = {"delayexpr": f"delay({leaf.value(time)})"}
    elif isinstance(time, int | float):
        sent = {"delay": _seconds(max(0.0, time))}
    else:
        leaf.plan.refuse(leaf.node.span, "`time` is no number of seconds", None, leaf.node.name)
        sent = {}
    send = element("send", event=f"elapsed.{id}", id=id, **sent)
    able = PREEMPTED in own_outcomes(leaf.node)
    again = element("if", element("raise", event=f"stop.{id}"), cond=requested(id))
    content = [*calls, send, *([again] if able else [])]
    begin, after = leaf.computed(*content)
    if not calls and not isinstance(time, Expression):
        begin, after = onentry([*entry(leaf.plan, leaf.path), *content]), []
    served = script(f"delete {requested(id)};")
    stops = leaf.exits(PREEMPTED, f"stop.{id}", served) if able else []
    return element(
        "state",
        begin,
        *leaf.exits(outcome, f"elapsed.{id}"),
        *stops,
        *after,
        element("onexit", element("cancel", sendid=id)),
    )


def _seconds(seconds: float) -> str:
    text = f"{seconds:.6f}".rstrip("0").rstrip(".")
    return f"{text}s"


def _invoked(leaf: _Leaf) -> Element:
    node, id, data = leaf.node, leaf.id, leaf.scope.data
    has_no_interface = leaf.in_iterator or node.open
    names = dict(remapping(node)) if node.open and not leaf.in_iterator else {}
    inputs = {key.name: leaf.outer(key.name) for key in node.inputs} | names
    outputs = {key.name: leaf.outer(key.name) for key in node.outputs} | names
    more = ", true" if has_no_interface else ""
    shown = [js_string(outcome) for outcome in leaf.outcomes]
    params = {"outcomes": f"[{', '.join(shown)}]"}
    if inputs or has_no_interface:
        params["inputs"] = f"view({data}, {names_object(inputs)}{more})"
    variables = _variables(leaf)
    if variables:
        params["variables"] = f"({js_object(variables.items())})"
    params["stopped"] = f"Boolean({requested(id)})"
    received = f"receive({js_string(id)}, _event.data, {data}, {names_object(outputs)}{more})"
    invoke = element(
        "invoke",
        *(element("param", name=name, expr=expr) for name, expr in params.items()),
        element("finalize", _received(leaf, received)),
        type=INVOKED,
        src=node.type,
        id=id,
    )
    calls = leaf.calls()
    begin, after = leaf.computed(*calls) if calls else (onentry(entry(leaf.plan, leaf.path)), [])
    exits = [exit_ for name in leaf.outcomes for exit_ in leaf.exits(name, f"{id}.{name}")]
    request = element("send", target=f"#_{id}", event="stop")
    return element(
        "state",
        begin,
        invoke,
        *exits,
        *after,
        *faults(leaf.plan, leaf.path, node, f"fault.{id}", message="_event.data.message"),
        element("transition", request, event=f"stop.{id}"),
    )


def _received(leaf: _Leaf, received: str) -> Element:
    """The element that takes the answer of the host; it also logs the trace events of its writes.
    It is one element, because SCION 4.3.27 cannot load a `<finalize>` with several."""
    if not leaf.plan.traced:
        return script(f"{received};")
    value = "_event.data.outputs[key]"
    for key in sorted(leaf.plan.secret.get(leaf.path, ())):
        value = f"key === {js_string(key)} ? {js_string(SECRET)} : {value}"
    event = {"event": "'write'", "path": js_string(leaf.path), "key": "key", "value": value}
    writes = f"{received}.map(key => ({js_object(event.items())}))"
    return element("log", label="trace", expr=f"JSON.stringify({writes})")


_FUNCTIONS: frozenset[VariableRole] = frozenset(["callbacks", "conditions"])


def _variables(leaf: _Leaf) -> dict[str, str]:
    """The values of the variables of a state that the host runs."""
    found = {}
    for held in leaf.node.variables:
        if held.role in _FUNCTIONS:
            continue
        try:
            if held.role in nodes.DEFINITION_KINDS:
                found[held.name] = js_string(type_text(held))
            else:
                found[held.name] = js_value(held.value.data)
        except UnsupportedError as error:
            names = (leaf.node.name, held.name)
            leaf.plan.refuse(held.span, f"`{held.name}`: {error}", error.help, *names)
    return found


_BUILT_IN: Mapping[str, Callable[[_Leaf], Element]] = {
    "CallbacksState": _callbacks,
    "ConditionalOutcomeState": _conditional,
    "SleepState": _sleep,
}
"""The built-in state types that a document contains; a host runs all others."""
