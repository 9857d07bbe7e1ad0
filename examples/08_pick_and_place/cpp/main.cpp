// Runs the machine on the fake arm: `./pick_and_place [SEED] [TRACE]`.
#include <cstdlib>

#include "fake_arm.hpp"
#include "pick_and_place.hpp"

int main(int count, char **arguments) {
  FakeWorld world(count > 1 ? std::strtoull(arguments[1], nullptr, 10) : 0U);
  FakeArm arm(world);
  pick_and_place::States states(world, arm);
  pick_and_place::Userdata userdata;
  smachac::Stop stop;

  std::FILE *file = count > 2 ? std::fopen(arguments[2], "w") : nullptr;
  smachac::TraceWriter trace(file);
  const pick_and_place::Outcome outcome =
      pick_and_place::run(states, userdata, file != nullptr ? &trace : nullptr, stop);
  if (file != nullptr) {
    std::fclose(file);
  }

  for (const auto &[name, pose] : world.bodies) {
    const smachac::Point &at = pose.position;
    std::printf("%s: x %.4f m, y %.4f m, z %.4f m\n", name.c_str(), at.x, at.y, at.z);
  }
  std::printf("%s\n", pick_and_place::name(outcome));
  return outcome == pick_and_place::Outcome::succeeded ? 0 : 1;
}
