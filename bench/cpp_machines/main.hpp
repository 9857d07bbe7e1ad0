// The main program of bench/cpp.py: the loop by hand, and the machine without and with an observer.
#include <cstdlib>
#include <cstring>
#include <ctime>

extern std::int64_t most;

namespace {

constexpr int rounds = 9;

double now() {
  timespec at;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
  return static_cast<double>(at.tv_sec) * 1e9 + static_cast<double>(at.tv_nsec);
}

struct Counter : smachac::Observer {
  explicit Counter(bool writes) : writes_(writes) {}
  void on(const smachac::Event &) override { ++events; }
  bool wants_writes() const override { return writes_; }
  std::uint64_t events = 0;

private:
  bool writes_;
};

void machine(smachac::Observer *observer) {
  smachac::Stop stop;
  sm::States states;
  sm::Userdata userdata;
  sm::run(states, userdata, observer, stop);
}
void run_by_hand() {
  bench::by_hand::Data data;
  hand::run(data);
}
void run_alone() { machine(nullptr); }
void run_watched() {
  Counter counter(false);
  machine(&counter);
}
void run_with_writes() {
  Counter counter(true);
  machine(&counter);
}

struct DirectCounter {
  void on(const smachac::Event &) { ++events; }
  std::uint64_t events = 0;
};

void run_counted() {
  smachac::Stop stop;
  sm::States states;
  sm::Userdata userdata;
  DirectCounter counter;
  sm::run(states, userdata, counter, stop);
  if (counter.events == 0) {
    std::abort();
  }
}

struct Way {
  const char *name;
  void (*run)();
};
constexpr Way ways[] = {{"by_hand", run_by_hand},
                        {"alone", run_alone},
                        {"watched", run_watched},
                        {"with_writes", run_with_writes},
                        {"counted", run_counted}};
constexpr std::size_t count = sizeof ways / sizeof *ways;

} // namespace

/// `program WAY STEPS` runs once; `program all STEPS` prints the least nanoseconds a step of each
/// way.
int main(int, char **argv) {
  const std::int64_t steps = std::atoll(argv[2]);
  const bool all = std::strcmp(argv[1], "all") == 0;
  most = steps;
  double best[count] = {1e9, 1e9, 1e9, 1e9, 1e9};
  for (int round = 0; round < (all ? rounds : 1); ++round) {
    for (std::size_t way = 0; way < count; ++way) {
      if (!all && std::strcmp(argv[1], ways[way].name) != 0) {
        continue;
      }
      // A watched step takes much longer.
      most = !all || way < 2 ? steps : steps / 20;
      const double start = now();
      ways[way].run();
      best[way] = std::min(best[way], (now() - start) / static_cast<double>(most));
    }
  }
  for (const double each : best) {
    std::printf("%.3f ", each);
  }
}
