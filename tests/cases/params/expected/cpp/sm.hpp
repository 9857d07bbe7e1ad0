// Made by smachac 0.1.0 from main.yml (sha256 cbcdbe3c8287df28).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::OUTER { // main.yml:12

enum class Outcome : std::uint8_t {
  fine,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"fine"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::string> arm{std::string("right")};
  smachac::Key<std::string> name_{std::string("right_arm")};
};

namespace types {

/// main.yml:18
struct INNER {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::INNER INNER;
};

enum class State : std::size_t {
  INNER,
};

inline constexpr smachac::Place places[] = {
    {"sm/OUTER/INNER", "main.yml:18"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::INNER;
  SMACHAC_TRY {
    switch (state) {
    case State::INNER: // main.yml:18
      run.enter(places, state);
      switch (states.INNER.execute()) {
      case types::INNER::Outcome::done:
        return run.end(places, state, "done", Outcome::fine);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::OUTER

namespace sm { // main.yml:2

enum class Outcome : std::uint8_t {
  succeeded,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"succeeded"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::array<std::vector<std::any>, 2>> data{std::array<std::vector<std::any>, 2>{{std::vector<std::any>{std::any{std::string("x")}}, std::vector<std::any>{std::any{std::int64_t{1}}, std::any{std::int64_t{2}}}}}};
  smachac::Key<std::map<std::string, std::map<std::string, std::string>>> nested{std::map<std::string, std::map<std::string, std::string>>{{std::string("a"), std::map<std::string, std::string>{{std::string("b"), std::string("left")}, {std::string("c"), std::string("12")}}}}};
  smachac::Key<std::string> topic{std::string("/left/joint")};
  smachac::Key<std::map<std::string, std::array<std::int64_t, 2>>> whole{std::map<std::string, std::array<std::int64_t, 2>>{{std::string("a"), std::array<std::int64_t, 2>{{1, 2}}}}};
  OUTER::Userdata OUTER_;
};

struct States {
  OUTER::States OUTER_;
};

enum class State : std::size_t {
  OUTER,
};

inline constexpr smachac::Place places[] = {
    {"sm/OUTER", "main.yml:12"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::OUTER;
  SMACHAC_TRY {
    switch (state) {
    case State::OUTER: // main.yml:12
      run.enter(places, state);
      switch (OUTER::execute(states.OUTER_, ud.OUTER_, run)) {
      case OUTER::Outcome::fine:
        return run.end(places, state, "fine", Outcome::succeeded);
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
