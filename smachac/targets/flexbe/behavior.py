"""The module of a behavior, in the form that the FlexBE App writes and reads.

The App keeps what is between its `[MANUAL_...]` marks: the imports of smachac's containers and
what they need beyond FlexBE's.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from keyword import iskeyword

from smachac.diagnostics.source import assert_never
from smachac.ir import nodes
from smachac.ir.concurrence_rules import by_priority
from smachac.ir.nodes import Concurrence, Container, Data, Expression, Leaf, Machine, Node, Struct
from smachac.ir.traversal import containers, leads_to_child, remapping, walk
from smachac.records import dataclass
from smachac.targets import made_by, stem
from smachac.targets.flexbe.names import Names, outcome, own_outcomes
from smachac.targets.flexbe.states import StateClass, interface_of
from smachac.targets.package_xml import summary
from smachac.targets.python.formatter import (
    Doc,
    call,
    docstring,
    flat,
    laid_out,
    literal,
    mapping,
    names,
    string,
)
from smachac.targets.python.items import items
from smachac.targets.python.parameters import RosParameter
from smachac.targets.python.structure import place

OWN = {
    *("name", "node", "beh_id", "contains", "requested_state_path", "create", "set_up", "execute"),
    *("add_parameter", "add_behavior", "use_behavior", "prepare_for_execution", "set_parameter"),
    *("confirm", "get_latest_status", "prepare_for_switch", "get_current_state", "preempt"),
    *("get_locked_state", "get_contained_behaviors"),
}
"""Attributes of FlexBE's class `Behavior`, which no parameter may have as its name."""


Edges = Callable[[Node], Iterator[tuple[str, str]]]
"""The transitions of a state: outcomes and targets."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Behavior:
    """What the behavior of a machine is made of.

    `states` is the package of its states, `program` the module of the SMACH program there. The
    program is a node of ROS with `parameters`; `settable` are the path and key of userdata, and the
    path and variable of states, that use one. `classes` are by the path of a state.
    """

    states: str
    program: str
    is_node: bool
    parameters: tuple[RosParameter, ...]
    settable: frozenset[tuple[str, str]]
    classes: Mapping[str, StateClass]
    names: Names


def class_name(machine: Machine) -> str:
    """The name of the class, as the App makes it."""
    words = re.sub(r"[^A-Za-z0-9]+", " ", stem(machine)).split() or ["machine"]
    name = "".join(word[0].upper() + word[1:] for word in words) + "SM"
    return f"Behavior{name}" if name[0].isdigit() else name


def attribute(parameter: RosParameter) -> str:
    """The attribute of a behavior with the value of a parameter."""
    name = parameter.name
    return f"{name}_parameter" if name in OWN or name.startswith("_") else name


def behavior_text(machine: Machine, behavior: Behavior) -> str:
    """The module of the behavior."""
    classes = dict.fromkeys(behavior.classes.values())
    imports = "".join(
        f"from {behavior.states}.{known.module} import {known.name}\n" for known in classes
    )
    ros = "".join(f"        {known.name}.initialize_ros(node)\n" for known in classes)
    parameters = "".join(
        f"        self.add_parameter({attribute(known)!r}, {flat(literal(known.default))})\n"
        for known in behavior.parameters
    )
    node = "\n        self.node = node\n        " if behavior.is_node else "\n\n        "
    create = "".join(f"        {line}".rstrip() + "\n" for line in _created(machine, behavior))
    doc = docstring(summary(machine))
    return f"""\
#!/usr/bin/env python
# {made_by(machine)}
from flexbe_core import Autonomy
from flexbe_core import Behavior
from flexbe_core import Logger
{imports}
# [MANUAL_IMPORT]
from {behavior.states} import {behavior.program} as smach_program
from {behavior.states}.smachac_flexbe import ConcurrencyContainer, Join, Loop
from {behavior.states}.smachac_flexbe import OperatableStateMachine
# [/MANUAL_IMPORT]


class {class_name(machine)}(Behavior):
    \"""
    {doc}
    \"""

    def __init__(self, node):
        super().__init__()
        self.name = {machine.root.name!r}

        # parameters of this behavior
{parameters}
        # references to used behaviors
        OperatableStateMachine.initialize_ros(node)
        ConcurrencyContainer.initialize_ros(node)
        Logger.initialize(node)
{ros}
        # [MANUAL_INIT]{node}# [/MANUAL_INIT]

    def create(self):
{create}
    # [MANUAL_FUNC]

    # [/MANUAL_FUNC]
"""


