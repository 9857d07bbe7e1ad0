// Made by smachac, as it is for every machine: do not edit.
//
// The state types of an arm (MoveAlongState, GripperState, ...) in C++, over your own robot: derive
// from `smachac::Arm` and `smachac::World`, and pass an object of each to the States of the
// machine.
//
// Lengths are in metres, angles in radians, poses in the frame of the robot's base. The position of
// a joint is in radians, or in metres if it slides; in the speed of a motion, 0.2 m of a joint that
// slides count as 1 rad of one that turns.
#ifndef SMACHAC_ARM_HPP
#define SMACHAC_ARM_HPP

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "smachac/smachac.hpp"

namespace smachac {
inline namespace v0_1_0 {

/// The name of an arm; empty if the robot has only one arm.
using Limb = std::optional<std::string>;

/// A constant list of values of the description of a robot.
template <class T> struct List {
  const T *first = nullptr;
  std::size_t count = 0;

  constexpr List() = default;
  template <std::size_t N> constexpr List(const T (&items)[N]) : first(items), count(N) {}

  constexpr const T *begin() const { return first; }
  constexpr const T *end() const { return first + count; }
  constexpr std::size_t size() const { return count; }
  constexpr const T &operator[](std::size_t index) const { return first[index]; }
};

/// A joint of an arm in the description of a robot: its limits and its home in radians, its largest
/// speed in rad/s; in metres and m/s if it does not turn, but slides. Infinite where there is no
/// limit: a joint that turns without limits is continuous.
struct JointDescription {
  const char *name;
  double lower, upper;
  double speed;
  double home;
  bool turns = true;
};

/// The way of a joint from one position to another, in radians or metres. A continuous joint turns
/// the short way.
inline double joint_way(const JointDescription &joint, double from, double to) {
  const bool continuous = joint.turns && std::isinf(joint.lower) && std::isinf(joint.upper);
  constexpr double turn = 6.283185307179586;
  return continuous ? std::remainder(to - from, turn) : to - from;
}

/// A joint of a gripper: its positions when the gripper is open and closed, in metres, or in
/// radians if the joint turns.
struct FingerDescription {
  const char *name;
  double open, closed;
};

/// A gripper: the distances between its fingers in metres, and its joints.
struct GripperDescription {
  double open, closed;
  List<FingerDescription> fingers;
};

/// An arm in the description of a robot, as `robots/<name>.hpp` has it: the link that carries the
/// tool, the tool in that link, the tool in the frame of a body that it grasps, and the base of the
/// robot in the world.
struct ArmDescription {
  const char *name;
  List<JointDescription> joints;
  const char *link;
  Pose tool;
  Pose grasp;
  Pose base;
  std::optional<GripperDescription> gripper;
};

/// The arm of a name, or the only arm for an empty name; null if there is none.
constexpr const ArmDescription *find_arm(List<ArmDescription> arms, const Limb &limb) {
  if (!limb.has_value()) {
    return arms.size() == 1 ? arms.begin() : nullptr;
  }
  for (const ArmDescription &arm : arms) {
    if (*limb == arm.name) {
      return &arm;
    }
  }
  return nullptr;
}

/// Whether the number of positions is that of the joints, and each one is within its limits.
template <class Positions>
constexpr bool within_limits(const ArmDescription &arm, const Positions &positions) {
  if (positions.size() != arm.joints.size()) {
    return false;
  }
  const JointDescription *joint = arm.joints.begin();
  for (const double position : positions) {
    if (!(joint->lower <= position && position <= joint->upper)) {
      return false;
    }
    ++joint;
  }
  return true;
}

/// The result of a motion: the goal was reached, it was not reached, or a preempt request ended the
/// motion.
enum class Motion : std::uint8_t { succeeded, aborted, preempted };

/// The interface of a robot: its actions, called by the states. The functions with a Stop block
/// until the motion is over. During a motion they must check `stop.requested()` repeatedly; if it
/// is true, they stop the arm where it is and return Motion::preempted. The state then serves the
/// request.
class Arm {
public:
  Arm() = default;
  Arm(const Arm &) = delete;
  Arm &operator=(const Arm &) = delete;
  virtual ~Arm() = default;

  /// The pose of the tool for a grasp of a body from above. `body` is the pose of the body.
  virtual Pose grasp_pose(const Limb &limb, const Pose &body) = 0;
  /// The joint positions for a pose of the tool; empty if the pose is out of reach.
  virtual std::optional<std::vector<double>> solve_ik(const Limb &limb, const Pose &tool) = 0;
  /// Moves the arm to joint positions along a straight line in joint space. `speed` is the speed of
  /// the fastest joint in rad/s.
  virtual Motion move_to_joints(const Limb &limb, const std::vector<double> &positions,
                                double speed, Stop &stop) = 0;
  /// Moves the tool to a pose along a straight line. `speed` is the speed of the fastest joint in
  /// rad/s.
  virtual Motion move_along(const Limb &limb, const Pose &tool, double speed, Stop &stop) = 0;
  /// Opens or closes the gripper. Returns Motion::aborted if the gripper does not open, or closes
  /// without a body between its fingers.
  virtual Motion grip(const Limb &limb, bool open, Stop &stop) = 0;
  /// The distance between the fingers of the gripper in metres.
  virtual double width(const Limb &limb) = 0;
  /// Whether the gripper holds the named body; without a name, whether it holds any body.
  virtual bool holds(const Limb &limb, const std::optional<std::string> &body) = 0;
};

/// A model to load into a world: the name of a built-in model, or a model from a file.
struct Model {
  std::string name;
  std::optional<std::string> path;
  std::string body;  ///< the name of the loaded body in the world
  std::string frame; ///< `base`, `world` or the name of a body
};

/// The interface of the world around the robot, called by the states: a simulator, or the
/// measurements of a camera.
class World {
public:
  World() = default;
  World(const World &) = delete;
  World &operator=(const World &) = delete;
  virtual ~World() = default;

  /// A random pose near `pose`: displaced by at most `spread` (x and y in metres, yaw in radians).
  /// `apart` maps names of bodies to their least distance from the result in metres.
  virtual Pose scattered(const Pose &pose, const std::array<double, 3> &spread,
                         const std::map<std::string, double> &apart) = 0;
  /// Loads a model at a pose. Returns false if the model or its frame does not exist, or the name
  /// of the body is in use.
  virtual bool load(const Model &model, const Pose &pose) = 0;
  /// The distance between a body and a pose in metres; empty if the body does not exist.
  virtual std::optional<double> distance(const std::string &body, const Pose &pose) = 0;
  /// The pose of a body; empty if the body does not exist.
  virtual std::optional<Pose> pose(const std::string &body) {
    (void)body;
    return std::nullopt;
  }
  /// Whether a body is upright and does not move.
  virtual bool at_rest(const std::string &body) = 0;
};

/// A pose after a translation and a rotation by an offset, both along the axes of the robot's base.
/// Without an offset, the pose unchanged.
inline Pose shifted(const Pose &pose, const std::optional<Pose> &offset) {
  if (!offset.has_value()) {
    return pose;
  }
  const Point &a = pose.position;
  const Point &b = offset->position;
  const Quaternion &p = offset->orientation;
  const Quaternion &q = pose.orientation;
  return Pose{Point{a.x + b.x, a.y + b.y, a.z + b.z},
              Quaternion{p.w * q.x + p.x * q.w + p.y * q.z - p.z * q.y,
                         p.w * q.y - p.x * q.z + p.y * q.w + p.z * q.x,
                         p.w * q.z + p.x * q.y - p.y * q.x + p.z * q.w,
                         p.w * q.w - p.x * q.x - p.y * q.y - p.z * q.z}};
}

namespace detail {

/// The outcome of a state for the result of its motion. After Motion::preempted the call serves the
/// preempt request.
template <class Outcome> Outcome outcome_of(Motion motion, Stop &stop) {
  switch (motion) {
  case Motion::succeeded:
    return Outcome::succeeded;
  case Motion::preempted:
    stop.service();
    return Outcome::preempted;
  case Motion::aborted:
    break;
  }
  return Outcome::aborted;
}

} // namespace detail

/// State type: moves an arm to joint positions along a straight line in joint space.
class MoveToJointPositionsState {
public:
  enum class Outcome { succeeded, aborted, preempted };
  struct In {
    const std::vector<double> &positions;
  };
  static constexpr std::uint32_t smachac_interface = 0x1e53a7a2U;

  MoveToJointPositionsState(Arm &arm, Limb limb, double speed)
      : arm_(arm), limb_(std::move(limb)), speed_(speed) {}

  Outcome execute(In in, Stop &stop) {
    return detail::outcome_of<Outcome>(arm_.move_to_joints(limb_, in.positions, speed_, stop),
                                       stop);
  }

private:
  Arm &arm_;
  Limb limb_;
  double speed_;
};

/// State type: moves the tool to a pose along a straight line.
class MoveAlongState {
public:
  enum class Outcome { succeeded, aborted, preempted };
  struct In {
    const Pose &pose;
    const std::optional<Pose> &offset;
  };
  static constexpr std::uint32_t smachac_interface = 0xf86fdf91U;

  MoveAlongState(Arm &arm, Limb limb, bool grasp, double speed)
      : arm_(arm), limb_(std::move(limb)), grasp_(grasp), speed_(speed) {}

  Outcome execute(In in, Stop &stop) {
    const Pose pose = grasp_ ? arm_.grasp_pose(limb_, in.pose) : in.pose;
    return detail::outcome_of<Outcome>(
        arm_.move_along(limb_, shifted(pose, in.offset), speed_, stop), stop);
  }

private:
  Arm &arm_;
  Limb limb_;
  bool grasp_;
  double speed_;
};

/// State type: opens or closes a gripper.
class GripperState {
public:
  enum class Outcome { succeeded, aborted, preempted };
  struct Out {
    Key<double> &width;
  };
  static constexpr std::uint32_t smachac_interface = 0xf6784b1fU;

  GripperState(Arm &arm, Limb limb, const std::string &command)
      : arm_(arm), limb_(std::move(limb)), open_(command == "open") {}

  Outcome execute(Out out, Stop &stop) {
    const Motion motion = arm_.grip(limb_, open_, stop);
    out.width = arm_.width(limb_);
    return detail::outcome_of<Outcome>(motion, stop);
  }

private:
  Arm &arm_;
  Limb limb_;
  bool open_;
};

/// State type: solves inverse kinematics, from a pose of the tool to joint positions.
class PoseToJointPositionsState {
public:
  enum class Outcome { succeeded, aborted };
  struct In {
    const Pose &pose;
    const std::optional<Pose> &offset;
  };
  struct Out {
    Key<std::vector<double>> &joints;
  };
  static constexpr std::uint32_t smachac_interface = 0xb36feb04U;

  PoseToJointPositionsState(Arm &arm, Limb limb, bool grasp)
      : arm_(arm), limb_(std::move(limb)), grasp_(grasp) {}

  Outcome execute(In in, Out out) {
    const Pose pose = grasp_ ? arm_.grasp_pose(limb_, in.pose) : in.pose;
    std::optional<std::vector<double>> joints = arm_.solve_ik(limb_, shifted(pose, in.offset));
    if (!joints.has_value()) {
      return Outcome::aborted;
    }
    out.joints = std::move(*joints);
    return Outcome::succeeded;
  }

private:
  Arm &arm_;
  Limb limb_;
  bool grasp_;
};

/// State type: checks whether the gripper holds a body.
class CheckGraspState {
public:
  enum class Outcome { succeeded, aborted };
  static constexpr std::uint32_t smachac_interface = 0x13d26e9fU;

  CheckGraspState(Arm &arm, Limb limb, std::optional<std::string> body)
      : arm_(arm), limb_(std::move(limb)), body_(std::move(body)) {}

  Outcome execute() { return arm_.holds(limb_, body_) ? Outcome::succeeded : Outcome::aborted; }

private:
  Arm &arm_;
  Limb limb_;
  std::optional<std::string> body_;
};

/// State type: checks whether a body is at rest at its goal pose, within a tolerance.
class CheckPlacedState {
public:
  enum class Outcome { succeeded, aborted };
  struct In {
    const Pose &pose;
  };
  struct Out {
    Key<double> &error;
  };
  static constexpr std::uint32_t smachac_interface = 0xe69f2892U;

  CheckPlacedState(World &world, std::string body, double tolerance)
      : world_(world), body_(std::move(body)), tolerance_(tolerance) {}

  Outcome execute(In in, Out out) {
    const std::optional<double> error = world_.distance(body_, in.pose);
    if (!error.has_value()) {
      return Outcome::aborted;
    }
    out.error = *error;
    return *error <= tolerance_ && world_.at_rest(body_) ? Outcome::succeeded : Outcome::aborted;
  }

private:
  World &world_;
  std::string body_;
  double tolerance_;
};

/// State type: reads the present pose of a body.
class ReadBodyPoseState {
public:
  enum class Outcome { succeeded, aborted };
  struct Out {
    Key<Pose> &pose;
  };
  static constexpr std::uint32_t smachac_interface = 0xa1f0b5e1U;

  ReadBodyPoseState(World &world, std::string body) : world_(world), body_(std::move(body)) {}

  Outcome execute(Out out) {
    const std::optional<Pose> pose = world_.pose(body_);
    if (!pose.has_value()) {
      return Outcome::aborted;
    }
    out.pose = *pose;
    return Outcome::succeeded;
  }

private:
  World &world_;
  std::string body_;
};

/// State type: loads a model into the world.
class LoadModelState {
public:
  enum class Outcome { succeeded, aborted };
  struct In {
    const Pose &pose;
    const std::optional<std::string> &reference_frame;
  };
  struct Out {
    Key<Pose> &pose;
  };
  static constexpr std::uint32_t smachac_interface = 0x8fbc7534U;

  LoadModelState(World &world, std::string model_name, std::optional<std::string> model_path,
                 const std::optional<std::string> &body, const std::array<double, 3> &spread,
                 std::map<std::string, double> apart)
      : world_(world), model_{model_name, std::move(model_path), body.value_or(model_name), {}},
        spread_(spread), apart_(std::move(apart)) {}

  Outcome execute(In in, Out out) {
    model_.frame = in.reference_frame.value_or("base");
    const Pose pose = world_.scattered(in.pose, spread_, apart_);
    const bool loaded = world_.load(model_, pose);
    out.pose = pose;
    return loaded ? Outcome::succeeded : Outcome::aborted;
  }

private:
  World &world_;
  Model model_;
  std::array<double, 3> spread_;
  std::map<std::string, double> apart_;
};

} // namespace v0_1_0
} // namespace smachac

#endif
