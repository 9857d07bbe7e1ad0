"""The params of a script as parameters of its ROS node, which a launch file can set.

A param is a parameter of the node if a variable or userdata uses it: as its value, in a list or a
mapping, or in a string construct. Names of types, code, time limits and numbers of retries are
fixed when the program is generated.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping
from keyword import iskeyword

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Span
from smachac.ir.nodes import Data, Expression, Leaf, LookUp, Machine, Param, Struct, Value
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.ir.traversal import walk
from smachac.ir.types import ANY, Type
from smachac.records import dataclass, field, replace
from smachac.targets.errors import fixed_param
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
from smachac.targets.python.functions import ITEMS, Place, Use, Uses
from smachac.targets.python.ros import RosType


@dataclass(frozen=True, slots=True, kw_only=True)
class RosParameter:
    """A parameter of a node: its name, also that of its variable in the program, its default, and
    the values that the interfaces of the states allow (empty: all of its type)."""

    name: str
    default: Data
    choices: tuple[int | str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedUse:
    """The use of a param in a value that a program contains as it is: the field, its place, and the
    param."""

    field: str
    span: Span
    param: Param


@dataclass(frozen=True, slots=True, kw_only=True)
class RosParameters:
    """The parameters of a node, the values of the machine that use them, and the uses of params
    that are fixed."""

    declared: tuple[RosParameter, ...] = ()
    uses: Uses = field(default_factory=dict)
    fixed: tuple[FixedUse, ...] = ()


RESERVED = frozenset(
    [*structure.OURS, "node", "program", "parameters", "values", "arguments", "rclpy", "topics"]
)
"""Names of a program that its parameters must not have."""


def ros_parameters(machine: Machine, taken: Collection[str]) -> RosParameters:
    """The parameters of the node of a machine; `taken` are names that variables must not have."""
    params = {param.value.span: param for param in machine.params}
    if not params:
        return RosParameters()
    found = [(value, _look_ups(value.value, params)) for value in _values(machine)]
    floats, choices = _limits(found)
    variables = {
        span: _variable(param.name, taken)
        for span, param in params.items()
        if param.name.isidentifier() and _has_ros_type(param.value.data)
    }
    # Where the type of the value matters, 5 is not 5.0.
    exact = {
        span: name
        for span, name in variables.items()
        if span not in floats or not isinstance(params[span].value.data, int)
    }
    uses: dict[Place, Use] = {}
    fixed = [
        FixedUse(field=param.field, span=param.word.span, param=params[param.value])
        for param in machine.fixed_params
        if param.value in params
    ]
    for value, look_ups in found:
        data, names = value.value.data, dict[str, None]()
        for look_up in look_ups:
            known = exact if look_up.path or look_up.parts else variables
            code = None if value.fixed else _code(look_up, known)
            if code is not None:
                data = _replaced(data, look_up.path, code.data)
                names |= dict.fromkeys(code.names)
            fixed += [
                FixedUse(field=value.name, span=value.span, param=params[span])
                for span in dict.fromkeys(part.span for part in (look_up, *_params_of(look_up)))
                if span in params and (code is None or span not in known)
            ]
        if names:
            uses[value.path, value.name] = Use(data=data, names=tuple(names))
    used = {name for use in uses.values() for name in use.names}
    declared = [
        RosParameter(
            name=variables[span],
            default=_default(param.value.data, span in floats),
            choices=choices.get(span, ()),
        )
        for span, param in params.items()
        if variables.get(span) in used
    ]
    return RosParameters(declared=tuple(declared), uses=uses, fixed=tuple(dict.fromkeys(fixed)))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Value:
    """A value of a machine: the path of its state, its name with the place, its type. `fixed`: a
    program contains it as code, or as the name of a type."""

    path: str
    name: str
    span: Span
    value: Value
    type: Type = ANY
    fixed: bool = False


def _values(machine: Machine) -> Iterator[_Value]:
    """The values in a machine."""
    for path, node in walk(machine.root):
        if isinstance(node, Leaf):
            known = machine.state_types.get(node.type)
            variables = known.variables if known is not None else {}
            for held in node.variables:
                fact = variables.get(held.name)
                yield _Value(
                    path=path,
                    name=held.name,
                    span=held.span,
                    value=held.value,
                    type=held.type,
                    fixed=held.role == "callbacks" or (fact is not None and fact.unquoted != ""),
                )
            continue
        for preset in node.userdata:
            yield _Value(path=path, name=preset.key, span=preset.span, value=preset.value)
        if isinstance(node, IteratorNode) and node.items is not None:
            yield _Value(path=path, name=ITEMS, span=node.items_span, value=node.items)


def _look_ups(value: Value, params: Mapping[Span, Param]) -> list[LookUp]:
    """The parts of a value that are made of params of the script, without parts of other parts."""
    found: list[LookUp] = []
    for up in (LookUp(span=value.span, data=value.data), *value.look_ups):
        if found and up.path[: len(found[-1].path)] == found[-1].path:
            continue
        param = params.get(up.span)
        if any(part.span in params for part in _params_of(up)) or (
            param is not None and not up.parts and param.value.data == up.data
        ):
            found.append(up)
    return found


def _limits(
    found: Iterable[tuple[_Value, list[LookUp]]],
) -> tuple[set[Span], dict[Span, tuple[int | str, ...]]]:
    """The params that must be floats, and the values that interfaces allow for params."""
    floats: set[Span] = set()
    choices: dict[Span, tuple[int | str, ...]] = {}
    for value, look_ups in found:
        for look_up in look_ups:
            if look_up.path or look_up.parts:
                continue
            if _plain(value.type).name == "float":
                floats.add(look_up.span)
            allowed = _choices(value.type)
            if allowed:
                before = choices.get(look_up.span, allowed)
                choices[look_up.span] = tuple(one for one in before if one in allowed)
    return floats, choices


def _params_of(look_up: LookUp) -> Iterator[LookUp]:
    """The params in a string construct."""
    return (part for part in look_up.parts if isinstance(part, LookUp))


def _code(look_up: LookUp, variables: Mapping[Span, str]) -> Use | None:
    """The code of a part that is made of params; None if it has no parameter, or is code itself."""
    if not look_up.parts:
        name = variables.get(look_up.span)
        return Use(data=Expression(text=name, span=look_up.span), names=(name,)) if name else None
    names: list[str] = []
    text = ""
    for part in look_up.parts:
        if isinstance(part, LookUp) and part.span in variables:
            names.append(variables[part.span])
            text += f"{{{names[-1]}}}"
        else:
            plain = str(part.data) if isinstance(part, LookUp) else part
            text += plain.replace("{", "{{").replace("}", "}}")
    if not names or not isinstance(look_up.data, str):
        return None
    return Use(data=Expression(text=f"f{string(text)}", span=look_up.span), names=tuple(names))


def _replaced(data: Data, path: tuple[str | int, ...], new: Data) -> Data:
    """Data with another part at a path."""
    if not path:
        return new
    first, rest = path[0], path[1:]
    match data:
        case Struct(entries=entries):
            return Struct(
                entries=tuple(
                    (key, _replaced(value, rest, new) if key == first else value)
                    for key, value in entries
                )
            )
        case tuple():
            return tuple(
                _replaced(value, rest, new) if number == first else value
                for number, value in enumerate(data)
            )
    return data


def fixed_uses(parameters: RosParameters) -> Iterator[Diagnostic]:
    """The findings for params that are fixed somewhere: warnings if they are parameters of the node
    as well, which then have effect elsewhere only, else notes."""
    declared = {parameter.name for parameter in parameters.declared}
    for use in parameters.fixed:
        found = fixed_param(use.span, use.field, use.param.name, use.param.value.span)
        settable = use.param.name in declared or f"{use.param.name}_" in declared
        yield found if settable else replace(found, severity=Severity.INFO)


def _variable(name: str, taken: Collection[str]) -> str:
    return f"{name}_" if name in taken or iskeyword(name) else name


def _has_ros_type(data: Data) -> bool:
    """Whether ROS has a parameter type for a value."""
    if isinstance(data, tuple):
        kinds = {type(value) for value in data}
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
    return tuple(argument for argument in plain.args if isinstance(argument, int | str))


NO_NODE: Mapping[str, object] = {"build_parameters": "", "main_parameters": ""}
"""The same variables for a program without a node of ROS 2."""


def node_variables(
    machine: Machine,
    settable: RosParameters,
    root: str,
    action: RosType | None,
    options: Mapping[str, str],
) -> dict[str, object]:
    """The variables of the template of a node: the parameters of its functions, the values that its
    parameters may have, the statements that run the machine in the variable `root`, and the
    outcomes of failure. `options` are those of the build."""
    outcomes = [outcome.name for outcome in machine.root.outcomes]
    failures = [name for name in outcomes if is_failure(name) or name == PREEMPTED]
    given = (
        ("", f"{parameter.name}={flat(literal(parameter.default))}")
        for parameter in settable.declared
    )
    head = Group("def build(", (("", "node"), *given), "):")
    choices = [
        (
            parameter.name,
            Group("[", tuple(("", flat(literal(one))) for one in parameter.choices), "]"),
        )
        for parameter in settable.declared
        if parameter.choices
    ]
    limits = [("choices=", mapping(choices))] if choices else []
    declared = call("parameters.declared", [("", "node"), ("", "build"), *limits])
    values = laid_out(declared, WIDTH - 8, len("values = "))
    named = {variable.name: variable.value.data for variable in machine.variables}
    name = literal(named.get("node_name", machine.root.name))
    run = [("", name), ("", "build"), ("", "arguments"), *limits]
    once = laid_out(call("program.run_once", run), WIDTH - 4, len("return "))
    return {
        "build_parameters": laid_out(head, WIDTH).removeprefix("def build(").removesuffix("):"),
        "main_parameters": "arguments=None",
        "ros_values": values if settable.declared else "",
        "ros_failures": flat(names(failures)),
        "ros_action": action is not None,
        "ros_lifecycle": options.get("lifecycle") == "true",
        "ros_package": options.get("package", "false") != "false",
        "ros_once": once.replace("\n", "\n    ") if runs_once(options) else "",
        "ros_run": _serving(machine, root, action)
        if action
        else f"return program.run(node, {root})",
    }


def runs_once(options: Mapping[str, str]) -> bool:
    """Whether a node runs its machine once, and does nothing else."""
    more = options.get("introspection") == "yes" or options.get("lifecycle") == "true"
    return not more and "action" not in options


def _serving(machine: Machine, root: str, action: RosType) -> str:
    """The statements that offer a machine as an action."""
    outcomes = [outcome.name for outcome in machine.root.outcomes]
    failures = [name for name in outcomes if is_failure(name)]
    good = [name for name in outcomes if name not in (*failures, PREEMPTED)]
    server = call(
        "serving.ActionServerWrapper",
        [
            *(("", text) for text in ("node", string(machine.root.name), action.name, root)),
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
