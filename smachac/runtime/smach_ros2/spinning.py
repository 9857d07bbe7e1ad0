"""Spinner: a thread that executes the callbacks of a node that nobody else spins.

A state that waits for an answer of ROS needs an executor that runs. `ensure` starts a thread if the
node has no executor. `Probe` detects an executor that does not run, for example because the machine
is executed in one of its callbacks; the node then moves to a thread of its own.
"""

from __future__ import annotations

import atexit
import threading
from typing import Any

from smachac.runtime.smach_ros2 import ros

TICK = 1.0
"""Seconds after which a spinner checks that its node was not taken over or destroyed."""

STOP_LIMIT = 5.0
"""Seconds to wait for the end of a callback when a spinner stops."""


class Spinner:
    """A thread that executes the callbacks of one node.

    It ends with the node, with its context, and when another executor takes the node over.
    """

    def __init__(self, node: Any, executor: Any = None) -> None:
        self._node = node
        executors = ros.load("rclpy.executors")
        self._executor = executor or executors.SingleThreadedExecutor(context=node.context)
        self._ended: type[Exception] = executors.ExternalShutdownException
        self._stopping = False
        self._thread = threading.Thread(
            target=self._run, name=f"executor of {node.get_name()}", daemon=True
        )

    def start(self) -> None:
        """Take the node over and start the thread."""
        self._executor.add_node(self._node)
        # A daemon thread that is inside rclpy at the end of the interpreter aborts the process.
        atexit.register(self.stop)
        self._thread.start()

    def stop(self) -> None:
        """Stop the thread and wait for its end."""
        self._stopping = True
        self._executor.wake()
        if threading.current_thread() is not self._thread:
            self._thread.join(STOP_LIMIT)

    def join(self) -> None:
        """Wait for the end of the thread, which a shutdown of rclpy causes."""
        self._thread.join()

    def _run(self) -> None:
        invalid = ros.invalid_handle()
        try:
            while self._is_needed():
                try:
                    self._executor.spin_once(timeout_sec=TICK)
                except self._ended:
                    break
                except invalid:  # an entity was destroyed after the executor had listed it
                    continue
                except Exception:
                    ros.log_failure(self._node, "a callback of the node failed")
        finally:
            self._executor.remove_node(self._node)
            self._executor.shutdown(timeout_sec=0)
            atexit.unregister(self.stop)

    def _is_needed(self) -> bool:
        node = self._node
        has_node = node in self._executor.get_nodes()
        return not self._stopping and node.context.ok() and has_node and not is_destroyed(node)


def is_assigned(node: Any) -> bool:
    """Whether the node belongs to an executor."""
    executor = node.executor
    return executor is not None and node in executor.get_nodes()


def is_destroyed(node: Any) -> bool:
    """Whether the node was destroyed."""
    try:
        with node.handle:
            return False
    except ros.invalid_handle():
        return True


def ensure(node: Any) -> None:
    """Start a thread that spins the node if it belongs to no executor."""
    if node.context.ok() and not is_assigned(node):
        Spinner(node).start()


class Probe:
    """The check that the executor of a node runs: a task that the executor has to perform.

    A node is taken over once at most: a callback that takes long must not start many threads.
    """

    def __init__(self, node: Any) -> None:
        self._node = node
        self._pending: threading.Event | None = None
        self._has_taken_over = False

    def check(self) -> None:
        """Check the task of the last call, and take the node over if it was not performed."""
        ensure(self._node)
        if self._has_taken_over:
            return
        if self._pending is not None and not self._pending.is_set():
            self._has_taken_over = True
            self._node.get_logger().warning(
                "the executor of the node does not run: a thread of smach_ros spins the node"
            )
            Spinner(self._node).start()
        executor = self._node.executor
        if executor is not None:
            self._pending = threading.Event()
            executor.create_task(self._pending.set)
