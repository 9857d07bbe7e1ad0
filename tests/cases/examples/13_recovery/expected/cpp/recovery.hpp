// Made by smachac 0.1.0 from main.yml (sha256 429970c082ff5f57).
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
namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY::PLACE_BLOCK { // pick_and_place.yml:12

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
        CHECK_PLACED(world, std::string("block"), 0.001) {}

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
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/PLAN_HOVER", "place_block.yml:9", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/PLAN_HOVER", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/MOVE_TO_HOVER", "place_block.yml:16", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_TO_HOVER", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/MOVE_DOWN", "place_block.yml:22", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_DOWN", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/OPEN_GRIPPER", "place_block.yml:29", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/OPEN_GRIPPER", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/MOVE_UP", "place_block.yml:35", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_UP", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK/CHECK_PLACED", "place_block.yml:42", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/CHECK_PLACED", "recovery/RIGHT/TRY/CARRY/PLACE_BLOCK"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
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

} // namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY::PLACE_BLOCK

// Grasp a block from above and lift it.
namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY::PICK_BLOCK { // pick_and_place.yml:8

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
        CHECK_GRASP(arm, std::optional<std::string>{std::string("right")}, std::optional<std::string>{std::string("block")}) {}

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
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/OPEN_GRIPPER", "pick_block.yml:8", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/OPEN_GRIPPER", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/PLAN_HOVER", "pick_block.yml:14", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/PLAN_HOVER", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/MOVE_TO_HOVER", "pick_block.yml:21", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/MOVE_TO_HOVER", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/MOVE_DOWN", "pick_block.yml:27", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/MOVE_DOWN", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/CLOSE_GRIPPER", "pick_block.yml:34", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/CLOSE_GRIPPER", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/LIFT", "pick_block.yml:40", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/LIFT", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK/CHECK_GRASP", "pick_block.yml:47", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/CHECK_GRASP", "recovery/RIGHT/TRY/CARRY/PICK_BLOCK"},
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

} // namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY::PICK_BLOCK

namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY { // try_arm.yml:23

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
  PICK_BLOCK::Userdata PICK_BLOCK_;
  PLACE_BLOCK::Userdata PLACE_BLOCK_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
  const smachac::Key<smachac::Pose> &place_pose;
};

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : PICK_BLOCK_(arm),
        PLACE_BLOCK_(arm, world) {}

  PICK_BLOCK::States PICK_BLOCK_;
  PLACE_BLOCK::States PLACE_BLOCK_;
};

enum class State : std::size_t {
  PICK_BLOCK,
  PLACE_BLOCK,
};

