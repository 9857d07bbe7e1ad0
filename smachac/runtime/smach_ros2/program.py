"""The main program of a node: start it, run a machine with it, stop it."""

from __future__ import annotations

import threading
from collections.abc import Collection
from typing import Any

from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.node import SmachNode
from smachac.runtime.smach_ros2.signals import GRACE, PreemptHandler


def start_node(
    name: str, args: list[str] | None = None, node_class: Any = SmachNode, **kwargs: Any
) -> Any:
    """Initialize rclpy and start a node that a thread spins.

    rclpy gets no signal handlers, because they end the node before goals can be cancelled: see
    `run`. `args` are the arguments of the program (default: sys.argv); other arguments are those of
    `node_class`.
    """
    options = ros.load("rclpy.signals").SignalHandlerOptions
    ros.rclpy.init(args=args, signal_handler_options=options.NO)
    node = node_class(name, **kwargs)
    node.start()
    return node


def run(node: Any, machine: Any, grace: float = GRACE) -> str | None:
    """Execute a machine in this thread and return its outcome.

    The first Ctrl-C or SIGTERM preempts it; after `grace` seconds the node shuts down, and states
    that wait for ROS end. The second one ends the program.
    """
    if threading.current_thread() is not threading.main_thread():
        return _execute(machine)
    handler = PreemptHandler(node.context, grace)
    handler.machines.append(machine)
    handler.install()
    try:
        return _execute(machine)
    finally:
        handler.remove()


def _execute(machine: Any) -> str | None:
    outcome: str | None = machine.execute()
    return outcome


def stop_node(node: Any) -> None:
    """Stop the thread of a node, destroy the node and shut rclpy down."""
    node.stop()
    node.destroy_node()
    node.context.try_shutdown()


def exit_code(outcome: str | None, failures: Collection[str] = ("aborted", "preempted")) -> int:
    """The exit code of a program for an outcome: 1 for none and for one of `failures`."""
    return 1 if outcome is None or outcome in failures else 0
