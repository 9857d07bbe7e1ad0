"""A lifecycle manager: each line of input is a transition of the node `machine`."""

import sys

import rclpy
from lifecycle_msgs.srv import ChangeState, GetState

TRANSITIONS = {"configure": 1, "cleanup": 2, "activate": 3, "deactivate": 4, "shutdown": 5}

rclpy.init()
node = rclpy.create_node("manager")
change = node.create_client(ChangeState, "/machine/change_state")
ask = node.create_client(GetState, "/machine/get_state")
change.wait_for_service()
ask.wait_for_service()
print("ready", flush=True)
for line in sys.stdin:
    name = line.strip()
    if name in TRANSITIONS:
        request = ChangeState.Request()
        request.transition.id = TRANSITIONS[name]
        future = change.call_async(request)
        rclpy.spin_until_future_complete(node, future)
        print(name, "done" if future.result().success else "failed", flush=True)
    else:  # wait for a state
        label = ""
        while label != name:
            future = ask.call_async(GetState.Request())
            rclpy.spin_until_future_complete(node, future)
            label = future.result().current_state.label
        print("is", label, flush=True)
rclpy.try_shutdown()
