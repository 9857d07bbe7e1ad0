// Made by smachac 0.1.0 from main.yml (sha256 6937b7d348686a85).
#pragma once

#include "smachac/smachac.hpp"

namespace patrol::VISIT_ALL::VISIT { // main.yml:20

enum class Outcome : std::uint8_t {
  seen,
  blocked,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"seen", "blocked"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<std::string> &waypoint;
};

namespace types {

/// main.yml:25
struct DRIVE {
  enum class Outcome : std::uint8_t {
    arrived,
    blocked,
  };

  Outcome execute() {
    return Outcome::arrived;
  }
};

/// main.yml:29
struct LOOK {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(const UserdataView &ud) {
    smachac::print("waypoint", ud.waypoint.unchecked());
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::DRIVE DRIVE;
  types::LOOK LOOK;
};

enum class State : std::size_t {
  DRIVE,
  LOOK,
};

inline constexpr smachac::Place places[] = {
    {"patrol/VISIT_ALL/VISIT/DRIVE", "main.yml:25"},
    {"patrol/VISIT_ALL/VISIT/LOOK", "main.yml:29"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::DRIVE;
  SMACHAC_TRY {
    switch (state) {
    case State::DRIVE: // main.yml:25
      run.enter(places, state);
      switch (states.DRIVE.execute()) {
      case types::DRIVE::Outcome::arrived:
        run.go(places, state, "arrived", State::LOOK);
        goto LOOK;
      case types::DRIVE::Outcome::blocked:
        return run.end(places, state, "blocked", Outcome::blocked);
      }
      break;
    case State::LOOK: // main.yml:29
    LOOK:
      run.enter(places, state);
      switch (states.LOOK.execute(ud)) {
      case types::LOOK::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::seen);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace patrol::VISIT_ALL::VISIT

namespace patrol::VISIT_ALL { // main.yml:9

enum class Outcome : std::uint8_t {
  all_seen,
  blocked,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"all_seen", "blocked", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::string> waypoint;
  VISIT::Userdata VISIT_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<std::array<std::string, 3>> &waypoints;
};

struct States {
  VISIT::States VISIT_;
};

enum class State : std::size_t {
  VISIT,
};

inline constexpr smachac::Place places[] = {
    {"patrol/VISIT_ALL/VISIT", "main.yml:20"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const auto items = smachac::need(ud.waypoints, "waypoints");
  if (items.empty()) {
    return Outcome::all_seen;
  }
  const auto state = State::VISIT;
  smachac::Round round(run.stop, places[0], items.size());
  for (const auto &item : items) {
    ud.own_.waypoint.hold(item);
    // main.yml:20
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = VISIT::execute(states.VISIT_, {ud.own_.VISIT_, ud.own_.waypoint}, run);
      const bool over = round.over();
      switch (outcome) {
      case VISIT::Outcome::seen:
        if (over) {
          return run.end(places, state, "seen", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "seen", Outcome::all_seen);
        }
        run.again(places, state, "seen");
        continue;
      case VISIT::Outcome::blocked:
        return run.end(places, state, "blocked", Outcome::blocked);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::all_seen;
}

} // namespace patrol::VISIT_ALL

namespace patrol { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::array<std::string, 3>> waypoints{std::array<std::string, 3>{{std::string("door"), std::string("window"), std::string("shelf")}}};
  VISIT_ALL::Userdata VISIT_ALL_;
};

struct States {
  VISIT_ALL::States VISIT_ALL_;
};

enum class State : std::size_t {
  VISIT_ALL,
};

inline constexpr smachac::Place places[] = {
    {"patrol/VISIT_ALL", "main.yml:9"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::VISIT_ALL;
  SMACHAC_TRY {
    switch (state) {
    case State::VISIT_ALL: // main.yml:9
      run.enter(places, state);
      switch (VISIT_ALL::execute(states.VISIT_ALL_, {ud.VISIT_ALL_, ud.waypoints}, run)) {
      case VISIT_ALL::Outcome::all_seen:
        return run.end_asked(places, state, "all_seen", Outcome::succeeded);
      case VISIT_ALL::Outcome::blocked:
        return run.end_asked(places, state, "blocked", Outcome::aborted);
      case VISIT_ALL::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::aborted);
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
  watched.start({"patrol", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"patrol", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace patrol
