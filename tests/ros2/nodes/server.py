"""A server: the action `work` and services; what it does depends on the goal.

Orders: 1 succeeds, 2 aborts, 3 is rejected, 4 runs until it is cancelled, 5 refuses to be cancelled
and runs until a line on the input, 6 accepts to be cancelled and never ends, 7 ends the process,
8 succeeds after three messages of feedback, 9 after these and a call of `trigger`. Each goal and
each cancel request is printed.
"""

import os
import sys
import threading
import time
from typing import Any

import rclpy
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.signals import SignalHandlerOptions
from std_srvs.srv import SetBool, Trigger
from test_msgs.action import Fibonacci

rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
node = rclpy.create_node("server")
group = ReentrantCallbackGroup()
released = threading.Event()
triggered = threading.Event()


def accept(goal: Any) -> Any:
    print(f"goal {goal.order}", flush=True)
    return GoalResponse.REJECT if goal.order == 3 else GoalResponse.ACCEPT


def cancel(handle: Any) -> Any:
    print(f"cancel {handle.request.order} at {time.monotonic():.6f}", flush=True)
    return CancelResponse.REJECT if handle.request.order == 5 else CancelResponse.ACCEPT


def execute(handle: Any) -> Any:
    order = handle.request.order
    if order == 7:
        os._exit(1)
    if order == 4:
        while not handle.is_cancel_requested:
            time.sleep(0.001)
        handle.canceled()
        return Fibonacci.Result(sequence=[4])
    if order in (5, 6):
        released.wait(60)
    if order in (8, 9):
        for number in range(3):
            handle.publish_feedback(Fibonacci.Feedback(sequence=[number]))
            time.sleep(0.02)
    if order == 9:
        triggered.wait(60)
    if order == 2:
        handle.abort()
    else:
        handle.succeed()
    return Fibonacci.Result(sequence=[order, 10])


def trigger(request: Any, response: Any) -> Any:
    triggered.set()
    response.success, response.message = True, "done"
    return response


def invert(request: Any, response: Any) -> Any:
    response.success, response.message = not request.data, str(request.data)
    return response


def hang(request: Any, response: Any) -> Any:
    print("called", flush=True)
    released.wait(60)
    response.message = "late"
    return response


def die(request: Any, response: Any) -> None:
    os._exit(1)


def release() -> None:
    for _ in sys.stdin:
        released.set()


ActionServer(
    node,
    Fibonacci,
    "work",
    execute,
    goal_callback=accept,
    cancel_callback=cancel,
    callback_group=group,
)
for name, kind, function in [
    ("trigger", Trigger, trigger),
    ("invert", SetBool, invert),
    ("hang", Trigger, hang),
    ("die", Trigger, die),
]:
    node.create_service(kind, name, function, callback_group=group)
threading.Thread(target=release, daemon=True).start()
executor = MultiThreadedExecutor(4)
executor.add_node(node)
print("ready", flush=True)
try:
    executor.spin()
except (KeyboardInterrupt, ExternalShutdownException):
    os._exit(0)
