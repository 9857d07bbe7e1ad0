"""The states of an SCXML document.

A state machine is a compound state with a final state for each outcome, which gives the outcome as
donedata; a concurrence is a parallel state whose transitions are its rules; an iterator is a
compound state with an index. Requests to stop are in the data of the document (functions.js).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from smachac.diagnostics.source import NOWHERE, assert_never
from smachac.ir import nodes
from smachac.ir.concurrence_rules import by_priority
from smachac.ir.nodes import Concurrence, Container, Leaf, Node, OutcomeRule, StateMachine
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import outcome_names
from smachac.targets import COMMENT_WIDTH, comment_lines
from smachac.targets.scxml.document import Comment, Element, element, script
from smachac.targets.scxml.expressions import (
    UnsupportedError,
    js_function,
    js_member,
    js_object,
    js_string,
    js_value,
)
from smachac.targets.scxml.leaves import leaf
from smachac.targets.scxml.plan import (
    Content,
    Plan,
    Scope,
    Way,
    entry,
    fault_target,
    faults,
    keys_outside,
    names_object,
    onentry,
    present,
    reads_of,
    requested,
    transition,
    ways,
)

STOPS = (
    element(
        "foreach",
        element("send", target="#_internal", eventexpr="'stop.' + state"),
        array="stopped",
        item="state",
    ),
)
"""Passes a request to the states in the data `stopped`."""


def place(node: Node) -> Content:
    """The comments above a state: its place in the script, and its documentation."""
    found: Content = []
    if node.span.source is not NOWHERE.source:
        found.append(Comment(f"{node.span.source.file_name}:{node.span.line}"))
    return found + [Comment(line) for line in comment_lines(node.doc, COMMENT_WIDTH)]


def copied_in(plan: Plan, path: str, node: Container) -> Content:
    if path not in plan.around or not node.inputs:
        return []
    outer, names = plan.scopes[plan.around[path][0]].data, keys_outside(plan, path, node)
    pairs: dict[str, list[str]] = {}
    for key in node.inputs:
        pairs.setdefault(names(key.name), []).append(key.name)
    return _copies(outer, plan.scopes[path].data, [(o, k) for o, ks in pairs.items() for k in ks])


def copied_out(plan: Plan, path: str, node: Container) -> Content:
    if path not in plan.around or not node.outputs:
        return []
    outer, names = plan.scopes[plan.around[path][0]].data, keys_outside(plan, path, node)
    pairs = [(key.name, names(key.name)) for key in node.outputs]
    return _copies(plan.scopes[path].data, outer, pairs)


def _copies(source: str, target: str, pairs: Sequence[tuple[str, str]]) -> Content:
    """Copies of keys in their order: of two that are copied to one, the last one counts. A key that
    is copied to several needs a call for each."""
    found: Content = []
    left = list(pairs)
    while left:
        taken: dict[str, str] = {}
        for key, to in left:
            taken.setdefault(key, to)
        found.append(script(f"copy({source}, {target}, {names_object(taken)});"))
        left = [pair for pair in left if taken[pair[0]] != pair[1]]
    return found


def container(plan: Plan, path: str) -> Content:
    """The state of a container below the root, with its transitions."""
    node = plan.scopes[path].node
    match node:
        case StateMachine() | nodes.Sequence():
            return [*place(node), _machine(plan, path, node)]
        case Concurrence():
            return [*place(node), *_in_region(plan, path, _concurrence(plan, path, node))]
        case nodes.Iterator():
            return [*place(node), _iterator(plan, path, node)]
    return assert_never(node)


def state(plan: Plan, path: str, node: Node) -> Content:
    """A state with the comments above it."""
    if isinstance(node, Leaf):
        return [*place(node), *_in_region(plan, path, leaf(plan, path, node))]
    return container(plan, path)


def _in_region(plan: Plan, path: str, inner: Element) -> Content:
    """A branch of a concurrence in a region with final states; any other state as it is."""
    if path not in plan.around or not isinstance(plan.around[path][1], Concurrence):
        return [inner]
    where = plan.around[path][0]
    node = plan.scopes[where].children[path[len(where) + 1 :]]
    for outcome in outcome_names(node):
        plan.final(path, outcome)
    failed = plan.failed(path)
    ids = [*plan.finals(path).values(), *([failed] if failed else [])]
    finals = [element("final", id=id) for id in ids]
    region = plan.extra(path, "branch")
    return [element("state", inner, *finals, id=region, initial=plan.ids[path])]


def _inside(plan: Plan, path: str, node: Container) -> Content:
    """The states in a container."""
    return [item for one in node.children for item in state(plan, f"{path}/{one.name}", one)]


def _machine(plan: Plan, path: str, node: StateMachine | nodes.Sequence) -> Element:
    initial = f"{path}/{node.initial or node.children[0].name}"
    inside = [
        item for child in node.children for item in state(plan, f"{path}/{child.name}", child)
    ]
    leave: Content = [script(f"leave({js_string(plan.ids[path])});")]
    return element(
        "state",
        onentry([*entry(plan, path), *copied_in(plan, path, node)]),
        *inside,
        *_finals(plan, path, node, leave),
        *_after(plan, path, node),
        id=plan.ids[path],
        initial=plan.ids[initial],
    )


def _finals(plan: Plan, path: str, node: Container, ending: Content) -> Iterator[Element]:
    """The final states of a container, which give its outcome as donedata."""
    for outcome in outcome_names(node):
        plan.final(path, outcome)
    for outcome, id in plan.finals(path).items():
        content: Content = []
        if outcome != node.catches:
            content = [*ending, *copied_out(plan, path, node)]
        content += present(plan.log("exit", path, outcome=js_string(outcome)))
        data = element("donedata", element("content", expr=js_string(outcome)))
        yield element("final", onentry(content), data, id=id)
    if failed := plan.failed(path):
        yield element("final", id=failed)


def _after(plan: Plan, path: str, node: Container) -> Iterator[Element]:
    """The transitions after a container has ended; a branch of a concurrence has none."""
    where, around = plan.around[path]
    if isinstance(around, Concurrence):
        return
    event = f"done.state.{plan.ids[path]}"
    for outcome in plan.finals(path):
        guard = f"_event.data === {js_string(outcome)}"
        found = ways(plan, path, outcome)
        for way in found:
            yield transition(event, way, *plan.moved(path, outcome, way), guard=guard)
        if not found:  # an outcome that the container does not declare
            error = plan.log("error", path, message=js_string("undeclared outcome"))
            target = Way(target=fault_target(plan, where))
            yield transition(event, target, *present(error), guard=guard)


def _concurrence(plan: Plan, path: str, node: Concurrence) -> Element:
    id, children = plan.ids[path], {f"{path}/{child.name}": child for child in node.children}
    names = ", ".join(js_string(plan.ids[child]) for child in children)
    start = script(f"start({js_string(id)}, [{names}]);")
    regions = [item for where, child in children.items() for item in state(plan, where, child)]
    ends = [_end(plan, path, node, where, child) for where, child in children.items()]
    return element(
        "parallel",
        onentry([*entry(plan, path), *copied_in(plan, path, node), start]),
        *regions,
        *ends,
        *_joined(plan, path, node),
        id=id,
    )


def _end(plan: Plan, path: str, node: Concurrence, where: str, child: Node) -> Element:
    """The end of a branch: under `join: any`, if a rule holds under `join: rule`, and after an
    exception, the others get a request."""
    wrapped = isinstance(child, Leaf | Concurrence)
    region = plan.extra(where, "branch") if wrapped else plan.ids[where]
    failed = plan.failed(where)
    tests = [f"In({js_string(failed)})"] if failed else []
    if node.join == "rule":
        tests += [f"({_guard(plan, path, rule)})" for rule in node.rules]
    stop = "true" if node.join == "any" else " || ".join(tests) or "false"
    given = f"{js_string(plan.ids[path])}, {js_string(plan.ids[where])}, {stop}"
    if stop == "false":
        return element("transition", script(f"end({given});"), event=f"done.state.{region}")
    ended = element("assign", location="stopped", expr=f"end({given})")
    return element("transition", ended, *STOPS, event=f"done.state.{region}")


def _joined(plan: Plan, path: str, node: Concurrence) -> Iterator[Element]:
    """The transitions of a concurrence: after an exception, after a request to a time limit, the
    rules from more to fewer conditions, the default outcome."""
    id = plan.ids[path]
    event = f"done.state.{id}"
    join = script(f"join({js_string(id)});")
    failed = [f"In({js_string(final)})" for child in node.children
              if (final := plan.failed(f"{path}/{child.name}"))]  # fmt: skip
    if failed:
        for fault in faults(plan, path, node, event, guard=" || ".join(failed)):
            assert isinstance(fault, Element)
            yield Element(fault.tag, fault.attributes, (join, *fault.content))
    if node.sugar:
        served = script(f"delete {requested(id)};")
        yield from _outcome(plan, path, node, PREEMPTED, requested(id), [join, served])
    for rule in by_priority(node):
        guard = _guard(plan, path, rule)
        yield from _outcome(plan, path, node, rule.outcome, guard, [join])
    if node.default_outcome:  # without one, the rules cover every combination
        yield from _outcome(plan, path, node, node.default_outcome, "", [join])


def _guard(plan: Plan, path: str, rule: OutcomeRule) -> str:
    """The condition that a rule holds: final states of branches."""
    tests = [
        f"In({js_string(plan.final(f'{path}/{one.child}', one.outcome))})" for one in rule.when
    ]
    return " && ".join(dict.fromkeys(tests))


def _outcome(
    plan: Plan, path: str, node: Concurrence, outcome: str, guard: str, content: Content
) -> Iterator[Element]:
    for way in ways(plan, path, outcome):
        leave = [*content, *copied_out(plan, path, node), *plan.logged(path, outcome, way)]
        yield transition(f"done.state.{plan.ids[path]}", way, *leave, guard=guard)


def _iterator(plan: Plan, path: str, node: nodes.Iterator) -> Element:
    scope = plan.scopes[path]
    (child,) = node.children
    where, first = f"{path}/{child.name}", plan.extra(path, "next")
    items, at = f"{scope.data}_items", f"{scope.data}_at"
    inside = state(plan, where, child)
    exhausted = dict(node.final_map).get(node.exhausted_outcome, node.exhausted_outcome)
    empty = [Way(target=plan.final(path, exhausted))]
    if node.sugar:
        stopped = Way(target=plan.final(path, PREEMPTED), guard=requested(scope.id))
        empty.insert(0, stopped)
    there = f"{items} !== null"
    error = plan.log("error", path, message="_event.data.reason")
    choose = element(
        "state",
        transition(None, Way(target=plan.ids[where], guard=f"{there} && {items}.length > 0")),
        *(transition(None, way, guard=there) for way in empty),
        transition(
            "error.execution",
            Way(target=fault_target(plan, path), guard=f"{items} === null"),
            *present(error),
        ),
        id=first,
    )
    answers = "true" if node.sugar else f"{at} > 0"
    return element(
        "state",
        onentry(
            [
                *entry(plan, path),
                *copied_in(plan, path, node),
                element("assign", location=at, expr="0"),
                element("assign", location=items, expr="null"),
                element("assign", location=items, expr=_items(plan, scope, node)),
            ]
        ),
        choose,
        *inside,
        *_finals(plan, path, node, [script(f"finish({js_string(scope.id)}, {answers});")]),
        *_after(plan, path, node),
        id=scope.id,
        initial=first,
    )


def _items(plan: Plan, scope: Scope, node: nodes.Iterator) -> str:
    """The expression for the items of an iterator."""
    if node.items_key:
        return f"items({js_member(scope.data, node.items_key)})"
    if node.items is None:
        return "items(null)"
    data = node.items.data
    try:
        if not isinstance(data, nodes.Expression):
            value = js_value(data)
            return value if isinstance(data, tuple) else f"items({value})"
        return f"items({js_function(data, reads_of(plan, scope)).text})"
    except UnsupportedError as error:
        plan.refuse(node.items.span, str(error), error.help)
        return "null"


def root(plan: Plan) -> list[Element | Comment]:
    """The outermost machine and its final states."""
    node, path = plan.machine.root, plan.machine.root.name
    scope = plan.scopes[path]
    initial = f"{path}/{node.initial or node.children[0].name}"
    inside = [
        item for child in node.children for item in state(plan, f"{path}/{child.name}", child)
    ]
    finals = [_root_final(plan, outcome, id) for outcome, id in plan.finals(path).items()]
    if failed := plan.failed(path):
        finals.append(element("final", id=failed))
    stores = [f"{scope.data} = userdata({scope.data});" for scope in plan.scopes.values()]
    take = f"Object.assign({scope.data}, inputs);"
    stop = f"if (preempted) request({js_string(scope.id)});"
    assignment = element("assign", location="stopped", expr=f"request({js_string(scope.id)})")
    machine = element(
        "state",
        element("onentry", script(" ".join([*stores, take, stop])), *entry(plan, path)),
        element("transition", assignment, *STOPS, event="preempt"),
        *inside,
        id=scope.id,
        initial=plan.ids[initial],
    )
    return [*place(node), machine, *finals]


def _root_final(plan: Plan, outcome: str, id: str) -> Element:
    """A final state of the document. Its donedata are the outcome and the outputs."""
    node = plan.machine.root
    scope = plan.scopes[node.name]
    outputs = names_object({key.name: key.name for key in node.outputs})
    view = f"view({scope.data}, {outputs})"
    finish = plan.log("finish", scope.path, outcome=js_string(outcome))
    return element(
        "final",
        onentry([script(f"leave({js_string(scope.id)});"), *present(finish)]),
        element(
            "donedata",
            element("param", name="outcome", expr=js_string(outcome)),
            element("param", name="outputs", expr=view) if node.outputs else None,
        ),
        id=id,
    )


def datamodel(plan: Plan, used: frozenset[str]) -> Element:
    """The data of the document: userdata, and what requests to stop need, of the names in
    `used`."""
    found = []
    for scope in plan.scopes.values():
        entries = []
        for preset in scope.node.userdata:
            try:
                entries.append((preset.key, js_value(preset.value.data)))
            except UnsupportedError as error:
                plan.refuse(preset.span, str(error), error.help, preset.key)
        found.append(element("data", id=scope.data, expr=f"({js_object(dict(entries).items())})"))
        if isinstance(scope.node, nodes.Iterator):
            found.append(element("data", id=f"{scope.data}_items", expr="null"))
            found.append(element("data", id=f"{scope.data}_at", expr="0"))
    inside = {
        scope.id: [plan.ids[f"{scope.path}/{child.name}"] for child in scope.node.children]
        for scope in plan.scopes.values()
    }
    names = ((id, f"[{', '.join(map(js_string, states))}]") for id, states in inside.items())
    tables = {
        "inputs": "({})",
        "preempted": "false",
        "previous": "({})",
        "requested": "({})",
        "running": "({})",
        "stopped": "[]",
        "state": "null",
        "inside": f"({js_object(names)})",
        "ready": "({})",
        "stopping": "({})",
    }
    found += [element("data", id=name, expr=expr) for name, expr in tables.items() if name in used]
    return element("datamodel", *found)
