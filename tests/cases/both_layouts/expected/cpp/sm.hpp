// Made by smachac 0.1.0 from main.yml (sha256 1b5bcabdfa18b5b7).
#pragma once

#include "smachac/smachac.hpp"

namespace sm { // main.yml:2

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

/// main.yml:6
struct FOO {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

/// main.yml:11
struct BAR {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

/// main.yml:16
struct BAZ {
  enum class Outcome : std::uint8_t {
    done,
    failed,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::FOO FOO;
  types::BAR BAR;
  types::BAZ BAZ;
};

enum class State : std::size_t {
  FOO,
  BAR,
  BAZ,
};

inline constexpr smachac::Place places[] = {
    {"sm/FOO", "main.yml:6"},
    {"sm/BAR", "main.yml:11"},
    {"sm/BAZ", "main.yml:16"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::FOO;
  SMACHAC_TRY {
    switch (state) {
    case State::FOO: // main.yml:6
      run.enter(places, state);
      switch (states.FOO.execute()) {
      case types::FOO::Outcome::done:
        run.go(places, state, "done", State::BAR);
        goto BAR;
      }
      break;
    case State::BAR: // main.yml:11
    BAR:
      run.enter(places, state);
      switch (states.BAR.execute()) {
      case types::BAR::Outcome::done:
        run.go(places, state, "done", State::BAZ);
        goto BAZ;
      }
      break;
    case State::BAZ: // main.yml:16
    BAZ:
      run.enter(places, state);
      switch (states.BAZ.execute()) {
      case types::BAZ::Outcome::done:
        return run.end(places, state, "done", Outcome::succeeded);
      case types::BAZ::Outcome::failed:
        return run.end(places, state, "failed", Outcome::aborted);
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
