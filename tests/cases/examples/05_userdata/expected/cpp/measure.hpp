// Made by smachac 0.1.0 from main.yml (sha256 151be300629b9acd).
#pragma once

#include "smachac/smachac.hpp"

namespace measure::JUDGE { // main.yml:17

enum class Outcome : std::uint8_t {
  fits,
  too_wide,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"fits", "too_wide"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<double> &limit;
  const smachac::Key<double> &width;
};

namespace types {

/// main.yml:24
struct COMPARE {
  enum class Outcome : std::uint8_t {
    fits,
    too_wide,
  };

  Outcome execute(const UserdataView &ud) {
    if (smachac::need(ud.width, "width") <= ud.limit.unchecked()) {
      return Outcome::fits;
    }
    return Outcome::too_wide;
  }
};

} // namespace types

struct States {
  types::COMPARE COMPARE;
};

enum class State : std::size_t {
  COMPARE,
};

inline constexpr smachac::Place places[] = {
    {"measure/JUDGE/COMPARE", "main.yml:24"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::COMPARE;
  SMACHAC_TRY {
    switch (state) {
    case State::COMPARE: // main.yml:24
      run.enter(places, state);
      switch (states.COMPARE.execute(ud)) {
      case types::COMPARE::Outcome::fits:
        return run.end(places, state, "fits", Outcome::fits);
      case types::COMPARE::Outcome::too_wide:
        return run.end(places, state, "too_wide", Outcome::too_wide);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace measure::JUDGE

namespace measure { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> limit{0.08};
  smachac::Key<double> part_width;
  JUDGE::Userdata JUDGE_;
};

namespace types {

/// main.yml:9
struct MEASURE_WIDTH {
  enum class Outcome : std::uint8_t {
    measured,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("width", ud.part_width, 0.05);
    return Outcome::measured;
  }
};

/// main.yml:32
struct TELL {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("limit", ud.limit.unchecked());
    smachac::print("part_width", smachac::need(ud.part_width, "part_width"));
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::MEASURE_WIDTH MEASURE_WIDTH;
  JUDGE::States JUDGE_;
  types::TELL TELL;
};

enum class State : std::size_t {
  MEASURE_WIDTH,
  JUDGE,
  TELL,
};

inline constexpr smachac::Place places[] = {
    {"measure/MEASURE_WIDTH", "main.yml:9"},
    {"measure/JUDGE", "main.yml:17"},
    {"measure/TELL", "main.yml:32"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::MEASURE_WIDTH;
  SMACHAC_TRY {
    switch (state) {
    case State::MEASURE_WIDTH: // main.yml:9
      run.enter(places, state);
      switch (states.MEASURE_WIDTH.execute(ud, run)) {
      case types::MEASURE_WIDTH::Outcome::measured:
        run.go(places, state, "measured", State::JUDGE);
        goto JUDGE;
      }
      break;
    case State::JUDGE: // main.yml:17
    JUDGE:
      run.enter(places, state);
      switch (JUDGE::execute(states.JUDGE_, {ud.JUDGE_, ud.limit, ud.part_width}, run)) {
      case JUDGE::Outcome::fits:
        run.go(places, state, "fits", State::TELL);
        goto TELL;
      case JUDGE::Outcome::too_wide:
        run.go(places, state, "too_wide", State::TELL);
        goto TELL;
      }
      break;
    case State::TELL: // main.yml:32
    TELL:
      run.enter(places, state);
      switch (states.TELL.execute(ud)) {
      case types::TELL::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
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
  watched.start({"measure", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"measure", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace measure
