"""A plain action client: each line of input is an order to send, or `cancel`."""

import sys
import threading

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
handles = []


def show_feedback(message):
    print("feedback", list(message.feedback.sequence), flush=True)


def show_result(future):
    response = future.result()
    print("ended", NAMES[response.status], list(response.result.sequence), flush=True)


def show_handle(future):
    handle = future.result()
    print("accepted" if handle.accepted else "rejected", flush=True)
    handles.append(handle)
    handle.get_result_async().add_done_callback(show_result)


for line in sys.stdin:
    if line.strip() == "cancel":
        handles[-1].cancel_goal_async()
    else:
        goal = Fibonacci.Goal(order=int(line))
        client.send_goal_async(goal, feedback_callback=show_feedback).add_done_callback(show_handle)
rclpy.try_shutdown()
