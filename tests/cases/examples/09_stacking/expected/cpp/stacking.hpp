// Made by smachac 0.1.0 from main.yml (sha256 67ca23235b32e45d).
#pragma once

#include "smachac/arm.hpp"
#include "smachac/smachac.hpp"

// A class with more outcomes than its interface is an error at every warning level.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#endif

static_assert(::smachac::LoadModelState::smachac_interface == 0x8fbc7534U,
              "smachac::LoadModelState was written for another LoadModelState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::LoadModelState::In::pose), const smachac::Pose &>,
              "smachac::LoadModelState::In::pose must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::smachac::LoadModelState::In::reference_frame), const std::optional<std::string> &>,
              "smachac::LoadModelState::In::reference_frame must be const std::optional<std::string> &");
static_assert(std::is_same_v<decltype(::smachac::LoadModelState::Out::pose), smachac::Key<smachac::Pose> &>,
              "smachac::LoadModelState::Out::pose must be smachac::Key<smachac::Pose> &");

static_assert(::smachac::MoveToJointPositionsState::smachac_interface == 0x1e53a7a2U,
              "smachac::MoveToJointPositionsState was written for another MoveToJointPositionsState.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::smachac::MoveToJointPositionsState::In::positions), const std::vector<double> &>,
              "smachac::MoveToJointPositionsState::In::positions must be const std::vector<double> &");

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

// Place the block in the gripper and look whether it lies there.
namespace stacking::PLACE_SECOND { // main.yml:83

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
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
      : PLAN_HOVER(arm, std::optional<std::string>{}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{}, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("second")}),
        MOVE_DOWN(arm, std::optional<std::string>{}, true, 1.0),
        OPEN_GRIPPER(arm, std::optional<std::string>{}, std::string("open")),
        MOVE_UP(arm, std::optional<std::string>{}, true, 1.0),
        CHECK_PLACED(world, std::string("second"), 0.002) {}

  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::CheckGraspState CHECK_GRASP;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::MoveAlongState MOVE_UP;
  ::smachac::CheckPlacedState CHECK_PLACED;
};

enum class State : std::size_t {
  PLAN_HOVER,
  MOVE_TO_HOVER,
  CHECK_GRASP,
  MOVE_DOWN,
  OPEN_GRIPPER,
  MOVE_UP,
  CHECK_PLACED,
};

