// Made by smachac 0.1.0 from main.yml (sha256 077db97046fb669f).
#pragma once

#include "smachac/arm.hpp"
#include "smachac/smachac.hpp"

// A class with more outcomes than its interface is an error at every warning level.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#endif

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

namespace sm::EACH::GO { // main.yml:23

enum class Outcome : std::uint8_t {
  reached,
  failed,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"reached", "failed"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::vector<double>> goal;
  smachac::Key<std::optional<smachac::Pose>> offset;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<smachac::Pose> &pose;
};

struct States {
  explicit States(smachac::Arm &arm)
      : PLAN(arm, std::optional<std::string>{}, false),
        MOVE(arm, std::optional<std::string>{}, 1.0) {}

  ::smachac::PoseToJointPositionsState PLAN;
  ::smachac::MoveToJointPositionsState MOVE;
};

enum class State : std::size_t {
  PLAN,
  MOVE,
};

inline constexpr smachac::Place places[] = {
    {"sm/EACH/GO/PLAN", "main.yml:28"},
    {"sm/EACH/GO/MOVE", "main.yml:32"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PLAN;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAN: // main.yml:28
      run.enter(places, state);
      switch (run.wrote(states.PLAN.execute({ud.pose.unchecked(), smachac::maybe<std::optional<smachac::Pose>>(ud.own_.offset)}, {run.out(ud.own_.goal)}), smachac::Output{"joints", ud.own_.goal})) {
      case ::smachac::PoseToJointPositionsState::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE);
        goto MOVE;
      case ::smachac::PoseToJointPositionsState::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::failed);
      }
      break;
    case State::MOVE: // main.yml:32
    MOVE:
      run.enter(places, state);
      switch (states.MOVE.execute({smachac::need(ud.own_.goal, "positions")}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::reached);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::failed);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::failed);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::EACH::GO

namespace sm::EACH { // main.yml:14

enum class Outcome : std::uint8_t {
  done,
  failed,
  reached,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "failed", "reached"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<smachac::Pose> pose;
  GO::Userdata GO_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<std::array<smachac::Pose, 2>> &poses;
};

struct States {
  explicit States(smachac::Arm &arm)
      : GO_(arm) {}

