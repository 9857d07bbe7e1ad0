// The pick-and-place machine where something goes wrong: `./faults FAULT [TRACE]`.
#include <cstring>

#include "fake_arm.hpp"
#include "pick_and_place.hpp"

namespace {

/// A world and an arm with a fault.
class Faulty : public FakeArm {
public:
  Faulty(FakeWorld &world, smachac::Stop &stop, const char *fault)
      : FakeArm(world), world_(world), stop_(stop), fault_(fault) {}

  smachac::Motion grip(const smachac::Limb &limb, bool open, smachac::Stop &stop) override {
    smachac::Pose &block = world_.bodies["block"];
    if (!open && is("displaced")) {
      block.position.x += 0.02;
    }
    if (!open && is("vanished")) {
      world_.bodies.erase("block");
    }
    const smachac::Motion motion = FakeArm::grip(limb, open, stop);
    if (open && is("nudged")) {
      world_.bodies["block"].position.y += 0.003;
    }
    return motion;
  }

  smachac::Motion move_along(const smachac::Limb &limb, const smachac::Pose &tool, double speed,
                             smachac::Stop &stop) override {
    if (is("stopped")) {
      stop_.request();
    }
    return FakeArm::move_along(limb, tool, speed, stop);
  }

  std::optional<std::vector<double>> solve_ik(const smachac::Limb &limb,
                                              const smachac::Pose &tool) override {
    smachac::Pose there = tool;
    there.position.x += is("far") ? 1.0 : 0.0;
    return FakeArm::solve_ik(limb, there);
  }

private:
  bool is(const char *fault) const { return std::strcmp(fault_, fault) == 0; }

  FakeWorld &world_;
  smachac::Stop &stop_;
  const char *fault_;
};

} // namespace

int main(int, char **arguments) {
  FakeWorld world(1);
  smachac::Stop stop;
  Faulty arm(world, stop, arguments[1]);
  pick_and_place::States states(world, arm);
  pick_and_place::Userdata userdata;
  smachac::TraceWriter trace(stdout);
  static_cast<void>(pick_and_place::run(states, userdata, &trace, stop));
  return 0;
}
