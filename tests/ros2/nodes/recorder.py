"""A node that prints the texts on a topic as they are on the wire, and reports when each of some
words was in one of them.

Its arguments: the topic, the words. At the first text it publishes `go`.
"""

import sys

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

topic, *words = sys.argv[1:]
missing = set(words)
rclpy.init()
node = rclpy.create_node("recorder")
latched = QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL)
start = node.create_publisher(String, "go", latched)
received: list[bytes] = []


def keep(data: bytes) -> None:
    """Print one message; the first one starts the machine."""
    if not received:
        start.publish(String(data="go"))
    received.append(data)
    print("message", data.hex(), flush=True)
    missing.difference_update([item for item in missing if item.encode() in data])
    if not missing:
        print("all are there", flush=True)


node.create_subscription(String, topic, keep, latched, raw=True)
print("ready", flush=True)
rclpy.spin(node)
