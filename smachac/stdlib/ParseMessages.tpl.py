{% block meta %}
name: ParseMessages
description: Functions that convert lists of numbers to messages.
type: None
{% endblock meta %}
{% include "MessageFields.tpl.py" %}
{% block imports %}
import io

import genpy
import rospy
from geometry_msgs.msg import Point, Point32, PointStamped, Pose, PoseArray, PoseStamped, Quaternion, Transform, TransformStamped, Vector3
from sensor_msgs.msg import PointCloud, PointCloud2, PointField
{% endblock %}
{% block defs %}
def parse_point(data):
    """Convert `[x, y, z]`, a Point, a Point32 or a PointStamped to a Point."""
    if isinstance(data, PointStamped):
        return data.point
    if isinstance(data, Point):
        return data
    if isinstance(data, Point32):
        return Point(data.x, data.y, data.z)
    x, y, z = map(float, data)
    return Point(x, y, z)


def parse_pose(data):
    """Convert `[[x, y, z], [qx, qy, qz, qw]]`, a Pose or a PoseStamped to a Pose."""
    if isinstance(data, PoseStamped):
        return data.pose
    if isinstance(data, Pose):
        return data
    position, orientation = data
    return Pose(parse_point(position), Quaternion(*map(float, orientation)))


def stamped(kind, part, data, value):
    """`data` if its type is `kind`, else a message with the value and a time stamp."""
    if isinstance(data, kind):
        return data
    message = kind(**{part: value})
    message.header.stamp = rospy.Time.now()
    return message


def parse_pointstamped(data):
    """Convert a PointStamped, or an argument of `parse_point`, to a PointStamped."""
    return stamped(PointStamped, "point", data, parse_point(data))


def parse_posestamped(data):
    """Convert a PoseStamped, or an argument of `parse_pose`, to a PoseStamped."""
    return stamped(PoseStamped, "pose", data, parse_pose(data))


def parse_posearray(data):
    """Convert a list of poses or a PoseArray to a PoseArray."""
    if isinstance(data, PoseArray):
        return data
    return stamped(PoseArray, "poses", data, [parse_pose(each) for each in data])


def parse_pointcloud(data):
    """Convert a list of points or a PointCloud to a PointCloud."""
    if isinstance(data, PointCloud):
        return data
    points = [Point32(*map(float, each)) for each in data]
    return stamped(PointCloud, "points", data, points)


def parse_pointcloud2(data):
    """Convert a list of points or a PointCloud2 to a PointCloud2."""
    if isinstance(data, PointCloud2):
        return data
    points = [tuple(map(float, each)) for each in data]
    fields = [
        PointField(name, 4 * place, PointField.FLOAT32, 1)
        for place, name in enumerate("xyz")
    ]
    message = PointCloud2(
        height=1,
        width=len(points),
        fields=fields,
        is_bigendian=False,
        point_step=12,
        row_step=12 * len(points),
        data=b"".join(struct.pack("<fff", *point) for point in points),
        is_dense=True,
    )
    message.header.stamp = rospy.Time.now()
    return message


def parse_transformstamped(data):
    """Convert a transform to a TransformStamped.

    `data`: `[[x, y, z], [qx, qy, qz, qw]]`, a Transform or a TransformStamped.
    """
    if isinstance(data, TransformStamped):
        return data
    if not isinstance(data, Transform):
        translation, rotation = data
        data = Transform(
            Vector3(*map(float, translation)), Quaternion(*map(float, rotation))
        )
    return TransformStamped(transform=data)


def checked(message):
    """Return a message. Raises ValueError, with the path, if a value does not fit its field."""
    try:
        message.serialize(io.BytesIO())
    except (genpy.SerializationError, OverflowError) as error:
        raise ValueError(f"{message._type}: {error}") from None
    return message


PARSERS = {
    "geometry_msgs/Point": parse_point,
    "geometry_msgs/PointStamped": parse_pointstamped,
    "geometry_msgs/Pose": parse_pose,
    "geometry_msgs/PoseStamped": parse_posestamped,
    "geometry_msgs/PoseArray": parse_posearray,
    "sensor_msgs/PointCloud": parse_pointcloud,
    "sensor_msgs/PointCloud2": parse_pointcloud2,
}


def parse_message(data, kind=None):
    """Convert lists of numbers, or a mapping of fields, to a message of type `kind`.

    A message of this type stays as it is. Without `kind`, the shape of the lists determines the
    message type, and a Point or a Pose becomes a stamped message. Raises TypeError or ValueError
    if the values do not fit.
    """
    if kind is None and isinstance(data, (Point, Point32)):
        return parse_pointstamped(data)
    if kind is None and isinstance(data, Pose):
        return parse_posestamped(data)
    if kind is None and hasattr(data, "_type"):
        return data
    if kind is not None:
        wanted = message_class(kind)
        if isinstance(data, wanted):
            return data
        if isinstance(data, dict) or wanted._type not in PARSERS:
            return filled(wanted(), data)
        return PARSERS[wanted._type](data)
    if isinstance(data, dict):
        raise TypeError("a mapping needs the key msg_type")
    if len(data) == 2 and len(data[0]) == 3 and len(data[1]) == 4:
        return parse_posestamped(data)
    if len(data) == 3 and all(isinstance(each, (int, float)) for each in data):
        return parse_pointstamped(data)
    if all(len(each) == 3 for each in data):
        return parse_pointcloud2(data)
    return parse_posearray(data)
{% endblock %}
