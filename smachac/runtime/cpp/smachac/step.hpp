// Made by smachac, as it is for every machine: do not edit.
//
// The runtime of machines that are stepped (docs/cpp_step.md): C++17 without heap, threads,
// exceptions, run-time type information and input or output; for control loops and
// microcontrollers.
//
// A call of `step` of a machine makes at most one transition in each active branch and returns.
// Contents: results of steps (Result), the context of a state (Context), userdata keys (Key), texts
// and lists with a bound (step_values.hpp), events and observers (Event), the state of a run (Run),
// the branches of a concurrence (Branches).
#ifndef SMACHAC_STEP_HPP
#define SMACHAC_STEP_HPP

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "smachac/class_checks.hpp"
#include "smachac/step_values.hpp"

namespace smachac {
inline namespace v0_1_0 {
namespace step {

/// A time in nanoseconds since the zero of the caller's clock, which never goes back.
using Nanoseconds = std::int64_t;

/// A number of seconds, rounded down to nanoseconds; at most 1e9 seconds.
constexpr Nanoseconds nanoseconds(double seconds) {
  return seconds <= 0.0   ? 0
         : seconds >= 1e9 ? Nanoseconds{1'000'000'000'000'000'000}
                          : static_cast<Nanoseconds>(seconds * 1e9);
}

/// The result of a state that has not ended.
struct Running {};
inline constexpr Running running{};

/// The result of a state with an error, which is no outcome.
struct Failed {};
inline constexpr Failed failed{};

/// Marks a place that no run reaches. A call is undefined behaviour.
[[noreturn]] inline void never() { __builtin_unreachable(); }

/// The codes of the results that are no outcome. The code of an outcome is its enumerator.
inline constexpr int RUNNING = -1;
inline constexpr int FAILED = -2;
/// A container has failed with a state in it, which has been reported.
inline constexpr int FAILED_INSIDE = -3;

/// The result of a container that runs or has failed.
struct Unended {
  int code;
};

/// The code of an outcome.
template <class Outcome> constexpr int code(Outcome outcome) { return static_cast<int>(outcome); }

/// The result of a step: an outcome, `running` or `failed`.
template <class Outcome> class Result {
public:
  constexpr Result(Outcome outcome) : code_(step::code(outcome)) {} // NOLINT: `return Outcome::ok`
  constexpr Result(Running) : code_(RUNNING) {}                     // NOLINT: `return running`
  constexpr Result(Failed) : code_(FAILED) {}                       // NOLINT: `return failed`
  /// The result of a state in it that has not ended.
  constexpr Result(Unended unended) : code_(unended.code) {} // NOLINT

  [[nodiscard]] constexpr bool is_running() const { return code_ == RUNNING; }
  [[nodiscard]] constexpr bool has_failed() const { return code_ < RUNNING; }
  [[nodiscard]] constexpr bool has_ended() const { return code_ >= 0; }
  /// The outcome of a state that has ended.
  [[nodiscard]] constexpr Outcome outcome() const { return static_cast<Outcome>(code_); }
  [[nodiscard]] constexpr int code() const { return code_; }

private:
  int code_;
};

struct Node;
template <class Observer, std::size_t nodes, const Node *table> class Run;

/// The context of a state in one step.
class Context : public Fault {
public:
  Context() = default;
  Context(const Context &) = delete;
  Context &operator=(const Context &) = delete;

  /// The time of the step.
  Nanoseconds now = 0;
  /// Whether this is the first step of this visit of the state.
  bool first = false;

  /// Whether a request to stop is pending for the state.
  [[nodiscard]] bool stop_requested() const { return asked_ != nullptr && *asked_; }
  /// Answers the request: the states after this one run without it.
  void service() {
    if (asked_ != nullptr) {
      *asked_ = false;
    }
  }
  /// The result of a state with an error: `return context.error("no answer");`. The text must
  /// outlive the run.
  Failed error(const char *message) {
    fail(message);
    return failed;
  }

private:
  template <class Observer, std::size_t nodes, const Node *table> friend class Run;
  bool *asked_ = nullptr;
};

// Events

/// A state in the tables of a machine: its path in the script, the path in the machine where it is
/// another one, otherwise null; its file and line; the names of its outcomes and their number; the
/// number of the container around it.
struct Node {
  const char *path;
  const char *in_machine;
  const char *src;
  const char *const *outcomes;
  std::uint16_t count;
  std::uint16_t around;

  [[nodiscard]] const char *full() const { return in_machine != nullptr ? in_machine : path; }
};

/// The functions that write a value as JSON, by parts of its text.
struct Value {
  const void *object;
  void (*json)(const void *object, const Sink &sink);
};

/// One event of a run. Names and values are looked up when they are asked for.
struct Event {
  enum class Kind : std::uint8_t { start, enter, exit, transition, write, preempt, error, finish };

  Kind kind;
  const Node *nodes;         ///< the table of the machine
  std::size_t node;          ///< the state: its index in the table
  Nanoseconds now;           ///< the time of the step
  int result = -1;           ///< of exit, transition and finish: the index of the outcome
  int to = -1;               ///< of transition: the index of the next state
  int with = -1;             ///< of transition: the index of the outcome of the container that ends
  const char *key = nullptr; ///< of write and error: a key
  const char *message = nullptr; ///< of error
  Value value{nullptr, nullptr}; ///< of write; without functions where the value is secret

  [[nodiscard]] const Node &state() const { return nodes[node]; }
  [[nodiscard]] const char *outcome() const {
    return result < 0 ? nullptr : state().outcomes[static_cast<std::size_t>(result)];
  }
};

/// The observer of a machine that nobody observes: no code is left of it.
struct NoObserver {};
inline NoObserver nobody;

namespace detail {

template <class Observer> inline constexpr bool watches = !std::is_same_v<Observer, NoObserver>;

/// Whether an observer receives the events of writes: all but those with `writes = false`.
template <class Observer, class = void>
struct wants_writes : std::bool_constant<watches<Observer>> {};
template <class Observer>
struct wants_writes<Observer, std::void_t<decltype(Observer::writes)>>
    : std::bool_constant<Observer::writes> {};

/// The observer of a run; without one, nothing.
template <class Observer> struct Observed { Observer &observer_; };
template <> struct Observed<NoObserver> {
  constexpr explicit Observed(NoObserver &) {}
};

template <class State, class... Parts>
using Started =
    decltype(std::declval<State &>().start(std::declval<Context &>(), std::declval<Parts>()...));
template <class State, class Enable, class... Parts> struct has_start : std::false_type {};
template <class State, class... Parts>
struct has_start<State, std::void_t<Started<State, Parts...>>, Parts...> : std::true_type {};

} // namespace detail

/// The failure of a run: the number of the state, the reason, and the key that it is about, if
/// there is one.
struct Failure {
  std::size_t node = 0;
  const char *message = nullptr;
  const char *key = nullptr;
};

/// The state of a run that all containers share: the context, the pending requests to stop of
/// `nodes` states (0: no state of the machine can receive one), the failure, and the observer.
/// `table` has all states.
template <class Observer, std::size_t nodes, const Node *table>
class Run : private detail::Observed<Observer> {
public:
  static constexpr bool watches = detail::watches<Observer>;
  static constexpr bool writes = detail::wants_writes<Observer>::value;
  static constexpr bool asks = nodes > 0;

  constexpr explicit Run(Observer &observer) : detail::Observed<Observer>{observer} {}
  Run(const Run &) = delete;
  Run &operator=(const Run &) = delete;

  Context context{};
  Failure failure{};

  // Requests to stop

  [[nodiscard]] bool asked(std::size_t node) const {
    if constexpr (asks) {
      return asked_[node];
    }
    return false;
  }
  /// Sends a request to a state.
  void ask(std::size_t node) {
    if constexpr (asks) {
      asked_[node] = true;
      send(Event::Kind::preempt, node);
    }
  }
  /// Takes back the request of a state, or of a state and all states in it.
  void recall(std::size_t node, std::size_t end) {
    if constexpr (asks) {
      for (std::size_t i = node; i < end; ++i) {
        asked_[i] = false;
      }
    }
  }
  void recall(std::size_t node) { recall(node, node + 1); }

  // State machines

  /// The entry of a container: a pending request is passed on to its first state.
  void begin(std::size_t container, std::size_t first) {
    context.first = true;
    if (asked(container)) {
      ask(first);
    }
  }
  /// A transition between two states of a container: the exit of one, then the transition.
  template <class State>
  Running go(State &active, State next, std::size_t container, std::size_t from, int result,
             std::size_t to) {
    send(Event::Kind::exit, from, result);
    send(Event::Kind::transition, from, result, static_cast<int>(to));
    active = next;
    context.first = true;
    if (asked(container)) {
      pass(container, from, to);
    }
    return running;
  }
  /// The entry of an iterator: a pending request is passed on to its state, which has the first
  /// item.
  void begin_items(std::size_t container, std::size_t child) {
    context.first = true;
    if (asked(container) && !asked(child)) {
      ask(child);
    }
  }
  /// The next item of an iterator.
  Running again(std::size_t child, int result) {
    send(Event::Kind::exit, child, result);
    send(Event::Kind::transition, child, result, static_cast<int>(child));
    context.first = true;
    return running;
  }
  /// A transition that ends a container.
  template <class State, class Outcome>
  Result<Outcome> end(State &active, Outcome with, std::size_t container, std::size_t from,
                      int result) {
    send(Event::Kind::exit, from, result);
    send(Event::Kind::transition, from, result, -1, code(with));
    active = State::none_;
    if (asked(container) && !asked(from)) {
      recall(container);
    }
    return with;
  }
  /// The result of a container whose state `from` has not ended with one of its outcomes: it runs,
  /// has failed, or has ended with a number that is no outcome.
  template <class State>
  Unended unended(State &active, std::size_t container, std::size_t from, int result) {
    if (result != RUNNING) {
      return fail(active, container, from, result);
    }
    if (context.first) { // a store that most steps need not make
      context.first = false;
    }
    return {RUNNING};
  }
  /// The failure of an outcome that leads nowhere.
  template <class State>
  [[gnu::cold, gnu::noinline]] Unended undeclared(State &active, std::size_t container,
                                                  std::size_t from) {
    report(from, "ended with an outcome that leads nowhere");
    return fail(active, container, from, FAILED_INSIDE);
  }
  /// The failure of a container itself.
  Unended give_up(std::size_t node) { return {failed_leaf(node)}; }

  // States

  /// The first step of a container; `idle`: this is one.
  void enter(std::size_t node, bool idle) {
    if (watches && idle) {
      send(Event::Kind::enter, node);
    }
  }
  /// A step of a state that is an object of a class of the user; the code of its result.
  template <class State, class... Parts>
  [[gnu::always_inline]] int leaf(std::size_t node, State &state, const Parts &...parts) {
    receive(node);
    if (context.first) {
      send(Event::Kind::enter, node);
      if constexpr (detail::has_start<State, void, Parts...>::value) {
        state.start(context, parts...);
      }
    }
    const Result<typename State::Outcome> result = state.step(context, parts...);
    return result.code();
  }
  /// As `leaf`, for a state that does not start where one of its inputs is unset.
  template <class State, class... Parts>
  int checked_leaf(std::size_t node, State &state, const Parts &...parts) {
    if (context.has_failed()) {
      send(Event::Kind::enter, node);
      return FAILED;
    }
    return leaf(node, state, parts...);
  }
  /// A step of a state of a built-in type; the code of its result.
  template <class State, class... Userdata>
  int built_in(std::size_t node, State &state, Userdata &...userdata) {
    receive(node);
    if (context.first) {
      send(Event::Kind::enter, node);
    }
    return state.step(*this, userdata...).code();
  }
  /// The result of a branch that is a state with `count` outcomes: its exit, or its failure.
  int ended_leaf(std::size_t node, int result, int count) {
    if (result == FAILED) {
      return failed_leaf(node);
    }
    if (result == RUNNING && context.first) {
      context.first = false;
    }
    return ended_container(node, result, count);
  }
  /// The result of a branch with `count` outcomes.
  int ended_container(std::size_t node, int result, int count) {
    if (result >= count) {
      report(node, "ended without an outcome");
      return FAILED_INSIDE;
    }
    if (watches && result >= 0) {
      send(Event::Kind::exit, node, result);
    }
    return result;
  }
  /// The result of a branch whose failure is an outcome.
  int caught_branch(std::size_t node, int result, int outcome) {
    if (result != FAILED_INSIDE) {
      return result;
    }
    send(Event::Kind::exit, node, outcome);
    return outcome;
  }
  /// The result of a step; a failure if the copies of outputs had one.
  int kept(std::size_t node, int result) {
    return context.has_failed() ? failed_leaf(node) : result;
  }
  /// The result of a step; a failure if the state has gone over the bound of an output.
  template <class T> int within_bound(int result, Key<T> &key, const char *name) {
    const bool searched = any_went_over.load(std::memory_order_relaxed);
    return searched && key.exceeded() ? over(name) : result;
  }

  /// The failure of a state.
  [[gnu::cold, gnu::noinline]] int failed_leaf(std::size_t node) {
    report(node, context.message());
    return FAILED_INSIDE;
  }

  // Writes

  /// Writes the result of a function of the script to a key.
  template <class T, class U>
  void write(std::size_t node, const char *name, Key<T> &key, const U &value, bool secret = false) {
    if (!context.has_failed()) {
      key.write(context, name, value);
    }
    if (!context.has_failed()) {
      wrote(node, name, key, secret);
    }
  }
  /// The output of a state that is about to run.
  template <class T> Key<T> &out(Key<T> &key) {
    if constexpr (writes) {
      key.fresh();
    }
    return key;
  }
  /// Sends the event for a key that a state has written in this step.
  template <class T>
  void wrote(std::size_t node, const char *name, Key<T> &key, bool secret = false) {
    if constexpr (writes) {
      if (key.fresh()) {
        Event event{Event::Kind::write, table, node, context.now};
        event.key = name;
        event.value = {secret ? nullptr : &key.get(), [](const void *object, const Sink &sink) {
                         write_json(sink,
                                    *static_cast<const typename Key<T>::value_type *>(object));
                       }};
        this->observer_.on(event);
      }
    }
  }

  void start() { send(Event::Kind::start, 0); }
  void finish(int result) {
    if (watches && result >= 0) {
      send(Event::Kind::finish, 0, result);
    }
  }

  /// Sends an event to the observer; nothing without one.
  void send(Event::Kind kind, std::size_t node, int result = -1, int to = -1, int with = -1) {
    if constexpr (watches) {
      Event event{kind, table, node, context.now};
      event.result = result;
      event.to = to;
      event.with = with;
      this->observer_.on(event);
    }
  }

private:
  void receive(std::size_t node) {
    if constexpr (asks) {
      context.asked_ = &asked_[node];
    }
  }
  [[gnu::cold, gnu::noinline]] void pass(std::size_t container, std::size_t from, std::size_t to) {
    if (asked(from)) {
      recall(from);
      ask(to);
    } else {
      recall(container);
    }
  }
  [[gnu::cold, gnu::noinline]] int over(const char *name) {
    context.fail("a value beyond its bound", name);
    return FAILED;
  }
  /// The end of a container with a failure; its request counts as answered if its last state has
  /// none.
  template <class State>
  [[gnu::cold, gnu::noinline]] Unended fail(State &active, std::size_t container, std::size_t from,
                                            int result) {
    if (result != FAILED_INSIDE) {
      report(from, result == FAILED ? context.message() : "ended without an outcome");
    }
    active = State::none_;
    if (asked(container) && !asked(from)) {
      recall(container);
    }
    return {FAILED_INSIDE};
  }
  [[gnu::cold, gnu::noinline]] void report(std::size_t node, const char *message) {
    failure = {node, message, context.key()};
    if constexpr (watches) {
      Event event{Event::Kind::error, table, node, context.now};
      event.message = message;
      event.key = context.key();
      this->observer_.on(event);
    }
    context.clear();
  }

  bool asked_[asks ? nodes : 1]{};
};

/// The `N` branches of a concurrence, which take turns.
template <std::size_t N> class Branches {
public:
  [[nodiscard]] bool idle() const { return live_ == 0; }

  /// The start of all branches. `nodes` are their numbers and the end of the last one; a pending
  /// request to the concurrence is passed on to them.
  template <class Run>
  void begin(Run &run, std::size_t container, const std::uint16_t (&nodes)[N + 1]) {
    live_ = N;
    stopping_ = failed_ = false;
    for (std::size_t i = 0; i < N; ++i) {
      branches_[i] = {RUNNING, true};
      if (run.asked(container) && !run.asked(nodes[i])) {
        run.ask(nodes[i]);
      }
    }
  }
  /// Whether a branch has not ended. If so, its turn begins.
  template <class Run> bool turn(std::size_t i, Run &run) {
    run.context.first = branches_[i].first;
    return branches_[i].code == RUNNING;
  }
  [[nodiscard]] bool live(std::size_t i) const { return live_ > 0 && branches_[i].code == RUNNING; }

  /// The end of a turn, with the result of the branch. Returns whether the other branches must be
  /// asked to stop: `any` is true if the end of the first branch does this; a failure always does.
  /// No request is sent if the concurrence has received one itself.
  template <class Run>
  bool turned(std::size_t i, int result, Run &run, std::size_t container, bool any) {
    branches_[i] = {static_cast<std::int16_t>(result), run.context.first};
    if (result == RUNNING) {
      return false;
    }
    --live_;
    if (result == FAILED_INSIDE && !failed_) {
      failed_ = true;
      failure_ = run.failure;
    }
    if (stopping_ || !(any || result == FAILED_INSIDE)) {
      return false;
    }
    stopping_ = true;
    return !run.asked(container);
  }
  /// Called after all branches have ended: requests that they have not answered are taken back; if
  /// there is none, the request to the concurrence is answered. Returns whether a request to the
  /// concurrence was pending.
  template <class Run>
  bool leave(Run &run, std::size_t container, const std::uint16_t (&nodes)[N + 1]) {
    const bool stopped = run.asked(container);
    bool open = false;
    for (std::size_t i = 0; i < N; ++i) {
      if (run.asked(nodes[i])) {
        open = true;
        run.recall(nodes[i], nodes[i + 1]);
      }
    }
    if (!open) {
      run.recall(container);
    }
    if (failed_) {
      run.failure = failure_;
    }
    return stopped;
  }
  [[nodiscard]] bool has_failed() const { return failed_; }
  /// Whether a branch ended with a result.
  [[nodiscard]] bool ended(std::size_t i, int result) const { return branches_[i].code == result; }

private:
  struct Branch {
    std::int16_t code;
    bool first;
  };

  Branch branches_[N]{};
  std::uint16_t live_ = 0;
  bool stopping_ = false;
  bool failed_ = false;
  Failure failure_{};
};

} // namespace step
} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_STEP_HPP
