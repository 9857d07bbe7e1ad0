#include "step_bodies.hpp"

std::int64_t most = 0;
bool waiting = false;

namespace bench {

using smachac::step::Context, smachac::step::Result, smachac::step::running;

Result<Hit::Outcome> Hit::step(Context &, In in, Out out) {
  if (waiting) {
    return running;
  }
  out.count = in.count + 1;
  return in.count < most ? Outcome::again : Outcome::done;
}

Result<HitPose::Outcome> HitPose::step(Context &, In in, Out out) {
  if (waiting) {
    return running;
  }
  out.pose.edit().stamp += 1.0;
  return in.pose.stamp < static_cast<double>(most) ? Outcome::again : Outcome::done;
}

Result<HitNames::Outcome> HitNames::step(Context &, In in, Out out) {
  if (waiting) {
    return running;
  }
  out.names.edit()[1][0] = static_cast<char>('a' + in.count % 2);
  out.count = in.count + 1;
  return in.count < most && in.names.size() == 3 ? Outcome::again : Outcome::done;
}

namespace by_hand {

Outcome Hit::step(Data &data) {
  if (waiting) {
    return Outcome::running;
  }
  data.count = data.count + 1;
  return data.count < most ? Outcome::again : Outcome::done;
}

Outcome HitPose::step(Data &data) {
  if (waiting) {
    return Outcome::running;
  }
  data.pose.stamp += 1.0;
  return data.pose.stamp < static_cast<double>(most) ? Outcome::again : Outcome::done;
}

Outcome HitNames::step(Data &data) {
  if (waiting) {
    return Outcome::running;
  }
  data.names[1][0] = static_cast<char>('a' + data.count % 2);
  data.count = data.count + 1;
  return data.count < most && data.names.size() == 3 ? Outcome::again : Outcome::done;
}

} // namespace by_hand
} // namespace bench
