// Made by smachac 0.1.0 from main.yml (sha256 b8f8a767cb97a2e5).
#pragma once

#include "smachac/smachac.hpp"

namespace bad_presets { // main.yml:2

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> height{0.4};
  smachac::Key<std::int64_t> limit{3};
  smachac::Key<double> speed{1.0};
};

namespace types {

/// main.yml:8
struct NEAR {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("height", ud.height.unchecked());
    smachac::print("limit", ud.limit.unchecked());
    smachac::print("speed", ud.speed.unchecked());
    return Outcome::succeeded;
  }
};

/// main.yml:14
struct FAR {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("height", ud.height.unchecked());
    smachac::print("limit", ud.limit.unchecked());
    smachac::print("speed", ud.speed.unchecked());
    return Outcome::succeeded;
  }
};

/// main.yml:20
struct LAST {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("height", ud.height.unchecked());
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::NEAR NEAR;
  types::FAR FAR;
  types::LAST LAST;
};

enum class State : std::size_t {
  NEAR,
  FAR,
  LAST,
};

inline constexpr smachac::Place places[] = {
    {"bad_presets/NEAR", "main.yml:8"},
    {"bad_presets/FAR", "main.yml:14"},
    {"bad_presets/LAST", "main.yml:20"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::NEAR;
  SMACHAC_TRY {
    switch (state) {
    case State::NEAR: // main.yml:8
      run.enter(places, state);
      switch (states.NEAR.execute(ud)) {
      case types::NEAR::Outcome::succeeded:
        run.go(places, state, "succeeded", State::FAR);
        goto FAR;
      }
      break;
    case State::FAR: // main.yml:14
    FAR:
      run.enter(places, state);
      switch (states.FAR.execute(ud)) {
      case types::FAR::Outcome::succeeded:
        run.go(places, state, "succeeded", State::LAST);
        goto LAST;
      }
      break;
    case State::LAST: // main.yml:20
    LAST:
      run.enter(places, state);
      switch (states.LAST.execute(ud)) {
      case types::LAST::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::done);
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
  watched.start({"bad_presets", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"bad_presets", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace bad_presets
