// Made by smachac 0.1.0 from main.yml (sha256 0eed65aba39ca33b).
#pragma once

#include "smachac/smachac.hpp"

static_assert(smachac::has_exceptions,
              "the script catches the exceptions of FIND (main.yml:7): compile with -fexceptions");

namespace fetch::EACH { // main.yml:50

enum class Outcome : std::uint8_t {
  succeeded,
  error,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "error"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> half;
  smachac::Key<std::int64_t> part;
  smachac::Key<std::array<std::int64_t, 2>> parts;
};

namespace types {

/// main.yml:60
struct HALVE {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("half", ud.half, smachac::py::divide(ud.part.unchecked(), smachac::py::subtract(ud.part.unchecked(), 1)));
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::HALVE HALVE;
};

enum class State : std::size_t {
  HALVE,
};

inline constexpr smachac::Place places[] = {
    {"fetch/EACH/HALVE", "main.yml:60"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const auto items = smachac::need(ud.parts, "parts");
  if (items.empty()) {
    return Outcome::succeeded;
  }
  const auto state = State::HALVE;
  smachac::Round round(run.stop, places[0], items.size());
  for (const auto &item : items) {
    ud.part.hold(item);
    // main.yml:60
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.HALVE.execute(ud, run);
      const bool over = round.over();
      switch (outcome) {
      case types::HALVE::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::succeeded);
        }
        if (round.last()) {
          return run.end(places, state, "succeeded", Outcome::succeeded);
        }
        run.again(places, state, "succeeded");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH {
      run.caught(places, state);
      const bool over = round.over();
      if (over) {
        return run.end(places, state, "error", Outcome::error);
      }
      if (round.last()) {
        return run.end(places, state, "error", Outcome::succeeded);
      }
      run.again(places, state, "error");
    }
  }
  return Outcome::succeeded;
}

} // namespace fetch::EACH

namespace fetch::BOTH { // main.yml:35

enum class Outcome : std::uint8_t {
  succeeded,
  failed,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "failed"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<std::int64_t> &n;
};

namespace types {

/// main.yml:43
struct LEFT {
  enum class Outcome : std::uint8_t {
    big,
    small,
  };

