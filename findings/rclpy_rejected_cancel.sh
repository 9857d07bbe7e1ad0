#!/usr/bin/env bash
# Subject: the answers of an action server of rclpy (9.1.2, ROS 2 Kilted; 7.1.6, Jazzy, answers the same).
#
# Guess before the run: a server that rejects a cancel request answers with return_code 1, because CancelGoal.srv says
# "ERROR_REJECTED=1: Indicates the request was rejected"; and a goal whose execute callback raises is aborted.
#
# Behaviour: the answer to a rejected request has return_code 0 (ERROR_NONE); only the empty list `goals_canceling`
# shows the rejection. If the callback raises after `goal.succeed()`, the client gets status 4 (SUCCEEDED) with an
# empty result; a raise before it gives status 6 (ABORTED).
#
# Output of 27 November 2026:
#   rejected cancel: return_code 0, goals_canceling 0
#   raised before succeed(): status 6 []
#   raised after succeed(): status 4 []
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
"${PYTHON:-python3}" -m venv venv
venv/bin/pip install -q ros-rclpy==9.1.2 ros-rmw-fastrtps-cpp==9.3.3 ros-test-msgs==2.3.0
export ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ROS_DOMAIN_ID=$((RANDOM % 100 + 1)) ROS_LOG_DIR=$folder/log
cat >node.py <<'PYTHON'
import threading

import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from test_msgs.action import Fibonacci

released = threading.Event()


def execute(goal):
    if goal.request.order == 0:
        released.wait()
    if goal.request.order != 1:
        goal.succeed()
    if goal.request.order != 0:
        raise RuntimeError("a fault of the server")
    return Fibonacci.Result(sequence=[0])


def finished(future):
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    done.wait()
    return future.result()


rclpy.init()
node = rclpy.create_node("both")
server = ActionServer(
    node, Fibonacci, "count", execute, callback_group=ReentrantCallbackGroup(),
    cancel_callback=lambda goal: CancelResponse.REJECT,
)
client = ActionClient(node, Fibonacci, "count", callback_group=ReentrantCallbackGroup())
executor = MultiThreadedExecutor(3)
executor.add_node(node)
threading.Thread(target=executor.spin, daemon=True).start()
client.wait_for_server()
goal = finished(client.send_goal_async(Fibonacci.Goal(order=0)))
answer = finished(goal.cancel_goal_async())
print(f"rejected cancel: return_code {answer.return_code}, "
      f"goals_canceling {len(answer.goals_canceling)}")
released.set()
finished(goal.get_result_async())
for order, when in (1, "before"), (2, "after"):
    goal = finished(client.send_goal_async(Fibonacci.Goal(order=order)))
    end = finished(goal.get_result_async())
    print(f"raised {when} succeed(): status {end.status} {list(end.result.sequence)}")
executor.shutdown()
rclpy.shutdown()
PYTHON
timeout 120 venv/bin/python node.py 2>errors | tee seen || cat errors
diff - seen <<'EXPECTED'
rejected cancel: return_code 0, goals_canceling 0
raised before succeed(): status 6 []
raised after succeed(): status 4 []
EXPECTED
