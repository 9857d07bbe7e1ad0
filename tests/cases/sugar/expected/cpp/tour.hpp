// Made by smachac 0.1.0 from main.yml (sha256 20f3bf8389600712).
#pragma once

#include "smachac/smachac.hpp"

namespace tour::EACH::TRIES { // main.yml:41

enum class Outcome : std::uint8_t {
  found,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"found", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
};

namespace types {

/// main.yml:41
struct EACH {
  enum class Outcome : std::uint8_t {
    found,
    lost,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    ++visits_;
    if (stop.requested()) {
      stop.service();
      return Outcome::preempted;
    }
    switch (visits_) {
    case 1:
      return Outcome::lost;
    case 2:
      return Outcome::lost;
    default:
      return Outcome::found;
    }
  }

  std::uint64_t visits_ = 0;
};

} // namespace types

struct States {
  types::EACH EACH;
};

enum class State : std::size_t {
  EACH,
};

inline constexpr smachac::Place places[] = {
    {"tour/EACH", "main.yml:41", "tour/EACH/TRIES/EACH", "tour/EACH (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 2> items = std::array<std::int64_t, 2>{{1, 2}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::EACH;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // main.yml:41
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.EACH.execute(run.stop_for(places, state));
      const bool over = round.over();
      switch (outcome) {
      case types::EACH::Outcome::found:
        if (over) {
          return run.end(places, state, "found", Outcome::preempted);
        }
        return run.end(places, state, "found", Outcome::found);
      case types::EACH::Outcome::lost:
        if (over) {
          return run.end(places, state, "lost", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "lost", Outcome::exhausted);
        }
        run.again(places, state, "lost");
        continue;
      case types::EACH::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace tour::EACH::TRIES

namespace tour::EACH { // main.yml:41

enum class Outcome : std::uint8_t {
  found,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"found", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::string> unused;
  TRIES::Userdata TRIES_;
};

struct States {
  TRIES::States TRIES_;
};

enum class State : std::size_t {
  TRIES,
};

inline constexpr smachac::Place places[] = {
    {"tour/EACH (retry)", "main.yml:41", "tour/EACH/TRIES", "tour/EACH (for_each)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::string, 2> items = std::array<std::string, 2>{{std::string("a"), std::string("b")}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRIES;
  for (const auto &item : items) {
    ud.unused.hold(item);
    // main.yml:41
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRIES::execute(states.TRIES_, ud.TRIES_, run);
      const bool over = round.over();
      switch (outcome) {
      case TRIES::Outcome::found:
        if (over) {
          return run.end(places, state, "found", Outcome::preempted);
        }
        return run.end(places, state, "found", Outcome::found);
      case TRIES::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      case TRIES::Outcome::exhausted:
        if (over) {
          return run.end(places, state, "exhausted", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "exhausted", Outcome::exhausted);
        }
        run.again(places, state, "exhausted");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace tour::EACH

namespace tour::WITHOUT { // main.yml:36

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::any> unused;
};

namespace types {

/// main.yml:36
struct WITHOUT {
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
  types::WITHOUT WITHOUT;
};

enum class State : std::size_t {
  WITHOUT,
};

inline constexpr smachac::Place places[] = {
    {"tour/WITHOUT", "main.yml:36", "tour/WITHOUT/WITHOUT", "tour/WITHOUT (for_each)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &, Userdata &, Run &run) {
  smachac::Round round(run.stop, places[0], 0);
  return round.over() ? Outcome::preempted : Outcome::succeeded;
}

} // namespace tour::WITHOUT

namespace tour::TRIES::TRIES { // main.yml:27

enum class Outcome : std::uint8_t {
  again,
  good,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"again", "good"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:32
struct HOPE {
  enum class Outcome : std::uint8_t {
    again,
  };

  Outcome execute() {
    return Outcome::again;
  }
};

} // namespace types

struct States {
  types::HOPE HOPE;
};

enum class State : std::size_t {
  HOPE,
};

inline constexpr smachac::Place places[] = {
    {"tour/TRIES/HOPE", "main.yml:32", "tour/TRIES/TRIES/HOPE", "tour/TRIES"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::HOPE;
  SMACHAC_TRY {
    switch (state) {
    case State::HOPE: // main.yml:32
      run.enter(places, state);
      switch (states.HOPE.execute()) {
      case types::HOPE::Outcome::again:
        return run.end(places, state, "again", Outcome::again);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace tour::TRIES::TRIES

namespace tour::TRIES { // main.yml:27

enum class Outcome : std::uint8_t {
  good,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"good", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
  TRIES::Userdata TRIES_;
};

struct States {
  TRIES::States TRIES_;
};

enum class State : std::size_t {
  TRIES,
};

inline constexpr smachac::Place places[] = {
    {"tour/TRIES", "main.yml:27", "tour/TRIES/TRIES", "tour/TRIES (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 2> items = std::array<std::int64_t, 2>{{1, 2}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRIES;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // main.yml:27
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRIES::execute(states.TRIES_, ud.TRIES_, run);
      const bool over = round.over();
      switch (outcome) {
      case TRIES::Outcome::again:
        if (over) {
          return run.end(places, state, "again", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "again", Outcome::exhausted);
        }
        run.again(places, state, "again");
        continue;
      case TRIES::Outcome::good:
        if (over) {
          return run.end(places, state, "good", Outcome::preempted);
        }
        return run.end(places, state, "good", Outcome::good);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace tour::TRIES

// It takes longer than it may.
namespace tour::HASTE { // main.yml:21

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

/// main.yml:21
struct HASTE {
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

/// main.yml:21
struct TIMER {
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
  types::HASTE HASTE;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  HASTE,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"tour/HASTE", "main.yml:21", "tour/HASTE/HASTE", "tour/HASTE (timeout)"},
    {"tour/HASTE (timeout)/TIMER", "main.yml:21", "tour/HASTE/TIMER", "tour/HASTE (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::HASTE::Outcome HASTE;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::HASTE: // main.yml:21
        run.enter(places, state);
        ended.HASTE = states.HASTE.execute(run.stop_for(places, state));
        switch (ended.HASTE) {
        case types::HASTE::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::HASTE::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::TIMER: // main.yml:21
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
  if (ended.HASTE == types::HASTE::Outcome::preempted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::preempted;
  }
  if (ended.HASTE == types::HASTE::Outcome::succeeded &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::succeeded;
  }
  return Outcome::timeout;
}

} // namespace tour::HASTE

namespace tour::VISIT { // main.yml:13

enum class Outcome : std::uint8_t {
  succeeded,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> goal;
  smachac::Key<std::array<std::int64_t, 3>> waypoints;
};

struct UserdataView {
  Userdata &own_;
  smachac::Key<std::int64_t> &total;
};

namespace types {

/// main.yml:13
struct VISIT {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(const UserdataView &ud, Run &run) {
    run.write("total", ud.total, smachac::py::add(ud.total.unchecked(), ud.own_.goal.unchecked()));
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::VISIT VISIT;
};

enum class State : std::size_t {
  VISIT,
};

inline constexpr smachac::Place places[] = {
    {"tour/VISIT", "main.yml:13", "tour/VISIT/VISIT", "tour/VISIT (for_each)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const auto items = smachac::need(ud.own_.waypoints, "waypoints");
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::succeeded;
  }
  const auto state = State::VISIT;
  for (const auto &item : items) {
    ud.own_.goal.hold(item);
    // main.yml:13
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.VISIT.execute(ud, run);
      const bool over = round.over();
      switch (outcome) {
      case types::VISIT::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "succeeded", Outcome::succeeded);
        }
        run.again(places, state, "succeeded");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::succeeded;
}

} // namespace tour::VISIT

namespace tour::LOOK::TRY::TIMED { // main.yml:6

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
  timeout,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted", "timeout"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:6
struct LOOK {
  enum class Outcome : std::uint8_t {
    succeeded,
    aborted,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    ++visits_;
    if (stop.requested()) {
      stop.service();
      return Outcome::preempted;
    }
    switch (visits_) {
    case 1:
      return Outcome::aborted;
    default:
      return Outcome::succeeded;
    }
  }

  std::uint64_t visits_ = 0;
};

/// main.yml:6
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(20.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::LOOK LOOK;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  LOOK,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"tour/LOOK", "main.yml:6", "tour/LOOK/TRY/TIMED/LOOK", "tour/LOOK (timeout)"},
    {"tour/LOOK (timeout)/TIMER", "main.yml:6", "tour/LOOK/TRY/TIMED/TIMER", "tour/LOOK (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::LOOK::Outcome LOOK;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::LOOK: // main.yml:6
        run.enter(places, state);
        ended.LOOK = states.LOOK.execute(run.stop_for(places, state));
        switch (ended.LOOK) {
        case types::LOOK::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::LOOK::Outcome::aborted:
          run.exit(places, state, "aborted");
          return;
        case types::LOOK::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::TIMER: // main.yml:6
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
  if (ended.LOOK == types::LOOK::Outcome::preempted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::preempted;
  }
  if (ended.LOOK == types::LOOK::Outcome::aborted &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::aborted;
  }
  if (ended.LOOK == types::LOOK::Outcome::succeeded &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::succeeded;
  }
  return Outcome::timeout;
}

} // namespace tour::LOOK::TRY::TIMED

namespace tour::LOOK::TRY { // main.yml:6

enum class Outcome : std::uint8_t {
  succeeded,
  aborted,
  preempted,
  timeout,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "aborted", "preempted", "timeout"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  TIMED::Userdata TIMED_;
};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<double> &pause;
};

namespace types {

/// main.yml:6
struct PAUSE {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(const UserdataView &ud, smachac::Stop &stop) {
    if (stop.wait(ud.pause.unchecked())) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::PAUSE PAUSE;
  TIMED::States TIMED_;
};

enum class State : std::size_t {
  PAUSE,
  TIMED,
};

inline constexpr smachac::Place places[] = {
    {"tour/LOOK (try)/PAUSE", "main.yml:6", "tour/LOOK/TRY/PAUSE", "tour/LOOK (try)"},
    {"tour/LOOK (timeout)", "main.yml:6", "tour/LOOK/TRY/TIMED", "tour/LOOK (try)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PAUSE;
  SMACHAC_TRY {
    switch (state) {
    case State::PAUSE: // main.yml:6
      run.enter(places, state);
      switch (states.PAUSE.execute(ud, run.stop_for(places, state))) {
      case types::PAUSE::Outcome::succeeded:
        run.go(places, state, "succeeded", State::TIMED);
        goto TIMED;
      case types::PAUSE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::TIMED: // main.yml:6
    TIMED:
      run.enter(places, state);
      switch (TIMED::execute(states.TIMED_, ud.own_.TIMED_, run)) {
      case TIMED::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::succeeded);
      case TIMED::Outcome::aborted:
        return run.end_asked(places, state, "aborted", Outcome::aborted);
      case TIMED::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case TIMED::Outcome::timeout:
        return run.end_asked(places, state, "timeout", Outcome::timeout);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace tour::LOOK::TRY

namespace tour::LOOK { // main.yml:6

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
  smachac::Key<double> pause;
  TRY::Userdata TRY_;
};

struct States {
  TRY::States TRY_;
};

enum class State : std::size_t {
  TRY,
};

inline constexpr smachac::Place places[] = {
    {"tour/LOOK (try)", "main.yml:6", "tour/LOOK/TRY", "tour/LOOK (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<double, 3> items = std::array<double, 3>{{0.0, 0.1, 0.1}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRY;
  for (const auto &item : items) {
    ud.pause.hold(item);
    // main.yml:6
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRY::execute(states.TRY_, {ud.TRY_, ud.pause}, run);
      const bool over = round.over();
      switch (outcome) {
      case TRY::Outcome::succeeded:
        if (over) {
          return run.end(places, state, "succeeded", Outcome::preempted);
        }
        return run.end(places, state, "succeeded", Outcome::succeeded);
      case TRY::Outcome::aborted:
        if (over) {
          return run.end(places, state, "aborted", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "aborted", Outcome::exhausted);
        }
        run.again(places, state, "aborted");
        continue;
      case TRY::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      case TRY::Outcome::timeout:
        if (over) {
          return run.end(places, state, "timeout", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "timeout", Outcome::exhausted);
        }
        run.again(places, state, "timeout");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace tour::LOOK

namespace tour { // main.yml:1

enum class Outcome : std::uint8_t {
  done,
  failed,
  stopped,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "failed", "stopped"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> count{0};
  smachac::Key<std::array<std::int64_t, 3>> waypoints{std::array<std::int64_t, 3>{{1, 2, 3}}};
  LOOK::Userdata LOOK_;
  VISIT::Userdata VISIT_;
  HASTE::Userdata HASTE_;
  TRIES::Userdata TRIES_;
  WITHOUT::Userdata WITHOUT_;
  EACH::Userdata EACH_;
};

namespace types {

/// main.yml:48
struct SHOW {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("count", ud.count.unchecked());
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  LOOK::States LOOK_;
  VISIT::States VISIT_;
  HASTE::States HASTE_;
  TRIES::States TRIES_;
  WITHOUT::States WITHOUT_;
  EACH::States EACH_;
  types::SHOW SHOW;
};

enum class State : std::size_t {
  LOOK,
  VISIT,
  HASTE,
  TRIES,
  WITHOUT,
  EACH,
  SHOW,
};

inline constexpr smachac::Place places[] = {
    {"tour/LOOK (retry)", "main.yml:6", "tour/LOOK", "tour"},
    {"tour/VISIT (for_each)", "main.yml:13", "tour/VISIT", "tour"},
    {"tour/HASTE (timeout)", "main.yml:21", "tour/HASTE", "tour"},
    {"tour/TRIES (retry)", "main.yml:27", "tour/TRIES", "tour"},
    {"tour/WITHOUT (for_each)", "main.yml:36", "tour/WITHOUT", "tour"},
    {"tour/EACH (for_each)", "main.yml:41", "tour/EACH", "tour"},
    {"tour/SHOW", "main.yml:48"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::LOOK;
  SMACHAC_TRY {
    switch (state) {
    case State::LOOK: // main.yml:6
      run.enter(places, state);
      switch (LOOK::execute(states.LOOK_, ud.LOOK_, run)) {
      case LOOK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::VISIT);
        goto VISIT;
      case LOOK::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      case LOOK::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::failed);
      }
      break;
    case State::VISIT: // main.yml:13
    VISIT:
      run.enter(places, state);
      ud.VISIT_.waypoints.hold(ud.waypoints.unchecked());
      switch (VISIT::execute(states.VISIT_, {ud.VISIT_, ud.count}, run)) {
      case VISIT::Outcome::succeeded:
        run.go(places, state, "succeeded", State::HASTE);
        goto HASTE;
      case VISIT::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      }
      break;
    case State::HASTE: // main.yml:21
    HASTE:
      run.enter(places, state);
      switch (HASTE::execute(states.HASTE_, ud.HASTE_, run)) {
      case HASTE::Outcome::succeeded:
        return run.end_asked(places, state, "succeeded", Outcome::failed);
      case HASTE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      case HASTE::Outcome::timeout:
        run.go(places, state, "timeout", State::TRIES);
        goto TRIES;
      }
      break;
    case State::TRIES: // main.yml:27
    TRIES:
      run.enter(places, state);
      switch (TRIES::execute(states.TRIES_, ud.TRIES_, run)) {
      case TRIES::Outcome::good:
        return run.end_asked(places, state, "good", Outcome::failed);
      case TRIES::Outcome::exhausted:
        run.go(places, state, "exhausted", State::WITHOUT);
        goto WITHOUT;
      case TRIES::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      }
      break;
    case State::WITHOUT: // main.yml:36
    WITHOUT:
      run.enter(places, state);
      switch (WITHOUT::execute(states.WITHOUT_, ud.WITHOUT_, run)) {
      case WITHOUT::Outcome::succeeded:
        run.go(places, state, "succeeded", State::EACH);
        goto EACH;
      case WITHOUT::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      }
      break;
    case State::EACH: // main.yml:41
    EACH:
      run.enter(places, state);
      switch (EACH::execute(states.EACH_, ud.EACH_, run)) {
      case EACH::Outcome::found:
        run.go(places, state, "found", State::SHOW);
        goto SHOW;
      case EACH::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::stopped);
      case EACH::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::failed);
      }
      break;
    case State::SHOW: // main.yml:48
    SHOW:
      run.enter(places, state);
      switch (states.SHOW.execute(ud)) {
      case types::SHOW::Outcome::succeeded:
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
  watched.start({"tour", "main.yml:1"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"tour", "main.yml:1"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace tour
