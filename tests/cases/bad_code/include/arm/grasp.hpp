#pragma once

#include "smachac/smachac.hpp"

namespace arm {

// Closes the gripper.
class Grasp {
public:
  enum class Outcome { held, preempted };
  struct In { const std::string &target; };
  static constexpr std::uint32_t smachac_interface = 0x0badcafeU;

  Outcome execute(In in, smachac::Stop &stop) {
    return stop.requested() || in.target.empty() ? Outcome::preempted : Outcome::held;
  }
};

} // namespace arm
