// Made by smachac 0.1.0 from main.yml (sha256 4c3ccd6f4eda27d8).
#pragma once

#include "smachac/smachac.hpp"

namespace get_ready { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:7
struct CHECK_BATTERY {
  enum class Outcome : std::uint8_t {
    full,
    low,
  };

  Outcome execute() {
    return Outcome::full;
  }
};

/// main.yml:12
struct RELEASE_BRAKES {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:17
struct GO_HOME {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::CHECK_BATTERY CHECK_BATTERY;
  types::RELEASE_BRAKES RELEASE_BRAKES;
  types::GO_HOME GO_HOME;
};

enum class State : std::size_t {
  CHECK_BATTERY,
  RELEASE_BRAKES,
  GO_HOME,
};

inline constexpr smachac::Place places[] = {
    {"get_ready/CHECK_BATTERY", "main.yml:7"},
    {"get_ready/RELEASE_BRAKES", "main.yml:12"},
    {"get_ready/GO_HOME", "main.yml:17"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::CHECK_BATTERY;
  SMACHAC_TRY {
    switch (state) {
    case State::CHECK_BATTERY: // main.yml:7
      run.enter(places, state);
      switch (states.CHECK_BATTERY.execute()) {
      case types::CHECK_BATTERY::Outcome::full:
        run.go(places, state, "full", State::RELEASE_BRAKES);
        goto RELEASE_BRAKES;
      case types::CHECK_BATTERY::Outcome::low:
        return run.end(places, state, "low", Outcome::aborted);
      }
      break;
    case State::RELEASE_BRAKES: // main.yml:12
    RELEASE_BRAKES:
      run.enter(places, state);
      switch (states.RELEASE_BRAKES.execute()) {
      case types::RELEASE_BRAKES::Outcome::succeeded:
        run.go(places, state, "succeeded", State::GO_HOME);
        goto GO_HOME;
      case types::RELEASE_BRAKES::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::GO_HOME: // main.yml:17
    GO_HOME:
      run.enter(places, state);
      switch (states.GO_HOME.execute()) {
      case types::GO_HOME::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::GO_HOME::Outcome::aborted:
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

/// Runs the machine once. The observer receives all events of the run; it may be null.
inline Outcome run(States &states, Userdata &ud, smachac::Observer *observer,
                   smachac::Stop &stop) {
  if (observer == nullptr) {
    smachac::Run alone{stop};
    return execute(states, ud, alone);
  }
  smachac::WatchedRun watched(*observer, stop);
  watched.start({"get_ready", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"get_ready", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace get_ready
