// Made by smachac 0.1.0 from main.yml (sha256 44e17fb39b6fd463).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::RACE { // main.yml:6

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

/// main.yml:14
struct WORK {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

/// main.yml:15
struct WATCH {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(60.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::WORK WORK;
  types::WATCH WATCH;
};

enum class State : std::size_t {
  WORK,
  WATCH,
};

inline constexpr smachac::Place places[] = {
    {"sm/RACE/WORK", "main.yml:14"},
    {"sm/RACE/WATCH", "main.yml:15"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::WORK::Outcome WORK;
    types::WATCH::Outcome WATCH;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::WORK: // main.yml:14
        run.enter(places, state);
        ended.WORK = states.WORK.execute();
        switch (ended.WORK) {
        case types::WORK::Outcome::done:
          run.exit(places, state, "done");
          return;
        }
        break;
      case State::WATCH: // main.yml:15
        run.enter(places, state);
        ended.WATCH = states.WATCH.execute(run.stop_for(places, state));
        switch (ended.WATCH) {
        case types::WATCH::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::WATCH::Outcome::preempted:
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
  if (ended.WORK == types::WORK::Outcome::done) {
    return Outcome::succeeded;
  }
  return Outcome::aborted;
}

} // namespace sm::RACE

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
  RACE::Userdata RACE_;
};

struct States {
  RACE::States RACE_;
};

enum class State : std::size_t {
  RACE,
};

inline constexpr smachac::Place places[] = {
    {"sm/RACE", "main.yml:6"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::RACE;
  SMACHAC_TRY {
    switch (state) {
    case State::RACE: // main.yml:6
      run.enter(places, state);
      switch (RACE::execute(states.RACE_, ud.RACE_, run)) {
      case RACE::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case RACE::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
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
