// Made by smachac, as it is for every machine: do not edit.
//
// An observer of stepped machines that writes each event as a line of JSON, in the format of all
// traces of smachac (docs/semantics.md, Traces). It needs no heap and no stdio: the caller has a
// function that receives the text.
#ifndef SMACHAC_STEP_TRACE_HPP
#define SMACHAC_STEP_TRACE_HPP

#include "smachac/step.hpp"

namespace smachac {
inline namespace v0_1_0 {
namespace step {

class TraceWriter {
public:
  /// `in_machine`: paths are those in the machine, where a state inside a time limit, retry or loop
  /// has another one in the script.
  explicit TraceWriter(Sink sink, bool in_machine = false) : sink_(sink), in_machine_(in_machine) {}

  void on(const Event &event) {
    constexpr std::string_view kinds[] = {"start", "enter",   "exit",  "transition",
                                          "write", "preempt", "error", "finish"};
    if (event.kind == Event::Kind::start) {
      began_ = event.now;
    }
    sink_("{\"seq\": ");
    write_number(sink_, ++count_);
    field("event", kinds[static_cast<std::size_t>(event.kind)]);
    field("path", path(event.state()));
    if (event.outcome() != nullptr) {
      field("outcome", event.outcome());
    }
    if (event.kind == Event::Kind::transition) {
      target(event);
    }
    if (event.kind == Event::Kind::write) {
      field("key", event.key);
      sink_(", \"value\": ");
      event.value.object != nullptr ? event.value.json(event.value.object, sink_)
                                    : sink_("\"(secret)\"");
    }
    if (event.message != nullptr) {
      message(event);
    }
    sink_(", \"t\": ");
    const Nanoseconds passed = (event.now - began_) / 1000;
    write_number(sink_, passed / 1'000'000);
    sink_(".");
    for (Nanoseconds unit = 100'000; unit > 0; unit /= 10) {
      write_number(sink_, passed / unit % 10);
    }
    if (*event.state().src != '\0') {
      field("src", event.state().src);
    }
    sink_("}\n");
  }

private:
  [[nodiscard]] const char *path(const Node &node) const {
    return in_machine_ ? node.full() : node.path;
  }
  void name(std::string_view name) {
    sink_(", \"");
    sink_(name);
    sink_("\": ");
  }
  void field(std::string_view key, std::string_view text) {
    name(key);
    write_text(sink_, text);
  }
  /// The target of a transition: a state, or the container and its outcome.
  void target(const Event &event) {
    if (event.to >= 0) {
      field("to", path(event.nodes[event.to]));
      return;
    }
    const Node &around = event.nodes[event.state().around];
    name("to");
    sink_("\"");
    write_escaped(sink_, path(around));
    sink_(":");
    write_escaped(sink_, around.outcomes[event.with]);
    sink_("\"");
  }
  /// The message of an error, with the name of the key that it is about.
  void message(const Event &event) {
    name("message");
    sink_("\"");
    write_escaped(sink_, event.message);
    if (event.key != nullptr) {
      sink_(": `");
      write_escaped(sink_, event.key);
      sink_("`");
    }
    sink_("\"");
  }

  Sink sink_;
  bool in_machine_;
  std::int64_t count_ = 0;
  Nanoseconds began_ = 0;
};

} // namespace step
} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_STEP_TRACE_HPP
