"""What the programs of the tests share: a node, names, and a report at the end."""

import atexit
import sys
import threading
from collections.abc import Callable
from typing import Any

from rclpy.duration import Duration
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool, Trigger
from test_msgs.action import Fibonacci

from smachac.runtime import smach
from smachac.runtime import smach_ros2 as smach_ros
from smachac.runtime.smach_ros2 import program

__all__ = [
    "Duration",
    "Fibonacci",
    "Int32",
    "SetBool",
    "String",
    "Trigger",
    "after",
    "goal_state",
    "node",
    "on_line",
    "program",
    "report",
    "smach",
    "smach_ros",
]

node = program.start_node("machine")


def report(name: str, *values: object) -> None:
    """Print what a test reads: `name: values`."""
    print(f"{name}:", *values)


def after(seconds: float, action: Callable[[], object]) -> None:
    """Perform an action later."""
    timer = threading.Timer(seconds, action)
    timer.daemon = True
    timer.start()


def on_line(action: Callable[[], object]) -> None:
    """Perform an action when a line comes on the input, and report it."""

    def wait() -> None:
        sys.stdin.readline()
        action()
        report("requested")

    threading.Thread(target=wait, daemon=True).start()


def goal_state(order: int, **arguments: Any) -> Any:
    """A state that sends the goal `order` to the server of the tests."""
    goal = Fibonacci.Goal(order=order)
    return smach_ros.SimpleActionState(node, "work", Fibonacci, goal=goal, **arguments)


def finish() -> None:
    program.stop_node(node)
    left = [item.name for item in threading.enumerate() if item is not threading.main_thread()]
    print("threads left:", left)


atexit.register(finish)
