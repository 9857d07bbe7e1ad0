// Made by smachac 0.1.0 from main.yml (sha256 4fc28c8251492587).
#pragma once

#include "arm/carry.hpp"
#include "smachac/smachac.hpp"

// A class with more outcomes than its interface is an error at every warning level.
#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic error "-Wswitch"
#endif

static_assert(::arm::Carry::smachac_interface == 0x64489222U,
              "arm::Carry was written for another Carry.yml: compare them, then set smachac_interface");
static_assert(std::is_same_v<decltype(::arm::Carry::In::from), const smachac::Pose &>,
              "arm::Carry::In::from must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::arm::Carry::In::into), const smachac::Pose &>,
              "arm::Carry::In::into must be const smachac::Pose &");
static_assert(std::is_same_v<decltype(::arm::Carry::In::gently), const std::optional<bool> &>,
              "arm::Carry::In::gently must be const std::optional<bool> &");
static_assert(smachac::in_order<::arm::Carry::In, const smachac::Pose &, const smachac::Pose &, const std::optional<bool> &>(
                  [](auto keys) { return smachac::before_mark(keys.from, keys.into, keys.gently); }),
              "arm::Carry::In must have its fields in the order from, into, gently");
static_assert(std::is_same_v<decltype(::arm::Carry::Out::metres), smachac::Key<double> &>,
              "arm::Carry::Out::metres must be smachac::Key<double> &");
static_assert(std::is_same_v<decltype(::arm::Carry::Out::seconds), smachac::Key<double> &>,
              "arm::Carry::Out::seconds must be smachac::Key<double> &");
static_assert(smachac::in_order<::arm::Carry::Out, smachac::Key<double> &, smachac::Key<double> &>(
                  [](auto keys) { return smachac::before_mark(keys.metres, keys.seconds); }),
              "arm::Carry::Out must have its fields in the order metres, seconds");

namespace code_in_both { // main.yml:2

enum class Outcome : std::uint8_t {
  done,
  lost,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done", "lost"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  smachac::Key<std::optional<bool>> gently;
  smachac::Key<double> metres;
  smachac::Key<double> seconds;
  smachac::Key<smachac::Pose> shelf{smachac::Pose{smachac::Point{0.5, 0.0, 0.1}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
  smachac::Key<smachac::Pose> table{smachac::Pose{smachac::Point{0.5, 0.3, 0.0}, smachac::Quaternion{0.0, 0.0, 0.0, 1.0}}};
};

struct States {
  States()
      : CARRY(0.5) {}

  ::arm::Carry CARRY;
};

enum class State : std::size_t {
  CARRY,
};

inline constexpr smachac::Place places[] = {
    {"code_in_both/CARRY", "main.yml:10"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::CARRY;
  SMACHAC_TRY {
    switch (state) {
    case State::CARRY: // main.yml:10
      run.enter(places, state);
      switch (run.wrote(states.CARRY.execute({ud.shelf.unchecked(), ud.table.unchecked(), smachac::maybe<std::optional<bool>>(ud.gently)}, {run.out(ud.metres), run.out(ud.seconds)}, run.stop_for(places, state)), smachac::Output{"metres", ud.metres}, smachac::Output{"seconds", ud.seconds})) {
      case ::arm::Carry::Outcome::done:
        return run.end_asked(places, state, "done", Outcome::done);
      case ::arm::Carry::Outcome::not_found:
        return run.end_asked(places, state, "not-found", Outcome::lost);
      case ::arm::Carry::Outcome::preempted:
        return run.end_asked(places, state, "preempted", Outcome::lost);
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
  watched.start({"code_in_both", "main.yml:2"});
  return watched.finish(execute(states, ud, watched));
}

/// As above, for an observer of any class with `on(const smachac::Event &)`. It receives
/// all events but those of writes and requests to stop, at less cost.
template <class Watch>
smachac::IfClass<Watch, Outcome> run(States &states, Userdata &ud, Watch &watch,
                                     smachac::Stop &stop) {
  constexpr smachac::Place machine{"code_in_both", "main.yml:2"};
  smachac::DirectRun<Watch> watched(watch, stop);
  watched.start(machine);
  return watched.finish(machine, execute(states, ud, watched));
}

} // namespace code_in_both

#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
