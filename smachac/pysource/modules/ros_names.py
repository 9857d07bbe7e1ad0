"""Names of ROS in Python: its versions, and the modules and messages that code may use by name."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Literal

Ros = Literal[1, 2]
"""A major version of ROS, for which programs are generated."""

ROS_VERSIONS: tuple[Ros, ...] = (1, 2)
DEFAULT_ROS: Ros = 2

ROS_MODULES: Mapping[Ros, tuple[str, ...]] = {
    1: ("rospy", "roslib", "rospkg", "rostopic", "actionlib", "tf2_ros"),
    2: ("rclpy", "tf2_ros"),
}
"""Modules of ROS that code may use without an import: those that SMACHA's bases imported in every
program, and their successors."""

MESSAGES = {
    "geometry_msgs.msg": (
        "Point Point32 PointStamped Polygon Pose Pose2D PoseArray PoseStamped"
        " PoseWithCovarianceStamped Quaternion QuaternionStamped Transform TransformStamped Twist"
        " TwistStamped Vector3 Vector3Stamped Wrench WrenchStamped"
    ),
    "sensor_msgs.msg": (
        "CameraInfo CompressedImage Image Imu JointState Joy LaserScan PointCloud PointCloud2"
        " PointField Range"
    ),
    "std_msgs.msg": (
        "Bool ColorRGBA Duration Float32 Float64 Float64MultiArray Header Int16 Int32 Int64 Int8"
        " String UInt16 UInt32 UInt64 UInt8"
    ),
    "trajectory_msgs.msg": "JointTrajectory JointTrajectoryPoint",
    "nav_msgs.msg": "OccupancyGrid Odometry Path",
    "actionlib_msgs.msg": "GoalID GoalStatus",
    "actionlib": "ActionClient ActionServer SimpleActionClient SimpleActionServer",
}
"""The messages of the common packages of ROS, by module. Scripts call these names to make messages.
SMACHA's template for actions imported all names of actionlib."""

MODULE_OF: Mapping[Ros, Mapping[str, str]] = {
    1: {name: module for module, names in MESSAGES.items() for name in names.split()},
    2: {
        name: "builtin_interfaces.msg" if name == "Duration" else module
        for module, names in MESSAGES.items()
        if not module.startswith("actionlib")
        for name in names.split()
    },
}


def importable(ros: Ros) -> set[str]:
    """The names that a program may use without importing them. Modules of the other version of ROS
    are reported as such."""
    modules = (name for names in ROS_MODULES.values() for name in names)
    return {"smach", "smach_ros", *modules, *MODULE_OF[ros]}


def message_module(code: ast.Attribute) -> str | None:
    """The module of the class of a message that code names as `std_msgs.msg.Bool`; None if it is
    other code."""
    match code:
        case ast.Attribute(
            value=ast.Attribute(value=ast.Name(id=package), attr="msg" | "srv" | "action" as kind),
            attr=name,
        ) if name[0].isupper() and package.islower():
            return f"{package}.{kind}"
    return None
