// Made by smachac 0.1.0 from the description of the robot "baxter": do not edit.
// Lengths are in metres, angles in radians, speeds in rad/s.
#pragma once

#include "smachac/arm.hpp"

namespace robots::baxter {

inline constexpr smachac::JointDescription left_joints[] = {
    // name, lower, upper, speed, home, turns
    {"left_s0", -1.70168, 1.70168, 1.5, -0.08, true},
    {"left_s1", -2.147, 1.047, 1.5, -0.99998, true},
    {"left_e0", -3.05418, 3.05418, 1.5, -1.18997, true},
    {"left_e1", -0.05, 2.618, 1.5, 1.94002, true},
    {"left_w0", -3.059, 3.059, 4.0, 0.67, true},
    {"left_w1", -1.5708, 2.094, 4.0, 1.03001, true},
    {"left_w2", -3.059, 3.059, 4.0, -0.5, true},
};
inline constexpr smachac::FingerDescription left_fingers[] = {
    // name, open, closed
    {"l_gripper_l_finger_joint", 0.020833, 0.0},
    {"l_gripper_r_finger_joint", -0.020833, 0.0},
};
/// The arm "left": joints, link, tool, grasp, base, gripper.
inline constexpr smachac::ArmDescription left{
    "left",
    left_joints,
    "left_gripper",
    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}},
    {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}},
    {{0.0, 0.0, 0.93}, {0.0, 0.0, 0.0, 1.0}},
    smachac::GripperDescription{0.057666, 0.016, left_fingers},
};

inline constexpr smachac::JointDescription right_joints[] = {
    // name, lower, upper, speed, home, turns
    {"right_s0", -1.70168, 1.70168, 1.5, 0.08, true},
    {"right_s1", -2.147, 1.047, 1.5, -0.99998, true},
    {"right_e0", -3.05418, 3.05418, 1.5, 1.18997, true},
    {"right_e1", -0.05, 2.618, 1.5, 1.94002, true},
    {"right_w0", -3.059, 3.059, 4.0, -0.67, true},
    {"right_w1", -1.5708, 2.094, 4.0, 1.03001, true},
    {"right_w2", -3.059, 3.059, 4.0, 0.5, true},
};
inline constexpr smachac::FingerDescription right_fingers[] = {
    // name, open, closed
    {"r_gripper_l_finger_joint", 0.020833, 0.0},
    {"r_gripper_r_finger_joint", -0.020833, 0.0},
};
/// The arm "right": joints, link, tool, grasp, base, gripper.
inline constexpr smachac::ArmDescription right{
    "right",
    right_joints,
    "right_gripper",
    {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 1.0}},
    {{0.0, 0.0, 0.0}, {0.0, 1.0, 0.0, 0.0}},
    {{0.0, 0.0, 0.93}, {0.0, 0.0, 0.0, 1.0}},
    smachac::GripperDescription{0.057666, 0.016, right_fingers},
};

/// All arms.
inline constexpr smachac::ArmDescription arms[] = {left, right};

/// The frame in which poses are given, in the world.
inline constexpr smachac::Pose base{{0.0, 0.0, 0.93}, {0.0, 0.0, 0.0, 1.0}};

} // namespace robots::baxter
