// Made by smachac 0.1.0 from main.yml (sha256 745b9b82fa27dae4).
#pragma once

#include "smachac/arm.hpp"
#include "smachac/smachac.hpp"

// A class with more outcomes than its interface is an error, whatever the warnings are.
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
  smachac::Key<smachac::Pose> hover_offset;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<smachac::Pose> place_pose;
  smachac::Key<double> placing_error;
  smachac::Key<double> width;
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
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::PLAN_HOVER;
  SMACHAC_TRY {
    for (;;) {
      run.enter(places, state);
      switch (state) {
      case State::PLAN_HOVER: // place_block.yml:9
        switch (run.wrote(states.PLAN_HOVER.execute({ud.place_pose.get(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.get())}, {run.out(ud.hover_joints)}), smachac::Output{"joints", ud.hover_joints})) {
        case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
          continue;
        case ::smachac::PoseToJointPositionsState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::MOVE_TO_HOVER: // place_block.yml:15
        switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.hover_joints, "positions")}, run.stop_for(places, state))) {
        case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CHECK_GRASP);
          continue;
        case ::smachac::MoveToJointPositionsState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveToJointPositionsState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::CHECK_GRASP: // place_block.yml:20
        switch (states.CHECK_GRASP.execute()) {
        case ::smachac::CheckGraspState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_DOWN);
          continue;
        case ::smachac::CheckGraspState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::MOVE_DOWN: // place_block.yml:25
        switch (states.MOVE_DOWN.execute({ud.place_pose.get(), smachac::maybe<std::optional<smachac::Pose>>(ud.offset)}, run.stop_for(places, state))) {
        case ::smachac::MoveAlongState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::OPEN_GRIPPER);
          continue;
        case ::smachac::MoveAlongState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveAlongState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::OPEN_GRIPPER: // place_block.yml:31
        switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.width})) {
        case ::smachac::GripperState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_UP);
          continue;
        case ::smachac::GripperState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::GripperState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::MOVE_UP: // place_block.yml:36
        switch (states.MOVE_UP.execute({ud.place_pose.get(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.get())}, run.stop_for(places, state))) {
        case ::smachac::MoveAlongState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CHECK_PLACED);
          continue;
        case ::smachac::MoveAlongState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveAlongState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::CHECK_PLACED: // place_block.yml:42
        switch (run.wrote(states.CHECK_PLACED.execute({ud.place_pose.get()}, {run.out(ud.placing_error)}), smachac::Output{"error", ud.placing_error})) {
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
  smachac::Key<smachac::Pose> hover_offset;
  smachac::Key<std::optional<smachac::Pose>> offset;
  smachac::Key<smachac::Pose> pick_pose;
  smachac::Key<double> width;
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
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::OPEN_GRIPPER;
  SMACHAC_TRY {
    for (;;) {
      run.enter(places, state);
      switch (state) {
      case State::OPEN_GRIPPER: // pick_block.yml:8
        switch (run.wrote(states.OPEN_GRIPPER.execute({run.out(ud.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.width})) {
        case ::smachac::GripperState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::PLAN_HOVER);
          continue;
        case ::smachac::GripperState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::GripperState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::PLAN_HOVER: // pick_block.yml:13
        switch (run.wrote(states.PLAN_HOVER.execute({ud.pick_pose.get(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.get())}, {run.out(ud.hover_joints)}), smachac::Output{"joints", ud.hover_joints})) {
        case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_TO_HOVER);
          continue;
        case ::smachac::PoseToJointPositionsState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::MOVE_TO_HOVER: // pick_block.yml:19
        switch (states.MOVE_TO_HOVER.execute({smachac::need(ud.hover_joints, "positions")}, run.stop_for(places, state))) {
        case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_DOWN);
          continue;
        case ::smachac::MoveToJointPositionsState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveToJointPositionsState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::MOVE_DOWN: // pick_block.yml:24
        switch (states.MOVE_DOWN.execute({ud.pick_pose.get(), smachac::maybe<std::optional<smachac::Pose>>(ud.offset)}, run.stop_for(places, state))) {
        case ::smachac::MoveAlongState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CLOSE_GRIPPER);
          continue;
        case ::smachac::MoveAlongState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveAlongState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::CLOSE_GRIPPER: // pick_block.yml:30
        switch (run.wrote(states.CLOSE_GRIPPER.execute({run.out(ud.width)}, run.stop_for(places, state)), smachac::Output{"width", ud.width})) {
        case ::smachac::GripperState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::LIFT);
          continue;
        case ::smachac::GripperState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::GripperState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::LIFT: // pick_block.yml:35
        switch (states.LIFT.execute({ud.pick_pose.get(), smachac::convert<std::optional<smachac::Pose>>(ud.hover_offset.get())}, run.stop_for(places, state))) {
        case ::smachac::MoveAlongState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CHECK_GRASP);
          continue;
        case ::smachac::MoveAlongState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveAlongState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::CHECK_GRASP: // pick_block.yml:41
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
    for (;;) {
      run.enter(places, state);
      switch (state) {
      case State::LOAD_TABLE: // main.yml:11
        switch (run.wrote(states.LOAD_TABLE.execute({ud.table_pose.get(), smachac::convert<std::optional<std::string>>(ud.table_frame.get())}, {run.out(ud.table_pose)}), smachac::Output{"pose", ud.table_pose})) {
        case ::smachac::LoadModelState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::LOAD_BLOCK);
          continue;
        case ::smachac::LoadModelState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::LOAD_BLOCK: // main.yml:20
        switch (run.wrote(states.LOAD_BLOCK.execute({ud.block_pose.get(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.block_pose)}), smachac::Output{"pose", ud.block_pose})) {
        case ::smachac::LoadModelState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::LOAD_MARK);
          continue;
        case ::smachac::LoadModelState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::LOAD_MARK: // main.yml:29
        switch (run.wrote(states.LOAD_MARK.execute({ud.goal_pose.get(), smachac::maybe<std::optional<std::string>>(ud.reference_frame)}, {run.out(ud.goal_pose)}), smachac::Output{"pose", ud.goal_pose})) {
        case ::smachac::LoadModelState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::MOVE_TO_START);
          continue;
        case ::smachac::LoadModelState::Outcome::aborted:
          return run.end(places, state, "aborted", Outcome::aborted);
        }
        break;
      case State::MOVE_TO_START: // main.yml:39
        switch (states.MOVE_TO_START.execute({smachac::convert<std::vector<double>>(ud.home.get())}, run.stop_for(places, state))) {
        case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::PICK_BLOCK);
          continue;
        case ::smachac::MoveToJointPositionsState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveToJointPositionsState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::PICK_BLOCK: // main.yml:44
        ud.PICK_BLOCK_.pick_pose.hold(ud.block_pose.get());
        ud.PICK_BLOCK_.hover_offset.hold(ud.hover_offset.get());
        switch (PICK_BLOCK::execute(states.PICK_BLOCK_, ud.PICK_BLOCK_, run)) {
        case PICK_BLOCK::Outcome::succeeded:
          run.go(places, state, "succeeded", State::PLACE_BLOCK);
          continue;
        case PICK_BLOCK::Outcome::aborted:
          run.go(places, state, "aborted", State::LET_GO);
          continue;
        }
        break;
      case State::PLACE_BLOCK: // main.yml:50
        ud.PLACE_BLOCK_.place_pose.hold(ud.goal_pose.get());
        ud.PLACE_BLOCK_.hover_offset.hold(ud.hover_offset.get());
        switch (PLACE_BLOCK::execute(states.PLACE_BLOCK_, ud.PLACE_BLOCK_, run)) {
        case PLACE_BLOCK::Outcome::succeeded:
          run.go(places, state, "succeeded", State::GO_HOME);
          continue;
        case PLACE_BLOCK::Outcome::aborted:
          run.go(places, state, "aborted", State::LET_GO);
          continue;
        }
        break;
      case State::GO_HOME: // main.yml:56
        switch (states.GO_HOME.execute({smachac::convert<std::vector<double>>(ud.home.get())}, run.stop_for(places, state))) {
        case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
          return run.end_asked(places, state, "succeeded", Outcome::succeeded);
        case ::smachac::MoveToJointPositionsState::Outcome::aborted:
          return run.end_asked(places, state, "aborted", Outcome::aborted);
        case ::smachac::MoveToJointPositionsState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::LET_GO: // main.yml:62
        switch (run.wrote(states.LET_GO.execute({run.out(ud.gripper_width)}, run.stop_for(places, state)), smachac::Output{"width", ud.gripper_width})) {
        case ::smachac::GripperState::Outcome::succeeded:
          run.go(places, state, "succeeded", State::RETREAT);
          continue;
        case ::smachac::GripperState::Outcome::aborted:
          run.go(places, state, "aborted", State::RETREAT);
          continue;
        case ::smachac::GripperState::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      case State::RETREAT: // main.yml:68
        switch (states.RETREAT.execute({smachac::convert<std::vector<double>>(ud.home.get())}, run.stop_for(places, state))) {
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
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

/// Run the machine once. An observer hears of all that it does; there may be none.
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

} // namespace pick_and_place

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
