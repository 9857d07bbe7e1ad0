"""Parameters of a node: the params of a script, with their types and default values."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import Any

from smachac.runtime.ros2_errors import ParameterError as ParameterError
from smachac.runtime.smach_ros2 import ros


def declared(
    node: Any, build: Callable[..., Any], choices: Mapping[str, Sequence[Any]] | None = None
) -> dict[str, Any]:
    """The values of the parameters of a node, which are declared here.

    The parameters are those of the function `build` that have defaults; `choices` are the allowed
    values by name. A whole number is accepted for a float. Raises ParameterError for a value of
    another type or outside the choices.
    """
    values = {}
    for each in inspect.signature(build).parameters.values():
        if each.default is inspect.Parameter.empty:
            continue
        allowed = (choices or {}).get(each.name, ())
        try:
            values[each.name] = _declare(node, each.name, each.default, allowed)
        except ros.load("rclpy.exceptions").ParameterException as error:
            raise ParameterError(f"parameter '{each.name}': {error}") from None
    return values


def _declare(node: Any, name: str, default: Any, allowed: Sequence[Any]) -> Any:
    """Declare one parameter, unless it is declared; its value."""
    if node.has_parameter(name):
        return _plain(node.get_parameter(name).value)
    limits = f"one of {', '.join(map(str, allowed))}" if allowed else ""
    errors = ros.load("rclpy.exceptions")
    descriptor = ros.load("rcl_interfaces.msg").ParameterDescriptor(
        description=f"param of the script, default {default!r}",
        additional_constraints=limits,
        read_only=True,  # the machine is built with it
    )
    try:
        value = node.declare_parameter(name, default, descriptor).value
    except errors.InvalidParameterTypeException:
        if not isinstance(default, float):
            raise
        with suppress(errors.InvalidParameterTypeException):  # the first message names the type
            return float(node.declare_parameter(name, int(default), descriptor).value)
        raise
    if allowed and value not in allowed:
        raise errors.InvalidParameterValueException(name, value, limits)
    return _plain(value)


def _plain(value: Any) -> Any:
    """A value without the array types of rclpy."""
    return list(value) if isinstance(value, Sequence) and not isinstance(value, str) else value
