"""Definitions of messages and services of every installation of ROS, for machines without one.

Fields and types are those of std_msgs, std_srvs and geometry_msgs, which are the same in ROS 1
(wiki.ros.org/std_msgs, wiki.ros.org/geometry_msgs) and ROS 2 (docs.ros.org, common_interfaces).
Types whose fields differ are left out: std_msgs/Header, Time and Duration.
"""

from __future__ import annotations

from collections.abc import Mapping

_PLAIN = {
    "Bool": "bool", "Byte": "byte", "Char": "char", "String": "string",
    "Float32": "float32", "Float64": "float64",
    "Int8": "int8", "Int16": "int16", "Int32": "int32", "Int64": "int64",
    "UInt8": "uint8", "UInt16": "uint16", "UInt32": "uint32", "UInt64": "uint64",
}  # fmt: skip
"""The messages of std_msgs with the one field `data`, and its type."""

_XYZ = "float64 x\nfloat64 y\nfloat64 z\n"
_DONE = "bool success\nstring message\n"

STANDARD: Mapping[str, str] = {
    **{f"std_msgs/msg/{name}.msg": f"{type_} data\n" for name, type_ in _PLAIN.items()},
    "std_msgs/msg/ColorRGBA.msg": "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n",
    "std_msgs/msg/Empty.msg": "",
    "std_srvs/srv/Empty.srv": "---\n",
    "std_srvs/srv/SetBool.srv": f"bool data\n---\n{_DONE}",
    "std_srvs/srv/Trigger.srv": f"---\n{_DONE}",
    "geometry_msgs/msg/Point.msg": _XYZ,
    "geometry_msgs/msg/Vector3.msg": _XYZ,
    "geometry_msgs/msg/Quaternion.msg": f"{_XYZ}float64 w\n",
    "geometry_msgs/msg/Pose.msg": "Point position\nQuaternion orientation\n",
    "geometry_msgs/msg/Transform.msg": "Vector3 translation\nQuaternion rotation\n",
    "geometry_msgs/msg/Twist.msg": "Vector3 linear\nVector3 angular\n",
    "geometry_msgs/msg/PoseStamped.msg": "std_msgs/Header header\nPose pose\n",
    "geometry_msgs/msg/TwistStamped.msg": "std_msgs/Header header\nTwist twist\n",
}
"""The text of each definition by its path, `package/msg/Name.msg`."""
