// The states of the machines in bench/cpp.py: for smachac and for the loops by hand, with the same
// bodies over the same data. The bodies are compiled apart, so that the optimiser does not see them.
#pragma once
#include "smachac/smachac.hpp"

namespace bench {

struct Hit {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    std::int64_t count;
  };
  struct Out {
    smachac::Key<std::int64_t> &count;
  };
  static constexpr std::uint32_t smachac_interface = HASH_Hit;
  Outcome execute(In in, Out out);
};

struct HitPose {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    const smachac::PoseStamped &pose;
  };
  struct Out {
    smachac::Key<smachac::PoseStamped> &pose;
  };
  static constexpr std::uint32_t smachac_interface = HASH_HitPose;
  Outcome execute(In in, Out out);
};

struct HitNames {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    const std::vector<std::string> &names;
    std::int64_t count;
  };
  struct Out {
    smachac::Key<std::vector<std::string>> &names;
    smachac::Key<std::int64_t> &count;
  };
  static constexpr std::uint32_t smachac_interface = HASH_HitNames;
  Outcome execute(In in, Out out);
};

namespace by_hand {

struct Data {
  std::int64_t count = 0;
  smachac::PoseStamped pose{"base_link", 0.0, {}};
  std::vector<std::string> names{"the door of the kitchen", "the window", "the shelf on the left"};
};

enum class Outcome : std::uint8_t { again, done };

struct Hit {
  Outcome execute(Data &data);
};
struct HitPose {
  Outcome execute(Data &data);
};
struct HitNames {
  Outcome execute(Data &data);
};

} // namespace by_hand
} // namespace bench
