// The same machine on a Cortex-M4 without operating system, heap and C library; it runs in QEMU.
// The board prints the trace of the run; a step is 1 ms.
#include <smachac/step_trace.hpp>

#include "grip.hpp"

extern "C" void board_print(const char *text, std::size_t size);

/// Prints the events of the run, but not the width in each step.
struct Trace : smachac::step::TraceWriter {
  using TraceWriter::TraceWriter;
  static constexpr bool writes = false;
};

int main() {
  Trace trace({nullptr, [](void *, const char *text, std::size_t size) {
                                      board_print(text, size);
                                    }});
  static gripper::Fingers fingers;
  grip::Machine<Trace> machine(fingers, trace);
  smachac::step::Nanoseconds now = 0;
  auto result = machine.step(now);
  while (result.is_running()) {
    now += 1'000'000;
    result = machine.step(now);
  }
  return result.has_failed() ? 1 : 0;
}
