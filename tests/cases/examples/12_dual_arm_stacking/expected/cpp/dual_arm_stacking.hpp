// Made by smachac 0.1.0 from main.yml (sha256 a04773f8ab211e87).
#pragma once

#include "smachac/arm.hpp"
#include "smachac/smachac.hpp"

// A class with more outcomes than its interface is an error at every warning level.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#endif

static_assert(::smachac::ReadBodyPoseState::smachac_interface == 0xa1f0b5e1U,
              "smachac::ReadBodyPoseState was written for another ReadBodyPoseState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::ReadBodyPoseState::Out::pose), smachac::Key<smachac::Pose> &>,
              "smachac::ReadBodyPoseState::Out::pose must be smachac::Key<smachac::Pose> &");

static_assert(::smachac::GripperState::smachac_interface == 0xf6784b1fU,
              "smachac::GripperState was written for another GripperState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::GripperState::Out::width), smachac::Key<double> &>,
              "smachac::GripperState::Out::width must be smachac::Key<double> &");

static_assert(::smachac::PoseToJointPositionsState::smachac_interface == 0xb36feb04U,
              "smachac::PoseToJointPositionsState was written for another PoseToJointPositionsState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::PoseToJointPositionsState::In::pose), const smachac::Pose &>,
              "smachac::PoseToJointPositionsState::In::pose must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::smachac::PoseToJointPositionsState::In::offset), const std::optional<smachac::Pose> &>,
              "smachac::PoseToJointPositionsState::In::offset must be const std::optional<smachac::Pose> &");
static_assert(std::is_same_v<decltype(::smachac::PoseToJointPositionsState::Out::joints), smachac::Key<std::vector<double>> &>,
              "smachac::PoseToJointPositionsState::Out::joints must be smachac::Key<std::vector<double>> &");

static_assert(::smachac::MoveToJointPositionsState::smachac_interface == 0x1e53a7a2U,
              "smachac::MoveToJointPositionsState was written for another MoveToJointPositionsState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::MoveToJointPositionsState::In::positions), const std::vector<double> &>,
              "smachac::MoveToJointPositionsState::In::positions must be const std::vector<double> &");

static_assert(::smachac::MoveAlongState::smachac_interface == 0xf86fdf91U,
              "smachac::MoveAlongState was written for another MoveAlongState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::MoveAlongState::In::pose), const smachac::Pose &>,
              "smachac::MoveAlongState::In::pose must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::smachac::MoveAlongState::In::offset), const std::optional<smachac::Pose> &>,
              "smachac::MoveAlongState::In::offset must be const std::optional<smachac::Pose> &");

static_assert(::smachac::CheckGraspState::smachac_interface == 0x13d26e9fU,
              "smachac::CheckGraspState was written for another CheckGraspState.yml: compare them, then set smachac_interface");

static_assert(::smachac::CheckPlacedState::smachac_interface == 0xe69f2892U,
              "smachac::CheckPlacedState was written for another CheckPlacedState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::CheckPlacedState::In::pose), const smachac::Pose &>,
              "smachac::CheckPlacedState::In::pose must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::smachac::CheckPlacedState::Out::error), smachac::Key<double> &>,
              "smachac::CheckPlacedState::Out::error must be smachac::Key<double> &");

// Place the block in the gripper and check where it lies.
namespace dual_arm_stacking::PLACE_SECOND { // main.yml:72

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::vector<double>> hover_joints;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<double> placing_error;
  smachac::Key<double> width;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &place_pose;
};

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : PLAN_HOVER(arm, std::optional<std::string>{std::string("right")}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{std::string("right")}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{std::string("right")}, true, 1.0),
        OPEN_GRIPPER(arm, std::optional<std::string>{std::string("right")}, std::string("open")),
        MOVE_UP(arm, std::optional<std::string>{std::string("right")}, true, 1.0),
        CHECK_PLACED(world, std::string("second"), 0.001) {}

  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::MoveAlongState MOVE_UP;
  ::smachac::CheckPlacedState CHECK_PLACED;
};

