"""set_preempt_handler: preempts a machine when the ROS node shuts down."""

from __future__ import annotations

import sys
import time
from typing import Any

from smachac.runtime import smach
from smachac.runtime.smach.container import Container
from smachac.runtime.smach_ros import ros


def set_preempt_handler(sc: Container) -> None:
    """Preempt a container when the node shuts down, and wait until the container has ended.

    A container that is executed by the thread that handles the signal cannot end before the
    handler returns: it is preempted without waiting.
    """

    def preempt() -> None:
        sc.request_preempt()
        smach.loginfo("shutting down: the machine is preempted")
        while sc.is_running() and not _is_run_below(sc):
            time.sleep(0.05)

    ros.rospy().on_shutdown(preempt)


def _is_run_below(container: Container) -> bool:
    """Whether this thread executes the container, further down its stack."""
    frame: Any = sys._getframe(1)
    while frame is not None:
        if frame.f_code.co_name == "execute" and frame.f_locals.get("self") is container:
            return True
        frame = frame.f_back
    return False
