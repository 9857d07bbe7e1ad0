// The part of a verify program of a stepped machine that does not depend on the machine: it runs the
// test cases that the program contains and prints their traces. It needs no heap, so that programs
// also run on a microcontroller; the program around it has the function `print`.
#include "smachac/step_trace.hpp"

namespace verify {

/// Prints a part of a text.
void print(const char *text, std::size_t size);

inline smachac::step::Sink sink{nullptr, [](void *, const char *text, std::size_t size) {
                                  print(text, size);
                                }};

/// The steps of a leaf in a test case: the number of the case for each visit.
struct Row {
  std::uint16_t leaf;
  std::uint16_t visits;
  const std::uint16_t *steps;
};

/// A test case: the number of the machine that runs it, the limit on visits of leaves, whether a
/// request to stop comes before the start, and the rows.
struct TestCase {
  std::uint16_t stage;
  std::int32_t most;
  bool stopped;
  std::uint16_t rows;
  const Row *row;
};

inline const TestCase *current = nullptr;
inline std::int32_t left = 0;
inline std::uint16_t visits[MOST_LEAVES] = {};
inline void (*request_stop)() = nullptr;

/// The case of a leaf for its next visit; -1 without one.
inline int next(std::uint16_t leaf) {
  for (std::size_t i = 0; i < current->rows; ++i) {
    const Row &row = current->row[i];
    if (row.leaf == leaf && visits[leaf] < row.visits && --left >= 0) {
      return row.steps[visits[leaf]++];
    }
  }
  return -1;
}

/// Whether a leaf waits in this step; in its first step it makes the request of the test case.
inline bool waits(const smachac::step::Context &context, bool waiting, bool requests) {
  if (context.first && requests) {
    request_stop();
  }
  return waiting && !context.stop_requested();
}

inline void text(std::string_view part) { sink(part); }

/// Prints the event of a read.
template <class T>
void read(const char *path, const char *src, const char *key, const T &value) {
  text("{\"event\": \"read\", \"path\": ");
  smachac::step::write_text(sink, path);
  text(", \"key\": ");
  smachac::step::write_text(sink, key);
  text(", \"value\": ");
  smachac::step::write_json(sink, value);
  text(", \"src\": ");
  smachac::step::write_text(sink, src);
  text("}\n");
}

constexpr std::int64_t most_steps = 100'000;

/// Runs a test case. A machine that never ends fails after `most_steps`.
template <class Machine, class Given> void play(const TestCase &test_case, Given given) {
  static Machine *machine = nullptr;
  smachac::step::TraceWriter trace(sink);
  Machine own(trace);
  machine = &own;
  current = &test_case;
  left = test_case.most;
  for (std::uint16_t &count : visits) {
    count = 0;
  }
  request_stop = [] { machine->request_stop(); };
  smachac::step::Fault fault;
  given(own.userdata, fault);
  if (test_case.stopped) {
    own.request_stop();
  }
  for (std::int64_t now = 0; own.step(now).is_running() && now < most_steps; ++now) {
  }
  text("--\n");
}

} // namespace verify
