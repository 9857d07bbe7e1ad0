"""The ROS states of SMACH's smach_ros, for machines whose ROS 1 came without SMACH, as Debian's.

`from smachac.runtime import smach, smach_ros` stands for `import smach, smach_ros`: the same names,
over rospy and actionlib. These are imported when the first state is made, so this module can be
imported without ROS; making a state then raises ImportError, which says what to install.
docs/ros.md lists what differs from smach_ros.
"""

from __future__ import annotations

from . import (
    action_server_wrapper,
    condition_state,
    introspection,
    monitor_state,
    service_state,
    simple_action_state,
    util,
    watch,
)
from .action_server_wrapper import ActionServerWrapper
from .condition_state import ConditionState
from .introspection import IntrospectionClient, IntrospectionServer
from .monitor_state import MonitorState
from .service_state import ServiceState
from .simple_action_state import SimpleActionState
from .util import set_preempt_handler

__all__ = [
    "ActionServerWrapper",
    "ConditionState",
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
    "watch",
]
