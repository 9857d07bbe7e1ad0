"""A publisher: `publisher.py TOPIC reliable|best_effort [latched]`; each line of input is a number
to publish once there is a subscription, or `cycle` and numbers to publish again and again."""

import itertools
import sys
import time

import rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Int32

rclpy.init()
node = rclpy.create_node("publisher")
profile = QoSProfile(depth=10, reliability=ReliabilityPolicy[sys.argv[2].upper()])
if "latched" in sys.argv:
    profile.durability = DurabilityPolicy.TRANSIENT_LOCAL
publisher = node.create_publisher(Int32, sys.argv[1], profile)
print("ready", flush=True)
for line in sys.stdin:
    if line.startswith("cycle"):
        for number in itertools.cycle(map(int, line.split()[1:])):
            publisher.publish(Int32(data=number))
            time.sleep(0.02)
    while not publisher.get_subscription_count() and "latched" not in sys.argv:
        rclpy.spin_once(node, timeout_sec=0.01)
    publisher.publish(Int32(data=int(line)))
    print("published", line.strip(), flush=True)
rclpy.try_shutdown()
