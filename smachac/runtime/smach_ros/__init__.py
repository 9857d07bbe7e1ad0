"""The ROS states of SMACH's smach_ros, for ROS 1 installations without SMACH, such as Debian's.

`from smachac.runtime import smach, smach_ros` replaces `import smach, smach_ros`: the public names
are the same, on top of rospy and actionlib. These are imported when the first state is made, so
this package can be imported without ROS; making a state then raises ImportError, whose message
contains the packages to install. docs/ros.md lists the differences from smach_ros.
"""

from __future__ import annotations

from smachac.runtime.smach_ros import (
    action_server_wrapper,
    condition_state,
    introspection,
    monitor_state,
    service_state,
    simple_action_state,
    util,
)
from smachac.runtime.smach_ros.action_server_wrapper import ActionServerWrapper
from smachac.runtime.smach_ros.condition_state import ConditionState
from smachac.runtime.smach_ros.introspection import (
    ContainerProxy,
    IntrospectionClient,
    IntrospectionServer,
)
from smachac.runtime.smach_ros.monitor_state import MonitorState
from smachac.runtime.smach_ros.service_state import ServiceState
from smachac.runtime.smach_ros.simple_action_state import SimpleActionState
from smachac.runtime.smach_ros.util import set_preempt_handler

__all__ = [
    "ActionServerWrapper",
    "ConditionState",
    "ContainerProxy",
    "IntrospectionClient",
    "IntrospectionServer",
    "MonitorState",
    "ServiceState",
    "SimpleActionState",
    "action_server_wrapper",
    "condition_state",
    "introspection",
    "monitor_state",
    "service_state",
    "set_preempt_handler",
    "simple_action_state",
    "util",
]
