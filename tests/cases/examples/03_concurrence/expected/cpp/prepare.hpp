// Made by smachac 0.1.0 from main.yml (sha256 599aef45d8faa625).
#pragma once

#include "smachac/smachac.hpp"

namespace prepare::FIND_AND_WARM_UP { // main.yml:7

enum class Outcome : std::uint8_t {
  ready,
  not_ready,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"ready", "not_ready"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:15
struct FIND_PART {
  enum class Outcome : std::uint8_t {
    found,
    nothing,
  };

  Outcome execute() {
    return Outcome::found;
  }
};

/// main.yml:18
struct WARM_UP {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(0.05)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::FIND_PART FIND_PART;
  types::WARM_UP WARM_UP;
};

enum class State : std::size_t {
  FIND_PART,
  WARM_UP,
};

inline constexpr smachac::Place places[] = {
    {"prepare/FIND_AND_WARM_UP/FIND_PART", "main.yml:15"},
    {"prepare/FIND_AND_WARM_UP/WARM_UP", "main.yml:18"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::FIND_PART::Outcome FIND_PART;
    types::WARM_UP::Outcome WARM_UP;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(false, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::FIND_PART: // main.yml:15
        run.enter(places, state);
        ended.FIND_PART = states.FIND_PART.execute();
        switch (ended.FIND_PART) {
        case types::FIND_PART::Outcome::found:
          run.exit(places, state, "found");
          return;
        case types::FIND_PART::Outcome::nothing:
          run.exit(places, state, "nothing");
          return;
        }
        break;
      case State::WARM_UP: // main.yml:18
        run.enter(places, state);
        ended.WARM_UP = states.WARM_UP.execute(run.stop_for(places, state));
        switch (ended.WARM_UP) {
        case types::WARM_UP::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::WARM_UP::Outcome::preempted:
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
  if (ended.FIND_PART == types::FIND_PART::Outcome::found &&
      ended.WARM_UP == types::WARM_UP::Outcome::succeeded) {
    return Outcome::ready;
  }
  return Outcome::not_ready;
}

} // namespace prepare::FIND_AND_WARM_UP

namespace prepare { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  FIND_AND_WARM_UP::Userdata FIND_AND_WARM_UP_;
};

namespace types {

/// main.yml:22
struct PICK {
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
  FIND_AND_WARM_UP::States FIND_AND_WARM_UP_;
  types::PICK PICK;
};

enum class State : std::size_t {
  FIND_AND_WARM_UP,
  PICK,
};

inline constexpr smachac::Place places[] = {
    {"prepare/FIND_AND_WARM_UP", "main.yml:7"},
    {"prepare/PICK", "main.yml:22"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::FIND_AND_WARM_UP;
  SMACHAC_TRY {
    switch (state) {
    case State::FIND_AND_WARM_UP: // main.yml:7
      run.enter(places, state);
      switch (FIND_AND_WARM_UP::execute(states.FIND_AND_WARM_UP_, ud.FIND_AND_WARM_UP_, run)) {
      case FIND_AND_WARM_UP::Outcome::ready:
        run.go(places, state, "ready", State::PICK);
        goto PICK;
      case FIND_AND_WARM_UP::Outcome::not_ready:
        return run.end_asked(places, state, "not_ready", Outcome::aborted);
      }
      break;
    case State::PICK: // main.yml:22
    PICK:
      run.enter(places, state);
      switch (states.PICK.execute()) {
      case types::PICK::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case types::PICK::Outcome::aborted:
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
  watched.start({"prepare", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"prepare", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace prepare