def _created(machine: Machine, behavior: Behavior) -> Iterator[str]:
    """The lines of the function that makes the state machine."""
    root = machine.root
    yield _positions(root)
    yield f"_state_machine = OperatableStateMachine({_interface(root, is_root=True)})"
    for preset in root.userdata:
        settable = (root.name, preset.key) in behavior.settable
        if not settable and not preset.secret and _is_plain(preset.value.data):
            name = f".{preset.key}" if _is_attribute(preset.key) else f"[{preset.key!r}]"
            yield f"_state_machine.userdata{name} = {flat(literal(preset.value.data))}"
    yield ""
    yield "# [MANUAL_CREATE]"
    yield from laid_out(_set_up(machine, behavior), 92).split("\n")
    yield "# [/MANUAL_CREATE]"
    found = [path for path, _ in containers(root)]
    variables = {path: f"_sm_{_word(path)}_{number}" for number, path in enumerate(found)}
    variables[root.name] = "_state_machine"
    for path, node in reversed([*containers(root)]):
        yield ""
        if node is not root:
            yield _positions(node)
            yield from _made(variables[path], path, node, behavior.names)
            yield ""
        yield f"with {variables[path]}:"
        for line in _added(path, node, variables, behavior):
            yield f"    {line}".rstrip()
    yield ""
    yield "return _state_machine"


def _word(path: str) -> str:
    return re.sub(r"\W+", "_", path.rpartition("/")[2], flags=re.ASCII).lower()


def _is_attribute(key: str) -> bool:
    return re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", key) is not None and not iskeyword(key)


def _is_plain(data: Data) -> bool:
    match data:
        case Expression():
            return False
        case Struct(entries=entries):
            return all(_is_plain(value) for _, value in entries)
        case tuple():
            return all(_is_plain(item) for item in data)
    return True


def _positions(node: Container) -> str:
    """The places of the outcomes on the page of the App."""
    return "# " + ", ".join(f"x:{900} y:{60 + 60 * at}" for at, _ in enumerate(node.outcomes))


def _list(words: tuple[str, ...] | list[str]) -> str:
    return f"[{', '.join(map(repr, words))}]"


def _interface(node: Container, *, is_root: bool = False) -> str:
    text = f"outcomes={_list(own_outcomes(node, is_root=is_root))}"
    for word, keys in (("input_keys", node.inputs), ("output_keys", node.outputs)):
        if keys:
            text += f", {word}={_list([key.name for key in keys])}"
    return text


def _made(variable: str, path: str, node: Container, labels: Names) -> Iterator[str]:
    """The statement that makes a container inside another."""
    if not isinstance(node, Concurrence):
        yield f"{variable} = OperatableStateMachine({_interface(node)})"
        return
    head = f"{variable} = ConcurrencyContainer("
    space = " " * len(head)
    rules = [
        f"({outcome(rule.outcome)!r}, ["
        + ", ".join(
            f"({labels.labels[f'{path}/{one.child}']!r}, {outcome(one.outcome)!r})"
            for one in rule.when
        )
        + "])"
        for rule in by_priority(node)
    ]
    if not rules:
        yield f"{head}{_interface(node)})"
        return
    yield f"{head}{_interface(node)}, conditions=["
    for number, rule in enumerate(rules, 1):
        yield f"{space}{rule}{',' if number < len(rules) else ''}"
    yield f"{space}])"


def _added(
    path: str, node: Container, variables: Mapping[str, str], behavior: Behavior
) -> Iterator[str]:
    """The statements that add the states of a container, the initial one first."""
    labels = behavior.names.labels
    first = node.initial if isinstance(node, nodes.StateMachine | nodes.Sequence) else ""
    ordered = sorted(node.children, key=lambda child: child.name != first)
    space = " " * len("OperatableStateMachine.add(")
    edges_of = _edges(path, node, behavior.names)
    for at, child in enumerate(ordered):
        where = f"{path}/{child.name}"
        state = variables[where] if where in variables else _constructed(child, where, behavior)
        edges = dict(edges_of(child))
        usual = "Autonomy.Inherit" if where in variables else "Autonomy.Off"
        levels = {outcome(one.outcome): f"Autonomy.{one.level}" for one in child.autonomy}
        needed = [f"{name!r}: {levels.get(name, usual)}" for name in edges]
        arguments = [
            f"OperatableStateMachine.add({labels[where]!r}",
            f"{space}{state}",
            f"{space}transitions={edges!r}",
            f"{space}autonomy={{{', '.join(needed)}}}",
        ]
        keys = dict.fromkeys(key.name for key in (*child.inputs, *child.outputs))
        if keys:
            to = {} if isinstance(node, nodes.Iterator) else remapping(child)
            pairs = {**{key: to.get(key, key) for key in keys}, **to}
            arguments.append(f"{space}remapping={pairs!r}")
        if at:
            yield ""
        yield f"# {place(child)}"
        yield f"# x:{30 + 220 * (at % 4)} y:{40 + 120 * (at // 4)}"
        yield from ",\n".join(arguments).split("\n")[:-1]
        yield f"{arguments[-1]})"


