#include "bodies.hpp"

std::int64_t most = 0;

namespace bench {

Hit::Outcome Hit::execute(In in, Out out) {
  out.count = in.count + 1;
  return in.count < most ? Outcome::again : Outcome::done;
}

HitPose::Outcome HitPose::execute(In in, Out out) {
  out.pose.edit().stamp += 1.0;
  return in.pose.stamp < static_cast<double>(most) ? Outcome::again : Outcome::done;
}

HitNames::Outcome HitNames::execute(In in, Out out) {
  out.names.edit()[1][0] = static_cast<char>('a' + in.count % 2);
  out.count = in.count + 1;
  return in.count < most && in.names.size() == 3 ? Outcome::again : Outcome::done;
}

namespace by_hand {

Outcome Hit::execute(Data &data) {
  data.count = data.count + 1;
  return data.count < most ? Outcome::again : Outcome::done;
}

Outcome HitPose::execute(Data &data) {
  data.pose.stamp += 1.0;
  return data.pose.stamp < static_cast<double>(most) ? Outcome::again : Outcome::done;
}

Outcome HitNames::execute(Data &data) {
  data.names[1][0] = static_cast<char>('a' + data.count % 2);
  data.count = data.count + 1;
  return data.count < most && data.names.size() == 3 ? Outcome::again : Outcome::done;
}

} // namespace by_hand
} // namespace bench