  GO::States GO_;
};

enum class State : std::size_t {
  GO,
};

inline constexpr smachac::Place places[] = {
    {"sm/EACH/GO", "main.yml:23"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const auto items = smachac::need(ud.poses, "poses");
  if (items.empty()) {
    return Outcome::done;
  }
  const auto state = State::GO;
  smachac::Round round(run.stop, places[0], items.size());
  for (const auto &item : items) {
    ud.own_.pose.hold(item);
    // main.yml:23
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = GO::execute(states.GO_, {ud.own_.GO_, ud.own_.pose}, run);
      const bool over = round.over();
      switch (outcome) {
      case GO::Outcome::reached:
        if (over) {
          return run.end(places, state, "reached", Outcome::reached);
        }
        if (round.last()) {
          return run.end(places, state, "reached", Outcome::done);
        }
        run.again(places, state, "reached");
        continue;
      case GO::Outcome::failed:
        return run.end(places, state, "failed", Outcome::failed);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::done;
}

} // namespace sm::EACH

namespace sm { // main.yml:2

enum class Outcome : std::uint8_t {
  done,
  failed,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "failed"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::optional<double>> best{std::optional<double>{}};
  smachac::Key<std::string> choice;
  smachac::Key<double> deeper;
  smachac::Key<double> depth{1.0};
  smachac::Key<smachac::Pose> first;
  smachac::Key<std::array<double, 7>> home{std::array<double, 7>{{0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785}}};
  smachac::Key<smachac::Point> near;
  smachac::Key<std::array<smachac::Pose, 2>> poses{std::array<smachac::Pose, 2>{{smachac::Pose{smachac::Point{0.5, 0.0, 0.1}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}, smachac::Pose{smachac::Point{0.4, 0.1, 0.1}, smachac::Quaternion{0.0, 1.0, 0.0, 0.0}}}}};
  smachac::Key<std::int64_t> tries{0};
  smachac::Key<std::string> word{std::string("open")};
  smachac::Key<std::any> word_2{std::any{std::int64_t{5}}};
  EACH::Userdata EACH_;
};

namespace types {

/// main.yml:37
struct COUNT {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("best", ud.best, std::optional<double>(smachac::py::max_of(std::array<double, 2>{{smachac::py::divide(ud.tries.unchecked(), 2), 1.0}})));
    run.write("choice", ud.choice, ud.tries.unchecked() > 2 ? std::string("open") : std::string("close"));
    run.write("deeper", ud.deeper, ud.depth.unchecked() + 0.1);
    run.write("first", ud.first, smachac::py::item(ud.poses.unchecked(), 0));
    run.write("near", ud.near, smachac::Point{ud.depth.unchecked(), 0.0, 1.5});
    run.write("tries", ud.tries, smachac::py::add(ud.tries.unchecked(), 1));
    return Outcome::succeeded;
  }
};

/// main.yml:49
struct USE {
  enum class Outcome : std::uint8_t {
    done,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("word_2", ud.word_2, std::any{std::string("five")});
    return Outcome::done;
  }
};

/// main.yml:65
struct AGAIN {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  explicit States(smachac::Arm &arm)
      : EACH_(arm),
        HOME(arm, std::optional<std::string>{}, 1.0) {}

  EACH::States EACH_;
  types::COUNT COUNT{};
  types::USE USE{};
  types::AGAIN AGAIN{};
  ::smachac::MoveToJointPositionsState HOME;
};

enum class State : std::size_t {
  EACH,
  COUNT,
  USE,
  AGAIN,
  HOME,
};

inline constexpr smachac::Place places[] = {
    {"sm/EACH", "main.yml:14"},
    {"sm/COUNT", "main.yml:37"},
    {"sm/USE", "main.yml:49"},
    {"sm/AGAIN", "main.yml:65"},
    {"sm/HOME", "main.yml:70"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::EACH;
  SMACHAC_TRY {
    switch (state) {
    case State::EACH: // main.yml:14
      run.enter(places, state);
      switch (EACH::execute(states.EACH_, {ud.EACH_, ud.poses}, run)) {
      case EACH::Outcome::done:
        run.go(places, state, "done", State::COUNT);
        goto COUNT;
      case EACH::Outcome::failed:
        return run.end_asked(places, state, "failed", Outcome::failed);
      case EACH::Outcome::reached:
        run.undeclared(places, state, "reached");
      }
      break;
    case State::COUNT: // main.yml:37
    COUNT:
      run.enter(places, state);
      switch (states.COUNT.execute(ud, run)) {
      case types::COUNT::Outcome::succeeded:
        run.go(places, state, "succeeded", State::USE);
        goto USE;
      }
      break;
    case State::USE: // main.yml:49
    USE:
      run.enter(places, state);
      switch (states.USE.execute(ud, run)) {
      case types::USE::Outcome::done:
        run.go(places, state, "done", State::AGAIN);
        goto AGAIN;
      }
      break;
    case State::AGAIN: // main.yml:65
    AGAIN:
      run.enter(places, state);
      switch (states.AGAIN.execute()) {
      case types::AGAIN::Outcome::done:
        run.go(places, state, "done", State::HOME);
        goto HOME;
      }
      break;
    case State::HOME: // main.yml:70
    HOME:
      run.enter(places, state);
      switch (states.HOME.execute({smachac::convert<std::vector<double>>(ud.home.unchecked())}, run.stop_for(places, state))) {
      case ::smachac::MoveToJointPositionsState::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::done);
      case ::smachac::MoveToJointPositionsState::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::failed);
      case ::smachac::MoveToJointPositionsState::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::failed);
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
  watched.start({"sm", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"sm", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace sm

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