inline constexpr smachac::Place places[] = {
    {"recovery/RIGHT/TRY/CARRY/PICK_BLOCK", "pick_and_place.yml:8", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PICK_BLOCK", "recovery/RIGHT/TRY/CARRY"},
    {"recovery/RIGHT/TRY/CARRY/PLACE_BLOCK", "pick_and_place.yml:12", "recovery/RIGHT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK", "recovery/RIGHT/TRY/CARRY"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PICK_BLOCK;
  SMACHAC_TRY {
    switch (state) {
    case State::PICK_BLOCK: // pick_and_place.yml:8
      run.enter(places, state);
      switch (PICK_BLOCK::execute(states.PICK_BLOCK_, {ud.own_.PICK_BLOCK_, ud.hover_offset, ud.pick_pose}, run)) {
      case PICK_BLOCK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_BLOCK);
        goto PLACE_BLOCK;
      case PICK_BLOCK::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case PICK_BLOCK::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::PLACE_BLOCK: // pick_and_place.yml:12
    PLACE_BLOCK:
      run.enter(places, state);
      switch (PLACE_BLOCK::execute(states.PLACE_BLOCK_, {ud.own_.PLACE_BLOCK_, ud.hover_offset, ud.place_pose}, run)) {
      case PLACE_BLOCK::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case PLACE_BLOCK::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case PLACE_BLOCK::Outcome::preempted:
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

} // namespace recovery::RIGHT::TRY::TRY::CARRY::CARRY

// Pick a block up and place it.
namespace recovery::RIGHT::TRY::TRY::CARRY { // try_arm.yml:23

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
  timeout,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted", "timeout"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  CARRY::Userdata CARRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
  const smachac::Key<smachac::Pose> &place_pose;
};

namespace types {

/// try_arm.yml:23
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(20.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : CARRY_(arm, world) {}

  CARRY::States CARRY_;
  types::TIMER TIMER{};
};

enum class State : std::size_t {
  CARRY,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"recovery/RIGHT/TRY/CARRY", "try_arm.yml:23", "recovery/RIGHT/TRY/TRY/CARRY/CARRY", "recovery/RIGHT/TRY/CARRY (timeout)"},
    {"recovery/RIGHT/TRY/CARRY (timeout)/TIMER", "try_arm.yml:23", "recovery/RIGHT/TRY/TRY/CARRY/TIMER", "recovery/RIGHT/TRY/CARRY (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &around) {
  struct {
    CARRY::Outcome CARRY;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::CARRY: // try_arm.yml:23
        run.enter(places, state);
        ended.CARRY = CARRY::execute(states.CARRY_, {ud.own_.CARRY_, ud.hover_offset, ud.pick_pose, ud.place_pose}, run);
        switch (ended.CARRY) {
        case CARRY::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case CARRY::Outcome::aborted:
          run.exit(places, state, "aborted");
          return;
        case CARRY::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::TIMER: // try_arm.yml:23
        run.enter(places, state);
        ended.TIMER = states.TIMER.execute(run.stop_for(places, state));
        switch (ended.TIMER) {
        case types::TIMER::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::TIMER::Outcome::preempted:
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
  if (branches.stopped()) {
    return Outcome::preempted;
  }
  if (ended.CARRY == CARRY::Outcome::preempted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::preempted;
  }
  if (ended.CARRY == CARRY::Outcome::aborted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::aborted;
  }
  if (ended.CARRY == CARRY::Outcome::succeeded &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::succeeded;
  }
  return Outcome::timeout;
}

} // namespace recovery::RIGHT::TRY::TRY::CARRY

namespace recovery::RIGHT::TRY::TRY { // try_arm.yml:10

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
  smachac::Key<smachac::Pose> block_pose;
  smachac::Key<double> gripper_width;
  CARRY::Userdata CARRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : FIND_BLOCK(world, std::string("block")),
        CARRY_(arm, world),
        LET_GO(arm, std::optional<std::string>{std::string("right")}, std::string("open")),
        RETREAT(arm, std::optional<std::string>{std::string("right")}, 1.0) {}

  ::smachac::ReadBodyPoseState FIND_BLOCK;
  CARRY::States CARRY_;
  ::smachac::GripperState LET_GO;
  ::smachac::MoveToJointPositionsState RETREAT;
};

enum class State : std::size_t {
  FIND_BLOCK,
  CARRY,
  LET_GO,
  RETREAT,
};

inline constexpr smachac::Place places[] = {
    {"recovery/RIGHT/TRY/FIND_BLOCK", "try_arm.yml:17", "recovery/RIGHT/TRY/TRY/FIND_BLOCK", "recovery/RIGHT/TRY"},
    {"recovery/RIGHT/TRY/CARRY (timeout)", "try_arm.yml:23", "recovery/RIGHT/TRY/TRY/CARRY", "recovery/RIGHT/TRY"},
    {"recovery/RIGHT/TRY/LET_GO", "try_arm.yml:32", "recovery/RIGHT/TRY/TRY/LET_GO", "recovery/RIGHT/TRY"},
    {"recovery/RIGHT/TRY/RETREAT", "try_arm.yml:39", "recovery/RIGHT/TRY/TRY/RETREAT", "recovery/RIGHT/TRY"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::FIND_BLOCK;
  SMACHAC_TRY {
    switch (state) {
    case State::FIND_BLOCK: // try_arm.yml:17
      run.enter(places, state);
      switch (run.wrote(states.FIND_BLOCK.execute({run.out(ud.own_.block_pose)}), smachac::Output{"pose", ud.own_.block_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CARRY);
        goto CARRY;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::CARRY: // try_arm.yml:23
    CARRY:
      run.enter(places, state);
      switch (CARRY::execute(states.CARRY_, {ud.own_.CARRY_, ud.hover_offset, ud.own_.block_pose, ud.goal_pose}, run)) {
      case CARRY::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case CARRY::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      case CARRY::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case CARRY::Outcome::timeout:
        run.go(places, state, "timeout", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::LET_GO: // try_arm.yml:32
    LET_GO:
      run.enter(places, state);
      switch (run.wrote(states.LET_GO.execute({run.out(ud.own_.gripper_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.gripper_width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::aborted:
        run.go(places, state, "aborted", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::RETREAT: // try_arm.yml:39
    RETREAT:
      run.enter(places, state);
      switch (states.RETREAT.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
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

} // namespace recovery::RIGHT::TRY::TRY

namespace recovery::RIGHT::TRY { // try_arm.yml:10

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
  TRY::Userdata TRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : TRY_(world, arm) {}

  TRY::States TRY_;
};

enum class State : std::size_t {
  TRY,
};

inline constexpr smachac::Place places[] = {
    {"recovery/RIGHT/TRY", "try_arm.yml:10", "recovery/RIGHT/TRY/TRY", "recovery/RIGHT/TRY (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRY;
  for (const auto &item : items) {
    ud.own_.attempt.hold(item);
    // try_arm.yml:10
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRY::execute(states.TRY_, {ud.own_.TRY_, ud.goal_pose, ud.home, ud.hover_offset}, run);
      const bool over = round.over();
      switch (outcome) {
      case TRY::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case TRY::Outcome::aborted:
        if (over) {
          return run.end(places, state, "aborted", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "aborted", Outcome::exhausted);
        }
        run.again(places, state, "aborted");
        continue;
      case TRY::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace recovery::RIGHT::TRY

// Pick and place the block with one arm, in at most three tries.
namespace recovery::RIGHT { // main.yml:26

enum class Outcome : std::uint8_t {
  succeeded,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  TRY::Userdata TRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : TRY_(world, arm),
        HOME(arm, std::optional<std::string>{std::string("right")}, 1.0) {}

  TRY::States TRY_;
  ::smachac::MoveToJointPositionsState HOME;
};

enum class State : std::size_t {
  TRY,
  HOME,
};

inline constexpr smachac::Place places[] = {
    {"recovery/RIGHT/TRY (retry)", "try_arm.yml:10", "recovery/RIGHT/TRY", "recovery/RIGHT"},
    {"recovery/RIGHT/HOME", "try_arm.yml:45"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::TRY;
  SMACHAC_TRY {
    switch (state) {
    case State::TRY: // try_arm.yml:10
      run.enter(places, state);
      switch (TRY::execute(states.TRY_, {ud.own_.TRY_, ud.goal_pose, ud.home, ud.hover_offset}, run)) {
      case TRY::Outcome::succeeded:
        run.go(places, state, "succeeded", State::HOME);
        goto HOME;
      case TRY::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case TRY::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::exhausted);
      }
      break;
    case State::HOME: // try_arm.yml:45
    HOME:
      run.enter(places, state);
      switch (states.HOME.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::exhausted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
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

} // namespace recovery::RIGHT

// Place the block in the gripper and check where it lies.
namespace recovery::LEFT::TRY::TRY::CARRY::CARRY::PLACE_BLOCK { // pick_and_place.yml:12

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
        CHECK_PLACED(world, std::string("block"), 0.001) {}

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
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/PLAN_HOVER", "place_block.yml:9", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/PLAN_HOVER", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/MOVE_TO_HOVER", "place_block.yml:16", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_TO_HOVER", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/MOVE_DOWN", "place_block.yml:22", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_DOWN", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/OPEN_GRIPPER", "place_block.yml:29", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/OPEN_GRIPPER", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/MOVE_UP", "place_block.yml:35", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/MOVE_UP", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK/CHECK_PLACED", "place_block.yml:42", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK/CHECK_PLACED", "recovery/LEFT/TRY/CARRY/PLACE_BLOCK"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
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

} // namespace recovery::LEFT::TRY::TRY::CARRY::CARRY::PLACE_BLOCK

// Grasp a block from above and lift it.
namespace recovery::LEFT::TRY::TRY::CARRY::CARRY::PICK_BLOCK { // pick_and_place.yml:8

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
        CHECK_GRASP(arm, std::optional<std::string>{std::string("left")}, std::optional<std::string>{std::string("block")}) {}

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
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/OPEN_GRIPPER", "pick_block.yml:8", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/OPEN_GRIPPER", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/PLAN_HOVER", "pick_block.yml:14", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/PLAN_HOVER", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/MOVE_TO_HOVER", "pick_block.yml:21", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/MOVE_TO_HOVER", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/MOVE_DOWN", "pick_block.yml:27", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/MOVE_DOWN", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/CLOSE_GRIPPER", "pick_block.yml:34", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/CLOSE_GRIPPER", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/LIFT", "pick_block.yml:40", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/LIFT", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK/CHECK_GRASP", "pick_block.yml:47", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK/CHECK_GRASP", "recovery/LEFT/TRY/CARRY/PICK_BLOCK"},
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

} // namespace recovery::LEFT::TRY::TRY::CARRY::CARRY::PICK_BLOCK

namespace recovery::LEFT::TRY::TRY::CARRY::CARRY { // try_arm.yml:23

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
  PICK_BLOCK::Userdata PICK_BLOCK_;
  PLACE_BLOCK::Userdata PLACE_BLOCK_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
  const smachac::Key<smachac::Pose> &place_pose;
};

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : PICK_BLOCK_(arm),
        PLACE_BLOCK_(arm, world) {}

  PICK_BLOCK::States PICK_BLOCK_;
  PLACE_BLOCK::States PLACE_BLOCK_;
};

enum class State : std::size_t {
  PICK_BLOCK,
  PLACE_BLOCK,
};

inline constexpr smachac::Place places[] = {
    {"recovery/LEFT/TRY/CARRY/PICK_BLOCK", "pick_and_place.yml:8", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PICK_BLOCK", "recovery/LEFT/TRY/CARRY"},
    {"recovery/LEFT/TRY/CARRY/PLACE_BLOCK", "pick_and_place.yml:12", "recovery/LEFT/TRY/TRY/CARRY/CARRY/PLACE_BLOCK", "recovery/LEFT/TRY/CARRY"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PICK_BLOCK;
  SMACHAC_TRY {
    switch (state) {
    case State::PICK_BLOCK: // pick_and_place.yml:8
      run.enter(places, state);
      switch (PICK_BLOCK::execute(states.PICK_BLOCK_, {ud.own_.PICK_BLOCK_, ud.hover_offset, ud.pick_pose}, run)) {
      case PICK_BLOCK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_BLOCK);
        goto PLACE_BLOCK;
      case PICK_BLOCK::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case PICK_BLOCK::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::PLACE_BLOCK: // pick_and_place.yml:12
    PLACE_BLOCK:
      run.enter(places, state);
      switch (PLACE_BLOCK::execute(states.PLACE_BLOCK_, {ud.own_.PLACE_BLOCK_, ud.hover_offset, ud.place_pose}, run)) {
      case PLACE_BLOCK::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case PLACE_BLOCK::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case PLACE_BLOCK::Outcome::preempted:
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

} // namespace recovery::LEFT::TRY::TRY::CARRY::CARRY

// Pick a block up and place it.
namespace recovery::LEFT::TRY::TRY::CARRY { // try_arm.yml:23

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
  timeout,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted", "timeout"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  CARRY::Userdata CARRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &hover_offset;
  const smachac::Key<smachac::Pose> &pick_pose;
  const smachac::Key<smachac::Pose> &place_pose;
};

namespace types {

/// try_arm.yml:23
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(20.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  States(smachac::Arm &arm, smachac::World &world)
      : CARRY_(arm, world) {}

  CARRY::States CARRY_;
  types::TIMER TIMER{};
};

enum class State : std::size_t {
  CARRY,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"recovery/LEFT/TRY/CARRY", "try_arm.yml:23", "recovery/LEFT/TRY/TRY/CARRY/CARRY", "recovery/LEFT/TRY/CARRY (timeout)"},
    {"recovery/LEFT/TRY/CARRY (timeout)/TIMER", "try_arm.yml:23", "recovery/LEFT/TRY/TRY/CARRY/TIMER", "recovery/LEFT/TRY/CARRY (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &around) {
  struct {
    CARRY::Outcome CARRY;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::CARRY: // try_arm.yml:23
        run.enter(places, state);
        ended.CARRY = CARRY::execute(states.CARRY_, {ud.own_.CARRY_, ud.hover_offset, ud.pick_pose, ud.place_pose}, run);
        switch (ended.CARRY) {
        case CARRY::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case CARRY::Outcome::aborted:
          run.exit(places, state, "aborted");
          return;
        case CARRY::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::TIMER: // try_arm.yml:23
        run.enter(places, state);
        ended.TIMER = states.TIMER.execute(run.stop_for(places, state));
        switch (ended.TIMER) {
        case types::TIMER::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::TIMER::Outcome::preempted:
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
  if (branches.stopped()) {
    return Outcome::preempted;
  }
  if (ended.CARRY == CARRY::Outcome::preempted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::preempted;
  }
  if (ended.CARRY == CARRY::Outcome::aborted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::aborted;
  }
  if (ended.CARRY == CARRY::Outcome::succeeded &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::succeeded;
  }
  return Outcome::timeout;
}

} // namespace recovery::LEFT::TRY::TRY::CARRY

namespace recovery::LEFT::TRY::TRY { // try_arm.yml:10

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
  smachac::Key<smachac::Pose> block_pose;
  smachac::Key<double> gripper_width;
  CARRY::Userdata CARRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : FIND_BLOCK(world, std::string("block")),
        CARRY_(arm, world),
        LET_GO(arm, std::optional<std::string>{std::string("left")}, std::string("open")),
        RETREAT(arm, std::optional<std::string>{std::string("left")}, 1.0) {}

  ::smachac::ReadBodyPoseState FIND_BLOCK;
  CARRY::States CARRY_;
  ::smachac::GripperState LET_GO;
  ::smachac::MoveToJointPositionsState RETREAT;
};

enum class State : std::size_t {
  FIND_BLOCK,
  CARRY,
  LET_GO,
  RETREAT,
};

inline constexpr smachac::Place places[] = {
    {"recovery/LEFT/TRY/FIND_BLOCK", "try_arm.yml:17", "recovery/LEFT/TRY/TRY/FIND_BLOCK", "recovery/LEFT/TRY"},
    {"recovery/LEFT/TRY/CARRY (timeout)", "try_arm.yml:23", "recovery/LEFT/TRY/TRY/CARRY", "recovery/LEFT/TRY"},
    {"recovery/LEFT/TRY/LET_GO", "try_arm.yml:32", "recovery/LEFT/TRY/TRY/LET_GO", "recovery/LEFT/TRY"},
    {"recovery/LEFT/TRY/RETREAT", "try_arm.yml:39", "recovery/LEFT/TRY/TRY/RETREAT", "recovery/LEFT/TRY"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::FIND_BLOCK;
  SMACHAC_TRY {
    switch (state) {
    case State::FIND_BLOCK: // try_arm.yml:17
      run.enter(places, state);
      switch (run.wrote(states.FIND_BLOCK.execute({run.out(ud.own_.block_pose)}), smachac::Output{"pose", ud.own_.block_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CARRY);
        goto CARRY;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::CARRY: // try_arm.yml:23
    CARRY:
      run.enter(places, state);
      switch (CARRY::execute(states.CARRY_, {ud.own_.CARRY_, ud.hover_offset, ud.own_.block_pose, ud.goal_pose}, run)) {
      case CARRY::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case CARRY::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      case CARRY::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case CARRY::Outcome::timeout:
        run.go(places, state, "timeout", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::LET_GO: // try_arm.yml:32
    LET_GO:
      run.enter(places, state);
      switch (run.wrote(states.LET_GO.execute({run.out(ud.own_.gripper_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.gripper_width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::aborted:
        run.go(places, state, "aborted", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::RETREAT: // try_arm.yml:39
    RETREAT:
      run.enter(places, state);
      switch (states.RETREAT.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
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

} // namespace recovery::LEFT::TRY::TRY

namespace recovery::LEFT::TRY { // try_arm.yml:10

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
  TRY::Userdata TRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : TRY_(world, arm) {}

  TRY::States TRY_;
};

enum class State : std::size_t {
  TRY,
};

inline constexpr smachac::Place places[] = {
    {"recovery/LEFT/TRY", "try_arm.yml:10", "recovery/LEFT/TRY/TRY", "recovery/LEFT/TRY (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRY;
  for (const auto &item : items) {
    ud.own_.attempt.hold(item);
    // try_arm.yml:10
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRY::execute(states.TRY_, {ud.own_.TRY_, ud.goal_pose, ud.home, ud.hover_offset}, run);
      const bool over = round.over();
      switch (outcome) {
      case TRY::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case TRY::Outcome::aborted:
        if (over) {
          return run.end(places, state, "aborted", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "aborted", Outcome::exhausted);
        }
        run.again(places, state, "aborted");
        continue;
      case TRY::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace recovery::LEFT::TRY

// Pick and place the block with one arm, in at most three tries.
namespace recovery::LEFT { // main.yml:20

enum class Outcome : std::uint8_t {
  succeeded,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  TRY::Userdata TRY_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &goal_pose;
  const smachac::Key<std::array<double, 7>> &home;
  const smachac::Key<smachac::Pose> &hover_offset;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : TRY_(world, arm),
        HOME(arm, std::optional<std::string>{std::string("left")}, 1.0) {}

  TRY::States TRY_;
  ::smachac::MoveToJointPositionsState HOME;
};

enum class State : std::size_t {
  TRY,
  HOME,
};

inline constexpr smachac::Place places[] = {
    {"recovery/LEFT/TRY (retry)", "try_arm.yml:10", "recovery/LEFT/TRY", "recovery/LEFT"},
    {"recovery/LEFT/HOME", "try_arm.yml:45"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::TRY;
  SMACHAC_TRY {
    switch (state) {
    case State::TRY: // try_arm.yml:10
      run.enter(places, state);
      switch (TRY::execute(states.TRY_, {ud.own_.TRY_, ud.goal_pose, ud.home, ud.hover_offset}, run)) {
      case TRY::Outcome::succeeded:
        run.go(places, state, "succeeded", State::HOME);
        goto HOME;
      case TRY::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case TRY::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::exhausted);
      }
      break;
    case State::HOME: // try_arm.yml:45
    HOME:
      run.enter(places, state);
      switch (states.HOME.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::exhausted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
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

} // namespace recovery::LEFT

// Pick and place a block in spite of faults.
namespace recovery { // main.yml:2

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
  smachac::Key<smachac::Pose> goal_pose;
  smachac::Key<smachac::Pose> hover_offset{smachac::Pose{smachac::Point{0.0, 0.0, 0.12}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<std::array<double, 7>> left_home{std::array<double, 7>{{-0.08, -0.99998, -1.18997, 1.94002, 0.67, 1.03001, -0.5}}};
  smachac::Key<std::array<double, 7>> right_home{std::array<double, 7>{{0.08, -0.99998, 1.18997, 1.94002, -0.67, 1.03001, 0.5}}};
  LEFT::Userdata LEFT_;
  RIGHT::Userdata RIGHT_;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : FIND_MARK(world, std::string("mark")),
        LEFT_(world, arm),
        RIGHT_(world, arm) {}

  ::smachac::ReadBodyPoseState FIND_MARK;
  LEFT::States LEFT_;
  RIGHT::States RIGHT_;
};

enum class State : std::size_t {
  FIND_MARK,
  LEFT,
  RIGHT,
};

inline constexpr smachac::Place places[] = {
    {"recovery/FIND_MARK", "main.yml:14"},
    {"recovery/LEFT", "main.yml:20"},
    {"recovery/RIGHT", "main.yml:26"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::FIND_MARK;
  SMACHAC_TRY {
    switch (state) {
    case State::FIND_MARK: // main.yml:14
      run.enter(places, state);
      switch (run.wrote(states.FIND_MARK.execute({run.out(ud.goal_pose)}), smachac::Output{"pose", ud.goal_pose})) {
      case ::smachac::ReadBodyPoseState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LEFT);
        goto LEFT;
      case ::smachac::ReadBodyPoseState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LEFT: // main.yml:20
    LEFT:
      run.enter(places, state);
      switch (LEFT::execute(states.LEFT_, {ud.LEFT_, ud.goal_pose, ud.left_home, ud.hover_offset}, run)) {
      case LEFT::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case LEFT::Outcome::exhausted:
        run.go(places, state, "exhausted", State::RIGHT);
        goto RIGHT;
      case LEFT::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::RIGHT: // main.yml:26
    RIGHT:
      run.enter(places, state);
      switch (RIGHT::execute(states.RIGHT_, {ud.RIGHT_, ud.goal_pose, ud.right_home, ud.hover_offset}, run)) {
      case RIGHT::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case RIGHT::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::aborted);
      case RIGHT::Outcome::preempted:
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
  watched.start({"recovery", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"recovery", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace recovery

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
