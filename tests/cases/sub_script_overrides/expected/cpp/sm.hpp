// Made by smachac 0.1.0 from main.yml (sha256 75a72e037e51c72b).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::THROUGH { // main.yml:16

enum class Outcome : std::uint8_t {
  done,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> a{1};
  smachac::Key<std::int64_t> b{2};
  smachac::Key<std::string> tool{std::string("through_gripper")};
};

namespace types {

/// sub.yml:7
struct A {
  enum class Outcome : std::uint8_t {
    done,
    aborted,
    extra,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::A A;
};

enum class State : std::size_t {
  A,
};

inline constexpr smachac::Place places[] = {
    {"sm/THROUGH/A", "sub.yml:7"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::A;
  SMACHAC_TRY {
    switch (state) {
    case State::A: // sub.yml:7
      run.enter(places, state);
      switch (states.A.execute()) {
      case types::A::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      case types::A::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      case types::A::Outcome::extra:
        return run.end(places, state, "extra", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::THROUGH

namespace sm::OTHER { // main.yml:10

enum class Outcome : std::uint8_t {
  done,
  aborted,
  extra,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "aborted", "extra"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> a{1};
  smachac::Key<std::int64_t> b{20};
  smachac::Key<std::int64_t> c{30};
  smachac::Key<std::string> tool{std::string("right_gripper")};
};

namespace types {

/// sub.yml:7
struct A {
  enum class Outcome : std::uint8_t {
    done,
    aborted,
    extra,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::A A;
};

enum class State : std::size_t {
  A,
};

inline constexpr smachac::Place places[] = {
    {"sm/OTHER/A", "sub.yml:7"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::A;
  SMACHAC_TRY {
    switch (state) {
    case State::A: // sub.yml:7
      run.enter(places, state);
      switch (states.A.execute()) {
      case types::A::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      case types::A::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      case types::A::Outcome::extra:
        return run.end(places, state, "extra", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::OTHER

namespace sm::PLAIN { // main.yml:7

enum class Outcome : std::uint8_t {
  done,
  aborted,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "aborted"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> a{1};
  smachac::Key<std::int64_t> b{2};
  smachac::Key<std::string> tool{std::string("nobody_gripper")};
};

namespace types {

/// sub.yml:7
struct A {
  enum class Outcome : std::uint8_t {
    done,
    aborted,
    extra,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::A A;
};

enum class State : std::size_t {
  A,
};

inline constexpr smachac::Place places[] = {
    {"sm/PLAIN/A", "sub.yml:7"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::A;
  SMACHAC_TRY {
    switch (state) {
    case State::A: // sub.yml:7
      run.enter(places, state);
      switch (states.A.execute()) {
      case types::A::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      case types::A::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      case types::A::Outcome::extra:
        return run.end(places, state, "extra", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::PLAIN

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
  PLAIN::Userdata PLAIN_;
  OTHER::Userdata OTHER_;
  THROUGH::Userdata THROUGH_;
};

struct States {
  PLAIN::States PLAIN_;
  OTHER::States OTHER_;
  THROUGH::States THROUGH_;
};

enum class State : std::size_t {
  PLAIN,
  OTHER,
  THROUGH,
};

inline constexpr smachac::Place places[] = {
    {"sm/PLAIN", "main.yml:7"},
    {"sm/OTHER", "main.yml:10"},
    {"sm/THROUGH", "main.yml:16"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::PLAIN;
  SMACHAC_TRY {
    switch (state) {
    case State::PLAIN: // main.yml:7
      run.enter(places, state);
      switch (PLAIN::execute(states.PLAIN_, ud.PLAIN_, run)) {
      case PLAIN::Outcome::done:
        run.go(places, state, "done", State::OTHER);
        goto OTHER;
      case PLAIN::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      }
      break;
    case State::OTHER: // main.yml:10
    OTHER:
      run.enter(places, state);
      switch (OTHER::execute(states.OTHER_, ud.OTHER_, run)) {
      case OTHER::Outcome::done:
        run.go(places, state, "done", State::THROUGH);
        goto THROUGH;
      case OTHER::Outcome::aborted:
        return run.end(places, state, "aborted", Outcome::aborted);
      case OTHER::Outcome::extra:
        return run.end(places, state, "extra", Outcome::aborted);
      }
      break;
    case State::THROUGH: // main.yml:16
    THROUGH:
      run.enter(places, state);
      switch (THROUGH::execute(states.THROUGH_, ud.THROUGH_, run)) {
      case THROUGH::Outcome::done:
        return run.end(places, state, "done", Outcome::succeeded);
      case THROUGH::Outcome::aborted:
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