  Outcome execute(const UserdataView &ud) {
    if (smachac::py::divide(1, ud.n.unchecked()) > 2.0) {
      return Outcome::big;
    }
    return Outcome::small;
  }
};

/// main.yml:49
struct RIGHT {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(0.01)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::LEFT LEFT;
  types::RIGHT RIGHT;
};

enum class State : std::size_t {
  LEFT,
  RIGHT,
};

inline constexpr smachac::Place places[] = {
    {"fetch/BOTH/LEFT", "main.yml:43"},
    {"fetch/BOTH/RIGHT", "main.yml:49"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &around) {
  struct {
    std::optional<types::LEFT::Outcome> LEFT;
    types::RIGHT::Outcome RIGHT;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(false, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::LEFT: // main.yml:43
        run.enter(places, state);
        ended.LEFT = states.LEFT.execute(ud);
        switch (*ended.LEFT) {
        case types::LEFT::Outcome::big:
          run.exit(places, state, "big");
          return;
        case types::LEFT::Outcome::small:
          run.exit(places, state, "small");
          return;
        }
        break;
      case State::RIGHT: // main.yml:49
        run.enter(places, state);
        ended.RIGHT = states.RIGHT.execute(run.stop_for(places, state));
        switch (ended.RIGHT) {
        case types::RIGHT::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::RIGHT::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      default:
        smachac::never();
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH {
      switch (state) {
      case State::LEFT:
        run.caught(places, state);
        run.exit(places, state, "error");
        break;
      default:
        run.failed(places, state);
      }
    }
  });
  if (ended.LEFT == std::nullopt) {
    return Outcome::failed;
  }
  return Outcome::succeeded;
}

} // namespace fetch::BOTH

namespace fetch::CARRY { // main.yml:28

enum class Outcome : std::uint8_t {
  succeeded,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
  smachac::Key<std::int64_t> n;
  smachac::Key<double> width;
};

namespace types {

/// main.yml:28
struct CARRY {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("width", ud.width, smachac::py::divide(1, ud.n.unchecked()));
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::CARRY CARRY;
};

enum class State : std::size_t {
  CARRY,
};

inline constexpr smachac::Place places[] = {
    {"fetch/CARRY", "main.yml:28", "fetch/CARRY/CARRY", "fetch/CARRY (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::CARRY;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // main.yml:28
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.CARRY.execute(ud, run);
      const bool over = round.over();
      switch (outcome) {
      case types::CARRY::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        return run.end(places, state, "succeeded", Outcome::succeeded);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH {
      run.caught(places, state);
      const bool over = round.over();
      if (over) {
        return run.end(places, state, "error", Outcome::preempted);
      }
      if (round.last()) {
        return run.end(places, state, "error", Outcome::exhausted);
      }
      run.again(places, state, "error");
    }
  }
  return Outcome::exhausted;
}

} // namespace fetch::CARRY

namespace fetch::PICK { // main.yml:11

enum class Outcome : std::uint8_t {
  succeeded,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<double> width;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<std::int64_t> &n;
};

namespace types {

/// main.yml:18
struct DIVIDE {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(const UserdataView &ud, Run &run) {
    run.write("width", ud.own_.width, smachac::py::divide(1, ud.n.unchecked()));
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::DIVIDE DIVIDE;
};

enum class State : std::size_t {
  DIVIDE,
};

inline constexpr smachac::Place places[] = {
    {"fetch/PICK/DIVIDE", "main.yml:18"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::DIVIDE;
  SMACHAC_TRY {
    switch (state) {
    case State::DIVIDE: // main.yml:18
      run.enter(places, state);
      switch (states.DIVIDE.execute(ud, run)) {
      case types::DIVIDE::Outcome::succeeded:
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

} // namespace fetch::PICK

namespace fetch { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> n{0};
  smachac::Key<std::array<std::int64_t, 2>> parts{std::array<std::int64_t, 2>{{1, 2}}};
  smachac::Key<double> width;
  PICK::Userdata PICK_;
  CARRY::Userdata CARRY_;
  BOTH::Userdata BOTH_;
  EACH::Userdata EACH_;
};

namespace types {

/// main.yml:7
struct FIND {
  enum class Outcome : std::uint8_t {
    found,
    nothing,
  };

  Outcome execute() {
    return Outcome::found;
  }
};

/// main.yml:24
struct OWN {
  enum class Outcome : std::uint8_t {
    succeeded,
    error,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:65
struct LET_GO {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("n", ud.n, 1);
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::FIND FIND;
  PICK::States PICK_;
  types::OWN OWN;
  CARRY::States CARRY_;
  BOTH::States BOTH_;
  EACH::States EACH_;
  types::LET_GO LET_GO;
};

enum class State : std::size_t {
  FIND,
  PICK,
  OWN,
  CARRY,
  BOTH,
  EACH,
  LET_GO,
};

inline constexpr smachac::Place places[] = {
    {"fetch/FIND", "main.yml:7"},
    {"fetch/PICK", "main.yml:11"},
    {"fetch/OWN", "main.yml:24"},
    {"fetch/CARRY (retry)", "main.yml:28", "fetch/CARRY", "fetch"},
    {"fetch/BOTH", "main.yml:35"},
    {"fetch/EACH", "main.yml:50"},
    {"fetch/LET_GO", "main.yml:65"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::FIND;
  for (;;) {
    SMACHAC_TRY {
      switch (state) {
      case State::FIND: // main.yml:7
        run.enter(places, state);
        switch (states.FIND.execute()) {
        case types::FIND::Outcome::found:
          run.go(places, state, "found", State::PICK);
          goto PICK;
        case types::FIND::Outcome::nothing:
          return run.end(places, state, "nothing", Outcome::aborted);
        }
        break;
      case State::PICK: { // main.yml:11
      PICK:
        run.enter(places, state);
        const auto outcome = PICK::execute(states.PICK_, {ud.PICK_, ud.n}, run);
        ud.width.take(ud.PICK_.width);
        switch (outcome) {
        case PICK::Outcome::succeeded:
          run.go(places, state, "succeeded", State::OWN);
          goto OWN;
        }
        break;
      }
      case State::OWN: // main.yml:24
      OWN:
        run.enter(places, state);
        switch (states.OWN.execute()) {
        case types::OWN::Outcome::succeeded:
          run.go(places, state, "succeeded", State::CARRY);
          goto CARRY;
        case types::OWN::Outcome::error:
          return run.end(places, state, "error", Outcome::aborted);
        }
        break;
      case State::CARRY: { // main.yml:28
      CARRY:
        run.enter(places, state);
        ud.CARRY_.n.hold(ud.n.unchecked());
        const auto outcome = CARRY::execute(states.CARRY_, ud.CARRY_, run);
        ud.width.take(ud.CARRY_.width);
        switch (outcome) {
        case CARRY::Outcome::succeeded:
          run.go(places, state, "succeeded", State::BOTH);
          goto BOTH;
        case CARRY::Outcome::exhausted:
          run.go(places, state, "exhausted", State::BOTH);
          goto BOTH;
        case CARRY::Outcome::preempted:
          return run.end_asked(places, state, "preempted", Outcome::aborted);
        }
        break;
      }
      case State::BOTH: // main.yml:35
      BOTH:
        run.enter(places, state);
        switch (BOTH::execute(states.BOTH_, {ud.BOTH_, ud.n}, run)) {
        case BOTH::Outcome::succeeded:
          run.go(places, state, "succeeded", State::EACH);
          goto EACH;
        case BOTH::Outcome::failed:
          return run.end_asked(places, state, "failed", Outcome::aborted);
        }
        break;
      case State::EACH: // main.yml:50
      EACH:
        run.enter(places, state);
        ud.EACH_.parts.hold(ud.parts.unchecked());
        switch (EACH::execute(states.EACH_, ud.EACH_, run)) {
        case EACH::Outcome::succeeded:
          return run.end_asked(places, state, "succeeded", Outcome::succeeded);
        case EACH::Outcome::error:
          run.go(places, state, "error", State::LET_GO);
          goto LET_GO;
        }
        break;
      case State::LET_GO: // main.yml:65
      LET_GO:
        run.enter(places, state);
        switch (states.LET_GO.execute(ud, run)) {
        case types::LET_GO::Outcome::succeeded:
          run.go(places, state, "succeeded", State::OWN);
          goto OWN;
        }
        break;
      default:
        smachac::never();
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH {
      switch (state) {
      case State::FIND:
        run.caught(places, state);
        return run.end(places, state, "error", Outcome::aborted);
      case State::PICK:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::OWN:
        run.caught(places, state);
        run.go(places, state, "caught_error", State::LET_GO);
        break;
      case State::CARRY:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::BOTH:
        run.caught(places, state);
        run.go(places, state, "error", State::LET_GO);
        break;
      case State::EACH:
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
  watched.start({"fetch", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"fetch", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace fetch
