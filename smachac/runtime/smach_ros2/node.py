"""SmachNode: a node that is spun by a thread of its own."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.spinning import Spinner


class SmachNode(ros.Node):
    """A node for a state machine. `start` spins it in a thread, `join` waits for its end.

    Attributes:
        arguments: the arguments of the program, with those of ROS.
    """

    arguments: Sequence[str] = ()

    def __init__(self, node_name: str, **kwargs: Any) -> None:
        super().__init__(node_name, **kwargs)
        self._spinner: Spinner | None = None
        self.signal_handler: Any = None

    def start(self) -> None:
        """Spin the node in a thread, until rclpy shuts down."""
        self._spinner = Spinner(self)
        self._spinner.start()

    def join(self) -> None:
        """Wait for the end of the thread."""
        if self._spinner is not None:
            self._spinner.join()

    def stop(self) -> None:
        """Stop the thread and wait for its end."""
        if self._spinner is not None:
            self._spinner.stop()
