// Made by smachac 0.1.0 from main.yml (sha256 05e3a17974dfb005).
#pragma once

#include "smachac/smachac.hpp"

namespace pass_door::OPEN_DOOR { // main.yml:12

enum class Outcome : std::uint8_t {
  open,
  stuck,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"open", "stuck"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:17
struct GRASP_HANDLE {
  enum class Outcome : std::uint8_t {
    held,
    missed,
  };

  Outcome execute() {
    return Outcome::held;
  }
};

/// main.yml:21
struct TURN_HANDLE {
  enum class Outcome : std::uint8_t {
    turned,
    blocked,
  };

  Outcome execute() {
    return Outcome::turned;
  }
};

/// main.yml:25
struct PULL {
  enum class Outcome : std::uint8_t {
    open,
    stuck,
  };

  Outcome execute() {
    return Outcome::open;
  }
};

} // namespace types

struct States {
  types::GRASP_HANDLE GRASP_HANDLE;
  types::TURN_HANDLE TURN_HANDLE;
  types::PULL PULL;
};

enum class State : std::size_t {
  GRASP_HANDLE,
  TURN_HANDLE,
  PULL,
};

inline constexpr smachac::Place places[] = {
    {"pass_door/OPEN_DOOR/GRASP_HANDLE", "main.yml:17"},
    {"pass_door/OPEN_DOOR/TURN_HANDLE", "main.yml:21"},
    {"pass_door/OPEN_DOOR/PULL", "main.yml:25"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::GRASP_HANDLE;
  SMACHAC_TRY {
    switch (state) {
    case State::GRASP_HANDLE: // main.yml:17
      run.enter(places, state);
      switch (states.GRASP_HANDLE.execute()) {
      case types::GRASP_HANDLE::Outcome::held:
        run.go(places, state, "held", State::TURN_HANDLE);
        goto TURN_HANDLE;
      case types::GRASP_HANDLE::Outcome::missed:
        return run.end(places, state, "missed", Outcome::stuck);
      }
      break;
    case State::TURN_HANDLE: // main.yml:21
    TURN_HANDLE:
      run.enter(places, state);
      switch (states.TURN_HANDLE.execute()) {
      case types::TURN_HANDLE::Outcome::turned:
        run.go(places, state, "turned", State::PULL);
        goto PULL;
      case types::TURN_HANDLE::Outcome::blocked:
        return run.end(places, state, "blocked", Outcome::stuck);
      }
      break;
    case State::PULL: // main.yml:25
    PULL:
      run.enter(places, state);
      switch (states.PULL.execute()) {
      case types::PULL::Outcome::open:
        return run.end(places, state, "open", Outcome::open);
      case types::PULL::Outcome::stuck:
        return run.end(places, state, "stuck", Outcome::stuck);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace pass_door::OPEN_DOOR

namespace pass_door { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  OPEN_DOOR::Userdata OPEN_DOOR_;
};

namespace types {

/// main.yml:7
struct DRIVE_TO_DOOR {
  enum class Outcome : std::uint8_t {
    there,
    lost,
  };

  Outcome execute() {
    return Outcome::there;
  }
};

/// main.yml:30
struct DRIVE_THROUGH {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:35
struct CALL_FOR_HELP {
  enum class Outcome : std::uint8_t {
    called,
  };

  Outcome execute() {
    return Outcome::called;
  }
};

} // namespace types

struct States {
  types::DRIVE_TO_DOOR DRIVE_TO_DOOR;
  OPEN_DOOR::States OPEN_DOOR_;
  types::DRIVE_THROUGH DRIVE_THROUGH;
  types::CALL_FOR_HELP CALL_FOR_HELP;
};

enum class State : std::size_t {
  DRIVE_TO_DOOR,
  OPEN_DOOR,
  DRIVE_THROUGH,
  CALL_FOR_HELP,
};

inline constexpr smachac::Place places[] = {
    {"pass_door/DRIVE_TO_DOOR", "main.yml:7"},
    {"pass_door/OPEN_DOOR", "main.yml:12"},
    {"pass_door/DRIVE_THROUGH", "main.yml:30"},
    {"pass_door/CALL_FOR_HELP", "main.yml:35"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::DRIVE_TO_DOOR;
  SMACHAC_TRY {
    switch (state) {
    case State::DRIVE_TO_DOOR: // main.yml:7
      run.enter(places, state);
      switch (states.DRIVE_TO_DOOR.execute()) {
      case types::DRIVE_TO_DOOR::Outcome::there:
        run.go(places, state, "there", State::OPEN_DOOR);
        goto OPEN_DOOR;
      case types::DRIVE_TO_DOOR::Outcome::lost:
        return run.end(places, state, "lost", Outcome::aborted);
      }
      break;
    case State::OPEN_DOOR: // main.yml:12
    OPEN_DOOR:
      run.enter(places, state);
      switch (OPEN_DOOR::execute(states.OPEN_DOOR_, ud.OPEN_DOOR_, run)) {
      case OPEN_DOOR::Outcome::open:
        run.go(places, state, "open", State::DRIVE_THROUGH);
        goto DRIVE_THROUGH;
      case OPEN_DOOR::Outcome::stuck:
        run.go(places, state, "stuck", State::CALL_FOR_HELP);
        goto CALL_FOR_HELP;
      }
      break;
    case State::DRIVE_THROUGH: // main.yml:30
    DRIVE_THROUGH:
      run.enter(places, state);
      switch (states.DRIVE_THROUGH.execute()) {
      case types::DRIVE_THROUGH::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::DRIVE_THROUGH::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::CALL_FOR_HELP: // main.yml:35
    CALL_FOR_HELP:
      run.enter(places, state);
      switch (states.CALL_FOR_HELP.execute()) {
      case types::CALL_FOR_HELP::Outcome::called:
        return run.end(places, state, "called", Outcome::aborted);
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
  watched.start({"pass_door", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"pass_door", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace pass_door
