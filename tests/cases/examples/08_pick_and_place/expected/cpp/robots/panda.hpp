// Made by smachac 0.1.0 from the description of the robot "panda": do not edit.
// Lengths are in metres, angles in radians, speeds in rad/s.
#pragma once

#include "smachac/arm.hpp"

namespace robots::panda {

inline constexpr smachac::JointDescription arm_joints[] = {
    // name, lower, upper, speed, home, turns
    {"panda_joint1", -2.9671, 2.9671, 2.175, 0.0, true},
    {"panda_joint2", -1.8326, 1.8326, 2.175, -0.7853981633974483, true},
    {"panda_joint3", -2.9671, 2.9671, 2.175, 0.0, true},
    {"panda_joint4", -3.1416, 0.0, 2.175, -2.356194490192345, true},
    {"panda_joint5", -2.9671, 2.9671, 2.61, 0.0, true},
    {"panda_joint6", -0.0873, 3.8223, 2.61, 1.5707963267948966, true},
    {"panda_joint7", -2.9671, 2.9671, 2.61, 0.7853981633974483, true},
};
inline constexpr smachac::FingerDescription arm_fingers[] = {
    // name, open, closed
    {"panda_finger_joint1", 0.04, 0.0},
    {"panda_finger_joint2", 0.04, 0.0},
};
/// The arm "arm": joints, link, tool, grasp, base, gripper.
inline constexpr smachac::ArmDescription arm{
    "arm",
    arm_joints,
    "panda_grasptarget",
    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}},
    {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
    {{0.0, 0.0, 0.4}, {0.0, 0.0, 0.0, 1.0}},
    smachac::GripperDescription{0.08, 0.0, arm_fingers},
};

/// All arms.
inline constexpr smachac::ArmDescription arms[] = {arm};

/// The frame in which poses are given, in the world.
inline constexpr smachac::Pose base{{0.0, 0.0, 0.4}, {0.0, 0.0, 0.0, 1.0}};

} // namespace robots::panda
