// Made by smachac 0.1.0 from main.yml (sha256 745b9b82fa27dae4).
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
namespace pick_and_place::PLACE_BLOCK { // main.yml:50

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
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("block")}),
        MOVE_DOWN(arm, std::optional<std::string>{}, true, 1.0),
        OPEN_GRIPPER(arm, std::optional<std::string>{}, std::string("open")),
        MOVE_UP(arm, std::optional<std::string>{}, true, 1.0),
        CHECK_PLACED(world, std::string("block"), 0.002) {}

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
    {"pick_and_place/PLACE_BLOCK/PLAN_HOVER", "place_block.yml:9"},
    {"pick_and_place/PLACE_BLOCK/MOVE_TO_HOVER", "place_block.yml:15"},
    {"pick_and_place/PLACE_BLOCK/CHECK_GRASP", "place_block.yml:20"},
    {"pick_and_place/PLACE_BLOCK/MOVE_DOWN", "place_block.yml:25"},
    {"pick_and_place/PLACE_BLOCK/OPEN_GRIPPER", "place_block.yml:31"},
    {"pick_and_place/PLACE_BLOCK/MOVE_UP", "place_block.yml:36"},
    {"pick_and_place/PLACE_BLOCK/CHECK_PLACED", "place_block.yml:42"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
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

} // namespace pick_and_place::PLACE_BLOCK

// Grasp a block from above and lift it.
namespace pick_and_place::PICK_BLOCK { // main.yml:44

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
        CHECK_GRASP(arm, std::optional<std::string>{}, std::optional<std::string>{std::string("block")}) {}

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
    {"pick_and_place/PICK_BLOCK/OPEN_GRIPPER", "pick_block.yml:8"},
    {"pick_and_place/PICK_BLOCK/PLAN_HOVER", "pick_block.yml:13"},
    {"pick_and_place/PICK_BLOCK/MOVE_TO_HOVER", "pick_block.yml:19"},
    {"pick_and_place/PICK_BLOCK/MOVE_DOWN", "pick_block.yml:24"},
    {"pick_and_place/PICK_BLOCK/CLOSE_GRIPPER", "pick_block.yml:30"},
    {"pick_and_place/PICK_BLOCK/LIFT", "pick_block.yml:35"},
    {"pick_and_place/PICK_BLOCK/CHECK_GRASP", "pick_block.yml:41"},
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

} // namespace pick_and_place::PICK_BLOCK

