// Made by smachac 0.1.0 from main.yml (sha256 81866c077464b068).
#pragma once

#include "smachac/smachac.hpp"

static_assert(smachac::has_exceptions,
              "the script catches the exceptions of PICK (main.yml:16): compile with -fexceptions");

namespace properties::CARRY { // main.yml:27

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
  timeout,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted", "timeout"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:27
struct CARRY {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.requested()) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

/// main.yml:27
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(5.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::CARRY CARRY;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  CARRY,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"properties/CARRY", "main.yml:27", "properties/CARRY/CARRY", "properties/CARRY (timeout)"},
    {"properties/CARRY (timeout)/TIMER", "main.yml:27", "properties/CARRY/TIMER", "properties/CARRY (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::CARRY::Outcome CARRY;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::CARRY: // main.yml:27
        run.enter(places, state);
        ended.CARRY = states.CARRY.execute(run.stop_for(places, state));
        switch (ended.CARRY) {
        case types::CARRY::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::CARRY::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::TIMER: // main.yml:27
        run.enter(places, state);
        ended.TIMER = states.TIMER.execute(run.stop_for(places, state));
        switch (ended.TIMER) {
        case types::TIMER::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::TIMER::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      default:
        smachac::never();
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  });
  if (branches.stopped()) {
    return Outcome::preempted;
  }
  if (ended.CARRY == types::CARRY::Outcome::preempted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::preempted;
  }
  if (ended.CARRY == types::CARRY::Outcome::succeeded &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::succeeded;
  }
  return Outcome::timeout;
}

} // namespace properties::CARRY

namespace properties::PICK::CLOSE { // main.yml:20

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
};

namespace types {

/// main.yml:20
struct CLOSE {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.requested()) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::CLOSE CLOSE;
};

enum class State : std::size_t {
  CLOSE,
};

inline constexpr smachac::Place places[] = {
    {"properties/PICK/CLOSE", "main.yml:20", "properties/PICK/CLOSE/CLOSE", "properties/PICK/CLOSE (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::CLOSE;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // main.yml:20
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.CLOSE.execute(run.stop_for(places, state));
      const bool over = round.over();
      switch (outcome) {
      case types::CLOSE::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::CLOSE::Outcome::aborted:
        if (over) {
          return run.end(places, state, "aborted", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "aborted", Outcome::exhausted);
        }
        run.again(places, state, "aborted");
        continue;
      case types::CLOSE::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace properties::PICK::CLOSE

namespace properties::PICK { // main.yml:16

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  CLOSE::Userdata CLOSE_;
};

struct States {
  CLOSE::States CLOSE_;
};

enum class State : std::size_t {
  CLOSE,
};

inline constexpr smachac::Place places[] = {
    {"properties/PICK/CLOSE (retry)", "main.yml:20", "properties/PICK/CLOSE", "properties/PICK"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::CLOSE;
  SMACHAC_TRY {
    switch (state) {
    case State::CLOSE: // main.yml:20
      run.enter(places, state);
      switch (CLOSE::execute(states.CLOSE_, ud.CLOSE_, run)) {
      case CLOSE::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case CLOSE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
      case CLOSE::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::aborted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace properties::PICK

// Pick a part, carry it away, and never keep it.
namespace properties { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  PICK::Userdata PICK_;
  CARRY::Userdata CARRY_;
};

namespace types {

/// main.yml:33
struct PLACE {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:38
struct LET_GO {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:43
struct REST {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  PICK::States PICK_;
  CARRY::States CARRY_;
  types::PLACE PLACE;
  types::LET_GO LET_GO;
  types::REST REST;
};

enum class State : std::size_t {
  PICK,
  CARRY,
  PLACE,
  LET_GO,
  REST,
};

inline constexpr smachac::Place places[] = {
    {"properties/PICK", "main.yml:16"},
    {"properties/CARRY (timeout)", "main.yml:27", "properties/CARRY", "properties"},
    {"properties/PLACE", "main.yml:33"},
    {"properties/LET_GO", "main.yml:38"},
    {"properties/REST", "main.yml:43"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::PICK;
  for (;;) {
    SMACHAC_TRY {
      switch (state) {
      case State::PICK: // main.yml:16
        run.enter(places, state);
        switch (PICK::execute(states.PICK_, ud.PICK_, run)) {
        case PICK::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CARRY);
          goto CARRY;
        case PICK::Outcome::aborted:
          run.go(places, state, "aborted", State::LET_GO);
          goto LET_GO;
        }
        break;
      case State::CARRY: // main.yml:27
      CARRY:
        run.enter(places, state);
        switch (CARRY::execute(states.CARRY_, ud.CARRY_, run)) {
        case CARRY::Outcome::succeeded:
          run.go(places, state, "succeeded", State::PLACE);
          goto PLACE;
        case CARRY::Outcome::preempted:
          run.go(places, state, "preempted", State::LET_GO);
          goto LET_GO;
        case CARRY::Outcome::timeout:
          run.go(places, state, "timeout", State::LET_GO);
          goto LET_GO;
        }
        break;
      case State::PLACE: // main.yml:33
      PLACE:
        run.enter(places, state);
        switch (states.PLACE.execute()) {
        case types::PLACE::Outcome::succeeded:
          run.go(places, state, "succeeded", State::REST);
          goto REST;
        }
        break;
      case State::LET_GO: // main.yml:38
      LET_GO:
        run.enter(places, state);
        switch (states.LET_GO.execute()) {
        case types::LET_GO::Outcome::succeeded:
          return run.end(places, state, "succeeded", Outcome::aborted);
        }
        break;
      case State::REST: // main.yml:43
      REST:
        run.enter(places, state);
        switch (states.REST.execute()) {
        case types::REST::Outcome::succeeded:
          return run.end(places, state, "succeeded", Outcome::succeeded);
        }
        break;
      default:
        smachac::never();
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH {
      switch (state) {
      case State::PICK:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::CARRY:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::PLACE:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::REST:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      default:
        run.failed(places, state);
      }
    }
  }
}

/// Runs the machine once. The observer receives all events of the run; it may be null.
inline Outcome run(States &states, Userdata &ud, smachac::Observer *observer,
                   smachac::Stop &stop) {
  if (observer == nullptr) {
    smachac::Run alone{stop};
    return execute(states, ud, alone);
  }
  smachac::WatchedRun watched(*observer, stop);
  watched.start({"properties", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"properties", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace properties
