"""The statements that build the containers of a machine on YASMIN, and what YASMIN refuses."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.concurrence_rules import by_priority
from smachac.ir.nodes import (
    Concurrence,
    Container,
    Leaf,
    Machine,
    Node,
    StateMachine,
    Transition,
)
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import containers, leads_to_child, outcome_names, remapping, walk
from smachac.targets.errors import unsupported_by_target
from smachac.targets.native import native_types
from smachac.targets.python.formatter import (
    WIDTH,
    Doc,
    Group,
    call,
    laid_out,
    mapping,
    names,
    string,
)
from smachac.targets.python.items import items, refused_items
from smachac.targets.python.structure import notes, variable_names

CLASSES = ("Concurrence", "Native", "Repeat")
"""The classes of the runtime that not every module needs."""

Arguments = list[tuple[str, Doc]]


def refused(machine: Machine) -> Iterator[Diagnostic]:
    """What YASMIN refuses: states without outcomes, containers without states, and items whose code
    needs names of the program."""
    for path, node in walk(machine.root):
        if not node.outcomes and not (isinstance(node, Leaf) and node.open):
            message = f"`{node.name}` has no outcome"
            yield unsupported_by_target(node.span, "YASMIN", message, names=(path,))
        if not isinstance(node, Leaf) and not node.children:
            message = f"`{node.name}` has no states"
            yield unsupported_by_target(node.span, "YASMIN", message, names=(path,))
    yield from refused_items(machine, "YASMIN")


def built(machine: Machine) -> list[str]:
    """The lines of the function `build`, without indentation."""
    fresh = variable_names()
    for name in ("parts", "states", "userdata"):  # the names of the function
        fresh(name, "")
    variables: dict[str, str] = {}
    lines = ["states, userdata = parts.states, parts.userdata"]
    reached = {path: _reached(node) for path, node in containers(machine.root)}
    with deep_recursion():
        native = frozenset(native_types(machine, "yasmin"))
        lines += _container(machine.root, machine.root.name, "", fresh, variables, reached, native)
    return [*lines, f"return {variables[machine.root.name]}"]


def _reached(node: Container) -> frozenset[str]:
    """The states of a container that can be entered: YASMIN refuses a machine with others."""
    if not isinstance(node, StateMachine | nodes.Sequence):
        return frozenset(child.name for child in node.children)
    children = {child.name: child for child in node.children}
    names = frozenset(children)
    found, todo = set(), [node.initial or next(iter(children), "")]
    while todo:
        name = todo.pop()
        if name not in found and name in children:
            found.add(name)
            edges = children[name].transitions
            todo += [edge.target for edge in edges if leads_to_child(edge, names)]
    return frozenset(found)


def _container(
    node: Container,
    path: str,
    around: str,
    fresh: Callable[[str, str], str],
    variables: dict[str, str],
    reached: Mapping[str, frozenset[str]],
    native: frozenset[str],
) -> Iterator[str]:
    """The statements that make a container and add its states. `around` is the path of the
    container around it, `reached` are the states that can be entered, `native` the state types
    whose classes are of YASMIN."""
    variable = variables[path] = fresh(node.name, "sm_" if around else "")
    states = frozenset(child.name for child in node.children)
    made = laid_out(_construct(node, path), WIDTH - 4, len(variable) + 3)
    yield from f"{variable} = {made}".split("\n")
    for child in node.children:
        where = f"{path}/{child.name}"
        yield ""
        yield from notes(child, 1).split("\n")
        if child.name not in reached[path]:
            yield f"# No transition leads to {child.name!r}; YASMIN refuses such a state."
            continue
        if isinstance(child, Leaf):
            caught = [("catches=", string(child.catches))] if child.catches else []
            function = "Native" if child.type in native else "Skill"
            own = keys(child) if child.type in native else []
            state: Doc = call(function, [("", f"states[{string(where)}]"), *own, *caught])
        else:
            yield from _container(child, where, path, fresh, variables, reached, native)
            state = variables[where]
        yield from _added(node, variable, child, state, states).split("\n")
    if isinstance(node, StateMachine | nodes.Sequence) and node.initial:
        first = next(child.name for child in node.children if child.name in reached[path])
        if node.initial != first:
            yield f"{variable}.set_start_state({string(_state_name(node, node.initial))})"


def keys(node: Node) -> Iterator[tuple[str, Doc]]:
    """The arguments for the declared keys."""
    for word, some in (("inputs=", node.inputs), ("outputs=", node.outputs)):
        if some:
            yield word, names(key.name for key in some)


def _construct(node: Container, path: str) -> Group:
    """The call that makes a container."""
    own = [*outcome_names(node)]
    if node.catches and isinstance(node, StateMachine | nodes.Sequence):
        own.remove(node.catches)
    arguments: Arguments = [("", string(path)), ("outcomes=", names(own))]
    match node:
        case StateMachine() | nodes.Sequence():
            function = "Machine"
        case Concurrence():
            function = "Concurrence"
            arguments += _rules(node)
        case nodes.Iterator():
            function = "Repeat"
            arguments += _repeat(node)
        case _:
            assert_never(node)
    arguments += keys(node)
    if node.userdata:
        arguments.append(("userdata=", f"userdata[{string(path)}]"))
    if node.catches:
        arguments.append(("catches=", string(node.catches)))
    return call(function, arguments)


def _rules(node: Concurrence) -> Iterator[tuple[str, Doc]]:
    rules = [
        Group("(", (
            ("", string(rule.outcome)),
            ("", mapping((one.child, string(one.outcome)) for one in rule.when)),
        ), ")")
        for rule in by_priority(node)
    ]  # fmt: skip
    if rules:
        yield "rules=", Group("[", tuple(("", rule) for rule in rules), "]")
    if node.default_outcome:
        yield "default=", string(node.default_outcome)
    if node.join != "all":
        yield "first_ends=" if node.join == "any" else "rule_ends=", "True"
    if node.sugar:
        yield "is_limit=", "True"


def _repeat(node: nodes.Iterator) -> Iterator[tuple[str, Doc]]:
    yield "items=", items(node)
    yield "item=", string(node.item_key)
    yield "again=", names(node.loop_outcomes)
    yield "exhausted=", string(node.exhausted_outcome)
    if node.final_map:
        yield "renamed=", mapping((key, string(to)) for key, to in node.final_map)
    if node.sugar:
        yield "is_loop=", "True"


def _target(node: Container, edge: Transition, states: frozenset[str]) -> str:
    """The target of a transition, as YASMIN names it."""
    return _state_name(node, edge.target) if leads_to_child(edge, states) else edge.target


def _state_name(node: Container, name: str) -> str:
    """The name of a state in YASMIN, which refuses that of an outcome."""
    return f"{name} (state)" if name in outcome_names(node) else name


def _added(node: Container, variable: str, child: Node, state: Doc, states: frozenset[str]) -> str:
    """The statement that adds a state to its container, which has these states."""
    arguments: Arguments = [("", string(child.name)), ("", state)]
    if isinstance(node, StateMachine | nodes.Sequence):
        edges = ((edge.outcome, string(_target(node, edge, states))) for edge in child.transitions)
        arguments.append(("", mapping(edges)))
    if child.remaps and not isinstance(node, nodes.Iterator):
        pairs = ((key, string(to)) for key, to in remapping(child).items())
        arguments.append(("remapping=", mapping(pairs)))
    return laid_out(call(f"{variable}.add", arguments), WIDTH - 4)