// Pick the block and place it on the mark.
namespace pick_and_place { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<smachac::Pose> block_pose{smachac::Pose{smachac::Point{0.5, 0.0, 0.025}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<smachac::Pose> goal_pose{smachac::Pose{smachac::Point{0.5, 0.0, 0.025}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<double> gripper_width;
  smachac::Key<std::array<double, 7>> home{std::array<double, 7>{{0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785}}};
  smachac::Key<smachac::Pose> hover_offset{smachac::Pose{smachac::Point{0.0, 0.0, 0.15}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<std::optional<std::string>> reference_frame;
  smachac::Key<std::string> table_frame{std::string("world")};
  smachac::Key<smachac::Pose> table_pose{smachac::Pose{smachac::Point{0.55, 0.0, 0.0}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  PICK_BLOCK::Userdata PICK_BLOCK_;
  PLACE_BLOCK::Userdata PLACE_BLOCK_;
};

struct States {
  States(smachac::World &world, smachac::Arm &arm)
      : LOAD_TABLE(world, std::string("table"), std::optional<std::string>{}, std::optional<std::string>{}, std::array<double, 3>{{0.0, 0.0, 0.0}}, std::map<std::string, double>{}),
        LOAD_BLOCK(world, std::string("block"), std::optional<std::string>{}, std::optional<std::string>{}, std::array<double, 3>{{0.14, 0.28, 3.1416}}, std::map<std::string, double>{}),
        LOAD_MARK(world, std::string("goal"), std::optional<std::string>{}, std::optional<std::string>{}, std::array<double, 3>{{0.14, 0.28, 0.0}}, std::map<std::string, double>{{std::string("block"), 0.15}}),
        MOVE_TO_START(arm, std::optional<std::string>{}, 1.0),
        PICK_BLOCK_(arm),
        PLACE_BLOCK_(arm, world),
        GO_HOME(arm, std::optional<std::string>{}, 1.0),
        LET_GO(arm, std::optional<std::string>{}, std::string("open")),
        RETREAT(arm, std::optional<std::string>{}, 1.0) {}

  ::smachac::LoadModelState LOAD_TABLE;
  ::smachac::LoadModelState LOAD_BLOCK;
  ::smachac::LoadModelState LOAD_MARK;
  ::smachac::MoveToJointPositionsState MOVE_TO_START;
  PICK_BLOCK::States PICK_BLOCK_;
  PLACE_BLOCK::States PLACE_BLOCK_;
  ::smachac::MoveToJointPositionsState GO_HOME;
  ::smachac::GripperState LET_GO;
  ::smachac::MoveToJointPositionsState RETREAT;
};

enum class State : std::size_t {
  LOAD_TABLE,
  LOAD_BLOCK,
  LOAD_MARK,
  MOVE_TO_START,
  PICK_BLOCK,
  PLACE_BLOCK,
  GO_HOME,
  LET_GO,
  RETREAT,
};

inline constexpr smachac::Place places[] = {
    {"pick_and_place/LOAD_TABLE", "main.yml:11"},
    {"pick_and_place/LOAD_BLOCK", "main.yml:20"},
    {"pick_and_place/LOAD_MARK", "main.yml:29"},
    {"pick_and_place/MOVE_TO_START", "main.yml:39"},
    {"pick_and_place/PICK_BLOCK", "main.yml:44"},
    {"pick_and_place/PLACE_BLOCK", "main.yml:50"},
    {"pick_and_place/GO_HOME", "main.yml:56"},
    {"pick_and_place/LET_GO", "main.yml:62"},
    {"pick_and_place/RETREAT", "main.yml:68"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::LOAD_TABLE;
  SMACHAC_TRY {
    switch (state) {
    case State::LOAD_TABLE: // main.yml:11
      run.enter(places, state);
      switch (run.wrote(states.LOAD_TABLE.execute({ud.table_pose.unchecked(), smachac::convert<std::optional<std::string>>(ud.table_frame.unchecked())}, {run.out(ud.table_pose)}), smachac::Output{"pose", ud.table_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LOAD_BLOCK);
        goto LOAD_BLOCK;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LOAD_BLOCK: // main.yml:20
    LOAD_BLOCK:
      run.enter(places, state);
      switch (run.wrote(states.LOAD_BLOCK.execute({ud.block_pose.unchecked(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.block_pose)}), smachac::Output{"pose", ud.block_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LOAD_MARK);
        goto LOAD_MARK;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::LOAD_MARK: // main.yml:29
    LOAD_MARK:
      run.enter(places, state);
      switch (run.wrote(states.LOAD_MARK.execute({ud.goal_pose.unchecked(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.goal_pose)}), smachac::Output{"pose", ud.goal_pose})) {
      case ::smachac::LoadModelState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE_TO_START);
        goto MOVE_TO_START;
      case ::smachac::LoadModelState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::MOVE_TO_START: // main.yml:39
    MOVE_TO_START:
      run.enter(places, state);
      switch (states.MOVE_TO_START.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PICK_BLOCK);
        goto PICK_BLOCK;
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      }
      break;
    case State::PICK_BLOCK: // main.yml:44
    PICK_BLOCK:
      run.enter(places, state);
      switch (PICK_BLOCK::execute(states.PICK_BLOCK_, {ud.PICK_BLOCK_, ud.hover_offset, ud.block_pose}, run)) {
      case PICK_BLOCK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::PLACE_BLOCK);
        goto PLACE_BLOCK;
      case PICK_BLOCK::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::PLACE_BLOCK: // main.yml:50
    PLACE_BLOCK:
      run.enter(places, state);
      switch (PLACE_BLOCK::execute(states.PLACE_BLOCK_, {ud.PLACE_BLOCK_, ud.hover_offset, ud.goal_pose}, run)) {
      case PLACE_BLOCK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::GO_HOME);
        goto GO_HOME;
      case PLACE_BLOCK::Outcome::aborted:
        run.go(places, state, "aborted", State::LET_GO);
        goto LET_GO;
      }
      break;
    case State::GO_HOME: // main.yml:56
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
    case State::LET_GO: // main.yml:62
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
    case State::RETREAT: // main.yml:68
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
  watched.start({"pick_and_place", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"pick_and_place", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace pick_and_place

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