inline constexpr smachac::Place places[] = {
    {"stacking/PLACE_SECOND/PLAN_HOVER", "place_block.yml:9"},
    {"stacking/PLACE_SECOND/MOVE_TO_HOVER", "place_block.yml:15"},
    {"stacking/PLACE_SECOND/CHECK_GRASP", "place_block.yml:20"},
    {"stacking/PLACE_SECOND/MOVE_DOWN", "place_block.yml:25"},
    {"stacking/PLACE_SECOND/OPEN_GRIPPER", "place_block.yml:31"},
    {"stacking/PLACE_SECOND/MOVE_UP", "place_block.yml:36"},
    {"stacking/PLACE_SECOND/CHECK_PLACED", "place_block.yml:42"},
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
    case State::MOVE_TO_HOVER: // place_block.yml:15
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CHECK_GRASP: // place_block.yml:20
    CHECK_GRASP:
      run.enter(places, state);
      switch (states.CHECK_GRASP.execute()) {
      case ::smachac::CheckGraspState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::CheckGraspState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_DOWN: // place_block.yml:25
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({smachac::need(ud.place_pose, "pose"), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::OPEN_GRIPPER);
        goto OPEN_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::OPEN_GRIPPER: // place_block.yml:31
    OPEN_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_UP);
        goto MOVE_UP;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::MOVE_UP: // place_block.yml:36
    MOVE_UP:
      run.enter(places, state);
      switch (states.MOVE_UP.execute({smachac::need(ud.place_pose, "pose"), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_PLACED);
        goto CHECK_PLACED;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
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

} // namespace stacking::PLACE_SECOND

// Grasp a block from above and lift it.
namespace stacking::PICK_SECOND { // main.yml:77

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
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
      : OPEN_GRIPPER(arm, std::optional<std::string>{}, std::string("open")),
        PLAN_HOVER(arm, std::optional<std::string>{}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{}, true, 1.0),
        CLOSE_GRIPPER(arm, std::optional<std::string>{}, std::string("close")),
        LIFT(arm, std::optional<std::string>{}, true, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("second")}) {}

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
    {"stacking/PICK_SECOND/OPEN_GRIPPER", "pick_block.yml:8"},
    {"stacking/PICK_SECOND/PLAN_HOVER", "pick_block.yml:13"},
    {"stacking/PICK_SECOND/MOVE_TO_HOVER", "pick_block.yml:19"},
    {"stacking/PICK_SECOND/MOVE_DOWN", "pick_block.yml:24"},
    {"stacking/PICK_SECOND/CLOSE_GRIPPER", "pick_block.yml:30"},
    {"stacking/PICK_SECOND/LIFT", "pick_block.yml:35"},
    {"stacking/PICK_SECOND/CHECK_GRASP", "pick_block.yml:41"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
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
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::PLAN_HOVER: // pick_block.yml:13
    PLAN_HOVER:
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({ud.pick_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // pick_block.yml:19
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::MOVE_DOWN: // pick_block.yml:24
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({ud.pick_pose.unchecked(), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CLOSE_GRIPPER);
        goto CLOSE_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CLOSE_GRIPPER: // pick_block.yml:30
    CLOSE_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.CLOSE_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LIFT);
        goto LIFT;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::LIFT: // pick_block.yml:35
    LIFT:
      run.enter(places, state);
      switch (states.LIFT.execute({ud.pick_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CHECK_GRASP: // pick_block.yml:41
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

} // namespace stacking::PICK_SECOND

// Place the block in the gripper and look whether it lies there.
namespace stacking::PLACE_FIRST { // main.yml:71

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
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
      : PLAN_HOVER(arm, std::optional<std::string>{}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{}, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("first")}),
        MOVE_DOWN(arm, std::optional<std::string>{}, true, 1.0),
        OPEN_GRIPPER(arm, std::optional<std::string>{}, std::string("open")),
        MOVE_UP(arm, std::optional<std::string>{}, true, 1.0),
        CHECK_PLACED(world, std::string("first"), 0.002) {}

  ::smachac::PoseToJointPositionsState PLAN_HOVER;
  ::smachac::MoveToJointPositionsState MOVE_TO_HOVER;
  ::smachac::CheckGraspState CHECK_GRASP;
  ::smachac::MoveAlongState MOVE_DOWN;
  ::smachac::GripperState OPEN_GRIPPER;
  ::smachac::MoveAlongState MOVE_UP;
  ::smachac::CheckPlacedState CHECK_PLACED;
};

enum class State : std::size_t {
  PLAN_HOVER,
  MOVE_TO_HOVER,
  CHECK_GRASP,
  MOVE_DOWN,
  OPEN_GRIPPER,
  MOVE_UP,
  CHECK_PLACED,
};

inline constexpr smachac::Place places[] = {
    {"stacking/PLACE_FIRST/PLAN_HOVER", "place_block.yml:9"},
    {"stacking/PLACE_FIRST/MOVE_TO_HOVER", "place_block.yml:15"},
    {"stacking/PLACE_FIRST/CHECK_GRASP", "place_block.yml:20"},
    {"stacking/PLACE_FIRST/MOVE_DOWN", "place_block.yml:25"},
    {"stacking/PLACE_FIRST/OPEN_GRIPPER", "place_block.yml:31"},
    {"stacking/PLACE_FIRST/MOVE_UP", "place_block.yml:36"},
    {"stacking/PLACE_FIRST/CHECK_PLACED", "place_block.yml:42"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PLAN_HOVER;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAN_HOVER: // place_block.yml:9
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({ud.place_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // place_block.yml:15
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CHECK_GRASP: // place_block.yml:20
    CHECK_GRASP:
      run.enter(places, state);
      switch (states.CHECK_GRASP.execute()) {
      case ::smachac::CheckGraspState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::CheckGraspState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_DOWN: // place_block.yml:25
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({ud.place_pose.unchecked(), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::OPEN_GRIPPER);
        goto OPEN_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::OPEN_GRIPPER: // place_block.yml:31
    OPEN_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_UP);
        goto MOVE_UP;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::MOVE_UP: // place_block.yml:36
    MOVE_UP:
      run.enter(places, state);
      switch (states.MOVE_UP.execute({ud.place_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_PLACED);
        goto CHECK_PLACED;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CHECK_PLACED: // place_block.yml:42
    CHECK_PLACED:
      run.enter(places, state);
      switch (run.wrote(states.CHECK_PLACED.execute({ud.place_pose.unchecked()}, {run.out(ud.own_.placing_error)}), smachac::Output{"error", ud.own_.placing_error})) {
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

} // namespace stacking::PLACE_FIRST

// Grasp a block from above and lift it.
namespace stacking::PICK_FIRST { // main.yml:65

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
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
      : OPEN_GRIPPER(arm, std::optional<std::string>{}, std::string("open")),
        PLAN_HOVER(arm, std::optional<std::string>{}, true),
        MOVE_TO_HOVER(arm, std::optional<std::string>{}, 1.0),
        MOVE_DOWN(arm, std::optional<std::string>{}, true, 1.0),
        CLOSE_GRIPPER(arm, std::optional<std::string>{}, std::string("close")),
        LIFT(arm, std::optional<std::string>{}, true, 1.0),
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("first")}) {}

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
    {"stacking/PICK_FIRST/OPEN_GRIPPER", "pick_block.yml:8"},
    {"stacking/PICK_FIRST/PLAN_HOVER", "pick_block.yml:13"},
    {"stacking/PICK_FIRST/MOVE_TO_HOVER", "pick_block.yml:19"},
    {"stacking/PICK_FIRST/MOVE_DOWN", "pick_block.yml:24"},
    {"stacking/PICK_FIRST/CLOSE_GRIPPER", "pick_block.yml:30"},
    {"stacking/PICK_FIRST/LIFT", "pick_block.yml:35"},
    {"stacking/PICK_FIRST/CHECK_GRASP", "pick_block.yml:41"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
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
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::PLAN_HOVER: // pick_block.yml:13
    PLAN_HOVER:
      run.enter(places, state);
      switch (run.wrote(states.PLAN_HOVER.execute({ud.pick_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, {run.out(ud.own_.hover_joints)}), smachac::Output{"joints", ud.own_.hover_joints})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
        goto MOVE_TO_HOVER;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_HOVER: // pick_block.yml:19
    MOVE_TO_HOVER:
      run.enter(places, state);
      switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.own_.hover_joints, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_DOWN);
        goto MOVE_DOWN;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::MOVE_DOWN: // pick_block.yml:24
    MOVE_DOWN:
      run.enter(places, state);
      switch (states.MOVE_DOWN.execute({ud.pick_pose.unchecked(), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CLOSE_GRIPPER);
        goto CLOSE_GRIPPER;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CLOSE_GRIPPER: // pick_block.yml:30
    CLOSE_GRIPPER:
      run.enter(places, state);
      switch (run.wrote(states.CLOSE_GRIPPER.execute({run.out(ud.own_.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.own_.width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LIFT);
        goto LIFT;
      case ::smachac::GripperState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::LIFT: // pick_block.yml:35
    LIFT:
      run.enter(places, state);
      switch (states.LIFT.execute({ud.pick_pose.unchecked(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveAlongState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_GRASP);
        goto CHECK_GRASP;
      case ::smachac::MoveAlongState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveAlongState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::CHECK_GRASP: // pick_block.yml:41
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

} // namespace stacking::PICK_FIRST

// Stack two blocks on the mark.
namespace stacking { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> first_error;
  smachac::Key<smachac::Pose> first_pose{smachac::Pose{smachac::Point{0.5, 0.0, 0.025}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<smachac::Pose> goal_pose{smachac::Pose{smachac::Point{0.5, 0.0, 0.025}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<double> gripper_width;
  smachac::Key<std::array<double, 7>> home{std::array<double, 7>{{0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785}}};
  smachac::Key<smachac::Pose> hover_offset{smachac::Pose{smachac::Point{0.0, 0.0, 0.15}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<std::optional<std::string>> reference_frame;
  smachac::Key<smachac::Pose> second_pose{smachac::Pose{smachac::Point{0.5, 0.0, 0.025}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<std::string> table_frame{std::string("world")};
  smachac::Key<smachac::Pose> table_pose{smachac::Pose{smachac::Point{0.55, 0.0, 0.0}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<smachac::Pose> top_pose;
  PICK_FIRST::Userdata PICK_FIRST_;
  PLACE_FIRST::Userdata PLACE_FIRST_;
  PICK_SECOND::Userdata PICK_SECOND_;
  PLACE_SECOND::Userdata PLACE_SECOND_;
};

namespace types {

/// main.yml:51
struct PLAN_STACK {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("top_pose", ud.top_pose, smachac::Pose{smachac::Point{ud.goal_pose.unchecked().position.x, ud.goal_pose.unchecked().position.y, ud.goal_pose.unchecked().position.z + 0.05}, ud.goal_pose.unchecked().orientation});
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : LOAD_TABLE(world, std::string("table"), std::optional<std::string>{}, std::optional<std::string>{}, std::array<double, 3>{{0.0, 0.0, 0.0}}, std::map<std::string, double>{}),
        LOAD_FIRST(world, std::string("block"), std::optional<std::string>{}, std::optional<std::string>{std::string("first")}, std::array<double, 3>{{0.14, 0.28, 3.1416}}, std::map<std::string, double>{}),
        LOAD_SECOND(world, std::string("block"), std::optional<std::string>{}, std::optional<std::string>{std::string("second")}, std::array<double, 3>{{0.14, 0.28, 3.1416}}, std::map<std::string, double>{{std::string("first"), 0.15}}),
        LOAD_MARK(world, std::string("goal"), std::optional<std::string>{}, std::optional<std::string>{}, std::array<double, 3>{{0.14, 0.28, 0.0}}, std::map<std::string, double>{{std::string("first"), 0.15}, {std::string("second"), 0.15}}),
        MOVE_TO_START(arm, std::optional<std::string>{}, 1.0),
        PICK_FIRST_(arm),
        PLACE_FIRST_(arm, world),
        PICK_SECOND_(arm),
        PLACE_SECOND_(arm, world),
        CHECK_FIRST(world, std::string("first"), 0.002),
        GO_HOME(arm, std::optional<std::string>{}, 1.0),
        LET_GO(arm, std::optional<std::string>{}, std::string("open")),
        RETREAT(arm, std::optional<std::string>{}, 1.0) {}

  ::smachac::LoadModelState LOAD_TABLE;
  ::smachac::LoadModelState LOAD_FIRST;
  ::smachac::LoadModelState LOAD_SECOND;
  ::smachac::LoadModelState LOAD_MARK;
  // The second block goes on top of the first, one edge length (0.05 m) higher.
  types::PLAN_STACK PLAN_STACK{};
  ::smachac::MoveToJointPositionsState MOVE_TO_START;
  PICK_FIRST::States PICK_FIRST_;
  PLACE_FIRST::States PLACE_FIRST_;
  PICK_SECOND::States PICK_SECOND_;
  PLACE_SECOND::States PLACE_SECOND_;
  // The second block must not have moved the first.
  ::smachac::CheckPlacedState CHECK_FIRST;
  ::smachac::MoveToJointPositionsState GO_HOME;
  ::smachac::GripperState LET_GO;
  ::smachac::MoveToJointPositionsState RETREAT;
};

enum class State : std::size_t {
  LOAD_TABLE,
  LOAD_FIRST,
  LOAD_SECOND,
  LOAD_MARK,
  PLAN_STACK,
  MOVE_TO_START,
  PICK_FIRST,
  PLACE_FIRST,
  PICK_SECOND,
  PLACE_SECOND,
  CHECK_FIRST,
  GO_HOME,
  LET_GO,
  RETREAT,
};

inline constexpr smachac::Place places[] = {
    {"stacking/LOAD_TABLE", "main.yml:11"},
    {"stacking/LOAD_FIRST", "main.yml:20"},
    {"stacking/LOAD_SECOND", "main.yml:30"},
    {"stacking/LOAD_MARK", "main.yml:41"},
    {"stacking/PLAN_STACK", "main.yml:51"},
    {"stacking/MOVE_TO_START", "main.yml:60"},
    {"stacking/PICK_FIRST", "main.yml:65"},
    {"stacking/PLACE_FIRST", "main.yml:71"},
    {"stacking/PICK_SECOND", "main.yml:77"},
    {"stacking/PLACE_SECOND", "main.yml:83"},
    {"stacking/CHECK_FIRST", "main.yml:89"},
    {"stacking/GO_HOME", "main.yml:96"},
    {"stacking/LET_GO", "main.yml:102"},
    {"stacking/RETREAT", "main.yml:108"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::LOAD_TABLE;
  SMACHAC_TRY {
    switch (state) {
    case State::LOAD_TABLE: // main.yml:11
      run.enter(places, state);
      switch (run.wrote(states.LOAD_TABLE.execute({ud.table_pose.unchecked(), smachac::convert<std::optional<std::string>>(ud.table_frame.unchecked())}, {run.out(ud.table_pose)}), smachac::Output{"pose", ud.table_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LOAD_FIRST);
        goto LOAD_FIRST;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LOAD_FIRST: // main.yml:20
    LOAD_FIRST:
      run.enter(places, state);
      switch (run.wrote(states.LOAD_FIRST.execute({ud.first_pose.unchecked(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.first_pose)}), smachac::Output{"pose", ud.first_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LOAD_SECOND);
        goto LOAD_SECOND;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LOAD_SECOND: // main.yml:30
    LOAD_SECOND:
      run.enter(places, state);
      switch (run.wrote(states.LOAD_SECOND.execute({ud.second_pose.unchecked(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.second_pose)}), smachac::Output{"pose", ud.second_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LOAD_MARK);
        goto LOAD_MARK;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LOAD_MARK: // main.yml:41
    LOAD_MARK:
      run.enter(places, state);
      switch (run.wrote(states.LOAD_MARK.execute({ud.goal_pose.unchecked(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.goal_pose)}), smachac::Output{"pose", ud.goal_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLAN_STACK);
        goto PLAN_STACK;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::PLAN_STACK: // main.yml:51
    PLAN_STACK:
      run.enter(places, state);
      switch (states.PLAN_STACK.execute(ud, run)) {
      case types::PLAN_STACK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_START);
        goto MOVE_TO_START;
      }
      break;
    case State::MOVE_TO_START: // main.yml:60
    MOVE_TO_START:
      run.enter(places, state);
      switch (states.MOVE_TO_START.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PICK_FIRST);
        goto PICK_FIRST;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::PICK_FIRST: // main.yml:65
    PICK_FIRST:
      run.enter(places, state);
      switch (PICK_FIRST::execute(states.PICK_FIRST_, {ud.PICK_FIRST_, ud.hover_offset, ud.first_pose}, run)) {
      case PICK_FIRST::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_FIRST);
        goto PLACE_FIRST;
      case PICK_FIRST::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::PLACE_FIRST: // main.yml:71
    PLACE_FIRST:
      run.enter(places, state);
      switch (PLACE_FIRST::execute(states.PLACE_FIRST_, {ud.PLACE_FIRST_, ud.hover_offset, ud.goal_pose}, run)) {
      case PLACE_FIRST::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PICK_SECOND);
        goto PICK_SECOND;
      case PLACE_FIRST::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::PICK_SECOND: // main.yml:77
    PICK_SECOND:
      run.enter(places, state);
      switch (PICK_SECOND::execute(states.PICK_SECOND_, {ud.PICK_SECOND_, ud.hover_offset, ud.second_pose}, run)) {
      case PICK_SECOND::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_SECOND);
        goto PLACE_SECOND;
      case PICK_SECOND::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::PLACE_SECOND: // main.yml:83
    PLACE_SECOND:
      run.enter(places, state);
      switch (PLACE_SECOND::execute(states.PLACE_SECOND_, {ud.PLACE_SECOND_, ud.hover_offset, ud.top_pose}, run)) {
      case PLACE_SECOND::Outcome::succeeded:
        run.go(places, state, "succeeded", State::CHECK_FIRST);
        goto CHECK_FIRST;
      case PLACE_SECOND::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::CHECK_FIRST: // main.yml:89
    CHECK_FIRST:
      run.enter(places, state);
      switch (run.wrote(states.CHECK_FIRST.execute({ud.goal_pose.unchecked()}, {run.out(ud.first_error)}), smachac::Output{"error", ud.first_error})) {
      case ::smachac::CheckPlacedState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::GO_HOME);
        goto GO_HOME;
      case ::smachac::CheckPlacedState::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::GO_HOME: // main.yml:96
    GO_HOME:
      run.enter(places, state);
      switch (states.GO_HOME.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::LET_GO: // main.yml:102
    LET_GO:
      run.enter(places, state);
      switch (run.wrote(states.LET_GO.execute({run.out(ud.gripper_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.gripper_width})) {
      case ::smachac::GripperState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::aborted:
        run.go(places, state, "aborted", State::RETREAT);
        goto RETREAT;
      case ::smachac::GripperState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::RETREAT: // main.yml:108
    RETREAT:
      run.enter(places, state);
      switch (states.RETREAT.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
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
  watched.start({"stacking", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"stacking", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace stacking

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
