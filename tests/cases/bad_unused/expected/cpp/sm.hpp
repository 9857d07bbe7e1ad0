// Made by smachac 0.1.0 from main.yml (sha256 36ce5025c9f6b2d3).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::CALL { // main.yml:10

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// sub.yml:6
struct SAY {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  // at2
  types::SAY SAY;
};

enum class State : std::size_t {
  SAY,
};

inline constexpr smachac::Place places[] = {
    {"sm/CALL/SAY", "sub.yml:6"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::SAY;
  SMACHAC_TRY {
    switch (state) {
    case State::SAY: // sub.yml:6
      run.enter(places, state);
      switch (states.SAY.execute()) {
      case types::SAY::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::CALL

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
  smachac::Key<std::array<double, 2>> both{std::array<double, 2>{{1.0, 2.0}}};
  smachac::Key<std::string> way{std::string("/left")};
  CALL::Userdata CALL_;
};

namespace types {

/// main.yml:14
struct JUDGE {
  enum class Outcome : std::uint8_t {
    large,
    small,
    tiny,
  };

  Outcome execute(Userdata &ud) {
    if (smachac::py::item(ud.both.unchecked(), 0) > 1.0 && ud.way.unchecked() != "") {
      return Outcome::large;
    }
    return Outcome::small;
  }
};

} // namespace types

struct States {
  CALL::States CALL_;
  types::JUDGE JUDGE;
};

enum class State : std::size_t {
  CALL,
  JUDGE,
};

inline constexpr smachac::Place places[] = {
    {"sm/CALL", "main.yml:10"},
    {"sm/JUDGE", "main.yml:14"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::CALL;
  SMACHAC_TRY {
    switch (state) {
    case State::CALL: // main.yml:10
      run.enter(places, state);
      switch (CALL::execute(states.CALL_, ud.CALL_, run)) {
      case CALL::Outcome::done:
        run.go(places, state, "done", State::JUDGE);
        goto JUDGE;
      }
      break;
    case State::JUDGE: // main.yml:14
    JUDGE:
      run.enter(places, state);
      switch (states.JUDGE.execute(ud)) {
      case types::JUDGE::Outcome::large:
        return run.end(places, state, "large", Outcome::done);
      case types::JUDGE::Outcome::small:
        return run.end(places, state, "small", Outcome::failed);
      case types::JUDGE::Outcome::tiny:
        return run.end(places, state, "tiny", Outcome::failed);
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
