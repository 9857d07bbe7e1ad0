"""The header of a robot, `robots/<name>.hpp`: the arms of its description as constants.

The types are in smachac/arm.hpp.
"""

from __future__ import annotations

from collections.abc import Iterator

from smachac.ir.robot import Arm, Joint, Robot
from smachac.robots.fields import Pose
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.types import UnportableError, cpp_float, cpp_literal
from smachac.version import __version__

ARMS, BASE = "arms", "base"
"""The names in the header beside those of the arms: all arms, the frame of the poses."""

Lines = Iterator[str]


def robot_file(robot: Robot) -> str:
    """The file name of the header of a robot."""
    return f"robots/{identifier(robot.name)}.hpp"


def robot_header(robot: Robot) -> str:
    """The header of a described robot. Raises UnportableError if two names in it are the same."""
    names = [_name(arm) for arm in robot.arms]
    _check_names(robot, names)
    scope = f"robots::{identifier(robot.name)}"
    lines = [
        f"// Made by smachac {__version__} from the description of the robot"
        f" {cpp_literal(robot.name)}: do not edit.",
        "// Lengths are in metres, angles in radians, speeds in rad/s.",
        "#pragma once",
        "",
        '#include "smachac/arm.hpp"',
        "",
        f"namespace {scope} {{",
        "",
        *(line for arm, name in zip(robot.arms, names, strict=True) for line in _arm(arm, name)),
        "/// All arms.",
        f"inline constexpr smachac::ArmDescription {ARMS}[] = {{{', '.join(names)}}};",
        "",
        "/// The frame in which poses are given, in the world.",
        f"inline constexpr smachac::Pose {BASE}{_pose(robot.base)};",
        "",
        f"}} // namespace {scope}",
    ]
    return "\n".join(lines) + "\n"


def _name(arm: Arm) -> str:
    """The constant of an arm."""
    word = identifier(arm.name)
    return f"{word}_" if word in (ARMS, BASE) else word


def _check_names(robot: Robot, names: list[str]) -> None:
    taken: dict[str, str] = {}
    for arm, name in zip(robot.arms, names, strict=True):
        for text in (name, f"{name}_joints", f"{name}_fingers"):
            if text in taken:
                raise UnportableError(
                    f"the arms `{taken[text]}` and `{arm.name}` of `{robot.name}` would both have"
                    f" the name `{text}`",
                    *("arm", taken[text], arm.name),
                )
            taken[text] = arm.name


def _arm(arm: Arm, name: str) -> Lines:
    """The constants of an arm."""
    limb, gripper = arm.limb, arm.limb.gripper
    yield f"inline constexpr smachac::JointDescription {name}_joints[] = {{"
    yield "    // name, lower, upper, speed, home, turns"
    for joint, home in zip(arm.joints, limb.home, strict=True):
        yield f"    {_joint(joint, home)},"
    yield "};"
    held = "std::nullopt"
    if gripper is not None:
        yield f"inline constexpr smachac::FingerDescription {name}_fingers[] = {{"
        yield "    // name, open, closed"
        for finger in gripper.fingers:
            values = ", ".join(map(cpp_float, (finger.opened, finger.closed)))
            yield f"    {{{cpp_literal(finger.joint)}, {values}}},"
        yield "};"
        closed, opened = map(cpp_float, gripper.width)
        held = f"smachac::GripperDescription{{{opened}, {closed}, {name}_fingers}}"
    yield f"/// The arm {cpp_literal(arm.name)}: joints, link, tool, grasp, base, gripper."
    yield f"inline constexpr smachac::ArmDescription {name}{{"
    yield f"    {cpp_literal(arm.name)},"
    yield f"    {name}_joints,"
    yield f"    {cpp_literal(limb.tip)},"
    for pose in (limb.offset, limb.grasp, arm.base):
        yield f"    {_pose(pose)},"
    yield f"    {held},"
    yield "};"
    yield ""


def _joint(joint: Joint, home: float) -> str:
    numbers = (joint.lower, joint.upper, joint.velocity, home)
    turns = "true" if joint.turns else "false"
    return f"{{{cpp_literal(joint.name)}, {', '.join(map(cpp_float, numbers))}, {turns}}}"


def _pose(pose: Pose) -> str:
    position, rotation = (", ".join(map(cpp_float, row)) for row in pose)
    return f"{{{{{position}}}, {{{rotation}}}}}"
