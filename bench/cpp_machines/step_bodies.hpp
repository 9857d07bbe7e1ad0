// The states of the stepped machines in bench/cpp.py: for smachac and for the switches by hand, with
// the same bodies over the same data. The bodies are compiled apart.
#pragma once
#include "smachac/step.hpp"

namespace bench {

struct Hit {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    std::int64_t count;
  };
  struct Out {
    smachac::step::Key<std::int64_t> &count;
  };
  static constexpr std::uint32_t smachac_interface = HASH_Hit;
  smachac::step::Result<Outcome> step(smachac::step::Context &context, In in, Out out);
};

struct HitPose {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    const smachac::step::PoseStampedOf<32> &pose;
  };
  struct Out {
    smachac::step::Key<smachac::step::PoseStampedOf<32>> &pose;
  };
  static constexpr std::uint32_t smachac_interface = HASH_HitPose;
  smachac::step::Result<Outcome> step(smachac::step::Context &context, In in, Out out);
};

struct HitNames {
  enum class Outcome : std::uint8_t { again, done };
  struct In {
    const smachac::step::List<smachac::step::TextOf<32>> &names;
    std::int64_t count;
  };
  struct Out {
    smachac::step::Key<smachac::step::List<smachac::step::TextOf<32>>> &names;
    smachac::step::Key<std::int64_t> &count;
  };
  static constexpr std::uint32_t smachac_interface = HASH_HitNames;
  smachac::step::Result<Outcome> step(smachac::step::Context &context, In in, Out out);
};

namespace by_hand {

struct Data {
  std::int64_t now = 0;
  std::int64_t count = 0;
  smachac::step::PoseStampedOf<32> pose{"base_link", 0.0, {}};
  smachac::step::ListOf<smachac::step::TextOf<32>, 4> names{"the door of the kitchen", "the window",
                                                           "the shelf on the left"};
};

/// `running`, or an outcome.
enum class Outcome : std::uint8_t { running, again, done };

struct Hit {
  Outcome step(Data &data);
};
struct HitPose {
  Outcome step(Data &data);
};
struct HitNames {
  Outcome step(Data &data);
};

} // namespace by_hand
} // namespace bench
