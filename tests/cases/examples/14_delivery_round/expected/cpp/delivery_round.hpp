// Made by smachac 0.1.0 from main.yml (sha256 205e7c6b3d0fea7c).
#pragma once

#include "smachac/smachac.hpp"

namespace delivery_round::CHARGE { // main.yml:76

enum class Outcome : std::uint8_t {
  full,
  no_current,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"full", "no_current", "timeout", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:76
struct CHARGE {
  enum class Outcome : std::uint8_t {
    full,
    no_current,
  };

  Outcome execute() {
    return Outcome::full;
  }
};

/// main.yml:76
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(7200.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::CHARGE CHARGE;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  CHARGE,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/CHARGE", "main.yml:76", "delivery_round/CHARGE/CHARGE", "delivery_round/CHARGE (timeout)"},
    {"delivery_round/CHARGE (timeout)/TIMER", "main.yml:76", "delivery_round/CHARGE/TIMER", "delivery_round/CHARGE (timeout)"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::CHARGE::Outcome CHARGE;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::CHARGE: // main.yml:76
        run.enter(places, state);
        ended.CHARGE = states.CHARGE.execute();
        switch (ended.CHARGE) {
        case types::CHARGE::Outcome::full:
          run.exit(places, state, "full");
          return;
        case types::CHARGE::Outcome::no_current:
          run.exit(places, state, "no_current");
          return;
        }
        break;
      case State::TIMER: // main.yml:76
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
  if (ended.CHARGE == types::CHARGE::Outcome::no_current &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::no_current;
  }
  if (ended.CHARGE == types::CHARGE::Outcome::full &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::full;
  }
  return Outcome::timeout;
}

} // namespace delivery_round::CHARGE

namespace delivery_round::DOCK::TRY { // main.yml:71

enum class Outcome : std::uint8_t {
  docked,
  missed,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"docked", "missed"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

struct UserdataView {
  Userdata &own_;
  const smachac::Key<double> &pause;
};

namespace types {

/// main.yml:71
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

/// main.yml:71
struct DOCK {
  enum class Outcome : std::uint8_t {
    docked,
    missed,
  };

