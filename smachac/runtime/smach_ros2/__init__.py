"""The ROS states of SMACH's smach_ros for ROS 2, under its public names, without its package.

`from smachac.runtime import smach, smach_ros2 as smach_ros` replaces `import smach, smach_ros`: the
names and arguments are those of SMACH for ROS 2, on top of rclpy. Importing this package imports
rclpy; ImportError names the packages to install. docs/ros.md lists the differences from smach_ros.
"""

from __future__ import annotations

from smachac.runtime.smach_ros2 import ros, util
from smachac.runtime.smach_ros2.action_server_wrapper import ActionServerWrapper
from smachac.runtime.smach_ros2.condition_state import ConditionState
from smachac.runtime.smach_ros2.introspection import (
    ContainerProxy,
    IntrospectionClient,
    IntrospectionServer,
)
from smachac.runtime.smach_ros2.monitor_state import MonitorState
from smachac.runtime.smach_ros2.node import SmachNode
from smachac.runtime.smach_ros2.ros_state import RosState
from smachac.runtime.smach_ros2.service_state import ServiceState
from smachac.runtime.smach_ros2.simple_action_state import SimpleActionState
from smachac.runtime.smach_ros2.util import set_preempt_handler

__all__ = [
    "ActionServerWrapper",
    "ConditionState",
    "ContainerProxy",
    "IntrospectionClient",
    "IntrospectionServer",
    "MonitorState",
    "RosState",
    "ServiceState",
    "SimpleActionState",
    "SmachNode",
    "set_preempt_handler",
    "util",
]

ros.connect_smach()
