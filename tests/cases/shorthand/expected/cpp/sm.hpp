// Made by smachac 0.1.0 from main.yml (sha256 17f6c8bbb589f3bd).
#pragma once

#include "smachac/smachac.hpp"

namespace sm { // main.yml:3

enum class Outcome : std::uint8_t {
  succeeded,
  o,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded", "o"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::int64_t> p{1};
  smachac::Key<std::any> s{std::any{std::map<std::string, std::any>{{std::string("t"), std::any{std::string("x")}}}}};
};

namespace types {

/// main.yml:9
struct T {
  enum class Outcome : std::uint8_t {
    done,
    s,
  };

  template <class Run>
  Outcome execute(Userdata &ud, Run &run) {
    run.write("t", ud.s, std::any{std::int64_t{3}});
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::T T;
};

enum class State : std::size_t {
  T,
};

inline constexpr smachac::Place places[] = {
    {"sm/T", "main.yml:9"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::T;
  SMACHAC_TRY {
    switch (state) {
    case State::T: // main.yml:9
      run.enter(places, state);
      switch (states.T.execute(ud, run)) {
      case types::T::Outcome::done:
        return run.end(places, state, "done", Outcome::succeeded);
      case types::T::Outcome::s:
        return run.end(places, state, "s", Outcome::o);
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
  watched.start({"sm", "main.yml:3"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"sm", "main.yml:3"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace sm
