// Made by smachac 0.1.0 from main.yml (sha256 902e49a7a704b304).
#pragma once

#include "smachac/smachac.hpp"

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27::C28::C29 { // main.yml:122

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {};

namespace types {

/// main.yml:126
struct LEAF {
  enum class Outcome : std::uint8_t {
    done,
  };

  Outcome execute() {
    return Outcome::done;
  }
};

} // namespace types

struct States {
  types::LEAF LEAF;
};

enum class State : std::size_t {
  LEAF,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25/C26/C27/C28/C29/LEAF", "main.yml:126"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &, Run &run) {
  State state = State::LEAF;
  SMACHAC_TRY {
    switch (state) {
    case State::LEAF: // main.yml:126
      run.enter(places, state);
      switch (states.LEAF.execute()) {
      case types::LEAF::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27::C28::C29

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27::C28 { // main.yml:118

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C29::Userdata C29_;
};

struct States {
  C29::States C29_;
};

enum class State : std::size_t {
  C29,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25/C26/C27/C28/C29", "main.yml:122"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C29;
  SMACHAC_TRY {
    switch (state) {
    case State::C29: // main.yml:122
      run.enter(places, state);
      switch (C29::execute(states.C29_, ud.C29_, run)) {
      case C29::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27::C28

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27 { // main.yml:114

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C28::Userdata C28_;
};

struct States {
  C28::States C28_;
};

enum class State : std::size_t {
  C28,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25/C26/C27/C28", "main.yml:118"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C28;
  SMACHAC_TRY {
    switch (state) {
    case State::C28: // main.yml:118
      run.enter(places, state);
      switch (C28::execute(states.C28_, ud.C28_, run)) {
      case C28::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26::C27

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26 { // main.yml:110

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C27::Userdata C27_;
};

struct States {
  C27::States C27_;
};

enum class State : std::size_t {
  C27,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25/C26/C27", "main.yml:114"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C27;
  SMACHAC_TRY {
    switch (state) {
    case State::C27: // main.yml:114
      run.enter(places, state);
      switch (C27::execute(states.C27_, ud.C27_, run)) {
      case C27::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25::C26

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25 { // main.yml:106

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C26::Userdata C26_;
};

struct States {
  C26::States C26_;
};

enum class State : std::size_t {
  C26,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25/C26", "main.yml:110"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C26;
  SMACHAC_TRY {
    switch (state) {
    case State::C26: // main.yml:110
      run.enter(places, state);
      switch (C26::execute(states.C26_, ud.C26_, run)) {
      case C26::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24::C25

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24 { // main.yml:102

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C25::Userdata C25_;
};

struct States {
  C25::States C25_;
};

enum class State : std::size_t {
  C25,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24/C25", "main.yml:106"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C25;
  SMACHAC_TRY {
    switch (state) {
    case State::C25: // main.yml:106
      run.enter(places, state);
      switch (C25::execute(states.C25_, ud.C25_, run)) {
      case C25::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23::C24

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23 { // main.yml:98

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C24::Userdata C24_;
};

struct States {
  C24::States C24_;
};

enum class State : std::size_t {
  C24,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23/C24", "main.yml:102"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C24;
  SMACHAC_TRY {
    switch (state) {
    case State::C24: // main.yml:102
      run.enter(places, state);
      switch (C24::execute(states.C24_, ud.C24_, run)) {
      case C24::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22::C23

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22 { // main.yml:94

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C23::Userdata C23_;
};

struct States {
  C23::States C23_;
};

enum class State : std::size_t {
  C23,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22/C23", "main.yml:98"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C23;
  SMACHAC_TRY {
    switch (state) {
    case State::C23: // main.yml:98
      run.enter(places, state);
      switch (C23::execute(states.C23_, ud.C23_, run)) {
      case C23::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21::C22

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21 { // main.yml:90

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C22::Userdata C22_;
};

struct States {
  C22::States C22_;
};

enum class State : std::size_t {
  C22,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21/C22", "main.yml:94"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C22;
  SMACHAC_TRY {
    switch (state) {
    case State::C22: // main.yml:94
      run.enter(places, state);
      switch (C22::execute(states.C22_, ud.C22_, run)) {
      case C22::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20::C21

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20 { // main.yml:86

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C21::Userdata C21_;
};

struct States {
  C21::States C21_;
};

enum class State : std::size_t {
  C21,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20/C21", "main.yml:90"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C21;
  SMACHAC_TRY {
    switch (state) {
    case State::C21: // main.yml:90
      run.enter(places, state);
      switch (C21::execute(states.C21_, ud.C21_, run)) {
      case C21::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19::C20

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19 { // main.yml:82

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C20::Userdata C20_;
};

struct States {
  C20::States C20_;
};

enum class State : std::size_t {
  C20,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19/C20", "main.yml:86"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C20;
  SMACHAC_TRY {
    switch (state) {
    case State::C20: // main.yml:86
      run.enter(places, state);
      switch (C20::execute(states.C20_, ud.C20_, run)) {
      case C20::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18::C19

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18 { // main.yml:78

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C19::Userdata C19_;
};

struct States {
  C19::States C19_;
};

enum class State : std::size_t {
  C19,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18/C19", "main.yml:82"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C19;
  SMACHAC_TRY {
    switch (state) {
    case State::C19: // main.yml:82
      run.enter(places, state);
      switch (C19::execute(states.C19_, ud.C19_, run)) {
      case C19::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17::C18

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17 { // main.yml:74

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C18::Userdata C18_;
};

struct States {
  C18::States C18_;
};

enum class State : std::size_t {
  C18,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17/C18", "main.yml:78"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C18;
  SMACHAC_TRY {
    switch (state) {
    case State::C18: // main.yml:78
      run.enter(places, state);
      switch (C18::execute(states.C18_, ud.C18_, run)) {
      case C18::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16::C17

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16 { // main.yml:70

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C17::Userdata C17_;
};

struct States {
  C17::States C17_;
};

enum class State : std::size_t {
  C17,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16/C17", "main.yml:74"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C17;
  SMACHAC_TRY {
    switch (state) {
    case State::C17: // main.yml:74
      run.enter(places, state);
      switch (C17::execute(states.C17_, ud.C17_, run)) {
      case C17::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15::C16

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15 { // main.yml:66

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C16::Userdata C16_;
};

struct States {
  C16::States C16_;
};

enum class State : std::size_t {
  C16,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15/C16", "main.yml:70"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C16;
  SMACHAC_TRY {
    switch (state) {
    case State::C16: // main.yml:70
      run.enter(places, state);
      switch (C16::execute(states.C16_, ud.C16_, run)) {
      case C16::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14::C15

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14 { // main.yml:62

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C15::Userdata C15_;
};

struct States {
  C15::States C15_;
};

enum class State : std::size_t {
  C15,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14/C15", "main.yml:66"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C15;
  SMACHAC_TRY {
    switch (state) {
    case State::C15: // main.yml:66
      run.enter(places, state);
      switch (C15::execute(states.C15_, ud.C15_, run)) {
      case C15::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13::C14

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13 { // main.yml:58

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C14::Userdata C14_;
};

struct States {
  C14::States C14_;
};

enum class State : std::size_t {
  C14,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13/C14", "main.yml:62"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C14;
  SMACHAC_TRY {
    switch (state) {
    case State::C14: // main.yml:62
      run.enter(places, state);
      switch (C14::execute(states.C14_, ud.C14_, run)) {
      case C14::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12::C13

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12 { // main.yml:54

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C13::Userdata C13_;
};

struct States {
  C13::States C13_;
};

enum class State : std::size_t {
  C13,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12/C13", "main.yml:58"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C13;
  SMACHAC_TRY {
    switch (state) {
    case State::C13: // main.yml:58
      run.enter(places, state);
      switch (C13::execute(states.C13_, ud.C13_, run)) {
      case C13::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11::C12

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11 { // main.yml:50

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C12::Userdata C12_;
};

struct States {
  C12::States C12_;
};

enum class State : std::size_t {
  C12,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11/C12", "main.yml:54"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C12;
  SMACHAC_TRY {
    switch (state) {
    case State::C12: // main.yml:54
      run.enter(places, state);
      switch (C12::execute(states.C12_, ud.C12_, run)) {
      case C12::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10::C11

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10 { // main.yml:46

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C11::Userdata C11_;
};

struct States {
  C11::States C11_;
};

enum class State : std::size_t {
  C11,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10/C11", "main.yml:50"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C11;
  SMACHAC_TRY {
    switch (state) {
    case State::C11: // main.yml:50
      run.enter(places, state);
      switch (C11::execute(states.C11_, ud.C11_, run)) {
      case C11::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9::C10

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9 { // main.yml:42

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C10::Userdata C10_;
};

struct States {
  C10::States C10_;
};

enum class State : std::size_t {
  C10,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9/C10", "main.yml:46"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C10;
  SMACHAC_TRY {
    switch (state) {
    case State::C10: // main.yml:46
      run.enter(places, state);
      switch (C10::execute(states.C10_, ud.C10_, run)) {
      case C10::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8::C9

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8 { // main.yml:38

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C9::Userdata C9_;
};

struct States {
  C9::States C9_;
};

enum class State : std::size_t {
  C9,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8/C9", "main.yml:42"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C9;
  SMACHAC_TRY {
    switch (state) {
    case State::C9: // main.yml:42
      run.enter(places, state);
      switch (C9::execute(states.C9_, ud.C9_, run)) {
      case C9::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7::C8

namespace sm::C0::C1::C2::C3::C4::C5::C6::C7 { // main.yml:34

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C8::Userdata C8_;
};

struct States {
  C8::States C8_;
};

enum class State : std::size_t {
  C8,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7/C8", "main.yml:38"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C8;
  SMACHAC_TRY {
    switch (state) {
    case State::C8: // main.yml:38
      run.enter(places, state);
      switch (C8::execute(states.C8_, ud.C8_, run)) {
      case C8::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6::C7

namespace sm::C0::C1::C2::C3::C4::C5::C6 { // main.yml:30

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C7::Userdata C7_;
};

struct States {
  C7::States C7_;
};

enum class State : std::size_t {
  C7,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6/C7", "main.yml:34"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C7;
  SMACHAC_TRY {
    switch (state) {
    case State::C7: // main.yml:34
      run.enter(places, state);
      switch (C7::execute(states.C7_, ud.C7_, run)) {
      case C7::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5::C6

namespace sm::C0::C1::C2::C3::C4::C5 { // main.yml:26

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C6::Userdata C6_;
};

struct States {
  C6::States C6_;
};

enum class State : std::size_t {
  C6,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5/C6", "main.yml:30"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C6;
  SMACHAC_TRY {
    switch (state) {
    case State::C6: // main.yml:30
      run.enter(places, state);
      switch (C6::execute(states.C6_, ud.C6_, run)) {
      case C6::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4::C5

namespace sm::C0::C1::C2::C3::C4 { // main.yml:22

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C5::Userdata C5_;
};

struct States {
  C5::States C5_;
};

enum class State : std::size_t {
  C5,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4/C5", "main.yml:26"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C5;
  SMACHAC_TRY {
    switch (state) {
    case State::C5: // main.yml:26
      run.enter(places, state);
      switch (C5::execute(states.C5_, ud.C5_, run)) {
      case C5::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3::C4

namespace sm::C0::C1::C2::C3 { // main.yml:18

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C4::Userdata C4_;
};

struct States {
  C4::States C4_;
};

enum class State : std::size_t {
  C4,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3/C4", "main.yml:22"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C4;
  SMACHAC_TRY {
    switch (state) {
    case State::C4: // main.yml:22
      run.enter(places, state);
      switch (C4::execute(states.C4_, ud.C4_, run)) {
      case C4::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2::C3

namespace sm::C0::C1::C2 { // main.yml:14

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C3::Userdata C3_;
};

struct States {
  C3::States C3_;
};

enum class State : std::size_t {
  C3,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2/C3", "main.yml:18"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C3;
  SMACHAC_TRY {
    switch (state) {
    case State::C3: // main.yml:18
      run.enter(places, state);
      switch (C3::execute(states.C3_, ud.C3_, run)) {
      case C3::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1::C2

namespace sm::C0::C1 { // main.yml:10

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C2::Userdata C2_;
};

struct States {
  C2::States C2_;
};

enum class State : std::size_t {
  C2,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1/C2", "main.yml:14"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C2;
  SMACHAC_TRY {
    switch (state) {
    case State::C2: // main.yml:14
      run.enter(places, state);
      switch (C2::execute(states.C2_, ud.C2_, run)) {
      case C2::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0::C1

namespace sm::C0 { // main.yml:6

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C1::Userdata C1_;
};

struct States {
  C1::States C1_;
};

enum class State : std::size_t {
  C1,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0/C1", "main.yml:10"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C1;
  SMACHAC_TRY {
    switch (state) {
    case State::C1: // main.yml:10
      run.enter(places, state);
      switch (C1::execute(states.C1_, ud.C1_, run)) {
      case C1::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
      }
      break;
    default:
      smachac::never();
    }
    run.no_outcome(places, state);
  }
  SMACHAC_CATCH { run.failed(places, state); }
}

} // namespace sm::C0

namespace sm { // main.yml:2

enum class Outcome : std::uint8_t {
  done,
};

constexpr const char *name(Outcome outcome) {
  constexpr const char *names[] = {"done"};
  return names[static_cast<std::size_t>(outcome)];
}

struct Userdata {
  C0::Userdata C0_;
};

struct States {
  C0::States C0_;
};

enum class State : std::size_t {
  C0,
};

inline constexpr smachac::Place places[] = {
    {"sm/C0", "main.yml:6"},
};

template <class Run>
[[gnu::always_inline]] inline Outcome execute(States &states, Userdata &ud, Run &run) {
  State state = State::C0;
  SMACHAC_TRY {
    switch (state) {
    case State::C0: // main.yml:6
      run.enter(places, state);
      switch (C0::execute(states.C0_, ud.C0_, run)) {
      case C0::Outcome::done:
        return run.end(places, state, "done", Outcome::done);
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
