"""A machine as an action: the program waits for signals while a server runs the machine."""

from __future__ import annotations

from typing import Any

from smachac.runtime.smach_ros2.action_server_wrapper import (
    ActionServerWrapper as ActionServerWrapper,  # that of smach_ros has no `path_slot`
)
from smachac.runtime.smach_ros2.signals import GRACE, PreemptHandler


def serve(node: Any, machine: Any, grace: float = GRACE) -> None:
    """Wait for a stop signal, which preempts the machine and then shuts the node down.

    The node is one of `start_node`.
    """
    handler: PreemptHandler | None = node.signal_handler
    if handler is not None:
        handler.grace, handler.shuts_down = grace, True
        handler.add(machine)
    node.join()


def text_field(message: Any) -> str | None:
    """The name of the first field of a message with a text or texts; None if there is none."""
    kinds = message.get_fields_and_field_types().items()
    return next(
        (name for name, kind in kinds if kind.startswith(("string", "sequence<string"))), None
    )
