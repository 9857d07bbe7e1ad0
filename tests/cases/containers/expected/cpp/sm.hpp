// Made by smachac 0.1.0 from main.yml (sha256 35b3e424b6eae106).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::BOTH { // main.yml:27

enum class Outcome : std::uint8_t {
  both,
  one,
  none,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"both", "one", "none"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:36
struct A {
  enum class Outcome : std::uint8_t {
    done,
    failed,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

/// main.yml:37
struct B {
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
  types::A A;
  types::B B;
};

enum class State : std::size_t {
  A,
  B,
};

inline constexpr smachac::Place places[] = {
    {"sm/BOTH/A", "main.yml:36"},
    {"sm/BOTH/B", "main.yml:37"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::A::Outcome A;
    types::B::Outcome B;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(false, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::A: // main.yml:36
        run.enter(places, state);
        ended.A = states.A.execute();
        switch (ended.A) {
        case types::A::Outcome::done:
          run.exit(places, state, "done");
          return;
        case types::A::Outcome::failed:
          run.exit(places, state, "failed");
          return;
        }
        break;
      case State::B: // main.yml:37
        run.enter(places, state);
        ended.B = states.B.execute();
        switch (ended.B) {
        case types::B::Outcome::done:
          run.exit(places, state, "done");
          return;
        case types::B::Outcome::failed:
          run.exit(places, state, "failed");
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
  if (ended.A == types::A::Outcome::done &&
      ended.B == types::B::Outcome::done) {
    return Outcome::both;
  }
  if (ended.A == types::A::Outcome::done) {
    return Outcome::one;
  }
  return Outcome::none;
}

} // namespace sm::BOTH

namespace sm::ROUND { // main.yml:16

enum class Outcome : std::uint8_t {
  finished,
  aborted,
  go,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"finished", "aborted", "go"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> number;
};

namespace types {

/// main.yml:26
struct STEP {
  enum class Outcome : std::uint8_t {
    go,
    stop,
  };

  Outcome execute() {
    return Outcome::go;
  }
};

} // namespace types

struct States {
  types::STEP STEP;
};

enum class State : std::size_t {
  STEP,
};

inline constexpr smachac::Place places[] = {
    {"sm/ROUND/STEP", "main.yml:26"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  if (items.empty()) {
    return Outcome::finished;
  }
  const auto state = State::STEP;
  smachac::Round round(run.stop, places[0], items.size());
  for (const auto &item : items) {
    ud.number.hold(item);
    // main.yml:26
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.STEP.execute();
      const bool over = round.over();
      switch (outcome) {
      case types::STEP::Outcome::go:
        if (over) {
          return run.end(places, state, "go", Outcome::go);
        }
        if (round.last()) {
          return run.end(places, state, "go", Outcome::finished);
        }
        run.again(places, state, "go");
        continue;
      case types::STEP::Outcome::stop:
        return run.end(places, state, "stop", Outcome::aborted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::finished;
}

} // namespace sm::ROUND

namespace sm::LINE { // main.yml:7

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

/// main.yml:13
struct ONE {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:14
struct TWO {
  enum class Outcome : std::uint8_t {
    succeeded,
    failed,
  };

  Outcome execute() {
    return Outcome::succeeded;
  }
};

/// main.yml:15
struct THREE {
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
  types::ONE ONE;
  types::TWO TWO;
  types::THREE THREE;
};

enum class State : std::size_t {
  ONE,
  TWO,
  THREE,
};

inline constexpr smachac::Place places[] = {
    {"sm/LINE/ONE", "main.yml:13"},
    {"sm/LINE/TWO", "main.yml:14"},
    {"sm/LINE/THREE", "main.yml:15"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::ONE;
  SMACHAC_TRY {
    switch (state) {
    case State::ONE: // main.yml:13
      run.enter(places, state);
      switch (states.ONE.execute()) {
      case types::ONE::Outcome::succeeded:
        run.go(places, state, "succeeded", State::TWO);
        goto TWO;
      }
      break;
    case State::TWO: // main.yml:14
    TWO:
      run.enter(places, state);
      switch (states.TWO.execute()) {
      case types::TWO::Outcome::succeeded:
        run.go(places, state, "succeeded", State::THREE);
        goto THREE;
      case types::TWO::Outcome::failed:
        return run.end(places, state, "failed", Outcome::aborted);
      }
      break;
    case State::THREE: // main.yml:15
    THREE:
      run.enter(places, state);
      switch (states.THREE.execute()) {
      case types::THREE::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::THREE::Outcome::aborted:
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

} // namespace sm::LINE

namespace sm { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  LINE::Userdata LINE_;
  ROUND::Userdata ROUND_;
  BOTH::Userdata BOTH_;
};

struct States {
  LINE::States LINE_;
  ROUND::States ROUND_;
  BOTH::States BOTH_;
};

enum class State : std::size_t {
  LINE,
  ROUND,
  BOTH,
};

inline constexpr smachac::Place places[] = {
    {"sm/LINE", "main.yml:7"},
    {"sm/ROUND", "main.yml:16"},
    {"sm/BOTH", "main.yml:27"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::ROUND;
  SMACHAC_TRY {
    switch (state) {
    case State::LINE: // main.yml:7
    LINE:
      run.enter(places, state);
      switch (LINE::execute(states.LINE_, ud.LINE_, run)) {
      case LINE::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case LINE::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::ROUND: // main.yml:16
      run.enter(places, state);
      switch (ROUND::execute(states.ROUND_, ud.ROUND_, run)) {
      case ROUND::Outcome::finished:
        run.go(places, state, "finished", State::BOTH);
        goto BOTH;
      case ROUND::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case ROUND::Outcome::go:
        run.undeclared(places, state, "go");
      }
      break;
    case State::BOTH: // main.yml:27
    BOTH:
      run.enter(places, state);
      switch (BOTH::execute(states.BOTH_, ud.BOTH_, run)) {
      case BOTH::Outcome::both:
        run.go(places, state, "both", State::LINE);
        goto LINE;
      case BOTH::Outcome::one:
        run.go(places, state, "one", State::LINE);
        goto LINE;
      case BOTH::Outcome::none:
        return run.end(places, state, "none", Outcome::aborted);
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
