// The part of a verify program that does not depend on the machine: it reads test cases from the
// input, runs them and prints their traces.
//
// A test case is the limit on visits of leaves, whether a request to stop comes before the start
// and, for each leaf, its number, the number of its
// visits and the number of the case for each visit.
#include "smachac/smachac.hpp"

#include <atomic>
#include <cstdio>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace verify {

struct Row {
  std::vector<std::size_t> steps;
  std::size_t visits = 0;
};
inline std::map<std::size_t, Row> rows;
inline std::atomic<long> left{0};
inline smachac::Stop *machine = nullptr;
inline smachac::Observer *observer = nullptr;

/// The case of a leaf for its next visit.
inline std::size_t next(std::size_t leaf) {
  const auto found = rows.find(leaf);
  if (found == rows.end() || found->second.visits == found->second.steps.size() || --left < 0) {
    throw std::runtime_error("is not in the script");
  }
  return found->second.steps[found->second.visits++];
}
inline constexpr double longest_wait = 5.0; // s

/// Whether a leaf has a request to stop; a leaf that waits gets one within `longest_wait`.
inline bool preempted(smachac::Stop &stop, bool waits, bool requests) {
  if (requests) {
    machine->request();
  }
  if (waits && !stop.wait(longest_wait)) {
    throw std::runtime_error("was not asked to stop");
  }
  return stop.requested();
}
inline void service(smachac::Stop &stop) { stop.service(); }
inline void read(const smachac::Place &place, const char *key, const std::string &value) {
  observer->tell({"read", place, nullptr, nullptr, key, value.c_str()});
}

/// Run the next test case of the input.
template <class Trace, class Userdata, class Given, class Run> void play(Given given, Run run) {
  smachac::Stop stop;
  Trace trace(stdout);
  Userdata userdata;
  given(userdata);
  machine = &stop;
  observer = &trace;
  std::size_t leaves = 0;
  long most = 0;
  bool stopped = false;
  std::cin >> most >> stopped >> leaves;
  if (stopped) {
    stop.request();
  }
  left = most;
  rows.clear();
  for (std::size_t i = 0; i < leaves; ++i) {
    std::size_t leaf = 0;
    std::size_t visits = 0;
    std::cin >> leaf >> visits;
    rows[leaf].steps.resize(visits);
    for (auto &step : rows[leaf].steps) {
      std::cin >> step;
    }
  }
  try {
    run(userdata, &trace, stop);
  } catch (const std::exception &) {
  }
  std::puts("--");
  std::fflush(stdout);
}

} // namespace verify
