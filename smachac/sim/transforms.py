"""Poses: positions in metres, quaternions x y z w, plain floats.

A pose is written `[[x, y, z], [qx, qy, qz, qw]]` in scripts and held as two tuples here.
"""

import math
from collections.abc import Iterable, Sequence
from typing import Any, TypeAlias

Vector: TypeAlias = tuple[float, float, float]
Quaternion: TypeAlias = tuple[float, float, float, float]
Pose: TypeAlias = tuple[Vector, Quaternion]

IDENTITY: Pose = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


def as_pose(value: Any) -> Pose:
    """`value`, a pose as scripts write it, checked and with its quaternion normalized.

    The quaternion may be left out; all zeros stands for no rotation, as many scripts mean it.
    Raises ValueError when the numbers are not three and four finite ones.
    """
    try:
        position, rotation = value if len(value) == 2 else (value, IDENTITY[1])
        p = [float(each) for each in position]
        q = [float(each) for each in rotation]
    except (TypeError, ValueError):
        raise ValueError(f"not a pose [[x, y, z], [qx, qy, qz, qw]]: {value!r}") from None
    if len(p) != 3 or len(q) != 4 or not all(map(math.isfinite, p + q)):
        raise ValueError(f"not a pose [[x, y, z], [qx, qy, qz, qw]]: {value!r}")
    return (p[0], p[1], p[2]), _normalized(q)


def as_lists(pose: Pose) -> list[list[float]]:
    """The pose as scripts write it."""
    return [list(pose[0]), list(pose[1])]


def _normalized(q: Sequence[float]) -> Quaternion:
    norm = math.sqrt(sum(each * each for each in q))
    if norm == 0.0:
        return IDENTITY[1]
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


def multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    """The rotation `b` followed by `a`, both seen from the outer frame."""
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
    """`v` turned by `q`."""
    x, y, z, _ = multiply(multiply(q, (*v, 0.0)), conjugate(q))
    return (x, y, z)


def compose(outer: Pose, inner: Pose) -> Pose:
    """The pose `inner`, given in the frame `outer`, seen from where `outer` is given."""
    return add(outer[0], rotate(outer[1], inner[0])), multiply(outer[1], inner[1])


def inverse(pose: Pose) -> Pose:
    """The pose that undoes `pose`."""
    back = conjugate(pose[1])
    x, y, z = rotate(back, pose[0])
    return (-x, -y, -z), back


def add(a: Vector, b: Vector) -> Vector:
    """The sum of two vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def shifted(pose: Pose, offset: Pose) -> Pose:
    """`pose` moved and turned by `offset`, both along the axes of the frame it is given in."""
    return add(pose[0], offset[0]), multiply(offset[1], pose[1])


def angle_between(a: Quaternion, b: Quaternion) -> float:
    """The angle in rad between two rotations; by atan2, since acos is blind below 1e-3 rad."""
    x, y, z, w = multiply(a, conjugate(b))
    return 2.0 * math.atan2(math.hypot(x, y, z), abs(w))


def slerp(a: Quaternion, b: Quaternion, t: float) -> Quaternion:
    """The rotation `t` (0..1) of the short way from `a` to `b`, at even speed."""
    cosine = sum(x * y for x, y in zip(a, b, strict=True))
    if cosine < 0.0:
        b, cosine = (-b[0], -b[1], -b[2], -b[3]), -cosine
    half = math.acos(min(1.0, cosine))
    if half < 1e-6:
        return _normalized(tuple((1 - t) * x + t * y for x, y in zip(a, b, strict=True)))
    from_a, from_b = math.sin((1 - t) * half), math.sin(t * half)
    return _normalized(tuple(from_a * x + from_b * y for x, y in zip(a, b, strict=True)))


def straight(start: Pose, end: Pose, count: int) -> Iterable[Pose]:
    """`count` poses evenly along the straight line from `start` (left out) to `end`."""
    for k in range(1, count + 1):
        t = k / count
        x, y, z = ((1 - t) * a + t * b for a, b in zip(start[0], end[0], strict=True))
        yield (x, y, z), slerp(start[1], end[1], t)


def yaw_of(q: Quaternion) -> float:
    """The turn about the vertical axis, in rad."""
    x, y, z, w = q
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def about_z(yaw: float) -> Quaternion:
    """The rotation by `yaw` about the vertical axis."""
    return (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def grasp_pose(block_pose: Any, turn: float = 0.0) -> list[list[float]]:
    """The tool pose that grips a cube at `block_pose`: at its centre, tool straight down.

    A cube looks the same every quarter turn, so its yaw is folded into +-45 degrees and the wrist
    never turns further than it must. `turn` (rad) is the hand's own mounting, see robots.Limb.
    """
    position, rotation = as_pose(block_pose)
    yaw = yaw_of(rotation)
    folded = yaw - math.pi / 2 * round(yaw / (math.pi / 2))
    down = multiply(about_z(folded + turn), (1.0, 0.0, 0.0, 0.0))
    return as_lists((position, down))
