// Made by smachac 0.1.0 from main.yml (sha256 d4b5d1deaa440d73).
#pragma once

#include "smachac/smachac.hpp"

namespace wave::WAVE_RIGHT { // main.yml:14

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> times{3};
  smachac::Key<std::string> topic{std::string("/right/joint_command")};
};

namespace types {

/// wave.yml:10
struct TELL {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("times", ud.times.unchecked());
    smachac::print("topic", ud.topic.unchecked());
    return Outcome::succeeded;
  }
};

/// wave.yml:14
struct MOVE {
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
  types::TELL TELL;
  types::MOVE MOVE;
};

enum class State : std::size_t {
  TELL,
  MOVE,
};

inline constexpr smachac::Place places[] = {
    {"wave/WAVE_RIGHT/TELL", "wave.yml:10"},
    {"wave/WAVE_RIGHT/MOVE", "wave.yml:14"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::TELL;
  SMACHAC_TRY {
    switch (state) {
    case State::TELL: // wave.yml:10
      run.enter(places, state);
      switch (states.TELL.execute(ud)) {
      case types::TELL::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE);
        goto MOVE;
      }
      break;
    case State::MOVE: // wave.yml:14
    MOVE:
      run.enter(places, state);
      switch (states.MOVE.execute()) {
      case types::MOVE::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::MOVE::Outcome::aborted:
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

} // namespace wave::WAVE_RIGHT

namespace wave::WAVE_LEFT { // main.yml:9

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> times{2};
  smachac::Key<std::string> topic{std::string("/left/joint_command")};
};

namespace types {

/// wave.yml:10
struct TELL {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("times", ud.times.unchecked());
    smachac::print("topic", ud.topic.unchecked());
    return Outcome::succeeded;
  }
};

/// wave.yml:14
struct MOVE {
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
  types::TELL TELL;
  types::MOVE MOVE;
};

enum class State : std::size_t {
  TELL,
  MOVE,
};

inline constexpr smachac::Place places[] = {
    {"wave/WAVE_LEFT/TELL", "wave.yml:10"},
    {"wave/WAVE_LEFT/MOVE", "wave.yml:14"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::TELL;
  SMACHAC_TRY {
    switch (state) {
    case State::TELL: // wave.yml:10
      run.enter(places, state);
      switch (states.TELL.execute(ud)) {
      case types::TELL::Outcome::succeeded:
        run.go(places, state, "succeeded", State::MOVE);
        goto MOVE;
      }
      break;
    case State::MOVE: // wave.yml:14
    MOVE:
      run.enter(places, state);
      switch (states.MOVE.execute()) {
      case types::MOVE::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::MOVE::Outcome::aborted:
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

} // namespace wave::WAVE_LEFT

namespace wave { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  WAVE_LEFT::Userdata WAVE_LEFT_;
  WAVE_RIGHT::Userdata WAVE_RIGHT_;
};

struct States {
  WAVE_LEFT::States WAVE_LEFT_;
  WAVE_RIGHT::States WAVE_RIGHT_;
};

enum class State : std::size_t {
  WAVE_LEFT,
  WAVE_RIGHT,
};

inline constexpr smachac::Place places[] = {
    {"wave/WAVE_LEFT", "main.yml:9"},
    {"wave/WAVE_RIGHT", "main.yml:14"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::WAVE_LEFT;
  SMACHAC_TRY {
    switch (state) {
    case State::WAVE_LEFT: // main.yml:9
      run.enter(places, state);
      switch (WAVE_LEFT::execute(states.WAVE_LEFT_, ud.WAVE_LEFT_, run)) {
      case WAVE_LEFT::Outcome::succeeded:
        run.go(places, state, "succeeded", State::WAVE_RIGHT);
        goto WAVE_RIGHT;
      case WAVE_LEFT::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::WAVE_RIGHT: // main.yml:14
    WAVE_RIGHT:
      run.enter(places, state);
      switch (WAVE_RIGHT::execute(states.WAVE_RIGHT_, ud.WAVE_RIGHT_, run)) {
      case WAVE_RIGHT::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case WAVE_RIGHT::Outcome::aborted:
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
  watched.start({"wave", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"wave", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace wave
