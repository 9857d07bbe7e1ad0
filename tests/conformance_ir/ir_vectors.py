"""Recorded SMACH machines as state graphs, and their runs in the interpreter."""

from __future__ import annotations

import copy
from collections.abc import Iterator as Iter
from typing import Any, cast

from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.result import Event, InterpreterResult
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Data,
    Iterator,
    Key,
    Leaf,
    Machine,
    Node,
    Origin,
    Outcome,
    OutcomeRule,
    Preset,
    Remap,
    Sequence,
    StateMachine,
    Struct,
    Transition,
    Value,
)
from smachac.ir.traversal import outcome_names

Json = Any


def machine_of(case: Json) -> Machine:
    """The graph of a case. The root has no name, so that paths are those of the case.

    The interpreter does not mind a root that is another container.
    """
    return Machine(root=cast(StateMachine, _node(case["machine"], {"label": ""}, {})))


def data_of(value: Json) -> Data:
    if isinstance(value, list):
        return tuple(data_of(item) for item in value)
    if isinstance(value, dict):
        return Struct(entries=tuple((key, data_of(item)) for key, item in value.items()))
    return cast(Data, value)


def _value(value: Json) -> Value:
    return Value(data=data_of(value), span=NOWHERE)


def _node(node: Json, spec: Json, targets: dict[str, tuple[str, Origin]]) -> Node:
    """A node; `spec` is its entry in the container, `targets` where its outcomes lead."""
    both = node.get("io", [])
    common: dict[str, Any] = {
        "name": spec["label"],
        "span": NOWHERE,
        "outcomes": tuple(Outcome(name=name, span=NOWHERE) for name in node["outcomes"]),
        "inputs": tuple(Key(name=key, span=NOWHERE) for key in [*node.get("in", []), *both]),
        "outputs": tuple(Key(name=key, span=NOWHERE) for key in [*node.get("out", []), *both]),
        "remaps": tuple(
            Remap(key=key, to=to, span=NOWHERE) for key, to in spec.get("remapping", {}).items()
        ),
        "transitions": tuple(
            Transition(outcome=outcome, target=target, origin=origin, span=NOWHERE)
            for outcome, (target, origin) in targets.items()
        ),
    }
    if node["type"] == "leaf":
        return Leaf(type="Vector", **common)
    held = {**node.get("preset", {}), **node.get("initial_ud", {})}
    common["userdata"] = tuple(
        Preset(key=key, value=_value(value), span=NOWHERE) for key, value in held.items()
    )
    match node["type"]:
        case "state_machine" | "sequence":
            return _machine(node, common)
        case "concurrence":
            return _concurrence(node, common)
    return _iterator(node, common)


def _machine(node: Json, common: dict[str, Any]) -> Node:
    states = node["states"]
    children = tuple(
        _node(spec["node"], spec, targets)
        for spec, targets in zip(states, _targets(node), strict=True)
    )
    initial = [*node.get("initial", []), *(spec["label"] for spec in states), ""][0]
    if node["type"] == "state_machine":
        return StateMachine(type="StateMachine", children=children, initial=initial, **common)
    return Sequence(
        type="Sequence",
        children=children,
        initial=initial,
        connector_outcome=node["connector"],
        **common,
    )


def _targets(node: Json) -> list[dict[str, tuple[str, Origin]]]:
    """Where the outcomes of each state of a machine lead, connectors included (A1, A2, Q1-Q5)."""
    states = node["states"]
    targets: list[dict[str, tuple[str, Origin]]] = [
        {
            outcome: (target or outcome, "written" if target else "implicit")
            for outcome, target in {
                **dict.fromkeys(spec["node"]["outcomes"]),
                **spec.get("transitions", {}),
            }.items()
        }
        for spec in states
    ]
    last: int | None = None
    for at, spec in enumerate(states):
        label = spec["label"]
        if at and "auto" in states[at - 1]:
            targets[at - 1].update(dict.fromkeys(states[at - 1]["auto"], (label, "written")))
        if node["type"] == "sequence" and "auto" not in spec:
            if last is not None and _links(states[last], node["connector"]):
                origin: Origin = "connector" if last == at - 1 else "written"
                targets[last][node["connector"]] = (label, origin)
            last = at
    return targets


def _links(spec: Json, connector: str) -> bool:
    """Whether a sequence links a state to the next: it can end so, and leads nowhere yet (Q2)."""
    known = connector in spec["node"]["outcomes"]
    return known and spec.get("transitions", {}).get(connector) is None


def _concurrence(node: Json, common: dict[str, Any]) -> Node:
    specs = {spec["label"]: spec for spec in node["children"]}
    default, rules = _rules(node)
    return Concurrence(
        type="Concurrence",
        sugar=node.get("sugar", ""),
        children=tuple(_node(spec["node"], spec, {}) for spec in specs.values()),
        default_outcome=default,
        join="any" if any(rule["ret"] for rule in node.get("term_cb", [])) else "all",
        rules=tuple(rules),
        **common,
    )


def _rules(node: Json) -> tuple[str, list[OutcomeRule]]:
    """The default outcome, and the rules of the map and of the outcome callback.

    The last that holds wins in SMACH (N6, N7), in the graph the one with most conditions: so each
    repeats its conditions until it has more than those before it. One without conditions always
    holds, which makes it the default.
    """
    rules: list[OutcomeRule] = []
    default, most = node["default"], 0
    for outcome, when in _given_rules(node):
        if not when:
            default, rules, most = outcome, [], 0
            continue
        times = most // len(when) + 1
        most = times * len(when)
        conditions = tuple(
            Condition(child=label, outcome=ended, span=NOWHERE) for label, ended in when.items()
        )
        rules.append(OutcomeRule(outcome=outcome, when=conditions * times, span=NOWHERE))
    return default, rules


