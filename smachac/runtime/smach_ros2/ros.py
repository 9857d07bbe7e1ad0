"""Access to rclpy: the module, its Node class, durations, and the hooks of SMACH.

Importing this module imports rclpy. ImportError names the packages if there is none.
"""

from __future__ import annotations

import math
import traceback
from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias

from smachac.runtime import smach
from smachac.runtime.smach import log


class Duration(Protocol):
    """The interface of rclpy.duration.Duration."""

    @property
    def nanoseconds(self) -> int: ...


Time: TypeAlias = "Duration | float"
"""A duration: rclpy.duration.Duration, or a number of seconds."""


def load(name: str) -> Any:
    """The module of that name. Raises ImportError with the packages to install."""
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(
            f"smach_ros2 needs ROS 2, and this Python has none ({error}); source the setup file of "
            "a ROS 2 installation, or: pip install ros-kilted-rclpy ros-kilted-rmw-fastrtps-cpp"
        ) from error


rclpy: Any = load("rclpy")

if TYPE_CHECKING:

    class Node:
        """The class rclpy.node.Node."""

        def __init__(self, node_name: str, **kwargs: Any) -> None: ...

        def destroy_node(self) -> None: ...

        def __getattr__(self, name: str) -> Any: ...

    class LifecycleNode(Node):
        """The class rclpy.lifecycle.LifecycleNode."""

        def on_configure(self, state: Any) -> Any: ...

        def on_activate(self, state: Any) -> Any: ...

        def on_deactivate(self, state: Any) -> Any: ...

        def on_cleanup(self, state: Any) -> Any: ...

        def on_shutdown(self, state: Any) -> Any: ...

    class ActionClient:
        """The class rclpy.action.ActionClient."""

        def __init__(self, node: Any, action_type: Any, name: str, **kwargs: Any) -> None: ...

        def send_goal_async(self, *args: Any, **kwargs: Any) -> Any: ...

        def __getattr__(self, name: str) -> Any: ...

else:
    ActionClient = load("rclpy.action").ActionClient
    Node = load("rclpy.node").Node
    LifecycleNode = load("rclpy.lifecycle").LifecycleNode

NANOSECONDS = 1_000_000_000


def nanoseconds(seconds: float) -> int:
    """The nearest whole number of nanoseconds."""
    whole = math.floor(seconds)
    return whole * NANOSECONDS + round((seconds - whole) * NANOSECONDS)


def duration(seconds: float) -> Any:
    """The rclpy.duration.Duration that is nearest to a number of seconds. The constructor of that
    class cuts fractions off: its 2.01 s are one nanosecond less."""
    return load("rclpy.duration").Duration(nanoseconds=nanoseconds(seconds))


def seconds(time: Time | None) -> float | None:
    """A duration as a number of seconds; None stays None."""
    if time is None or isinstance(time, (int, float)):
        return time
    return time.nanoseconds / NANOSECONDS


def limit(time: Time | None) -> float | None:
    """A time limit as a number of seconds; None, and 0 as in smach_ros, means no limit."""
    return seconds(time) or None


def invalid_handle() -> type[Exception]:
    """The exception of rclpy for an entity that is destroyed while it is used."""
    error: type[Exception] = load("rclpy.exceptions").InvalidHandle
    return error


def own_group() -> Any:
    """A callback group for one entity, which other callbacks of the node do not block."""
    return load("rclpy.callback_groups").ReentrantCallbackGroup()


def fields(message: Any) -> list[str]:
    """The names of the fields of a message, a request, a goal and so on."""
    return list(message.get_fields_and_field_types())


def shutdown_check() -> Callable[[], bool]:
    """A function that returns whether rclpy has been shut down since it was seen running.

    rclpy replaces a context that was shut down by a new one, which looks as if nothing had been.
    """
    was_running = False

    def is_shut_down() -> bool:
        nonlocal was_running
        is_running = bool(rclpy.ok())
        was_running = was_running or is_running
        return was_running and not is_running

    return is_shut_down


def connect_smach() -> None:
    """Give SMACH the logger of rclpy and the shutdown check, unless a script set others."""
    if (smach.loginfo, smach.logerr) == (log.loginfo, log.logerr):
        logger = load("rclpy.logging").get_logger("smach_ros")
        smach.set_loggers(
            lambda text: logger.info(str(text)),  # rclpy raises TypeError for what is no text
            lambda text: logger.warning(str(text)),
            lambda text: logger.debug(str(text)),
            lambda text: logger.error(str(text)),
        )
    if smach.is_shutdown is log.is_shutdown:
        smach.set_shutdown_check(shutdown_check())


def log_failure(node: Any, what: str) -> None:
    """Log the exception that is being handled, with its traceback."""
    node.get_logger().error(f"{what}:\n{traceback.format_exc()}")