enum class State : std::size_t {
  PLAN_HOVER,
  MOVE_TO_HOVER,
  MOVE_DOWN,
  OPEN_GRIPPER,
  MOVE_UP,
  CHECK_PLACED,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/PLACE_SECOND/PLAN_HOVER", "place_block.yml:9"},
    {"dual_arm_stacking/PLACE_SECOND/MOVE_TO_HOVER", "place_block.yml:16"},
    {"dual_arm_stacking/PLACE_SECOND/MOVE_DOWN", "place_block.yml:22"},
    {"dual_arm_stacking/PLACE_SECOND/OPEN_GRIPPER", "place_block.yml:29"},
    {"dual_arm_stacking/PLACE_SECOND/MOVE_UP", "place_block.yml:35"},
    {"dual_arm_stacking/PLACE_SECOND/CHECK_PLACED", "place_block.yml:42"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PLAN_HOVER;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAN_HOVER: // place_block.yml:9
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({smachac::need(ud.place_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // place_block.yml:16
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_DOWN: // place_block.yml:22
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({smachac::need(ud.place_pose, "pose"), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::OPEN_GRIPPER);
        goto OPEN_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::OPEN_GRIPPER: // place_block.yml:29
    OPEN_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_UP);
        goto MOVE_UP;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_UP: // place_block.yml:35
    MOVE_UP:
      run.enter(places, state);
      switch (states.MOVE_UP.execute({smachac::need(ud.place_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_PLACED);
        goto CHECK_PLACED;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHECK_PLACED: // place_block.yml:42
    CHECK_PLACED:
      run.enter(places, state);
      switch (run.wrote(states.CHECK_PLACED.execute({smachac::need(ud.place_pose, "pose")}, {run.out(ud.own_.placing_error)}), smachac::Output{"error", ud.own_.placing_error})) {
      case ::smachac::CheckPlacedState::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::CheckPlacedState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace dual_arm_stacking::PLACE_SECOND

// Place the block in the gripper and check where it lies.
namespace dual_arm_stacking::PLACE_FIRST { // main.yml:60

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::vector<double>> hover_joints;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<double> placing_error;
  smachac::Key<double> width;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &place_pose;
};

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : PLAN_HOVER(arm, std::optional<std::string>{std::string("left")}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{std::string("left")}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{std::string("left")}, true, 1.0),
        OPEN_GRIPPER(arm, std::optional<std::string>{std::string("left")}, std::string("open")),
        MOVE_UP(arm, std::optional<std::string>{std::string("left")}, true, 1.0),
        CHECK_PLACED(world, std::string("first"), 0.001) {}

  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::MoveAlongState MOVE_UP;
  ::smachac::CheckPlacedState CHECK_PLACED;
};

enum class State : std::size_t {
  PLAN_HOVER,
  MOVE_TO_HOVER,
  MOVE_DOWN,
  OPEN_GRIPPER,
  MOVE_UP,
  CHECK_PLACED,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/PLACE_FIRST/PLAN_HOVER", "place_block.yml:9"},
    {"dual_arm_stacking/PLACE_FIRST/MOVE_TO_HOVER", "place_block.yml:16"},
    {"dual_arm_stacking/PLACE_FIRST/MOVE_DOWN", "place_block.yml:22"},
    {"dual_arm_stacking/PLACE_FIRST/OPEN_GRIPPER", "place_block.yml:29"},
    {"dual_arm_stacking/PLACE_FIRST/MOVE_UP", "place_block.yml:35"},
    {"dual_arm_stacking/PLACE_FIRST/CHECK_PLACED", "place_block.yml:42"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PLAN_HOVER;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAN_HOVER: // place_block.yml:9
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({smachac::need(ud.place_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // place_block.yml:16
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_DOWN: // place_block.yml:22
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({smachac::need(ud.place_pose, "pose"), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::OPEN_GRIPPER);
        goto OPEN_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::OPEN_GRIPPER: // place_block.yml:29
    OPEN_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_UP);
        goto MOVE_UP;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_UP: // place_block.yml:35
    MOVE_UP:
      run.enter(places, state);
      switch (states.MOVE_UP.execute({smachac::need(ud.place_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_PLACED);
        goto CHECK_PLACED;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHECK_PLACED: // place_block.yml:42
    CHECK_PLACED:
      run.enter(places, state);
      switch (run.wrote(states.CHECK_PLACED.execute({smachac::need(ud.place_pose, "pose")}, {run.out(ud.own_.placing_error)}), smachac::Output{"error", ud.own_.placing_error})) {
      case ::smachac::CheckPlacedState::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::CheckPlacedState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace dual_arm_stacking::PLACE_FIRST

// Grasp a block from above and lift it.
namespace dual_arm_stacking::PICK_BLOCKS::PICK_SECOND { // main.yml:55

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::vector<double>> hover_joints;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<double> width;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
};

struct States {
  explicit States(smachac::Arm &arm)
      : OPEN_GRIPPER(arm, std::optional<std::string>{std::string("right")}, std::string("open")),
        PLAN_HOVER(arm, std::optional<std::string>{std::string("right")}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{std::string("right")}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{std::string("right")}, true, 1.0),
        CLOSE_GRIPPER(arm, std::optional<std::string>{std::string("right")}, std::string("close")),
        LIFT(arm, std::optional<std::string>{std::string("right")}, true, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{std::string("right")}, std::optional<std::string>{std::string("second")}) {}

  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState CLOSE_GRIPPER;
  ::smachac::MoveAlongState LIFT;
  ::smachac::CheckGraspState CHECK_GRASP;
};

enum class State : std::size_t {
  OPEN_GRIPPER,
  PLAN_HOVER,
  MOVE_TO_HOVER,
  MOVE_DOWN,
  CLOSE_GRIPPER,
  LIFT,
  CHECK_GRASP,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/OPEN_GRIPPER", "pick_block.yml:8"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/PLAN_HOVER", "pick_block.yml:14"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/MOVE_TO_HOVER", "pick_block.yml:21"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/MOVE_DOWN", "pick_block.yml:27"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/CLOSE_GRIPPER", "pick_block.yml:34"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/LIFT", "pick_block.yml:40"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND/CHECK_GRASP", "pick_block.yml:47"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::OPEN_GRIPPER;
  SMACHAC_TRY {
    switch (state) {
    case State::OPEN_GRIPPER: // pick_block.yml:8
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLAN_HOVER);
        goto PLAN_HOVER;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::PLAN_HOVER: // pick_block.yml:14
    PLAN_HOVER:
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({smachac::need(ud.pick_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // pick_block.yml:21
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_DOWN: // pick_block.yml:27
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({smachac::need(ud.pick_pose, "pose"), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CLOSE_GRIPPER);
        goto CLOSE_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CLOSE_GRIPPER: // pick_block.yml:34
    CLOSE_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.CLOSE_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LIFT);
        goto LIFT;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::LIFT: // pick_block.yml:40
    LIFT:
      run.enter(places, state);
      switch (states.LIFT.execute({smachac::need(ud.pick_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHECK_GRASP: // pick_block.yml:47
    CHECK_GRASP:
      run.enter(places, state);
      switch (states.CHECK_GRASP.execute()) {
      case ::smachac::CheckGraspState::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::CheckGraspState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace dual_arm_stacking::PICK_BLOCKS::PICK_SECOND

// Grasp a block from above and lift it.
namespace dual_arm_stacking::PICK_BLOCKS::PICK_FIRST { // main.yml:50

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::vector<double>> hover_joints;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<double> width;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
};

struct States {
  explicit States(smachac::Arm &arm)
      : OPEN_GRIPPER(arm, std::optional<std::string>{std::string("left")}, std::string("open")),
        PLAN_HOVER(arm, std::optional<std::string>{std::string("left")}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{std::string("left")}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{std::string("left")}, true, 1.0),
        CLOSE_GRIPPER(arm, std::optional<std::string>{std::string("left")}, std::string("close")),
        LIFT(arm, std::optional<std::string>{std::string("left")}, true, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{std::string("left")}, std::optional<std::string>{std::string("first")}) {}

  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState CLOSE_GRIPPER;
  ::smachac::MoveAlongState LIFT;
  ::smachac::CheckGraspState CHECK_GRASP;
};

enum class State : std::size_t {
  OPEN_GRIPPER,
  PLAN_HOVER,
  MOVE_TO_HOVER,
  MOVE_DOWN,
  CLOSE_GRIPPER,
  LIFT,
  CHECK_GRASP,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/OPEN_GRIPPER", "pick_block.yml:8"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/PLAN_HOVER", "pick_block.yml:14"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/MOVE_TO_HOVER", "pick_block.yml:21"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/MOVE_DOWN", "pick_block.yml:27"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/CLOSE_GRIPPER", "pick_block.yml:34"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/LIFT", "pick_block.yml:40"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST/CHECK_GRASP", "pick_block.yml:47"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::OPEN_GRIPPER;
  SMACHAC_TRY {
    switch (state) {
    case State::OPEN_GRIPPER: // pick_block.yml:8
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLAN_HOVER);
        goto PLAN_HOVER;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::PLAN_HOVER: // pick_block.yml:14
    PLAN_HOVER:
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({smachac::need(ud.pick_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // pick_block.yml:21
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::MOVE_DOWN: // pick_block.yml:27
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({smachac::need(ud.pick_pose, "pose"), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CLOSE_GRIPPER);
        goto CLOSE_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CLOSE_GRIPPER: // pick_block.yml:34
    CLOSE_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.CLOSE_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LIFT);
        goto LIFT;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::LIFT: // pick_block.yml:40
    LIFT:
      run.enter(places, state);
      switch (states.LIFT.execute({smachac::need(ud.pick_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHECK_GRASP: // pick_block.yml:47
    CHECK_GRASP:
      run.enter(places, state);
      switch (states.CHECK_GRASP.execute()) {
      case ::smachac::CheckGraspState::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::CheckGraspState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace dual_arm_stacking::PICK_BLOCKS::PICK_FIRST

// Both arms move at the same time in one world.
namespace dual_arm_stacking::PICK_BLOCKS { // main.yml:41

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  PICK_FIRST::Userdata PICK_FIRST_;
  PICK_SECOND::Userdata PICK_SECOND_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &first_pose;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &second_pose;
};

struct States {
  explicit States(smachac::Arm &arm)
      : PICK_FIRST_(arm),
        PICK_SECOND_(arm) {}

  PICK_FIRST::States PICK_FIRST_;
  PICK_SECOND::States PICK_SECOND_;
};

enum class State : std::size_t {
  PICK_FIRST,
  PICK_SECOND,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/PICK_BLOCKS/PICK_FIRST", "main.yml:50"},
    {"dual_arm_stacking/PICK_BLOCKS/PICK_SECOND", "main.yml:55"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &around) {
  struct {
    PICK_FIRST::Outcome PICK_FIRST;
    PICK_SECOND::Outcome PICK_SECOND;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(false, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::PICK_FIRST: // main.yml:50
        run.enter(places, state);
        ended.PICK_FIRST = PICK_FIRST::execute(states.PICK_FIRST_, {ud.own_.PICK_FIRST_, ud.hover_offset, ud.first_pose}, run);
        switch (ended.PICK_FIRST) {
        case PICK_FIRST::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case PICK_FIRST::Outcome::aborted:
          run.exit(places, state, "aborted");
          return;
        case PICK_FIRST::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::PICK_SECOND: // main.yml:55
        run.enter(places, state);
        ended.PICK_SECOND = PICK_SECOND::execute(states.PICK_SECOND_, {ud.own_.PICK_SECOND_, ud.hover_offset, ud.second_pose}, run);
        switch (ended.PICK_SECOND) {
        case PICK_SECOND::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case PICK_SECOND::Outcome::aborted:
          run.exit(places, state, "aborted");
          return;
        case PICK_SECOND::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      default:
        smachac::never();
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  });
  if (ended.PICK_FIRST == PICK_FIRST::Outcome::succeeded &&
      ended.PICK_SECOND == PICK_SECOND::Outcome::succeeded) {
    return Outcome::succeeded;
  }
  return Outcome::aborted;
}

} // namespace dual_arm_stacking::PICK_BLOCKS

// Pick two blocks with both arms at once and stack them on the mark.
namespace dual_arm_stacking { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> first_error;
  smachac::Key<smachac::Pose> first_pose;
  smachac::Key<smachac::Pose> goal_pose;
  smachac::Key<smachac::Pose> hover_offset{smachac::Pose{smachac::Point{0.0, 0.0, 0.12}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<std::array<double, 7>> left_home{std::array<double, 7>{{-0.08, -0.99998, -1.18997, 1.94002, 0.67, 1.03001, -0.5}}};
  smachac::Key<double> left_width;
  smachac::Key<std::array<double, 7>> right_home{std::array<double, 7>{{0.08, -0.99998, 1.18997, 1.94002, -0.67, 1.03001, 0.5}}};
  smachac::Key<double> right_width;
  smachac::Key<smachac::Pose> second_pose;
  smachac::Key<smachac::Pose> top_pose;
  PICK_BLOCKS::Userdata PICK_BLOCKS_;
  PLACE_FIRST::Userdata PLACE_FIRST_;
  PLACE_SECOND::Userdata PLACE_SECOND_;
};

namespace types {

/// main.yml:32
struct PLAN_STACK {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("top_pose", ud.top_pose, smachac::Pose{smachac::Point{smachac::need(ud.goal_pose, "goal_pose").position.x, smachac::need(ud.goal_pose, "goal_pose").position.y, smachac::need(ud.goal_pose, "goal_pose").position.z + 0.05}, smachac::need(ud.goal_pose, "goal_pose").orientation});
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : FIND_FIRST(world, std::string("first")),
        FIND_SECOND(world, std::string("second")),
        FIND_MARK(world, std::string("mark")),
        PICK_BLOCKS_(arm),
        PLACE_FIRST_(arm, world),
        LEFT_HOME(arm, std::optional<std::string>{std::string("left")}, 1.0),
        PLACE_SECOND_(arm, world),
        RIGHT_HOME(arm, std::optional<std::string>{std::string("right")}, 1.0),
        CHECK_FIRST(world, std::string("first"), 0.001),
        LET_GO_LEFT(arm, std::optional<std::string>{std::string("left")}, std::string("open")),
        LET_GO_RIGHT(arm, std::optional<std::string>{std::string("right")}, std::string("open")) {}

  ::smachac::ReadBodyPoseState FIND_FIRST;
  ::smachac::ReadBodyPoseState FIND_SECOND;
  ::smachac::ReadBodyPoseState FIND_MARK;
  // The second block goes on top of the first, one edge length (0.05 m) higher.
  types::PLAN_STACK PLAN_STACK{};
  PICK_BLOCKS::States PICK_BLOCKS_;
  PLACE_FIRST::States PLACE_FIRST_;
  ::smachac::MoveToJointPositionsState LEFT_HOME;
  PLACE_SECOND::States PLACE_SECOND_;
  ::smachac::MoveToJointPositionsState RIGHT_HOME;
  // The second block must not have moved the first.
  ::smachac::CheckPlacedState CHECK_FIRST;
  ::smachac::GripperState LET_GO_LEFT;
  ::smachac::GripperState LET_GO_RIGHT;
};

enum class State : std::size_t {
  FIND_FIRST,
  FIND_SECOND,
  FIND_MARK,
  PLAN_STACK,
  PICK_BLOCKS,
  PLACE_FIRST,
  LEFT_HOME,
  PLACE_SECOND,
  RIGHT_HOME,
  CHECK_FIRST,
  LET_GO_LEFT,
  LET_GO_RIGHT,
};

inline constexpr smachac::Place places[] = {
    {"dual_arm_stacking/FIND_FIRST", "main.yml:14"},
    {"dual_arm_stacking/FIND_SECOND", "main.yml:20"},
    {"dual_arm_stacking/FIND_MARK", "main.yml:26"},
    {"dual_arm_stacking/PLAN_STACK", "main.yml:32"},
    {"dual_arm_stacking/PICK_BLOCKS", "main.yml:41"},
    {"dual_arm_stacking/PLACE_FIRST", "main.yml:60"},
    {"dual_arm_stacking/LEFT_HOME", "main.yml:66"},
    {"dual_arm_stacking/PLACE_SECOND", "main.yml:72"},
    {"dual_arm_stacking/RIGHT_HOME", "main.yml:78"},
    {"dual_arm_stacking/CHECK_FIRST", "main.yml:84"},
    {"dual_arm_stacking/LET_GO_LEFT", "main.yml:93"},
    {"dual_arm_stacking/LET_GO_RIGHT", "main.yml:100"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::FIND_FIRST;
  SMACHAC_TRY {
    switch (state) {
    case State::FIND_FIRST: // main.yml:14
      run.enter(places, state);
      switch (run.wrote(states.FIND_FIRST.execute({run.out(ud.first_pose)}), smachac::Output{"pose", ud.first_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::FIND_SECOND);
        goto FIND_SECOND;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::FIND_SECOND: // main.yml:20
    FIND_SECOND:
      run.enter(places, state);
      switch (run.wrote(states.FIND_SECOND.execute({run.out(ud.second_pose)}), smachac::Output{"pose", ud.second_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::FIND_MARK);
        goto FIND_MARK;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::FIND_MARK: // main.yml:26
    FIND_MARK:
      run.enter(places, state);
      switch (run.wrote(states.FIND_MARK.execute({run.out(ud.goal_pose)}), smachac::Output{"pose", ud.goal_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLAN_STACK);
        goto PLAN_STACK;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::PLAN_STACK: // main.yml:32
    PLAN_STACK:
      run.enter(places, state);
      switch (states.PLAN_STACK.execute(ud, run)) {
      case types::PLAN_STACK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PICK_BLOCKS);
        goto PICK_BLOCKS;
      }
      break;
    case State::PICK_BLOCKS: // main.yml:41
    PICK_BLOCKS:
      run.enter(places, state);
      switch (PICK_BLOCKS::execute(states.PICK_BLOCKS_, {ud.PICK_BLOCKS_, ud.first_pose, ud.hover_offset, ud.second_pose}, run)) {
      case PICK_BLOCKS::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_FIRST);
        goto PLACE_FIRST;
      case PICK_BLOCKS::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      }
      break;
    case State::PLACE_FIRST: // main.yml:60
    PLACE_FIRST:
      run.enter(places, state);
      switch (PLACE_FIRST::execute(states.PLACE_FIRST_, {ud.PLACE_FIRST_, ud.hover_offset, ud.goal_pose}, run)) {
      case PLACE_FIRST::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LEFT_HOME);
        goto LEFT_HOME;
      case PLACE_FIRST::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      case PLACE_FIRST::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::LEFT_HOME: // main.yml:66
    LEFT_HOME:
      run.enter(places, state);
      switch (states.LEFT_HOME.execute({smachac::convert<std::vector<double>>(ud.left_home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_SECOND);
        goto PLACE_SECOND;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::PLACE_SECOND: // main.yml:72
    PLACE_SECOND:
      run.enter(places, state);
      switch (PLACE_SECOND::execute(states.PLACE_SECOND_, {ud.PLACE_SECOND_, ud.hover_offset, ud.top_pose}, run)) {
      case PLACE_SECOND::Outcome::succeeded:
        run.go(places, state, "succeeded", State::RIGHT_HOME);
        goto RIGHT_HOME;
      case PLACE_SECOND::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      case PLACE_SECOND::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::RIGHT_HOME: // main.yml:78
    RIGHT_HOME:
      run.enter(places, state);
      switch (states.RIGHT_HOME.execute({smachac::convert<std::vector<double>>(ud.right_home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_FIRST);
        goto CHECK_FIRST;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHECK_FIRST: // main.yml:84
    CHECK_FIRST:
      run.enter(places, state);
      switch (run.wrote(states.CHECK_FIRST.execute({smachac::need(ud.goal_pose, "pose")}, {run.out(ud.first_error)}), smachac::Output{"error", ud.first_error})) {
      case ::smachac::CheckPlacedState::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::CheckPlacedState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_LEFT);
        goto LET_GO_LEFT;
      }
      break;
    case State::LET_GO_LEFT: // main.yml:93
    LET_GO_LEFT:
      run.enter(places, state);
      switch (run.wrote(states.LET_GO_LEFT.execute({run.out(ud.left_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.left_width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LET_GO_RIGHT);
        goto LET_GO_RIGHT;
      case ::smachac::GripperState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO_RIGHT);
        goto LET_GO_RIGHT;
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::LET_GO_RIGHT: // main.yml:100
    LET_GO_RIGHT:
      run.enter(places, state);
      switch (run.wrote(states.LET_GO_RIGHT.execute({run.out(ud.right_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.right_width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::aborted);
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

/// Runs the machine once. The observer receives all events of the run; it may be null.
inline Outcome run(States &states, Userdata &ud, smachac::Observer *observer,
                   smachac::Stop &stop) {
  if (observer == nullptr) {
    smachac::Run alone{stop};
    return execute(states, ud, alone);
  }
  smachac::WatchedRun watched(*observer, stop);
  watched.start({"dual_arm_stacking", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"dual_arm_stacking", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace dual_arm_stacking

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
