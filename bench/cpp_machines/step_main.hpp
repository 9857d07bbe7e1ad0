// The main program of the stepped machines of bench/cpp.py: `program WAY STEPS` runs one way until
// its machine ends after so many transitions; `program WAY -STEPS` makes steps of a machine that
// waits.
#include <cstdlib>
#include <cstring>

extern std::int64_t most;
extern bool waiting;

namespace {

struct Counter {
  static constexpr bool writes = false;
  void on(const smachac::step::Event &) { ++events; }
  std::uint64_t events = 0;
};

/// A step as a call from a loop that the optimiser does not see into.
template <class Machine> [[gnu::noinline, gnu::flatten]] auto step(Machine &machine, std::int64_t now) {
  return machine.step(now);
}

template <class Machine> void run(Machine &machine, std::int64_t steps) {
  for (std::int64_t now = 0; step(machine, now).is_running() && now != steps; ++now) {
  }
}

void run_by_hand(std::int64_t steps) {
  hand::Machine machine;
  for (std::int64_t now = 0; step(machine, now) && now != steps; ++now) {
  }
}

} // namespace

int main(int, char **argv) {
  const std::int64_t count = std::atoll(argv[2]);
  waiting = count < 0;
  most = waiting ? 1 : count;
  const std::int64_t steps = waiting ? -count : -1;
  if (std::strcmp(argv[1], "by_hand") == 0) {
    run_by_hand(steps);
  } else if (std::strcmp(argv[1], "stepped") == 0) {
    sm::Machine<> machine;
    run(machine, steps);
  } else {
    Counter counter;
    sm::Machine<Counter> machine(counter);
    run(machine, steps);
    return counter.events == 0;
  }
}
