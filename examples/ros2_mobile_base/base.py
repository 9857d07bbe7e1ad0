"""A simulated mobile base as a ROS 2 node: it drives to places, reports its battery, and docks.

- action `drive` (test_msgs/NestedMessage): `nested_field.float64_value` and `float32_value` are x
  and y in metres. It is the only action on PyPI that has such numbers; a robot has its own.
- topic `battery` (sensor_msgs/BatteryState), 10 Hz, best effort
- service `dock` (std_srvs/Trigger): fails unless the base is within 0.1 m of (0, 0)

Parameters: `speed` (m/s), `charge` (0 to 1), `range` (metres with a full battery).
"""

import math
import time
from contextlib import suppress

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState
from std_srvs.srv import Trigger
from test_msgs.action import NestedMessage

PERIOD = 0.05


class MobileBase(Node):
    def __init__(self):
        super().__init__("mobile_base")
        self.speed = self.declare_parameter("speed", 1.0).value
        self.charge = self.declare_parameter("charge", 1.0).value
        self.range = self.declare_parameter("range", 20.0).value
        self.x = self.y = 0.0
        self.battery = self.create_publisher(BatteryState, "battery", qos_profile_sensor_data)
        self.create_timer(0.1, self.report)
        self.create_service(Trigger, "dock", self.dock)
        self.server = ActionServer(
            self,
            NestedMessage,
            "drive",
            self.drive,
            callback_group=ReentrantCallbackGroup(),
            cancel_callback=lambda goal: CancelResponse.ACCEPT,
        )

    def report(self):
        self.battery.publish(BatteryState(percentage=self.charge))

    def drive(self, goal):
        """Drive in a straight line; stop where the goal is cancelled or the battery is empty."""
        wanted = goal.request.nested_field
        x, y = wanted.float64_value, wanted.float32_value
        self.get_logger().info(f"drive to ({x:.1f}, {y:.1f})")
        feedback, result = NestedMessage.Feedback(), NestedMessage.Result()
        while (left := math.hypot(x - self.x, y - self.y)) > 0.001:
            if goal.is_cancel_requested:
                goal.canceled()
                self.get_logger().info("cancelled")
                return result
            if self.charge <= 0:
                goal.abort()
                return result
            step = min(left, self.speed * PERIOD)
            self.x += (x - self.x) * step / left
            self.y += (y - self.y) * step / left
            self.charge = max(0.0, self.charge - step / self.range)
            feedback.nested_field.float64_value = self.x
            feedback.nested_field.float32_value = self.y
            goal.publish_feedback(feedback)
            time.sleep(PERIOD)
        goal.succeed()
        return result

    def dock(self, request, response):
        response.success = math.hypot(self.x, self.y) < 0.1
        response.message = "docked" if response.success else "the dock is too far away"
        return response


def main():
    rclpy.init()
    base = MobileBase()
    executor = MultiThreadedExecutor()
    executor.add_node(base)
    base.get_logger().info("ready")
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        executor.spin()


if __name__ == "__main__":
    main()
