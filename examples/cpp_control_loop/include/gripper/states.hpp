// The states of grip.yml: a simulated gripper, moved a little in each step.
#pragma once
#include <smachac/step.hpp>

namespace gripper {

using smachac::step::Context;
using smachac::step::Key;
using smachac::step::Result;
using smachac::step::running;

/// The fingers and the part between them; widths in metres, forces in newtons.
struct Fingers {
  double part = 0.03;
  bool lifted = false;
};

/// The speed of the fingers in metres for each nanosecond: 0.2 m/s.
constexpr double speed = 0.2e-9;

/// The part of a movement since the last step.
class Clock {
public:
  double passed(const Context &context) {
    const double since = context.first ? 0.0 : static_cast<double>(context.now - last_);
    last_ = context.now;
    return since;
  }

private:
  smachac::step::Nanoseconds last_ = 0;
};

class CloseUntilContact {
public:
  enum class Outcome : std::uint8_t { contact, closed, preempted };
  struct In {
    double width;
  };
  struct Out {
    Key<double> &width;
    Key<double> &force;
  };
  static constexpr std::uint32_t smachac_interface = 0x4334f408U;

  constexpr explicit CloseUntilContact(Fingers &fingers) : fingers_(fingers) {}

  Result<Outcome> step(Context &context, In in, Out out) {
    if (context.stop_requested()) {
      context.service();
      return Outcome::preempted;
    }
    const double width = in.width - speed * clock_.passed(context);
    out.width = width;
    if (width <= fingers_.part) {
      out.force = 12.0;
      return Outcome::contact;
    }
    if (width <= 0.0) {
      return Outcome::closed;
    }
    return running;
  }

private:
  Fingers &fingers_;
  Clock clock_{};
};

class OpenFully {
public:
  enum class Outcome : std::uint8_t { opened, preempted };
  struct In {
    double width;
  };
  struct Out {
    Key<double> &width;
  };
  static constexpr std::uint32_t smachac_interface = 0xbe2cdd30U;

  constexpr explicit OpenFully(Fingers &fingers) : fingers_(fingers) {}

  Result<Outcome> step(Context &context, In in, Out out) {
    if (context.stop_requested()) {
      context.service();
      return Outcome::preempted;
    }
    out.width = in.width + speed * clock_.passed(context);
    fingers_.lifted = false;
    return in.width < 0.08 ? Result<Outcome>(running) : Outcome::opened;
  }

private:
  Fingers &fingers_;
  Clock clock_{};
};

} // namespace gripper
