"""Messages of geometry_msgs and sensor_msgs from lists of numbers, and their rotation and shift."""

from __future__ import annotations

import copy
import struct
from collections.abc import Mapping, Sequence
from typing import Any

from smachac.runtime.smach_ros2 import ros
from smachac.runtime.smach_ros2.interfaces import message_class
from smachac.runtime.smach_ros2.message_fields import checked, filled, is_message

Vector = tuple[float, float, float]


def parse_message(value: Any, kind: str | None = None, node: Any = None) -> Any:
    """A message from a message, a mapping or lists of numbers.

    `kind` is its type, such as `geometry_msgs/Pose`. Without it, the shape of the lists determines
    it: `[x, y, z]` is a PointStamped, `[[x, y, z], [x, y, z, w]]` a PoseStamped, a list of points a
    PointCloud2, a list of poses a PoseArray. The values of its fields have the types of the fields.
    Raises TypeError or ValueError for other values.
    """
    if is_message(value):
        kind_of_value = type(value) if kind is None else message_class(kind)
        message = checked(value, kind_of_value, "msg")
        return message if kind is not None else _stamped_message(message, node)
    if kind is None:
        if isinstance(value, Mapping):
            raise ValueError("a mapping needs the key `msg_type`")
        kind = _kind(value)
    made = message_class(kind)()
    name = type(made).__name__
    if name == "PointCloud2" and not isinstance(value, Mapping):
        _set_points(made, [tuple(map(float, point)) for point in value])
    elif name in _PARTS and not isinstance(value, Mapping):
        filled(made, {_PARTS[name]: value}, "msg")
    else:
        filled(made, value, "msg")
    return _now(made, node)


_PARTS = {
    "PointStamped": "point",
    "PoseStamped": "pose",
    "PoseArray": "poses",
    "PointCloud": "points",
}
"""The field with the value, of messages that have a header too."""


def _kind(value: Sequence[Any]) -> str:
    if len(value) == 3 and all(isinstance(item, (int, float)) for item in value):
        return "geometry_msgs/PointStamped"
    if len(value) == 2 and len(value[0]) == 3 and len(value[1]) == 4:
        return "geometry_msgs/PoseStamped"
    return "sensor_msgs/PointCloud2" if all(len(item) == 3 for item in value) else _POSES


_POSES = "geometry_msgs/PoseArray"


def _stamped_message(value: Any, node: Any) -> Any:
    """A Point or Pose as a stamped message; other messages as they are."""
    part = {"Point": "point", "Pose": "pose"}.get(type(value).__name__)
    if part is None:
        return value
    made = message_class(f"geometry_msgs/{type(value).__name__}Stamped")()
    setattr(made, part, value)
    return _now(made, node)


def _now(message: Any, node: Any) -> Any:
    if node is not None and hasattr(message, "header"):
        message.header.stamp = node.get_clock().now().to_msg()
    return message


def _set_points(cloud: Any, points: Sequence[tuple[float, ...]]) -> None:
    """Make a PointCloud2 of points."""
    field = ros.load("sensor_msgs.msg").PointField
    cloud.height, cloud.width = 1, len(points)
    cloud.fields = [
        field(name=name, offset=4 * place, datatype=field.FLOAT32, count=1)
        for place, name in enumerate("xyz")
    ]
    cloud.is_bigendian, cloud.is_dense = False, True
    cloud.point_step, cloud.row_step = 12, 12 * len(points)
    cloud.data = b"".join(struct.pack("<fff", *point) for point in points)


def transformed(message: Any, transform: Any) -> Any:
    """A copy of a message after a transform (TransformStamped). Raises TypeError for other types.

    The types: Point, Pose, their stamped messages, PoseArray, PointCloud and PointCloud2 with the
    fields x, y and z of 32 bits.
    """
    result = copy.deepcopy(message)
    apply = _Transform(transform.transform)
    match type(message).__name__:
        case "Point" | "Point32":
            apply.point(result)
        case "PointStamped":
            apply.point(result.point)
        case "Pose":
            apply.pose(result)
        case "PoseStamped":
            apply.pose(result.pose)
        case "PoseArray":
            for pose in result.poses:
                apply.pose(pose)
        case "PointCloud":
            for point in result.points:
                apply.point(point)
        case "PointCloud2":
            apply.cloud(result)
        case name:
            raise TypeError(f"the type {name} is not supported")
    if hasattr(result, "header"):
        result.header = copy.deepcopy(transform.header)
    return result


class _Transform:
    """A rotation, then a shift. Quaternions are (x, y, z, w)."""

    def __init__(self, transform: Any) -> None:
        shift, turn = transform.translation, transform.rotation
        self._shift = (shift.x, shift.y, shift.z)
        self._turn = (turn.x, turn.y, turn.z, turn.w)

    def moved(self, vector: Vector) -> Vector:
        x, y, z, w = self._turn
        rotated = _product(_product(self._turn, (*vector, 0.0)), (-x, -y, -z, w))
        a, b, c = self._shift
        return rotated[0] + a, rotated[1] + b, rotated[2] + c

    def point(self, point: Any) -> None:
        point.x, point.y, point.z = self.moved((point.x, point.y, point.z))

    def pose(self, pose: Any) -> None:
        self.point(pose.position)
        turn = pose.orientation
        turned = _product(self._turn, (turn.x, turn.y, turn.z, turn.w))
        turn.x, turn.y, turn.z, turn.w = turned

    def cloud(self, cloud: Any) -> None:
        places = {field.name: field.offset for field in cloud.fields}
        offsets = [places[name] for name in "xyz"]
        order = ">" if cloud.is_bigendian else "<"
        data = bytearray(cloud.data)
        for start in range(0, len(data), cloud.point_step):
            old = tuple(struct.unpack_from(f"{order}f", data, start + at)[0] for at in offsets)
            for at, value in zip(offsets, self.moved((old[0], old[1], old[2])), strict=True):
                struct.pack_into(f"{order}f", data, start + at, value)
        cloud.data = bytes(data)


def _product(
    p: tuple[float, float, float, float], q: tuple[float, float, float, float]
) -> tuple[float, float, float, float]:
    """The product of two quaternions."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (
        d * e + a * h + b * g - c * f,
        d * f - a * g + b * h + c * e,
        d * g + a * f - b * e + c * h,
        d * h - a * e - b * f - c * g,
    )
