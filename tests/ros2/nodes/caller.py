"""A plain action client: each line of input is an order to send, or `cancel`."""

import sys
import threading
from typing import Any

import rclpy
from rclpy.action import ActionClient
from test_msgs.action import Fibonacci

NAMES = {4: "succeeded", 5: "canceled", 6: "aborted"}

rclpy.init()
node = rclpy.create_node("caller")
client = ActionClient(node, Fibonacci, "machine")
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
client.wait_for_server()
print("ready", flush=True)
handles: list[Any] = []


def show_feedback(message: Any) -> None:
    print("feedback", list(message.feedback.sequence), flush=True)


def show_result(future: Any) -> None:
    response = future.result()
    print("ended", NAMES[response.status], list(response.result.sequence), flush=True)


def show_handle(future: Any) -> None:
    handle = future.result()
    handles.append(handle)
    print("accepted" if handle.accepted else "rejected", flush=True)
    handle.get_result_async().add_done_callback(show_result)


for line in sys.stdin:
    if line.strip() == "cancel":
        handles[-1].cancel_goal_async()
    else:
        goal = Fibonacci.Goal(order=int(line))
        client.send_goal_async(goal, feedback_callback=show_feedback).add_done_callback(show_handle)
rclpy.try_shutdown()
