// A fake of the arm and of the table before it: geometry without physics, for trying a machine out
// before there is a robot. Everything is in the frame of the robot's base, in metres and radians.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "robots/panda.hpp"
#include "smachac/arm.hpp"

/// Tables, blocks and marks: poses by name.
class FakeWorld : public smachac::World {
public:
  explicit FakeWorld(std::uint64_t seed) : random_(seed) {}

  std::map<std::string, smachac::Pose> bodies;

  smachac::Pose scattered(const smachac::Pose &pose, const std::array<double, 3> &spread,
                          const std::map<std::string, double> &apart) override {
    std::uniform_real_distribution<double> side(-1.0, 1.0);
    for (int tries = 0; tries < 1000; ++tries) {
      smachac::Pose moved = pose;
      moved.position.x += spread[0] * side(random_);
      moved.position.y += spread[1] * side(random_);
      const double half = 0.5 * spread[2] * side(random_);
      moved.orientation = {0.0, 0.0, std::sin(half), std::cos(half)};
      const bool free = std::all_of(apart.begin(), apart.end(), [&](const auto &other) {
        const smachac::Point &at = bodies.at(other.first).position;
        return std::hypot(moved.position.x - at.x, moved.position.y - at.y) >= other.second;
      });
      if (free) {
        return moved;
      }
    }
    smachac::fail("no place is far enough from the other bodies");
  }

  bool load(const smachac::Model &model, const smachac::Pose &pose) override {
    return bodies.emplace(model.body, pose).second;
  }

  std::optional<double> distance(const std::string &body, const smachac::Pose &pose) override {
    const auto found = bodies.find(body);
    if (found == bodies.end()) {
      return {};
    }
    return apart(found->second.position, pose.position);
  }

  bool at_rest(const std::string &) override { return true; }

  static double apart(const smachac::Point &a, const smachac::Point &b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
  }

private:
  std::mt19937_64 random_;
};

/// An arm of two links on a turning base, with a hand that points down: joint 1 turns the base,
/// 2 is the shoulder, 4 the elbow, 6 the wrist, 7 turns the hand; 3 and 5 stay where they are.
class FakeArm : public smachac::Arm {
public:
  explicit FakeArm(FakeWorld &world) : world_(world) {}

  /// How many steps of motions were made.
  int steps = 0;

  smachac::Pose grasp_pose(const smachac::Limb &, const smachac::Pose &body) override {
    const smachac::Quaternion &turn = body.orientation;
    return {body.position, {turn.w, turn.z, 0.0, 0.0}};
  }

  std::optional<std::vector<double>> solve_ik(const smachac::Limb &,
                                              const smachac::Pose &tool) override {
    const smachac::Point &at = tool.position;
    const double out = std::hypot(at.x, at.y);
    const double up = at.z + hand - shoulder;
    const double reach = std::hypot(out, up);
    if (reach > upper + lower) {
      return {};
    }
    const double bend =
        (reach * reach - upper * upper - lower * lower) / (2.0 * upper * lower);
    const double elbow = std::acos(std::clamp(bend, -1.0, 1.0));
    const double lift = std::atan2(out, up) -
                        std::atan2(lower * std::sin(elbow), upper + lower * std::cos(elbow));
    const double turn = 2.0 * std::atan2(tool.orientation.y, tool.orientation.x);
    return std::vector<double>{
        std::atan2(at.y, at.x), lift, 0.0, elbow, 0.0, pi - lift - elbow, turn};
  }

  smachac::Motion move_to_joints(const smachac::Limb &, const std::vector<double> &positions,
                                 double speed, smachac::Stop &stop) override {
    if (positions.size() != joints_.size()) {
      return smachac::Motion::aborted;
    }
    double way = 0.0;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      way = std::max(way, std::abs(positions[i] - joints_[i]));
    }
    const std::vector<double> from = joints_;
    const int count = std::max(1, static_cast<int>(std::ceil(way / speed / time_step)));
    for (int k = 1; k <= count; ++k) {
      if (stop.requested()) {
        return smachac::Motion::preempted;
      }
      for (std::size_t i = 0; i < joints_.size(); ++i) {
        joints_[i] = from[i] + (positions[i] - from[i]) * k / count;
      }
      step();
    }
    return smachac::Motion::succeeded;
  }

  smachac::Motion move_along(const smachac::Limb &limb, const smachac::Pose &tool, double speed,
                             smachac::Stop &stop) override {
    const smachac::Point from = this->tool();
    for (int k = 1; k <= waypoints; ++k) {
      const double part = static_cast<double>(k) / waypoints;
      smachac::Pose there = tool;
      there.position.x = from.x + (tool.position.x - from.x) * part;
      there.position.y = from.y + (tool.position.y - from.y) * part;
      there.position.z = from.z + (tool.position.z - from.z) * part;
      const auto joints = solve_ik(limb, there);
      if (!joints.has_value()) {
        return smachac::Motion::aborted;
      }
      const smachac::Motion motion = move_to_joints(limb, *joints, speed, stop);
      if (motion != smachac::Motion::succeeded) {
        return motion;
      }
    }
    return smachac::Motion::succeeded;
  }

  smachac::Motion grip(const smachac::Limb &, bool open, smachac::Stop &stop) override {
    if (stop.requested()) {
      return smachac::Motion::preempted;
    }
    step();
    held_.clear();
    width_ = open ? description.gripper->open : description.gripper->closed;
    if (open) {
      return smachac::Motion::succeeded;
    }
    for (const auto &[name, pose] : world_.bodies) {
      if (FakeWorld::apart(pose.position, tool()) < 0.005) {
        held_ = name;
        width_ = 0.05;
        return smachac::Motion::succeeded;
      }
    }
    return smachac::Motion::aborted;
  }

  double width(const smachac::Limb &) override { return width_; }

  bool holds(const smachac::Limb &, const std::optional<std::string> &body) override {
    return !held_.empty() && body.value_or(held_) == held_;
  }

  /// Where the tool is.
  smachac::Point tool() const {
    const double elbow = joints_[1] + joints_[3];
    const double wrist = elbow + joints_[5];
    const double out =
        upper * std::sin(joints_[1]) + lower * std::sin(elbow) + hand * std::sin(wrist);
    const double up = shoulder + upper * std::cos(joints_[1]) + lower * std::cos(elbow) +
                      hand * std::cos(wrist);
    return {out * std::cos(joints_[0]), out * std::sin(joints_[0]), up};
  }

private:
  static constexpr const smachac::ArmDescription &description = robots::panda::arm;
  static constexpr double pi = 3.14159265358979323846;
  static constexpr double shoulder = 0.33, upper = 0.42, lower = 0.42, hand = 0.2;
  static constexpr double time_step = 0.01;
  static constexpr int waypoints = 6;

  void step() {
    ++steps;
    if (!held_.empty()) {
      world_.bodies[held_].position = tool();
    }
  }

  FakeWorld &world_;
  std::vector<double> joints_ = std::vector<double>(description.joints.size(), 0.0);
  std::string held_;
  double width_ = description.gripper->open;
};