def _given_rules(node: Json) -> list[tuple[str, dict[str, str]]]:
    """What decides on a concurrence's outcome, from what counts least to what counts most."""
    called = [
        (rule["ret"], rule.get("when", {}))
        for rule in reversed(node.get("outcome_cb", []))
        if isinstance(rule["ret"], str) and None not in rule.get("when", {}).values()
    ]
    return [*dict(node.get("map", [])).items(), *called]


def _iterator(node: Json, common: dict[str, Any]) -> Node:
    exhausted = node.get("exhausted", "exhausted")
    if exhausted not in node["outcomes"]:
        common["outcomes"] += (Outcome(name=exhausted, span=NOWHERE),)
    specs = [node["child"]] if "child" in node else []
    children = tuple(_node(spec["node"], spec, {}) for spec in specs)
    loop = tuple(node.get("loop", []))
    if node.get("break"):
        known = outcome_names(children[0])
        # Where all declared outcomes break, what the child does not declare loops (I6).
        told = [step.get("ret") for step in specs[0]["node"].get("steps", [])]
        undeclared = [name for name in told if isinstance(name, str) and name not in known]
        loop = tuple(name for name in known if name not in node["break"]) or tuple(undeclared)
    keyed = isinstance(node["it"], dict)
    return Iterator(
        type="Iterator",
        sugar=node.get("sugar", ""),
        children=children,
        items=None if keyed else _value(node["it"]),
        items_key=node["it"]["key"] if keyed else "",
        item_key=node.get("it_label", "it_data"),
        exhausted_outcome=exhausted,
        loop_outcomes=loop,
        final_map=tuple(node.get("final", {}).items()),
        **common,
    )


def leaves_of(case: Json) -> dict[str, Json]:
    """The descriptions of the leaves by path."""
    return {path: node for path, node in nodes_of(case) if node["type"] == "leaf"}


def nodes_of(case: Json) -> Iter[tuple[str, Json]]:
    """The descriptions of all nodes with their paths; that of the root is empty."""
    stack = [("", case["machine"])]
    while stack:
        path, node = stack.pop()
        yield path, node
        specs = [*node.get("states", []), *node.get("children", [])]
        specs += [node["child"]] if "child" in node else []
        stack.extend((f"{path}/{spec['label']}", spec["node"]) for spec in reversed(specs))


class ToldError(Exception):
    """What a leaf of a case raises because it is told to."""


class Replay:
    """A case on the interpreter: its leaves follow their scripts and note what they do."""

    def __init__(self, case: Json) -> None:
        self.case = case
        self.leaves = leaves_of(case)
        self.events: list[Event] = []
        self.interpreter = Interpreter(
            machine_of(case),
            self.behave,
            self.observe,
            userdata=copy.deepcopy(case.get("userdata", {})),
            max_steps=case.get("budget", 400),
        )
        if case.get("preempt_before"):
            self.interpreter.preemption.request("")

    def run(self, parent: dict[str, object] | None) -> tuple[InterpreterResult, list[Event]]:
        """One more run and its events."""
        self.events = []
        return self.interpreter.execute(parent), self.events

    def observe(self, event: Event) -> None:
        self.events.append(event)

    def note(self, event: str, path: str, *rest: Json) -> None:
        self.events.append({"event": event, "path": path, "rest": list(rest)})

    def behave(self, path: str, leaf: Leaf, visit: int, userdata: Userdata) -> str:
        node = self.leaves[path]
        keys = [] if node.get("blind") else [*node.get("in", []), *node.get("io", [])]
        inputs = {key: copy.deepcopy(userdata[key]) for key in sorted(keys) if key in userdata}
        asked = bool(self.case.get("preempt")) and userdata.preempted
        self.note("+", path, *([inputs, "P"] if asked else [inputs] if inputs else []))
        step = node["steps"][min(visit, len(node["steps"])) - 1]
        try:
            outcome = self._perform(step, userdata)
        except Exception:
            self.note("!", path)
            raise
        self.note("-", path, outcome)
        return cast(str, outcome)

    def _perform(self, step: Json, userdata: Userdata) -> Any:
        for operation in step.get("do", []):
            self._do(operation, userdata)
        if "raise" in step:
            raise ToldError(step["raise"])
        if "pre" in step and userdata.preempted:
            userdata.service_preempt()
            return step["pre"]
        result = step["ret"]
        if isinstance(result, dict):
            left, right = (_worth(one, userdata) for one in result["lt"])
            return result["then"] if left < right else result["else"]
        return result

    def _do(self, operation: Json, userdata: Userdata) -> None:
        match operation:
            case ["set", key, expression, *_]:
                userdata[key] = _worth(expression, userdata)
            case ["read", key]:
                userdata[key]
            case ["push", key, expression]:
                cast(Any, userdata[key]).append(_worth(expression, userdata))
            case ["preempt", path]:
                self.interpreter.preemption.request(path.removesuffix("/"))
            case ["service"]:
                userdata.service_preempt()
            case _:
                raise AssertionError(f"unknown operation {operation}")


def _worth(expression: Json, userdata: Userdata) -> Any:
    """What an expression of a script is worth; anything but an object is a constant."""
    match expression:
        case {"k": key}:
            return userdata[key]
        case {"get": [key, default]}:
            return userdata[key] if key in userdata else copy.deepcopy(default)
        case {"has": key}:
            return key in userdata
        case {"keys": _}:
            return userdata.keys()
        case {"add": [left, right]}:
            return _worth(left, userdata) + _worth(right, userdata)
        case {"append": [items, item]}:
            return [*_worth(items, userdata), _worth(item, userdata)]
    return copy.deepcopy(expression)
