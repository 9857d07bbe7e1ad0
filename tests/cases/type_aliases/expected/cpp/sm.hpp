// Made by smachac 0.1.0 from main.yml (sha256 72bced4d2696d3a8).
#pragma once

#include "smachac/smachac.hpp"

namespace sm { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> angle;
  smachac::Key<std::array<double, 7>> home{std::array<double, 7>{{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}}};
  smachac::Key<std::array<double, 7>> other;
  smachac::Key<std::optional<std::vector<std::array<double, 7>>>> path;
};

namespace types {

/// main.yml:10
struct A {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::A A;
};

enum class State : std::size_t {
  A,
};

inline constexpr smachac::Place places[] = {
    {"sm/A", "main.yml:10"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::A;
  SMACHAC_TRY {
    switch (state) {
    case State::A: // main.yml:10
      run.enter(places, state);
      switch (states.A.execute()) {
      case types::A::Outcome::done:
        return run.end(places, state, "done", Outcome::succeeded);
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
