// Carry: what it does.
#pragma once

#include <cstdint>

#include "smachac/smachac.hpp"

namespace arm {

class Carry {
public:
  enum class Outcome { done, not_found, preempted };
  struct In { const smachac::Pose &from; const smachac::Pose &into; const std::optional<bool> &gently; };
  struct Out { smachac::Key<double> &metres; smachac::Key<double> &seconds; };
  // Changes with the interface: the compiler then asks you to compare the two.
  static constexpr std::uint32_t smachac_interface = 0x64489222U;

  explicit Carry(double speed) : speed_(speed) {}

  Outcome execute(In in, Out out, smachac::Stop &stop) {
    (void)in;
    (void)stop;
    out.metres = double{};
    out.seconds = double{};
    return Outcome::done;
  }

private:
  double speed_;
};

}  // namespace arm