def _constructed(child: Node, where: str, behavior: Behavior) -> str:
    assert isinstance(child, Leaf)
    known = behavior.classes[where]
    if known.interface is not None:
        return f"{known.name}()"
    values = zip(("outcomes", "input_keys", "output_keys"), interface_of(child), strict=True)
    return f"{known.name}({', '.join(f'{name}={_list(words)}' for name, words in values)})"


def _edges(path: str, node: Container, labels: Names) -> Edges:
    """A function that makes the transitions of a state in a container."""
    own = own_outcomes(node, is_root="/" not in path)
    match node:
        case Concurrence():
            edges = _branch_edges(node, own)
        case nodes.Iterator():
            edges = _item_edges(node, own, labels.labels[f"{path}/{node.children[0].name}"])
        case nodes.StateMachine() | nodes.Sequence():
            edges = _state_edges(path, node, labels)
        case _:
            assert_never(node)
    return edges


def _branch_edges(node: Concurrence, own: tuple[str, ...]) -> Edges:
    """The transitions of a branch. The container decides: they show the first condition for it."""
    decided: dict[tuple[str, str], str] = {}
    for rule in by_priority(node):
        for one in rule.when:
            decided.setdefault((one.child, outcome(one.outcome)), outcome(rule.outcome))
    default = outcome(node.default_outcome) if node.default_outcome else own[0]

    def edges(child: Node) -> Iterator[tuple[str, str]]:
        for name in own_outcomes(child):
            yield name, decided.get((child.name, name), default)

    return edges


def _item_edges(node: nodes.Iterator, own: tuple[str, ...], label: str) -> Edges:
    """The transitions of the state that is repeated: to itself, or to the end of the loop."""
    again = {outcome(name) for name in node.loop_outcomes}
    renamed = {outcome(name): outcome(to) for name, to in node.final_map}

    def edges(child: Node) -> Iterator[tuple[str, str]]:
        for name in own_outcomes(child):
            to = renamed.get(name, name)
            yield name, to if name not in again and to in own else label

    return edges


def _state_edges(path: str, node: nodes.StateMachine | nodes.Sequence, labels: Names) -> Edges:
    states = frozenset(state.name for state in node.children)

    def edges(child: Node) -> Iterator[tuple[str, str]]:
        for edge in child.transitions:
            target = outcome(edge.target) if "/" in path else edge.target
            if leads_to_child(edge, states):
                target = labels.labels[f"{path}/{edge.target}"]
            yield outcome(edge.outcome), target

    return edges


def _set_up(machine: Machine, behavior: Behavior) -> Doc:
    """The call with what FlexBE's containers have no argument for."""
    given = ["self.node"] if behavior.is_node else []
    given += [f"{known.name}=self.{attribute(known)}" for known in behavior.parameters]
    arguments: list[tuple[str, Doc]] = [
        ("", call("smach_program.build", [("", text) for text in given])),
        ("", string(machine.root.name)),
    ]
    paths = behavior.names.paths
    loops: list[tuple[str, Doc]] = []
    joins: list[tuple[str, Doc]] = []
    for path, node in containers(machine.root):
        if isinstance(node, nodes.Iterator):
            loops.append((paths[path], call("Loop", _loop(node))))
        elif isinstance(node, Concurrence) and (join := [*_join(node)]):
            joins.append((paths[path], call("Join", join)))
    catches: list[tuple[str, Doc]] = [
        (paths[path], string(outcome(node.catches)))
        for path, node in walk(machine.root)
        if node.catches
    ]
    labels: list[tuple[str, Doc]] = [
        (path, string(name)) for path, name in behavior.names.changed()
    ]
    for word, pairs in (
        ("loops", loops),
        ("joins", joins),
        ("catches", catches),
        ("labels", labels),
    ):
        if pairs:
            arguments.append((f"{word}=", mapping(pairs)))
    return call("_state_machine.set_up", arguments)


def _loop(node: nodes.Iterator) -> Iterator[tuple[str, Doc]]:
    yield "items=", items(node)
    yield "item=", string(node.item_key)
    yield "again=", names(map(outcome, node.loop_outcomes))
    yield "exhausted=", string(outcome(node.exhausted_outcome))
    if node.final_map:
        pairs = ((outcome(key), string(outcome(to))) for key, to in node.final_map)
        yield "renamed=", mapping(pairs)
    if node.sugar:
        yield "is_sugar=", "True"


def _join(node: Concurrence) -> Iterator[tuple[str, Doc]]:
    if node.default_outcome:
        yield "default=", string(outcome(node.default_outcome))
    if node.join != "all":
        yield "first_ends=" if node.join == "any" else "rule_ends=", "True"
    if node.sugar:
        yield "is_limit=", "True"