  Outcome execute() {
    return Outcome::docked;
  }
};

} // namespace types

struct States {
  types::PAUSE PAUSE;
  types::DOCK DOCK;
};

enum class State : std::size_t {
  PAUSE,
  DOCK,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/DOCK (try)/PAUSE", "main.yml:71", "delivery_round/DOCK/TRY/PAUSE", "delivery_round/DOCK (try)"},
    {"delivery_round/DOCK", "main.yml:71", "delivery_round/DOCK/TRY/DOCK", "delivery_round/DOCK (try)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PAUSE;
  SMACHAC_TRY {
    switch (state) {
    case State::PAUSE: // main.yml:71
      run.enter(places, state);
      switch (states.PAUSE.execute(ud, run.stop_for(places, state))) {
      case types::PAUSE::Outcome::succeeded:
        run.go(places, state, "succeeded", State::DOCK);
        goto DOCK;
      case types::PAUSE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::missed);
      }
      break;
    case State::DOCK: // main.yml:71
    DOCK:
      run.enter(places, state);
      switch (states.DOCK.execute()) {
      case types::DOCK::Outcome::docked:
        return run.end(places, state, "docked", Outcome::docked);
      case types::DOCK::Outcome::missed:
        return run.end(places, state, "missed", Outcome::missed);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace delivery_round::DOCK::TRY

namespace delivery_round::DOCK { // main.yml:71

enum class Outcome : std::uint8_t {
  docked,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"docked", "exhausted", "preempted"};
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
    {"delivery_round/DOCK (try)", "main.yml:71", "delivery_round/DOCK/TRY", "delivery_round/DOCK (retry)"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<double, 5> items = std::array<double, 5>{{0.0, 0.01, 0.01, 0.01, 0.01}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRY;
  for (const auto &item : items) {
    ud.pause.hold(item);
    // main.yml:71
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRY::execute(states.TRY_, {ud.TRY_, ud.pause}, run);
      const bool over = round.over();
      switch (outcome) {
      case TRY::Outcome::docked:
        if (over) {
          return run.end(places, state, "docked", Outcome::preempted);
        }
        return run.end(places, state, "docked", Outcome::docked);
      case TRY::Outcome::missed:
        if (over) {
          return run.end(places, state, "missed", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "missed", Outcome::exhausted);
        }
        run.again(places, state, "missed");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace delivery_round::DOCK

namespace delivery_round::GO_HOME::TIMED { // main.yml:64

enum class Outcome : std::uint8_t {
  arrived,
  blocked,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"arrived", "blocked", "timeout", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:64
struct GO_HOME {
  enum class Outcome : std::uint8_t {
    arrived,
    blocked,
  };

  Outcome execute() {
    return Outcome::arrived;
  }
};

/// main.yml:64
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(300.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::GO_HOME GO_HOME;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  GO_HOME,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/GO_HOME", "main.yml:64", "delivery_round/GO_HOME/TIMED/GO_HOME", "delivery_round/GO_HOME (timeout)"},
    {"delivery_round/GO_HOME (timeout)/TIMER", "main.yml:64", "delivery_round/GO_HOME/TIMED/TIMER", "delivery_round/GO_HOME (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::GO_HOME::Outcome GO_HOME;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::GO_HOME: // main.yml:64
        run.enter(places, state);
        ended.GO_HOME = states.GO_HOME.execute();
        switch (ended.GO_HOME) {
        case types::GO_HOME::Outcome::arrived:
          run.exit(places, state, "arrived");
          return;
        case types::GO_HOME::Outcome::blocked:
          run.exit(places, state, "blocked");
          return;
        }
        break;
      case State::TIMER: // main.yml:64
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
  if (ended.GO_HOME == types::GO_HOME::Outcome::blocked &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::blocked;
  }
  if (ended.GO_HOME == types::GO_HOME::Outcome::arrived &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::arrived;
  }
  return Outcome::timeout;
}

} // namespace delivery_round::GO_HOME::TIMED

namespace delivery_round::GO_HOME { // main.yml:64

enum class Outcome : std::uint8_t {
  arrived,
  timeout,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"arrived", "timeout", "preempted", "exhausted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
  TIMED::Userdata TIMED_;
};

struct States {
  TIMED::States TIMED_;
};

enum class State : std::size_t {
  TIMED,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/GO_HOME (timeout)", "main.yml:64", "delivery_round/GO_HOME/TIMED", "delivery_round/GO_HOME (retry)"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 3> items = std::array<std::int64_t, 3>{{1, 2, 3}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TIMED;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // main.yml:64
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TIMED::execute(states.TIMED_, ud.TIMED_, run);
      const bool over = round.over();
      switch (outcome) {
      case TIMED::Outcome::arrived:
        if (over) {
          return run.end(places, state, "arrived", Outcome::preempted);
        }
        return run.end(places, state, "arrived", Outcome::arrived);
      case TIMED::Outcome::blocked:
        if (over) {
          return run.end(places, state, "blocked", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "blocked", Outcome::exhausted);
        }
        run.again(places, state, "blocked");
        continue;
      case TIMED::Outcome::timeout:
        if (over) {
          return run.end(places, state, "timeout", Outcome::preempted);
        }
        return run.end(places, state, "timeout", Outcome::timeout);
      case TIMED::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace delivery_round::GO_HOME

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER::WAIT_FOR_PERSON { // hand_over.yml:11

enum class Outcome : std::uint8_t {
  pressed,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"pressed", "timeout", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// hand_over.yml:11
struct WAIT_FOR_PERSON {
  enum class Outcome : std::uint8_t {
    pressed,
  };

  Outcome execute() {
    return Outcome::pressed;
  }
};

/// hand_over.yml:11
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(90.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::WAIT_FOR_PERSON WAIT_FOR_PERSON;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  WAIT_FOR_PERSON,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON", "hand_over.yml:11", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON/WAIT_FOR_PERSON", "delivery_round/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON (timeout)"},
    {"delivery_round/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON (timeout)/TIMER", "hand_over.yml:11", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON/TIMER", "delivery_round/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::WAIT_FOR_PERSON::Outcome WAIT_FOR_PERSON;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::WAIT_FOR_PERSON: // hand_over.yml:11
        run.enter(places, state);
        ended.WAIT_FOR_PERSON = states.WAIT_FOR_PERSON.execute();
        switch (ended.WAIT_FOR_PERSON) {
        case types::WAIT_FOR_PERSON::Outcome::pressed:
          run.exit(places, state, "pressed");
          return;
        }
        break;
      case State::TIMER: // hand_over.yml:11
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
  if (ended.WAIT_FOR_PERSON == types::WAIT_FOR_PERSON::Outcome::pressed &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::pressed;
  }
  return Outcome::timeout;
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER::WAIT_FOR_PERSON

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER::OPEN_DRAWER { // hand_over.yml:6

enum class Outcome : std::uint8_t {
  open,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"open", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
};

namespace types {

/// hand_over.yml:6
struct OPEN_DRAWER {
  enum class Outcome : std::uint8_t {
    open,
    jammed,
  };

  Outcome execute() {
    return Outcome::open;
  }
};

} // namespace types

struct States {
  types::OPEN_DRAWER OPEN_DRAWER;
};

enum class State : std::size_t {
  OPEN_DRAWER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS/HAND_OVER/OPEN_DRAWER", "hand_over.yml:6", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/OPEN_DRAWER/OPEN_DRAWER", "delivery_round/VISIT_ROOMS/HAND_OVER/OPEN_DRAWER (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 2> items = std::array<std::int64_t, 2>{{1, 2}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::OPEN_DRAWER;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // hand_over.yml:6
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.OPEN_DRAWER.execute();
      const bool over = round.over();
      switch (outcome) {
      case types::OPEN_DRAWER::Outcome::open:
        if (over) {
          return run.end(places, state, "open", Outcome::preempted);
        }
        return run.end(places, state, "open", Outcome::open);
      case types::OPEN_DRAWER::Outcome::jammed:
        if (over) {
          return run.end(places, state, "jammed", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "jammed", Outcome::exhausted);
        }
        run.again(places, state, "jammed");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER::OPEN_DRAWER

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER { // main.yml:49

enum class Outcome : std::uint8_t {
  done,
  nobody,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "nobody", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  OPEN_DRAWER::Userdata OPEN_DRAWER_;
  WAIT_FOR_PERSON::Userdata WAIT_FOR_PERSON_;
};

namespace types {

/// hand_over.yml:16
struct CLOSE_DRAWER {
  enum class Outcome : std::uint8_t {
    closed,
  };

  Outcome execute() {
    return Outcome::closed;
  }
};

/// hand_over.yml:20
struct GIVE_UP {
  enum class Outcome : std::uint8_t {
    closed,
  };

  Outcome execute() {
    return Outcome::closed;
  }
};

} // namespace types

struct States {
  OPEN_DRAWER::States OPEN_DRAWER_;
  WAIT_FOR_PERSON::States WAIT_FOR_PERSON_;
  types::CLOSE_DRAWER CLOSE_DRAWER;
  types::GIVE_UP GIVE_UP;
};

enum class State : std::size_t {
  OPEN_DRAWER,
  WAIT_FOR_PERSON,
  CLOSE_DRAWER,
  GIVE_UP,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS/HAND_OVER/OPEN_DRAWER (retry)", "hand_over.yml:6", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/OPEN_DRAWER", "delivery_round/VISIT_ROOMS/HAND_OVER"},
    {"delivery_round/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON (timeout)", "hand_over.yml:11", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/WAIT_FOR_PERSON", "delivery_round/VISIT_ROOMS/HAND_OVER"},
    {"delivery_round/VISIT_ROOMS/HAND_OVER/CLOSE_DRAWER", "hand_over.yml:16", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/CLOSE_DRAWER", "delivery_round/VISIT_ROOMS/HAND_OVER"},
    {"delivery_round/VISIT_ROOMS/HAND_OVER/GIVE_UP", "hand_over.yml:20", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER/GIVE_UP", "delivery_round/VISIT_ROOMS/HAND_OVER"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::OPEN_DRAWER;
  SMACHAC_TRY {
    switch (state) {
    case State::OPEN_DRAWER: // hand_over.yml:6
      run.enter(places, state);
      switch (OPEN_DRAWER::execute(states.OPEN_DRAWER_, ud.OPEN_DRAWER_, run)) {
      case OPEN_DRAWER::Outcome::open:
        run.go(places, state, "open", State::WAIT_FOR_PERSON);
        goto WAIT_FOR_PERSON;
      case OPEN_DRAWER::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::nobody);
      case OPEN_DRAWER::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::WAIT_FOR_PERSON: // hand_over.yml:11
    WAIT_FOR_PERSON:
      run.enter(places, state);
      switch (WAIT_FOR_PERSON::execute(states.WAIT_FOR_PERSON_, ud.WAIT_FOR_PERSON_, run)) {
      case WAIT_FOR_PERSON::Outcome::pressed:
        run.go(places, state, "pressed", State::CLOSE_DRAWER);
        goto CLOSE_DRAWER;
      case WAIT_FOR_PERSON::Outcome::timeout:
        run.go(places, state, "timeout", State::GIVE_UP);
        goto GIVE_UP;
      case WAIT_FOR_PERSON::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CLOSE_DRAWER: // hand_over.yml:16
    CLOSE_DRAWER:
      run.enter(places, state);
      switch (states.CLOSE_DRAWER.execute()) {
      case types::CLOSE_DRAWER::Outcome::closed:
        return run.end(places, state, "closed", Outcome::done);
      }
      break;
    case State::GIVE_UP: // hand_over.yml:20
    GIVE_UP:
      run.enter(places, state);
      switch (states.GIVE_UP.execute()) {
      case types::GIVE_UP::Outcome::closed:
        return run.end(places, state, "closed", Outcome::nobody);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::HAND_OVER

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE::TRY::TIMED { // main.yml:39

enum class Outcome : std::uint8_t {
  arrived,
  blocked,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"arrived", "blocked", "timeout", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:39
struct DRIVE {
  enum class Outcome : std::uint8_t {
    arrived,
    blocked,
  };

  Outcome execute() {
    return Outcome::arrived;
  }
};

/// main.yml:39
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(300.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::DRIVE DRIVE;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  DRIVE,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS/DRIVE", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE/TRY/TIMED/DRIVE", "delivery_round/VISIT_ROOMS/DRIVE (timeout)"},
    {"delivery_round/VISIT_ROOMS/DRIVE (timeout)/TIMER", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE/TRY/TIMED/TIMER", "delivery_round/VISIT_ROOMS/DRIVE (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::DRIVE::Outcome DRIVE;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::DRIVE: // main.yml:39
        run.enter(places, state);
        ended.DRIVE = states.DRIVE.execute();
        switch (ended.DRIVE) {
        case types::DRIVE::Outcome::arrived:
          run.exit(places, state, "arrived");
          return;
        case types::DRIVE::Outcome::blocked:
          run.exit(places, state, "blocked");
          return;
        }
        break;
      case State::TIMER: // main.yml:39
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
  if (ended.DRIVE == types::DRIVE::Outcome::blocked &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::blocked;
  }
  if (ended.DRIVE == types::DRIVE::Outcome::arrived &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::arrived;
  }
  return Outcome::timeout;
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE::TRY::TIMED

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE::TRY { // main.yml:39

enum class Outcome : std::uint8_t {
  arrived,
  blocked,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"arrived", "blocked", "timeout", "preempted"};
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

/// main.yml:39
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
    {"delivery_round/VISIT_ROOMS/DRIVE (try)/PAUSE", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE/TRY/PAUSE", "delivery_round/VISIT_ROOMS/DRIVE (try)"},
    {"delivery_round/VISIT_ROOMS/DRIVE (timeout)", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE/TRY/TIMED", "delivery_round/VISIT_ROOMS/DRIVE (try)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PAUSE;
  SMACHAC_TRY {
    switch (state) {
    case State::PAUSE: // main.yml:39
      run.enter(places, state);
      switch (states.PAUSE.execute(ud, run.stop_for(places, state))) {
      case types::PAUSE::Outcome::succeeded:
        run.go(places, state, "succeeded", State::TIMED);
        goto TIMED;
      case types::PAUSE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::TIMED: // main.yml:39
    TIMED:
      run.enter(places, state);
      switch (TIMED::execute(states.TIMED_, ud.own_.TIMED_, run)) {
      case TIMED::Outcome::arrived:
        return run.end_asked(places, state, "arrived", Outcome::arrived);
      case TIMED::Outcome::blocked:
        return run.end_asked(places, state, "blocked", Outcome::blocked);
      case TIMED::Outcome::timeout:
        return run.end_asked(places, state, "timeout", Outcome::timeout);
      case TIMED::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE::TRY

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE { // main.yml:39

enum class Outcome : std::uint8_t {
  arrived,
  preempted,
  exhausted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"arrived", "preempted", "exhausted"};
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
    {"delivery_round/VISIT_ROOMS/DRIVE (try)", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE/TRY", "delivery_round/VISIT_ROOMS/DRIVE (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<double, 3> items = std::array<double, 3>{{0.0, 0.01, 0.01}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::TRY;
  for (const auto &item : items) {
    ud.pause.hold(item);
    // main.yml:39
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = TRY::execute(states.TRY_, {ud.TRY_, ud.pause}, run);
      const bool over = round.over();
      switch (outcome) {
      case TRY::Outcome::arrived:
        if (over) {
          return run.end(places, state, "arrived", Outcome::preempted);
        }
        return run.end(places, state, "arrived", Outcome::arrived);
      case TRY::Outcome::blocked:
        if (over) {
          return run.end(places, state, "blocked", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "blocked", Outcome::exhausted);
        }
        run.again(places, state, "blocked");
        continue;
      case TRY::Outcome::timeout:
        if (over) {
          return run.end(places, state, "timeout", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "timeout", Outcome::exhausted);
        }
        run.again(places, state, "timeout");
        continue;
      case TRY::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS::DRIVE

namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS { // main.yml:27

enum class Outcome : std::uint8_t {
  visited,
  stuck,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"visited", "stuck", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  DRIVE::Userdata DRIVE_;
  HAND_OVER::Userdata HAND_OVER_;
};

struct UserdataView {
  Userdata &own_;
  smachac::Key<std::int64_t> &failed_rooms;
  const smachac::Key<std::int64_t> &room;
};

namespace types {

/// main.yml:35
struct PLAN_PATH {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(const UserdataView &ud) {
    smachac::print("room", ud.room.unchecked());
    return Outcome::succeeded;
  }
};

/// main.yml:45
struct KNOCK {
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

/// main.yml:53
struct NOTE_ABSENCE {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  template <class Run>
  Outcome execute(const UserdataView &ud, Run &run) {
    run.write("failed_rooms", ud.failed_rooms, smachac::py::add(ud.failed_rooms.unchecked(), 1));
    return Outcome::succeeded;
  }
};

/// main.yml:59
struct STEP_BACK {
  enum class Outcome : std::uint8_t {
    free,
    jammed,
  };

  Outcome execute() {
    return Outcome::free;
  }
};

} // namespace types

struct States {
  types::PLAN_PATH PLAN_PATH;
  DRIVE::States DRIVE_;
  types::KNOCK KNOCK;
  HAND_OVER::States HAND_OVER_;
  types::NOTE_ABSENCE NOTE_ABSENCE;
  types::STEP_BACK STEP_BACK;
};

enum class State : std::size_t {
  PLAN_PATH,
  DRIVE,
  KNOCK,
  HAND_OVER,
  NOTE_ABSENCE,
  STEP_BACK,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS/PLAN_PATH", "main.yml:35", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/PLAN_PATH", "delivery_round/VISIT_ROOMS"},
    {"delivery_round/VISIT_ROOMS/DRIVE (retry)", "main.yml:39", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/DRIVE", "delivery_round/VISIT_ROOMS"},
    {"delivery_round/VISIT_ROOMS/KNOCK", "main.yml:45", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/KNOCK", "delivery_round/VISIT_ROOMS"},
    {"delivery_round/VISIT_ROOMS/HAND_OVER", "main.yml:49", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/HAND_OVER", "delivery_round/VISIT_ROOMS"},
    {"delivery_round/VISIT_ROOMS/NOTE_ABSENCE", "main.yml:53", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/NOTE_ABSENCE", "delivery_round/VISIT_ROOMS"},
    {"delivery_round/VISIT_ROOMS/STEP_BACK", "main.yml:59", "delivery_round/VISIT_ROOMS/VISIT_ROOMS/STEP_BACK", "delivery_round/VISIT_ROOMS"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  State state = State::PLAN_PATH;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAN_PATH: // main.yml:35
      run.enter(places, state);
      switch (states.PLAN_PATH.execute(ud)) {
      case types::PLAN_PATH::Outcome::succeeded:
        run.go(places, state, "succeeded", State::DRIVE);
        goto DRIVE;
      }
      break;
    case State::DRIVE: // main.yml:39
    DRIVE:
      run.enter(places, state);
      switch (DRIVE::execute(states.DRIVE_, ud.own_.DRIVE_, run)) {
      case DRIVE::Outcome::arrived:
        run.go(places, state, "arrived", State::KNOCK);
        goto KNOCK;
      case DRIVE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case DRIVE::Outcome::exhausted:
        run.go(places, state, "exhausted", State::STEP_BACK);
        goto STEP_BACK;
      }
      break;
    case State::KNOCK: // main.yml:45
    KNOCK:
      run.enter(places, state);
      switch (states.KNOCK.execute(run.stop_for(places, state))) {
      case types::KNOCK::Outcome::succeeded:
        run.go(places, state, "succeeded", State::HAND_OVER);
        goto HAND_OVER;
      case types::KNOCK::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::HAND_OVER: // main.yml:49
    HAND_OVER:
      run.enter(places, state);
      switch (HAND_OVER::execute(states.HAND_OVER_, ud.own_.HAND_OVER_, run)) {
      case HAND_OVER::Outcome::done:
        return run.end_asked(places, state, "done", Outcome::visited);
      case HAND_OVER::Outcome::nobody:
        run.go(places, state, "nobody", State::NOTE_ABSENCE);
        goto NOTE_ABSENCE;
      case HAND_OVER::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::NOTE_ABSENCE: // main.yml:53
    NOTE_ABSENCE:
      run.enter(places, state);
      switch (states.NOTE_ABSENCE.execute(ud, run)) {
      case types::NOTE_ABSENCE::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::visited);
      }
      break;
    case State::STEP_BACK: // main.yml:59
    STEP_BACK:
      run.enter(places, state);
      switch (states.STEP_BACK.execute()) {
      case types::STEP_BACK::Outcome::free:
        run.go(places, state, "free", State::NOTE_ABSENCE);
        goto NOTE_ABSENCE;
      case types::STEP_BACK::Outcome::jammed:
        return run.end(places, state, "jammed", Outcome::stuck);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace delivery_round::VISIT_ROOMS::VISIT_ROOMS

namespace delivery_round::VISIT_ROOMS { // main.yml:27

enum class Outcome : std::uint8_t {
  visited,
  stuck,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"visited", "stuck", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> room;
  VISIT_ROOMS::Userdata VISIT_ROOMS_;
};

struct UserdataView {
  Userdata &own_;
  smachac::Key<std::int64_t> &failed_rooms;
  const smachac::Key<std::array<std::int64_t, 3>> &rooms;
};

struct States {
  VISIT_ROOMS::States VISIT_ROOMS_;
};

enum class State : std::size_t {
  VISIT_ROOMS,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/VISIT_ROOMS", "main.yml:27", "delivery_round/VISIT_ROOMS/VISIT_ROOMS", "delivery_round/VISIT_ROOMS (for_each)"},
};

template <class Run>
inline Outcome execute(States &states, const UserdataView &ud, Run &run) {
  const auto items = smachac::need(ud.rooms, "rooms");
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::visited;
  }
  const auto state = State::VISIT_ROOMS;
  for (const auto &item : items) {
    ud.own_.room.hold(item);
    // main.yml:27
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = VISIT_ROOMS::execute(states.VISIT_ROOMS_, {ud.own_.VISIT_ROOMS_, ud.failed_rooms, ud.own_.room}, run);
      const bool over = round.over();
      switch (outcome) {
      case VISIT_ROOMS::Outcome::visited:
        if (over) {
          return run.end(places, state, "visited", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "visited", Outcome::visited);
        }
        run.again(places, state, "visited");
        continue;
      case VISIT_ROOMS::Outcome::stuck:
        if (over) {
          return run.end(places, state, "stuck", Outcome::preempted);
        }
        return run.end(places, state, "stuck", Outcome::stuck);
      case VISIT_ROOMS::Outcome::preempted:
        return run.end(places, state, "preempted", Outcome::preempted);
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::visited;
}

} // namespace delivery_round::VISIT_ROOMS

namespace delivery_round::FETCH::WAIT_FOR_PERSON { // hand_over.yml:11

enum class Outcome : std::uint8_t {
  pressed,
  timeout,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"pressed", "timeout", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// hand_over.yml:11
struct WAIT_FOR_PERSON {
  enum class Outcome : std::uint8_t {
    pressed,
  };

  Outcome execute() {
    return Outcome::pressed;
  }
};

/// hand_over.yml:11
struct TIMER {
  enum class Outcome : std::uint8_t {
    succeeded,
    preempted,
  };

  Outcome execute(smachac::Stop &stop) {
    if (stop.wait(7200.0)) {
      stop.service();
      return Outcome::preempted;
    }
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  types::WAIT_FOR_PERSON WAIT_FOR_PERSON;
  types::TIMER TIMER;
};

enum class State : std::size_t {
  WAIT_FOR_PERSON,
  TIMER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/FETCH/WAIT_FOR_PERSON", "hand_over.yml:11", "delivery_round/FETCH/WAIT_FOR_PERSON/WAIT_FOR_PERSON", "delivery_round/FETCH/WAIT_FOR_PERSON (timeout)"},
    {"delivery_round/FETCH/WAIT_FOR_PERSON (timeout)/TIMER", "hand_over.yml:11", "delivery_round/FETCH/WAIT_FOR_PERSON/TIMER", "delivery_round/FETCH/WAIT_FOR_PERSON (timeout)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::WAIT_FOR_PERSON::Outcome WAIT_FOR_PERSON;
    types::TIMER::Outcome TIMER;
  } ended{};
  smachac::Branches<Run, 2> branches(around, places);
  branches.run(true, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::WAIT_FOR_PERSON: // hand_over.yml:11
        run.enter(places, state);
        ended.WAIT_FOR_PERSON = states.WAIT_FOR_PERSON.execute();
        switch (ended.WAIT_FOR_PERSON) {
        case types::WAIT_FOR_PERSON::Outcome::pressed:
          run.exit(places, state, "pressed");
          return;
        }
        break;
      case State::TIMER: // hand_over.yml:11
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
  if (ended.WAIT_FOR_PERSON == types::WAIT_FOR_PERSON::Outcome::pressed &&
      ended.TIMER == types::TIMER::Outcome::preempted) {
    return Outcome::pressed;
  }
  return Outcome::timeout;
}

} // namespace delivery_round::FETCH::WAIT_FOR_PERSON

namespace delivery_round::FETCH::OPEN_DRAWER { // hand_over.yml:6

enum class Outcome : std::uint8_t {
  open,
  exhausted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"open", "exhausted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> attempt;
};

namespace types {

/// hand_over.yml:6
struct OPEN_DRAWER {
  enum class Outcome : std::uint8_t {
    open,
    jammed,
  };

  Outcome execute() {
    return Outcome::open;
  }
};

} // namespace types

struct States {
  types::OPEN_DRAWER OPEN_DRAWER;
};

enum class State : std::size_t {
  OPEN_DRAWER,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/FETCH/OPEN_DRAWER", "hand_over.yml:6", "delivery_round/FETCH/OPEN_DRAWER/OPEN_DRAWER", "delivery_round/FETCH/OPEN_DRAWER (retry)"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  const std::array<std::int64_t, 2> items = std::array<std::int64_t, 2>{{1, 2}};
  smachac::Round round(run.stop, places[0], items.size());
  if (items.empty()) {
    return round.over() ? Outcome::preempted : Outcome::exhausted;
  }
  const auto state = State::OPEN_DRAWER;
  for (const auto &item : items) {
    ud.attempt.hold(item);
    // hand_over.yml:6
    SMACHAC_TRY {
      run.enter(places, state);
      const auto outcome = states.OPEN_DRAWER.execute();
      const bool over = round.over();
      switch (outcome) {
      case types::OPEN_DRAWER::Outcome::open:
        if (over) {
          return run.end(places, state, "open", Outcome::preempted);
        }
        return run.end(places, state, "open", Outcome::open);
      case types::OPEN_DRAWER::Outcome::jammed:
        if (over) {
          return run.end(places, state, "jammed", Outcome::preempted);
        }
        if (round.last()) {
          return run.end(places, state, "jammed", Outcome::exhausted);
        }
        run.again(places, state, "jammed");
        continue;
      }
      run.no_outcome(places, state);
    }
    SMACHAC_CATCH { run.failed(places, state); }
  }
  return Outcome::exhausted;
}

} // namespace delivery_round::FETCH::OPEN_DRAWER

namespace delivery_round::FETCH { // main.yml:22

enum class Outcome : std::uint8_t {
  done,
  nobody,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "nobody", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  OPEN_DRAWER::Userdata OPEN_DRAWER_;
  WAIT_FOR_PERSON::Userdata WAIT_FOR_PERSON_;
};

namespace types {

/// hand_over.yml:16
struct CLOSE_DRAWER {
  enum class Outcome : std::uint8_t {
    closed,
  };

  Outcome execute() {
    return Outcome::closed;
  }
};

/// hand_over.yml:20
struct GIVE_UP {
  enum class Outcome : std::uint8_t {
    closed,
  };

  Outcome execute() {
    return Outcome::closed;
  }
};

} // namespace types

struct States {
  OPEN_DRAWER::States OPEN_DRAWER_;
  WAIT_FOR_PERSON::States WAIT_FOR_PERSON_;
  types::CLOSE_DRAWER CLOSE_DRAWER;
  types::GIVE_UP GIVE_UP;
};

enum class State : std::size_t {
  OPEN_DRAWER,
  WAIT_FOR_PERSON,
  CLOSE_DRAWER,
  GIVE_UP,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/FETCH/OPEN_DRAWER (retry)", "hand_over.yml:6", "delivery_round/FETCH/OPEN_DRAWER", "delivery_round/FETCH"},
    {"delivery_round/FETCH/WAIT_FOR_PERSON (timeout)", "hand_over.yml:11", "delivery_round/FETCH/WAIT_FOR_PERSON", "delivery_round/FETCH"},
    {"delivery_round/FETCH/CLOSE_DRAWER", "hand_over.yml:16"},
    {"delivery_round/FETCH/GIVE_UP", "hand_over.yml:20"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::OPEN_DRAWER;
  SMACHAC_TRY {
    switch (state) {
    case State::OPEN_DRAWER: // hand_over.yml:6
      run.enter(places, state);
      switch (OPEN_DRAWER::execute(states.OPEN_DRAWER_, ud.OPEN_DRAWER_, run)) {
      case OPEN_DRAWER::Outcome::open:
        run.go(places, state, "open", State::WAIT_FOR_PERSON);
        goto WAIT_FOR_PERSON;
      case OPEN_DRAWER::Outcome::exhausted:
        return run.end_asked(places, state, "exhausted", Outcome::nobody);
      case OPEN_DRAWER::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::WAIT_FOR_PERSON: // hand_over.yml:11
    WAIT_FOR_PERSON:
      run.enter(places, state);
      switch (WAIT_FOR_PERSON::execute(states.WAIT_FOR_PERSON_, ud.WAIT_FOR_PERSON_, run)) {
      case WAIT_FOR_PERSON::Outcome::pressed:
        run.go(places, state, "pressed", State::CLOSE_DRAWER);
        goto CLOSE_DRAWER;
      case WAIT_FOR_PERSON::Outcome::timeout:
        run.go(places, state, "timeout", State::GIVE_UP);
        goto GIVE_UP;
      case WAIT_FOR_PERSON::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CLOSE_DRAWER: // hand_over.yml:16
    CLOSE_DRAWER:
      run.enter(places, state);
      switch (states.CLOSE_DRAWER.execute()) {
      case types::CLOSE_DRAWER::Outcome::closed:
        return run.end(places, state, "closed", Outcome::done);
      }
      break;
    case State::GIVE_UP: // hand_over.yml:20
    GIVE_UP:
      run.enter(places, state);
      switch (states.GIVE_UP.execute()) {
      case types::GIVE_UP::Outcome::closed:
        return run.end(places, state, "closed", Outcome::nobody);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace delivery_round::FETCH

namespace delivery_round::CHECK_ROBOT { // main.yml:10

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

/// main.yml:18
struct CHECK_BATTERY {
  enum class Outcome : std::uint8_t {
    charged,
    low,
  };

  Outcome execute() {
    return Outcome::charged;
  }
};

/// main.yml:19
struct CHECK_LASER {
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

/// main.yml:20
struct CHECK_DRAWERS {
  enum class Outcome : std::uint8_t {
    locked,
    open,
  };

  Outcome execute() {
    return Outcome::locked;
  }
};

} // namespace types

struct States {
  types::CHECK_BATTERY CHECK_BATTERY;
  types::CHECK_LASER CHECK_LASER;
  types::CHECK_DRAWERS CHECK_DRAWERS;
};

enum class State : std::size_t {
  CHECK_BATTERY,
  CHECK_LASER,
  CHECK_DRAWERS,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/CHECK_ROBOT/CHECK_BATTERY", "main.yml:18"},
    {"delivery_round/CHECK_ROBOT/CHECK_LASER", "main.yml:19"},
    {"delivery_round/CHECK_ROBOT/CHECK_DRAWERS", "main.yml:20"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &, Run &around) {
  struct {
    types::CHECK_BATTERY::Outcome CHECK_BATTERY;
    types::CHECK_LASER::Outcome CHECK_LASER;
    types::CHECK_DRAWERS::Outcome CHECK_DRAWERS;
  } ended{};
  smachac::Branches<Run, 3> branches(around, places);
  branches.run(false, [&](std::size_t branch, Run &run) {
    const auto state = static_cast<State>(branch);
    SMACHAC_TRY {
      switch (state) {
      case State::CHECK_BATTERY: // main.yml:18
        run.enter(places, state);
        ended.CHECK_BATTERY = states.CHECK_BATTERY.execute();
        switch (ended.CHECK_BATTERY) {
        case types::CHECK_BATTERY::Outcome::charged:
          run.exit(places, state, "charged");
          return;
        case types::CHECK_BATTERY::Outcome::low:
          run.exit(places, state, "low");
          return;
        }
        break;
      case State::CHECK_LASER: // main.yml:19
        run.enter(places, state);
        ended.CHECK_LASER = states.CHECK_LASER.execute(run.stop_for(places, state));
        switch (ended.CHECK_LASER) {
        case types::CHECK_LASER::Outcome::succeeded:
          run.exit(places, state, "succeeded");
          return;
        case types::CHECK_LASER::Outcome::preempted:
          run.exit(places, state, "preempted");
          return;
        }
        break;
      case State::CHECK_DRAWERS: // main.yml:20
        run.enter(places, state);
        ended.CHECK_DRAWERS = states.CHECK_DRAWERS.execute();
        switch (ended.CHECK_DRAWERS) {
        case types::CHECK_DRAWERS::Outcome::locked:
          run.exit(places, state, "locked");
          return;
        case types::CHECK_DRAWERS::Outcome::open:
          run.exit(places, state, "open");
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
  if (ended.CHECK_BATTERY == types::CHECK_BATTERY::Outcome::charged &&
      ended.CHECK_LASER == types::CHECK_LASER::Outcome::succeeded &&
      ended.CHECK_DRAWERS == types::CHECK_DRAWERS::Outcome::locked) {
    return Outcome::ready;
  }
  return Outcome::not_ready;
}

} // namespace delivery_round::CHECK_ROBOT

namespace delivery_round { // main.yml:2

enum class Outcome : std::uint8_t {
  done,
  aborted,
  preempted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "aborted", "preempted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> failed_rooms{0};
  smachac::Key<std::array<std::int64_t, 3>> rooms{std::array<std::int64_t, 3>{{12, 14, 17}}};
  CHECK_ROBOT::Userdata CHECK_ROBOT_;
  FETCH::Userdata FETCH_;
  VISIT_ROOMS::Userdata VISIT_ROOMS_;
  GO_HOME::Userdata GO_HOME_;
  DOCK::Userdata DOCK_;
  CHARGE::Userdata CHARGE_;
};

namespace types {

/// main.yml:82
struct DOCK_AGAIN {
  enum class Outcome : std::uint8_t {
    docked,
    missed,
  };

  Outcome execute() {
    return Outcome::docked;
  }
};

/// main.yml:86
struct CALL_OPERATOR {
  enum class Outcome : std::uint8_t {
    succeeded,
  };

  Outcome execute(Userdata &ud) {
    smachac::print("failed_rooms", ud.failed_rooms.unchecked());
    return Outcome::succeeded;
  }
};

} // namespace types

struct States {
  CHECK_ROBOT::States CHECK_ROBOT_;
  FETCH::States FETCH_;
  VISIT_ROOMS::States VISIT_ROOMS_;
  GO_HOME::States GO_HOME_;
  DOCK::States DOCK_;
  CHARGE::States CHARGE_;
  types::DOCK_AGAIN DOCK_AGAIN;
  types::CALL_OPERATOR CALL_OPERATOR;
};

enum class State : std::size_t {
  CHECK_ROBOT,
  FETCH,
  VISIT_ROOMS,
  GO_HOME,
  DOCK,
  CHARGE,
  DOCK_AGAIN,
  CALL_OPERATOR,
};

inline constexpr smachac::Place places[] = {
    {"delivery_round/CHECK_ROBOT", "main.yml:10"},
    {"delivery_round/FETCH", "main.yml:22"},
    {"delivery_round/VISIT_ROOMS (for_each)", "main.yml:27", "delivery_round/VISIT_ROOMS", "delivery_round"},
    {"delivery_round/GO_HOME (retry)", "main.yml:64", "delivery_round/GO_HOME", "delivery_round"},
    {"delivery_round/DOCK (retry)", "main.yml:71", "delivery_round/DOCK", "delivery_round"},
    {"delivery_round/CHARGE (timeout)", "main.yml:76", "delivery_round/CHARGE", "delivery_round"},
    {"delivery_round/DOCK_AGAIN", "main.yml:82"},
    {"delivery_round/CALL_OPERATOR", "main.yml:86"},
};

template <class Run>
inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::CHECK_ROBOT;
  SMACHAC_TRY {
    switch (state) {
    case State::CHECK_ROBOT: // main.yml:10
      run.enter(places, state);
      switch (CHECK_ROBOT::execute(states.CHECK_ROBOT_, ud.CHECK_ROBOT_, run)) {
      case CHECK_ROBOT::Outcome::ready:
        run.go(places, state, "ready", State::FETCH);
        goto FETCH;
      case CHECK_ROBOT::Outcome::not_ready:
        run.go(places, state, "not_ready", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      }
      break;
    case State::FETCH: // main.yml:22
    FETCH:
      run.enter(places, state);
      switch (FETCH::execute(states.FETCH_, ud.FETCH_, run)) {
      case FETCH::Outcome::done:
        run.go(places, state, "done", State::VISIT_ROOMS);
        goto VISIT_ROOMS;
      case FETCH::Outcome::nobody:
        run.go(places, state, "nobody", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      case FETCH::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::VISIT_ROOMS: // main.yml:27
    VISIT_ROOMS:
      run.enter(places, state);
      switch (VISIT_ROOMS::execute(states.VISIT_ROOMS_, {ud.VISIT_ROOMS_, ud.failed_rooms, ud.rooms}, run)) {
      case VISIT_ROOMS::Outcome::visited:
        run.go(places, state, "visited", State::GO_HOME);
        goto GO_HOME;
      case VISIT_ROOMS::Outcome::stuck:
        run.go(places, state, "stuck", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      case VISIT_ROOMS::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::GO_HOME: // main.yml:64
    GO_HOME:
      run.enter(places, state);
      switch (GO_HOME::execute(states.GO_HOME_, ud.GO_HOME_, run)) {
      case GO_HOME::Outcome::arrived:
        run.go(places, state, "arrived", State::DOCK);
        goto DOCK;
      case GO_HOME::Outcome::timeout:
        run.go(places, state, "timeout", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      case GO_HOME::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      case GO_HOME::Outcome::exhausted:
        run.go(places, state, "exhausted", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      }
      break;
    case State::DOCK: // main.yml:71
    DOCK:
      run.enter(places, state);
      switch (DOCK::execute(states.DOCK_, ud.DOCK_, run)) {
      case DOCK::Outcome::docked:
        run.go(places, state, "docked", State::CHARGE);
        goto CHARGE;
      case DOCK::Outcome::exhausted:
        run.go(places, state, "exhausted", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      case DOCK::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::CHARGE: // main.yml:76
    CHARGE:
      run.enter(places, state);
      switch (CHARGE::execute(states.CHARGE_, ud.CHARGE_, run)) {
      case CHARGE::Outcome::full:
        return run.end_asked(places, state, "full", Outcome::done);
      case CHARGE::Outcome::no_current:
        run.go(places, state, "no_current", State::DOCK_AGAIN);
        goto DOCK_AGAIN;
      case CHARGE::Outcome::timeout:
        run.go(places, state, "timeout", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      case CHARGE::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::preempted);
      }
      break;
    case State::DOCK_AGAIN: // main.yml:82
    DOCK_AGAIN:
      run.enter(places, state);
      switch (states.DOCK_AGAIN.execute()) {
      case types::DOCK_AGAIN::Outcome::docked:
        return run.end(places, state, "docked", Outcome::done);
      case types::DOCK_AGAIN::Outcome::missed:
        run.go(places, state, "missed", State::CALL_OPERATOR);
        goto CALL_OPERATOR;
      }
      break;
    case State::CALL_OPERATOR: // main.yml:86
    CALL_OPERATOR:
      run.enter(places, state);
      switch (states.CALL_OPERATOR.execute(ud)) {
      case types::CALL_OPERATOR::Outcome::succeeded:
        return run.end(places, state, "succeeded", Outcome::aborted);
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
  watched.start({"delivery_round", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

} // namespace delivery_round
