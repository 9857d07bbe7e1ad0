"""Joint limits: the angles of a literal that are outside the limits of their joints."""

from __future__ import annotations

from smachac.analysis.type_inference import TypeFlow
from smachac.checks.robot.literal_parts import as_float
from smachac.ir.nodes import Data, Struct, is_number

TYPE_CHECKING = False  # annotations only: few scripts have a robot
if TYPE_CHECKING:
    from smachac.ir.robot import Joint, Robot

JOINT_TOLERANCE = 1e-4
"""Tolerance for joint limits in rad or m: they are given with four decimals."""


def joint_faults(flow: TypeFlow, robot: Robot) -> list[tuple[int, Joint, Data]]:
    """The angles of a literal that are outside the limits of their joints, each with the number of
    the joint."""
    return [
        (number, joint, angle)
        for number, (joint, angle) in enumerate(_angles(flow.value, robot), 1)
        if is_number(angle) and not within_limits(joint, as_float(angle))
    ]


def within_limits(joint: Joint, angle: float) -> bool:
    """Whether a joint can have an angle (rad) or position (m), up to `JOINT_TOLERANCE`."""
    return joint.lower - JOINT_TOLERANCE <= angle <= joint.upper + JOINT_TOLERANCE


def _angles(value: Data, robot: Robot) -> list[tuple[Joint, Data]]:
    """The angles of a literal with their joints; for a list, the joints of the limb of that length
    with the fewest angles outside the limits."""
    if isinstance(value, Struct):
        joints = {joint.name: joint for joint in robot.joints}
        return [(joints[name], angle) for name, angle in value.entries if name in joints]
    assert isinstance(value, tuple)
    limbs = [limb for limb in robot.limbs if len(limb) == len(value)]
    pairs = [list(zip(limb, value, strict=True)) for limb in limbs]
    return min(pairs, key=_misses, default=[])


def _misses(pairs: list[tuple[Joint, Data]]) -> int:
    return sum(not within_limits(joint, as_float(angle)) for joint, angle in pairs)
