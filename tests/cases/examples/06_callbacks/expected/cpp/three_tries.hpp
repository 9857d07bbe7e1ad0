// Made by smachac 0.1.0 from main.yml (sha256 b628bda36d0008e8).
#pragma once

#include "smachac/smachac.hpp"

namespace three_tries { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> tries{0};
};

namespace types {

/// main.yml:8
struct TRY {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
  };

  Outcome execute() {
    ++visits_;
    switch (visits_) {
    case 1:
      return Outcome::aborted;
    case 2:
      return Outcome::aborted;
    default:
      return Outcome::succeeded;
    }
  }

  std::uint64_t visits_ = 0;
};

/// main.yml:14
struct COUNT {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("tries", ud.tries, smachac::py::add(ud.tries.unchecked(), 1));
    return Outcome::succeeded;
  }
};

/// main.yml:21
struct DECIDE {
  enum class Outcome : std::uint8_t {
    again,
    enough,
  };

  Outcome execute(Userdata &ud) {
    if (ud.tries.unchecked() < 3) {
      return Outcome::again;
    }
    return Outcome::enough;
  }
};

} // namespace types

struct States {
  types::TRY TRY;
  types::COUNT COUNT;
  types::DECIDE DECIDE;
};

enum class State : std::size_t {
  TRY,
  COUNT,
  DECIDE,
};

inline constexpr smachac::Place places[] = {
    {"three_tries/TRY", "main.yml:8"},
    {"three_tries/COUNT", "main.yml:14"},
    {"three_tries/DECIDE", "main.yml:21"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::TRY;
  SMACHAC_TRY {
    switch (state) {
    case State::TRY: // main.yml:8
    TRY:
      run.enter(places, state);
      switch (states.TRY.execute()) {
      case types::TRY::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::TRY::Outcome::aborted:
        run.go(places, state, "aborted", State::COUNT);
        goto COUNT;
      }
      break;
    case State::COUNT: // main.yml:14
    COUNT:
      run.enter(places, state);
      switch (states.COUNT.execute(ud, run)) {
      case types::COUNT::Outcome::succeeded:
        run.go(places, state, "succeeded", State::DECIDE);
        goto DECIDE;
      }
      break;
    case State::DECIDE: // main.yml:21
    DECIDE:
      run.enter(places, state);
      switch (states.DECIDE.execute(ud)) {
      case types::DECIDE::Outcome::again:
        run.go(places, state, "again", State::TRY);
        goto TRY;
      case types::DECIDE::Outcome::enough:
        return run.end(places, state, "enough", Outcome::aborted);
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
  watched.start({"three_tries", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"three_tries", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace three_tries
