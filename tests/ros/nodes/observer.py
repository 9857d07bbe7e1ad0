"""Prints what an introspection server tells, and orders containers to start elsewhere."""

from __future__ import annotations

import base64
import os
import pickle
import sys
from typing import Any

import rospy
from client import say

from smachac.runtime.smach_ros import messages


class Bomb:
    """What makes a folder when it is unpickled."""

    def __reduce__(self) -> Any:
        return os.mkdir, (sys.argv[1],)


def structure(message: Any) -> None:
    lists = message.internal_outcomes, message.outcomes_from, message.outcomes_to
    edges = list(zip(*lists, strict=True))
    parts = [message.path, message.children, edges, message.container_outcomes]
    say(f"structure {' '.join(map(str, parts))}")


def status(message: Any) -> None:
    data = pickle.loads(base64.b64decode(message.local_data))
    parts = [message.path, message.initial_states, message.active_states, data, message.info]
    say(f"status {' '.join(map(str, parts))}")


def order(path: str, label: str, data: Any) -> None:
    """Order a container to start in this state."""
    text = base64.b64encode(pickle.dumps(data, 2)).decode()
    orders.publish(path=path, initial_states=[label], local_data=text)


rospy.init_node("observer")
rospy.Subscriber("sis/smach/container_structure", messages.container_structure(), structure)
rospy.Subscriber("sis/smach/container_status", messages.container_status(), status)
orders = rospy.Publisher(
    "sis/smach/container_init", messages.initial_status_command(), queue_size=10
)
say("ready")
while text := os.read(0, 1000).decode():
    for line in text.splitlines():
        path, label, kind = line.split()
        while not orders.get_num_connections():
            rospy.rostime.wallsleep(0.01)
        order(path, label, {"seen": Bomb()} if kind == "bomb" else {"seen": "told"})
