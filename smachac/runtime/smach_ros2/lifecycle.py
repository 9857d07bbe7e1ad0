"""LifecycleMachineNode: a managed node whose active state is the run of a machine."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

from smachac.runtime.smach_ros2 import program, ros
from smachac.runtime.smach_ros2.ros import LifecycleNode
from smachac.runtime.smach_ros2.spinning import Spinner

END_LIMIT = 10.0
"""Seconds that a machine has to end after a preempt request before a transition fails."""


class LifecycleMachineNode(LifecycleNode):
    """A managed node: `configure` builds a machine, `activate` runs it, `deactivate` preempts it.

    `build(node)` returns the machine. A machine that ends by itself deactivates the node; after
    that `activate` runs it again. `cleanup` drops it, `shutdown` preempts it and ends `execute`. A
    deactivation fails if the machine has not ended after 10 s.

    The node has the methods of a machine that `program.run(node, node)` needs: `execute` waits for
    the shutdown of the node, and returns the last outcome.

    Attributes:
        machine: the machine, or None while the node is not configured.
        outcome: the outcome of the last run, or None.
        arguments: the arguments of the program, with those of ROS.
    """

    arguments: Sequence[str] = ()

    def __init__(self, node_name: str, build: Callable[[Any], Any], **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self.machine: Any = None
        self.outcome: str | None = None
        self._build = build
        self._run_thread: threading.Thread | None = None
        self._is_stopping = False
        self._over = threading.Event()
        self._results: Any = ros.load("rclpy.lifecycle").TransitionCallbackReturn
        self._spinner: Spinner | None = None
        self.signal_handler: Any = None

    def start(self) -> None:
        """Spin the node in threads: transitions wait for a machine that needs the node."""
        executors = ros.load("rclpy.executors")
        self._spinner = Spinner(self, executors.MultiThreadedExecutor(2, context=self.context))
        self._spinner.start()

    def stop(self) -> None:
        """Stop the threads and wait for their end."""
        if self._spinner is not None:
            self._spinner.stop()

    # Transitions

    def on_configure(self, state: Any) -> Any:
        """Build the machine."""
        try:
            self.machine = self._build(self)
        except Exception:
            ros.log_failure(self, "the machine cannot be built")
            return self._results.FAILURE
        return super().on_configure(state)

    def on_activate(self, state: Any) -> Any:
        """Run the machine in a thread."""
        self._is_stopping = False
        self._run_thread = threading.Thread(target=self._run, name="machine", daemon=True)
        self._run_thread.start()
        return super().on_activate(state)

    def on_deactivate(self, state: Any) -> Any:
        """Preempt the machine and wait for its end."""
        return super().on_deactivate(state) if self._end_machine() else self._results.FAILURE

    def on_cleanup(self, state: Any) -> Any:
        """Drop the machine."""
        self.machine = None
        return super().on_cleanup(state)

    def on_shutdown(self, state: Any) -> Any:
        """Preempt the machine, wait for its end, and end `execute`."""
        self._end_machine()
        self._over.set()
        return super().on_shutdown(state)

    def _run(self) -> None:
        self.outcome = None
        try:
            self.outcome = self.machine.execute()
        except Exception:
            ros.log_failure(self, "the machine failed")
        self.get_logger().info(f"the machine ended with outcome {self.outcome}")
        executor = self.executor
        if not self._is_stopping and executor is not None and self.context.ok():
            executor.create_task(self.trigger_deactivate)

    def _end_machine(self) -> bool:
        """Preempt the machine if it runs; whether it has ended."""
        self._is_stopping = True
        thread = self._run_thread
        if thread is None or not thread.is_alive():
            return True
        self.machine.request_preempt()
        thread.join(END_LIMIT)
        return not thread.is_alive()

    # The methods of a machine

    def execute(self) -> str | None:
        """Wait until the node is shut down by a transition or a stop request; the last outcome."""
        self._over.wait()
        return self.outcome

    def request_preempt(self) -> None:
        """Preempt the machine, and end `execute`."""
        self._end_machine()
        self._over.set()

    def is_running(self) -> bool:
        """Whether the machine runs."""
        return self._run_thread is not None and self._run_thread.is_alive()


def start_node(
    name: str, build: Callable[[Any], Any], args: list[str] | None = None, **kwargs: Any
) -> LifecycleMachineNode:
    """Initialize rclpy and start a LifecycleMachineNode, as `program.start_node` does."""
    node: LifecycleMachineNode = program.start(
        lambda: LifecycleMachineNode(name, build, **kwargs), args
    )
    return node


def run(node: LifecycleMachineNode) -> str | None:
    """Wait until the node is shut down by a transition, or by a stop signal, which preempts its
    machine; the outcome of the last run."""
    return program.run(node, node)
