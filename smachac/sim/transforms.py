"""Poses and rotations: positions in m, unit quaternions x y z w, angles in rad, plain floats.

A pose is written `[[x, y, z], [qx, qy, qz, qw]]` in scripts and held as two tuples here.
"""

import math
from collections.abc import Iterable, Sequence
from typing import Any

from smachac.robots.description import DOWN
from smachac.robots.fields import IDENTITY as IDENTITY
from smachac.robots.fields import Pose as Pose
from smachac.robots.fields import Quaternion as Quaternion
from smachac.robots.fields import Vector as Vector


def as_pose(value: Any) -> Pose:
    """The pose in `value`, which is written as in scripts; its quaternion is normalized.

    A message of ROS, with the attributes `position` and `orientation`, is read too.
    The quaternion may be left out; four zeros mean no rotation, as in many scripts.
    Raises ValueError unless there are three and four finite numbers.
    """
    if hasattr(value, "pose"):
        value = value.pose
    if hasattr(value, "position"):
        p, q = value.position, value.orientation
        value = [[p.x, p.y, p.z], [q.x, q.y, q.z, q.w]]
    try:
        position, rotation = value if len(value) == 2 else (value, IDENTITY[1])
        place = [float(item) for item in position]
        turn = [float(value) for value in rotation]
    except (TypeError, ValueError):
        raise ValueError(f"not a pose [[x, y, z], [qx, qy, qz, qw]]: {value!r}") from None
    if len(place) != 3 or len(turn) != 4 or not all(map(math.isfinite, place + turn)):
        raise ValueError(f"not a pose [[x, y, z], [qx, qy, qz, qw]]: {value!r}")
    return (place[0], place[1], place[2]), _normalized(turn)


def as_lists(pose: Pose) -> list[list[float]]:
    """The pose `[[x, y, z], [qx, qy, qz, qw]]`, as it is written in scripts."""
    return [list(pose[0]), list(pose[1])]


def _normalized(q: Sequence[float]) -> Quaternion:
    norm = math.sqrt(sum(number * number for number in q))
    if norm == 0.0:
        return IDENTITY[1]
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """The Hamilton product a b: the rotation `b`, then `a`, about the axes of the outer frame."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def conjugate(q: Quaternion) -> Quaternion:
    """The inverse of a unit quaternion."""
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q: Quaternion, v: Vector) -> Vector:
    """The vector `v` rotated by `q`."""
    x, y, z, _ = multiply(multiply(q, (*v, 0.0)), conjugate(q))
    return (x, y, z)


def compose(outer: Pose, inner: Pose) -> Pose:
    """The pose `inner` of the frame `outer`, seen from the frame that `outer` is given in."""
    return add(outer[0], rotate(outer[1], inner[0])), multiply(outer[1], inner[1])


def inverse(pose: Pose) -> Pose:
    """The inverse transform: composed with `pose` it is the identity."""
    back = conjugate(pose[1])
    x, y, z = rotate(back, pose[0])
    return (-x, -y, -z), back


def add(a: Vector, b: Vector) -> Vector:
    """The sum of two vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def shifted(pose: Pose, offset: Pose) -> Pose:
    """`pose` moved and rotated by `offset`, along and about the axes of the frame of `pose`."""
    return add(pose[0], offset[0]), multiply(offset[1], pose[1])


def angle_between(a: Quaternion, b: Quaternion) -> float:
    """The angle (rad) between two rotations; by atan2, because acos is inexact below 1e-3 rad."""
    x, y, z, w = multiply(a, conjugate(b))
    return 2.0 * math.atan2(math.hypot(x, y, z), abs(w))


def slerp(a: Quaternion, b: Quaternion, t: float) -> Quaternion:
    """Spherical linear interpolation: the rotation at the fraction `t` (0..1) from `a` to `b`."""
    cosine = sum(x * y for x, y in zip(a, b, strict=True))
    if cosine < 0.0:
        b, cosine = (-b[0], -b[1], -b[2], -b[3]), -cosine
    half = math.acos(min(1.0, cosine))
    if half < 1e-6:
        return _normalized(tuple((1 - t) * x + t * y for x, y in zip(a, b, strict=True)))
    from_a, from_b = math.sin((1 - t) * half), math.sin(t * half)
    return _normalized(tuple(from_a * x + from_b * y for x, y in zip(a, b, strict=True)))


def straight(start: Pose, end: Pose, count: int) -> Iterable[Pose]:
    """`count` evenly spaced poses on the straight line from `start` (not included) to `end`."""
    for k in range(1, count + 1):
        t = k / count
        x, y, z = ((1 - t) * a + t * b for a, b in zip(start[0], end[0], strict=True))
        yield (x, y, z), slerp(start[1], end[1], t)


def yaw_of(q: Quaternion) -> float:
    """The yaw of a rotation (rad): the angle about the vertical axis."""
    x, y, z, w = q
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def from_rpy(roll: float, pitch: float, yaw: float) -> Quaternion:
    """The rotation by `roll`, then `pitch`, then `yaw` (rad) about the fixed axes x, y and z."""
    x = (math.sin(roll / 2), 0.0, 0.0, math.cos(roll / 2))
    y = (0.0, math.sin(pitch / 2), 0.0, math.cos(pitch / 2))
    return multiply(about_z(yaw), multiply(y, x))


def about_z(yaw: float) -> Quaternion:
    """The rotation by `yaw` (rad) about the vertical axis."""
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def grasp_pose(block_pose: Any, grasp: Pose = DOWN) -> list[list[float]]:
    """The tool pose that grips a cube at `block_pose`, for an upright cube.

    A cube is symmetric under quarter turns, so its yaw is reduced to +-45 degrees, the smallest
    rotation of the wrist. `grasp` is the pose of the tool in the frame of the cube, see
    robots.Limb. Raises ValueError for a value that is no pose.
    """
    position, rotation = as_pose(block_pose)
    yaw = yaw_of(rotation)
    folded = yaw - math.pi / 2 * round(yaw / (math.pi / 2))
    return as_lists(compose((position, about_z(folded)), grasp))


def nearest_turn(angle: float, other: float) -> float:
    """The angle (rad) plus whole turns that is nearest to `other`: at most half a turn from it."""
    return other + math.remainder(angle - other, 2.0 * math.pi)
