#pragma once

#include "smachac/smachac.hpp"

namespace arm {

class Drop {
public:
  enum class Outcome { dropped };
  struct In {
    const std::string &into; // where to
    const std::string &from;
    double count;
  };
  static constexpr std::uint32_t smachac_interface = 0x5605902fU;

  Outcome execute(In) { return Outcome::dropped; }
};

} // namespace arm
