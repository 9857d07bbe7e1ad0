"""Quality of service of topics: profiles of rclpy from the values that a script states."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from smachac.runtime import ros2_qos
from smachac.runtime.smach_ros2 import ros


def profile(value: Any = None) -> Any:
    """The QoSProfile for None (depth 10), a depth, a preset, a mapping of policies, or a profile.

    Raises ValueError that names what is wrong.
    """
    module = ros.load("rclpy.qos")
    if isinstance(value, module.QoSProfile):
        return value
    if faults := ros2_qos.faults(value):
        raise ValueError("; ".join(fault.text for fault in faults))
    policies = ros2_qos.policies(value)
    enums = {
        "reliability": module.ReliabilityPolicy,
        "durability": module.DurabilityPolicy,
        "history": module.HistoryPolicy,
    }
    chosen: Mapping[str, Any] = {
        key: enums[key][str(policy).upper()] if key in enums else policy
        for key, policy in policies.items()
    }
    return module.QoSProfile(**chosen)
