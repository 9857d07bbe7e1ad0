"""Parameters of a node: the params of a script, with their types and default values."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from itertools import chain, pairwise
from typing import Any

from smachac.runtime.ros2_errors import ParameterError as ParameterError
from smachac.runtime.smach_ros2 import ros


def declared(
    node: Any, build: Callable[..., Any], choices: Mapping[str, Sequence[Any]] | None = None
) -> dict[str, Any]:
    """The values of the parameters of a node, which are declared here.

    The parameters are those of the function `build` that have defaults; `choices` are the allowed
    values by name. A whole number is accepted for a float, also in a list. Raises ParameterError
    for a value of another type or outside the choices.
    """
    values = {}
    for parameter in inspect.signature(build).parameters.values():
        if parameter.default is inspect.Parameter.empty:
            continue
        allowed = (choices or {}).get(parameter.name, ())
        try:
            values[parameter.name] = _declare(node, parameter.name, parameter.default, allowed)
        except ros.load("rclpy.exceptions").ParameterException as error:
            raise ParameterError(f"parameter '{parameter.name}': {error}") from None
    _check_hidden(node, values)
    return values


def _declare(node: Any, name: str, default: Any, allowed: Sequence[Any]) -> Any:
    """Declare one parameter, unless it is declared; its value. Raises ParameterError."""
    errors = ros.load("rclpy.exceptions")
    limits = f"one of {', '.join(map(str, allowed))}" if allowed else ""
    if not node.has_parameter(name):
        descriptor = ros.load("rcl_interfaces.msg").ParameterDescriptor(
            description=f"param of the script, default {default!r}",
            additional_constraints=limits,
            read_only=True,  # the machine is built with it
        )
        try:
            node.declare_parameter(name, default, descriptor)
        except errors.InvalidParameterTypeException:
            if not _is_float(default):
                raise
            whole = int(default) if isinstance(default, float) else [int(item) for item in default]
            with suppress(errors.InvalidParameterTypeException):  # the first message has the type
                node.declare_parameter(name, whole, descriptor)
            if not node.has_parameter(name):
                raise
    try:
        value = _converted(name, default, node.get_parameter(name).value)
    except errors.ParameterUninitializedException:  # rclpy gives none to a parameter set to `[]`
        value = _converted(name, default, [])
    if allowed and value not in allowed:
        raise errors.InvalidParameterValueException(name, value, limits)
    return value


def _check_hidden(node: Any, values: Mapping[str, Any]) -> None:
    """Raise ParameterError if an argument of the program has no effect.

    rcl adds arguments to the section `/**` of the files of parameters. The last section for a node
    wins, and in one section a whole number wins over a float, so that a file can hide arguments. A
    second node reads the arguments alone.
    """
    arguments = list(getattr(node, "arguments", ()))
    pairs = [pair for pair in pairwise(arguments) if pair[0] in ("-p", "--param")]
    if not pairs or "--params-file" not in arguments:
        return
    reader = ros.Node(
        node.get_name(),
        namespace=node.get_namespace(),
        context=node.context,
        cli_args=["--ros-args", *chain.from_iterable(pairs)],
        use_global_arguments=False,
        enable_rosout=False,
        start_parameter_services=False,
        automatically_declare_parameters_from_overrides=True,
    )
    try:
        for name, value in values.items():
            given = reader.get_parameter_or(name).value
            if given is not None and repr(_converted(name, value, given)) != repr(value):
                raise ParameterError(
                    f"parameter '{name}': the argument {given!r} has no effect, because a file of "
                    f"parameters gives {value!r} in a section after `/**` or as another type; "
                    f"write `-p {node.get_name()}:{name}:=...` after the file"
                )
    finally:
        reader.destroy_node()


def _is_float(default: Any) -> bool:
    """Whether a default is a float or a list of floats."""
    first = default if isinstance(default, float) else next(iter(_list(default) or ()), None)
    return isinstance(first, float)


def _list(value: Any) -> list[Any] | None:
    """A list, a tuple or an array of rclpy as a list; None for other values."""
    is_list = isinstance(value, Sequence) and not isinstance(value, (str, bytes))
    return list(value) if is_list else None


def _converted(name: str, default: Any, value: Any) -> Any:
    """The value of a parameter with the type of its default. Raises ParameterError."""
    items = _list(value)
    if items is None:
        return float(value) if _is_float(default) else value
    if _list(default) is None:
        raise ParameterError(f"parameter '{name}': `{items}` is a list, the default is {default!r}")
    return [float(item) for item in items] if _is_float(default) else items
