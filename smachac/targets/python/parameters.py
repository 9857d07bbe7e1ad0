"""The params of a script as parameters of its ROS node, which a launch file can set.

A param is a parameter of the node if it is the whole value of a variable or of userdata.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field
from keyword import iskeyword

from smachac.ir.nodes import Data, Leaf, Machine, Value
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.ir.traversal import walk
from smachac.ir.types import ANY, Type
from smachac.targets.python import structure
from smachac.targets.python.formatter import (
    WIDTH,
    Group,
    call,
    flat,
    laid_out,
    literal,
    mapping,
    names,
    string,
)
from smachac.targets.python.functions import Place
from smachac.targets.python.ros import RosType


@dataclass(frozen=True, slots=True, kw_only=True)
class RosParameter:
    """A parameter of a node: its name, also that of its variable in the program, its default, and
    the values that the interfaces of the states allow (empty: all of its type)."""

    name: str
    default: Data
    choices: tuple[int | str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class RosParameters:
    """The parameters of a node, and the values of the machine that they stand for."""

    declared: tuple[RosParameter, ...] = ()
    places: Mapping[Place, str] = field(default_factory=dict)


RESERVED = frozenset(
    [*structure.OURS, "node", "program", "parameters", "values", "arguments", "rclpy", "topics"]
)
"""Names of a program that its parameters must not have."""


def ros_parameters(machine: Machine, taken: Collection[str]) -> RosParameters:
    """The parameters of the node of a machine; `taken` are names that variables must not have."""
    params = {
        each.value.span: each
        for each in machine.params
        if each.name.isidentifier() and _has_ros_type(each.value.data)
    }
    variables = {span: _variable(each.name, taken) for span, each in params.items()}
    places: dict[Place, str] = {}
    floats: set[str] = set()
    choices: dict[str, tuple[int | str, ...]] = {}
    for path, name, value, type_ in _values(machine):
        param, variable = params.get(value.span), variables.get(value.span)
        if param is None or variable is None or param.value.data != value.data:
            continue
        places[path, name] = variable
        if _plain(type_).name == "float":
            floats.add(variable)
        allowed = _choices(type_)
        if allowed:
            before = choices.get(variable, allowed)
            choices[variable] = tuple(each for each in before if each in allowed)
    used = set(places.values())
    declared = [
        RosParameter(
            name=variables[span],
            default=_default(each.value.data, variables[span] in floats),
            choices=choices.get(variables[span], ()),
        )
        for span, each in params.items()
        if variables.get(span) in used
    ]
    return RosParameters(declared=tuple(declared), places=places)


def _values(machine: Machine) -> Iterator[tuple[str, str, Value, Type]]:
    """The values in a machine: path of the state, name, value, type of the variable."""
    for path, node in walk(machine.root):
        if isinstance(node, Leaf):
            for held in node.variables:
                yield path, held.name, held.value, held.type
        else:
            for preset in node.userdata:
                yield path, preset.key, preset.value, ANY


def _variable(name: str, taken: Collection[str]) -> str:
    return f"{name}_" if name in taken or iskeyword(name) else name


def _has_ros_type(data: Data) -> bool:
    """Whether ROS has a parameter type for a value."""
    if isinstance(data, tuple):
        kinds = {type(each) for each in data}
        return len(kinds) == 1 and kinds <= {bool, int, float, str}
    return isinstance(data, bool | int | float | str)


def _default(data: Data, is_float: bool) -> Data:
    """The default of a parameter: a float where an interface wants one."""
    if is_float and isinstance(data, int) and not isinstance(data, bool):
        return float(data)
    return data


def _plain(type_: Type) -> Type:
    """A type without None."""
    inner = type_.args[0] if type_.name == "optional" else type_
    return inner if isinstance(inner, Type) else type_


def _choices(type_: Type) -> tuple[int | str, ...]:
    plain = _plain(type_)
    if plain.name != "one_of":
        return ()
    return tuple(each for each in plain.args if isinstance(each, int | str))


NO_NODE: Mapping[str, object] = {"build_parameters": "", "main_parameters": ""}
"""The same variables for a program without a node of ROS 2."""


def node_variables(
    machine: Machine, settable: RosParameters, root: str, action: RosType | None, *, lifecycle: bool
) -> dict[str, object]:
    """The variables of the template of a node: the parameters of its functions, the values that its
    parameters may have, the statements that run the machine in the variable `root`, and the
    outcomes of failure."""
    outcomes = [each.name for each in machine.root.outcomes]
    failures = [name for name in outcomes if is_failure(name) or name == PREEMPTED]
    given = (("", f"{each.name}={flat(literal(each.default))}") for each in settable.declared)
    head = Group("def build(", (("", "node"), *given), "):")
    choices = [
        (each.name, Group("[", tuple(("", flat(literal(one))) for one in each.choices), "]"))
        for each in settable.declared
        if each.choices
    ]
    limits = [("choices=", mapping(choices))] if choices else []
    declared = call("parameters.declared", [("", "node"), ("", "build"), *limits])
    values = laid_out(declared, WIDTH - 8, len("values = "))
    return {
        "build_parameters": laid_out(head, WIDTH).removeprefix("def build(").removesuffix("):"),
        "main_parameters": "arguments=None",
        "ros_values": values if settable.declared else "",
        "ros_failures": flat(names(failures)),
        "ros_action": action is not None,
        "ros_lifecycle": lifecycle,
        "ros_run": _serving(machine, root, action)
        if action
        else f"return program.run(node, {root})",
    }


def _serving(machine: Machine, root: str, action: RosType) -> str:
    """The statements that offer a machine as an action."""
    outcomes = [each.name for each in machine.root.outcomes]
    failures = [name for name in outcomes if is_failure(name)]
    good = [name for name in outcomes if name not in (*failures, PREEMPTED)]
    server = call(
        "smach_ros.ActionServerWrapper",
        [
            *(("", each) for each in ("node", string(machine.root.name), action.name, root)),
            ("succeeded_outcomes=", names(good)),
            ("aborted_outcomes=", names(failures)),
            ("preempted_outcomes=", names([PREEMPTED] if PREEMPTED in outcomes else [])),
            ("expand_goal_slots=", "True"),
            ("pack_result_slots=", "True"),
            ("path_slot=", f"serving.text_field({action.name}.Feedback)"),
        ],
    )
    made = laid_out(server, WIDTH - 8, len("wrapper = "))
    return f"wrapper = {made}\nwrapper.run_server()\nserving.serve(node, {root})"
