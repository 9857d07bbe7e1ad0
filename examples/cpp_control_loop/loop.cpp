// A control loop of 1 kHz on Linux: one step of the machine in each period, and a histogram of how
// late the periods began and how long the steps took. A first argument is the number of periods at
// most.
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "grip.hpp"

namespace {

constexpr std::int64_t period = 1'000'000; // ns

std::int64_t nanoseconds(const timespec &time) {
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

std::int64_t now() {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return nanoseconds(time);
}

/// Counts of times by powers of two of a microsecond: below 1, 2, 4, ... 2**14 us, and above.
class Histogram {
public:
  void add(std::int64_t time) {
    std::size_t at = 0;
    while (at + 1 < size && time >= (std::int64_t{1000} << at)) {
      ++at;
    }
    ++counts_[at];
  }
  void print(const char *what) const {
    std::printf("%s\n", what);
    for (std::size_t at = 0; at < size; ++at) {
      if (counts_[at] > 0) {
        std::printf("  < %5ld us  %6u\n", 1L << at, counts_[at]);
      }
    }
  }

private:
  static constexpr std::size_t size = 16;
  unsigned counts_[size]{};
};

} // namespace

int main(int count, char **arguments) {
  const long most = count > 1 ? std::atol(arguments[1]) : 60'000;
  gripper::Fingers fingers;
  grip::Machine<> machine(fingers);
  Histogram late, took;
  const std::int64_t begin = now();
  for (long at = 1; at <= most; ++at) {
    const std::int64_t due = begin + at * period;
    const timespec until{static_cast<time_t>(due / 1'000'000'000),
                         static_cast<long>(due % 1'000'000'000)};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    const std::int64_t start = now();
    const auto result = machine.step(start);
    took.add(now() - start);
    late.add(start - due);
    if (!result.is_running()) {
      late.print("periods that began late by");
      took.print("steps that took");
      std::printf("%ld steps: %s, width %.4f m\n", at,
                  result.has_failed() ? machine.failure().message : name(result.outcome()),
                  machine.userdata.width.get());
      return result.has_failed() ? 1 : 0;
    }
  }
  std::printf("no end after %ld steps\n", most);
  return 1;
}
