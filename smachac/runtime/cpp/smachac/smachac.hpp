// Made by smachac, as it is for every machine: do not edit.
//
// The runtime of generated state machines. C++17, header only, without dependencies.
//
// Contents: userdata keys (Key), preempt requests (Stop), observers (Observer, TraceWriter), the
// branches of a concurrence (Branches). A machine runs with a context: a Run without observer, a
// WatchedRun with an observer. The hooks of a Run send no events. The header compiles with
// -fno-exceptions and -fno-rtti; an error then ends the program with a message.
#ifndef SMACHAC_SMACHAC_HPP
#define SMACHAC_SMACHAC_HPP

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <mutex>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "smachac/class_checks.hpp"
#include "smachac/values.hpp"

#if defined(__cpp_exceptions)
#define SMACHAC_TRY try
#define SMACHAC_CATCH catch (...)
#else
#define SMACHAC_TRY
#define SMACHAC_CATCH if constexpr (false)
#endif

// Whether the standard library has threads. That of GCC over a bare Newlib has none.
#if defined(__GLIBCXX__) && !defined(_GLIBCXX_HAS_GTHREADS)
#define SMACHAC_THREADS 0
#else
#define SMACHAC_THREADS 1
#endif

namespace smachac {
inline namespace v0_1_0 {

/// Whether exceptions are enabled. A machine whose script catches exceptions does not compile
/// without them.
#if defined(__cpp_exceptions)
inline constexpr bool has_exceptions = true;
#else
inline constexpr bool has_exceptions = false;
#endif

#if SMACHAC_THREADS
using Mutex = std::mutex;
using RecursiveMutex = std::recursive_mutex;
using Condition = std::condition_variable;
#else
/// A mutex for a program with one thread: its functions do nothing.
struct Mutex {
  void lock() {}
  void unlock() {}
};
using RecursiveMutex = Mutex;

/// A condition variable for a program with one thread: no other thread can notify during a wait.
/// `wait` returns at once. `wait_for` evaluates `test` in a loop until it is true or the time is
/// over.
struct Condition {
  void notify_all() {}
  template <class Test> void wait(std::unique_lock<Mutex> &, Test) {}
  template <class Test>
  bool wait_for(std::unique_lock<Mutex> &, std::chrono::duration<double> most, Test test) {
    const auto begin = std::chrono::steady_clock::now();
    while (!test() && std::chrono::steady_clock::now() - begin < most) {
    }
    return test();
  }
};
#endif

/// Throws the Error for a read of an unset key.
[[noreturn, gnu::cold, gnu::noinline]] inline void unset_key() {
  fail("reads a key that holds nothing");
}

/// A userdata key: a value that is set or unset. A read of an unset key throws an Error.
template <class T> class Key {
public:
  Key() = default;
  Key(T value) : value_(std::move(value)), state_(held) {} // NOLINT: `Key<int> tries{0}`

  Key &operator=(T value) {
    value_ = std::move(value);
    state_ = written;
    return *this;
  }
  operator const T &() const { return get(); } // NOLINT: `in.tries + 1`
  [[nodiscard]] const T &get() const {
    if (state_ == unset) {
      unset_key();
    }
    return value_;
  }
  /// The value without a check, for a key that is certainly set. In an unset key it is the default
  /// value of T.
  [[nodiscard]] const T &unchecked() const { return value_; }
  /// A reference to the value for a change in place. The key then counts as written by a state. An
  /// unset key starts with the default value of T.
  [[nodiscard]] T &edit() {
    state_ = written;
    return value_;
  }
  [[nodiscard]] bool set() const { return state_ != unset; }

  /// Sets the value at the border of a container. This is not a write of a state: it causes no
  /// trace event. Throws an Error if the value cannot be converted to T.
  template <class U> void hold(const U &value) {
    replace(value);
    state_ = held;
  }
  /// As `hold`, for a key that is already set.
  template <class U> void replace(const U &value) {
    if constexpr (std::is_same_v<T, U>) {
      value_ = value; // reuses the memory of the value
    } else {
      value_ = convert<T>(value);
    }
  }
  /// Copies the value of another key as `hold` does; does nothing if that key is unset.
  template <class U> void take(const Key<U> &other) {
    if (other.set()) {
      hold(other.get());
    }
  }
  /// Whether a state has written the key since the last call. The call clears this mark.
  bool fresh() {
    const bool found = state_ == written;
    if (found) {
      state_ = held;
    }
    return found;
  }

private:
  enum : std::uint8_t { unset, held, written };

  T value_{};
  std::uint8_t state_ = unset;
};

/// The error of a read of an unset key, with the name of the key.
struct MissingKey : Error {
  explicit MissingKey(const char *key)
      : Error(std::string("reads `") + key + "`, which holds nothing") {}
};

/// The value of a key that must be set. Throws MissingKey if it is unset.
template <class T> [[nodiscard]] const T &need(const Key<T> &key, const char *name) {
  if (!key.set()) {
#if defined(__cpp_exceptions)
    throw MissingKey(name);
#else
    fail(MissingKey(name).what());
#endif
  }
  return key.get();
}

/// The value of a key as an optional; empty if the key is unset.
template <class Optional, class T> [[nodiscard]] Optional maybe(const Key<T> &key) {
  return key.set() ? convert<Optional>(key.get()) : Optional();
}

/// A state in the script: its path, `sm/PICK/OPEN`, and its file and line, `main.yml:12`. For a
/// state inside a time limit, retry or loop also `in_machine`, its path in the machine, and
/// `around`, the path in the script of the container around it (docs/language.md, Paths). Otherwise
/// these are null.
struct Place {
  const char *path;
  const char *src;
  const char *in_machine = nullptr;
  const char *around = nullptr;

  [[nodiscard]] const char *full() const { return in_machine != nullptr ? in_machine : path; }
};

/// One event of a run. Fields that an event does not have are null.
struct Event {
  const char *event; ///< start enter exit transition write preempt error finish
  Place place;
  const char *outcome = nullptr; ///< of exit, transition and finish
  const char *to = nullptr;      ///< of transition: the path of a state, or `path:outcome`
  const char *key = nullptr;     ///< of write
  const char *value = nullptr;   ///< of write: JSON
  const char *message = nullptr; ///< of error
  const char *with =
      nullptr; ///< of transition, for a class with `on`: the outcome of the container
};

/// Observer of a machine: receives its events. Calls come from the thread of the machine, from the
/// threads of the branches of a concurrence and from threads that send a preempt request, one call
/// at a time. The observer must exist until `run` has returned.
class Observer {
public:
  Observer() = default;
  Observer(const Observer &) = delete;
  Observer &operator=(const Observer &) = delete;
  virtual ~Observer() = default;

  /// Receives an event. The event and its texts are valid only during the call. The call may send a
  /// preempt request; the events of that request arrive before the call returns.
  virtual void on(const Event &event) = 0;
  /// Whether `on` receives the events of writes. If false, no value is converted to JSON.
  [[nodiscard]] virtual bool wants_writes() const { return true; }

  void tell(const Event &event) {
    const std::lock_guard<RecursiveMutex> hold(lock_);
    on(event);
  }

private:
  RecursiveMutex lock_{};
};

/// Observer that writes each event to a file as a line of JSON and flushes the file after each
/// line. The time `t` is in seconds since the event `start`. The caller opens and closes the file.
class TraceWriter : public Observer {
public:
  explicit TraceWriter(std::FILE *file) : file_(file) {}
  TraceWriter(const TraceWriter &) = delete;
  TraceWriter &operator=(const TraceWriter &) = delete;
  ~TraceWriter() override = default;

  void on(const Event &event) override {
    if (std::strcmp(event.event, "start") == 0) {
      began_ = std::chrono::steady_clock::now();
    }
    line_ = "{\"seq\": " + std::to_string(++count_);
    add("event", event.event);
    add("path", event.place.path);
    add("outcome", event.outcome);
    add("to", event.to);
    add("key", event.key);
    if (event.value != nullptr) {
      line_ += std::string(", \"value\": ") + event.value;
    }
    add("message", event.message);
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - began_;
    char seconds[32];
    std::snprintf(seconds, sizeof seconds, ", \"t\": %.6f", passed.count());
    line_ += seconds;
    if (*event.place.src != '\0') {
      add("src", event.place.src);
    }
    line_ += "}\n";
    std::fwrite(line_.data(), 1, line_.size(), file_);
    std::fflush(file_);
  }

private:
  void add(const char *name, const char *text) {
    if (text != nullptr) {
      line_ += std::string(", \"") + name + "\": " + json(std::string(text));
    }
  }

  std::FILE *file_;
  std::string line_{};
  std::uint64_t count_ = 0;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

/// The preempt requests of one thread of control: that of a machine or that of a branch.
///
/// Every thread may call `request`. A signal handler may not: it can set a flag that a thread
/// reads.
class Stop {
public:
  Stop() = default;
  Stop(const Stop &) = delete;
  Stop &operator=(const Stop &) = delete;

  /// Sends a preempt request to everything that runs, also in the branches of a concurrence. The
  /// request is pending until a state calls `service`; until then each next state receives it. A
  /// state that ends its machine without `service` keeps the request and receives it again at its
  /// next run. The observer receives an event `preempt` for each running state, in the thread of
  /// the caller.
  void request() {
    std::vector<std::pair<Observer *, Place>> told;
    {
      const std::lock_guard<Mutex> hold(lock_);
      ask(told);
      if (told.empty()) {
        return;
      }
      ++calls_;
    }
    const EndOfCalls end{*this};
    for (const auto &[observer, place] : told) {
      observer->tell({"preempt", place});
    }
  }
  /// Whether a preempt request is pending. May be called from every thread.
  [[nodiscard]] bool requested() const { return asked_.load(std::memory_order_relaxed); }
  /// Serves the pending request: the states after it run without the request.
  void service() { asked_.store(false, std::memory_order_relaxed); }
  /// The number of requests so far.
  [[nodiscard]] std::uint64_t requests() const { return requests_.load(std::memory_order_relaxed); }

  /// Waits for `seconds`, at most 1e9, or until a preempt request is pending. Returns whether one
  /// is pending. A negative time does not wait. Throws an Error if `seconds` is NaN.
  bool wait(double seconds) {
    if (std::isnan(seconds)) {
      fail("waits for `nan` seconds");
    }
    const std::chrono::duration<double> most(std::min(seconds, longest));
    std::unique_lock<Mutex> hold(lock_);
    return wake_.wait_for(hold, most, [this] { return asked_.load(); });
  }

private:
  template <class Run, std::size_t N> friend class Branches;
  friend class Round;
  friend struct Run;
  friend class WatchedRun;

  static constexpr double longest = 1e9;

  /// Marks the end of the observer calls of a request. The destructor of a WatchedRun waits for
  /// this.
  struct EndOfCalls {
    Stop &stop;
    ~EndOfCalls() {
      const std::lock_guard<Mutex> hold(stop.lock_);
      --stop.calls_;
      stop.uncalled_.notify_all();
    }
  };

  /// Marks the request as pending here and in the branches, and adds the running states and their
  /// observers to `told`. The caller must hold `lock_`.
  void ask(std::vector<std::pair<Observer *, Place>> &told) {
    if (ended_) {
      return;
    }
    asker_ = nullptr;
    asked_.store(true);
    requests_.fetch_add(1);
    wake_.notify_all();
    for (const Place &place : running_) {
      told.emplace_back(observer_, place);
    }
    for (Stop *branch = branches_; branch != nullptr; branch = branch->next_) {
      const std::lock_guard<Mutex> hold(branch->lock_);
      branch->ask(told);
    }
  }

  static bool within(std::string_view path, std::string_view around) {
    return path.substr(0, around.size()) == around &&
           (path.size() == around.size() || path[around.size()] == '/');
  }
  /// Called before a state starts. A request that the state, or a container around it, keeps
  /// becomes pending again; a pending one that another state has kept goes back to that state
  /// (`settle`).
  [[gnu::cold, gnu::noinline]] void remind(const char *path) noexcept {
    const std::lock_guard<Mutex> hold(lock_);
    settle(path);
    ask_again([path](const char *each) { return within(path, each); });
  }
  /// Called when a state ends its machine: if a request is pending, the state keeps it.
  [[gnu::cold, gnu::noinline]] void keep(const char *path) noexcept {
    const std::lock_guard<Mutex> hold(lock_);
    settle(path);
    if (asked_.load() && (asker_ == nullptr || !within(asker_, path))) {
      put(path);
    }
  }
  /// Called when a request ends an iterator: removes the requests that the states in it keep.
  void forget(const char *path) {
    const std::lock_guard<Mutex> hold(lock_);
    take([path](const char *each) { return within(each, path); });
  }

  // The callers of the following functions must hold `lock_`.

  /// If the pending request is one that a state has kept, and `path` is not in that state: the
  /// request is no longer pending, and that state keeps it again.
  void settle(const char *path) {
    if (asker_ == nullptr || within(path, asker_)) {
      return;
    }
    if (asked_.exchange(false)) {
      put(asker_);
    }
    asker_ = nullptr;
  }
  /// Makes kept requests pending again: those of the paths for which `which` is true. All these
  /// paths must be around one state. The outermost of them becomes `asker_`.
  template <class Which> void ask_again(Which which) {
    const char *outer = nullptr;
    take([&](const char *each) {
      const bool found = which(each);
      if (found && (outer == nullptr || within(outer, each))) {
        outer = each;
      }
      return found;
    });
    if (outer != nullptr && !asked_.exchange(true)) {
      asker_ = outer;
    }
    keeps_ = asker_ != nullptr || !kept_.empty();
  }
  void put(const char *path) {
    take([path](const char *each) { return std::strcmp(each, path) == 0; });
    kept_.push_back(path);
    keeps_ = true;
  }
  /// Removes the kept requests of the paths for which `which` is true.
  template <class Which> void take(Which which) {
    kept_.erase(std::remove_if(kept_.begin(), kept_.end(), which), kept_.end());
  }

  std::atomic<bool> asked_{false};
  std::atomic<std::uint64_t> requests_{0};
  Mutex lock_{};
  Condition wake_{};
  // False if no state keeps a request, so that `remind` need not be called. Only the thread of
  // control uses it.
  bool keeps_ = false;
  // Protected by `lock_`: the paths of the states that keep a request; and the path of the state
  // whose kept request is now the pending one, null if the pending request is for all states.
  std::vector<const char *> kept_{};
  const char *asker_ = nullptr;
  // Protected by `lock_`: the Stop of the first branch of the running concurrence, that of the next
  // branch, whether the branch has ended, the observer, and the places of the running states.
  Stop *branches_ = nullptr;
  Stop *next_ = nullptr;
  bool ended_ = false;
  Observer *observer_ = nullptr;
  std::vector<Place> running_{};
  // Protected by `lock_`: the number of requests that are calling observers now. The destructor of
  // a WatchedRun waits until it is zero.
  unsigned calls_ = 0;
  Condition uncalled_{};
};

/// The count of an iterator's remaining items, and the preempt requests to the iterator: it ends
/// after the item that runs at the request, also if the state has served the request. A request
/// that is pending before the iterator starts ends it after the first item.
class Round {
public:
  Round(Stop &stop, const Place &item, std::size_t items)
      : stop_(stop), item_(item), before_(stop.requests()), left_(items) {
    stop_.remind(item_.full());
    early_ = stop_.requested();
  }
  /// Called after each item. Returns whether a preempt request ends the iterator; that request is
  /// served.
  bool over() {
    --left_;
    if (!early_ && stop_.requests() == before_) {
      return false;
    }
    stop_.service();
    stop_.forget(item_.full());
    return true;
  }
  /// Whether no items remain. Call it after `over`.
  bool last() const { return left_ == 0; }

private:
  Stop &stop_;
  const Place &item_;
  std::uint64_t before_;
  std::size_t left_;
  bool early_ = false;
};

/// An output of a state: its name in the state, and the key. Traces hide the value of a secret one.
template <class T> struct Output {
  const char *name;
  Key<T> &key;
  bool secret = false;
};
template <class T> Output(const char *, Key<T> &) -> Output<T>;
template <class T> Output(const char *, Key<T> &, bool) -> Output<T>;

#if defined(__cpp_exceptions)
/// The error of a run that ends with an exception of a state: has the path of the state and its
/// place in the script. The exception of the state is nested in it (std::rethrow_if_nested).
class StateError : public std::runtime_error {
public:
  StateError(const Place &state, const char *what)
      : std::runtime_error(std::string(state.path) + " (" + state.src + "): " + what),
        place(state) {}
  Place place;
};
#endif

namespace detail {

/// The message of the current exception; empty for a StateError, because an error event for it has
/// been sent already. The caller must be an exception handler.
inline std::string message_of_current() {
#if defined(__cpp_exceptions)
  try {
    throw;
  } catch (const StateError &) {
    return {};
  } catch (const std::exception &error) {
    return *error.what() != '\0' ? error.what() : "an exception without a message";
  } catch (...) {
    return "an exception of an unknown type";
  }
#else
  return {};
#endif
}

[[noreturn]] inline void throw_on(const Place &place, const std::string &message) {
#if defined(__cpp_exceptions)
  if (message.empty()) {
    throw;
  }
  std::throw_with_nested(StateError(place, message.c_str()));
#else
  static_cast<void>(place);
  fail(message.c_str());
#endif
}

/// The error for an outcome of a state that its container does not expect. It is a failure of the
/// container: it never becomes the outcome of the state, also where the script catches exceptions.
struct Undeclared : Error {
  using Error::Error;
};

/// The error for a value that is not an enumerator of the state's Outcome: a number cast to the
/// type.
struct NoOutcome : Undeclared {
  NoOutcome() : Undeclared("ended without an outcome") {}
};

[[noreturn, gnu::cold, gnu::noinline]] inline void undeclared(const char *outcome) {
  const std::string text = std::string("ended with `") + outcome + "`, which leads nowhere";
#if defined(__cpp_exceptions)
  throw Undeclared(text);
#else
  fail(text.c_str());
#endif
}

[[noreturn, gnu::cold, gnu::noinline]] inline void no_outcome() {
#if defined(__cpp_exceptions)
  throw NoOutcome();
#else
  fail(NoOutcome().what());
#endif
}

inline bool current_is_undeclared() {
#if defined(__cpp_exceptions)
  try {
    throw;
  } catch (const Undeclared &) {
    return true;
  } catch (...) {
    return false;
  }
#else
  return false;
#endif
}

} // namespace detail

/// Marks a place that no run reaches. A call is undefined behaviour.
[[noreturn]] inline void never() { __builtin_unreachable(); }

/// Prints a line `key: value` on stdout, as the state type PrintUserdataState does.
template <class T> void print(const char *key, const T &value) {
  const std::string line = std::string(key) + ": " + py::text(value) + "\n";
  std::fwrite(line.data(), 1, line.size(), stdout);
}

/// Sleeps for `seconds`. A preempt request does not end the sleep. Throws an Error if `seconds` is
/// NaN.
inline void sleep(double seconds) { Stop().wait(seconds); }

/// The context of a run without observer. The generated containers call its functions. `places` is
/// the array of the places of the container's states; `state` is the index of a state in it.
struct Run {
  Stop &stop;

  /// The context of a branch of a concurrence.
  Run branch(Stop &own) const { return Run{own}; }

  template <class State> void enter(const Place *, State) {}
  template <class State> void go(const Place *, State &state, const char *, State next) {
    state = next;
  }
  template <class State> void again(const Place *, State, const char *) {}
  template <class State, class Outcome>
  Outcome end(const Place *, State, const char *, Outcome outcome) {
    return outcome;
  }
  /// As `end`, for a state that has a Stop: if a request is pending, the state keeps it.
  template <class State, class Outcome>
  Outcome end_asked(const Place *places, State state, const char *, Outcome outcome) {
    if (stop.requested()) {
      stop.keep(places[static_cast<std::size_t>(state)].full());
    }
    return outcome;
  }
  /// The Stop for a state that is about to run. A request that the state keeps is pending again.
  template <class State> Stop &stop_for(const Place *places, State state) {
    if (stop.keeps_) {
      stop.remind(places[static_cast<std::size_t>(state)].full());
    }
    return stop;
  }
  template <class State> void exit(const Place *, State, const char *) {}
  template <class T> Key<T> &out(Key<T> &key) { return key; }
  template <class Outcome, class... T> Outcome wrote(Outcome outcome, Output<T>...) {
    return outcome;
  }
  template <class T, class U> void write(const char *, Key<T> &key, U &&value, bool = false) {
    key = convert<T>(std::forward<U>(value));
  }
  /// Called in SMACHAC_CATCH where the script makes the exception of the state its outcome. An
  /// outcome that the container does not expect is not caught: it leaves as a StateError.
  template <class State> void caught(const Place *places, State state) {
    if (detail::current_is_undeclared()) {
      failed(places, state);
    }
  }
  /// Throws the error for an outcome of the state that the container does not expect.
  template <class State> [[noreturn]] void undeclared(const Place *, State, const char *outcome) {
    detail::undeclared(outcome);
  }
  /// Throws the error for a value that is not an outcome of the state.
  template <class State> [[noreturn]] void no_outcome(const Place *, State) {
    detail::no_outcome();
  }
  /// Called in SMACHAC_CATCH: throws a StateError with the current exception nested. A StateError
  /// is rethrown unchanged.
  template <class State> [[noreturn]] void failed(const Place *places, State state) {
    give_up(stop, places[static_cast<std::size_t>(state)]);
  }

private:
  // Not inlined: the function of a container then stays small enough to be inlined into its caller.
  [[noreturn, gnu::cold, gnu::noinline]] static void give_up(Stop &stop, const Place &place) {
    stop.keep(place.full());
    detail::throw_on(place, detail::message_of_current());
  }
};

/// A type, for arguments of a class only: a pointer to an Observer takes the other `run`.
template <class Watch, class Result>
using IfClass = std::enable_if_t<std::is_class_v<Watch>, Result>;

/// The context of a run with an observer of any class with `on(const Event &)`. It receives the
/// events start, enter, exit, transition, error and finish, without a virtual call, a lock or a
/// text that is made for it: a transition that ends a container has the outcome `with`, and no
/// `to`. The branches of a concurrence call it at the same time. Writes and requests need an
/// Observer.
template <class Watch> class DirectRun : public Run {
public:
  DirectRun(Watch &watch, Stop &own) : Run{own}, watch_(watch) {}

  DirectRun branch(Stop &own) const { return DirectRun(watch_, own); }

  void start(const Place &machine) { watch_.on(Event{"start", machine}); }
  template <class Outcome> Outcome finish(const Place &machine, Outcome outcome) {
    watch_.on(Event{"finish", machine, name(outcome)});
    return outcome;
  }
  template <class State> void enter(const Place *places, State state) {
    watch_.on(Event{"enter", at(places, state)});
  }
  template <class State>
  void go(const Place *places, State &state, const char *outcome, State next) {
    exit(places, state, outcome);
    watch_.on(Event{"transition", at(places, state), outcome, at(places, next).path});
    state = next;
  }
  template <class State> void again(const Place *places, State state, const char *outcome) {
    go(places, state, outcome, state);
  }
  template <class State, class Outcome>
  Outcome end(const Place *places, State state, const char *outcome, Outcome with) {
    exit(places, state, outcome);
    Event event{"transition", at(places, state), outcome};
    event.with = name(with);
    watch_.on(event);
    return with;
  }
  template <class State, class Outcome>
  Outcome end_asked(const Place *places, State state, const char *outcome, Outcome with) {
    return Run::end_asked(places, state, outcome, end(places, state, outcome, with));
  }
  template <class State> void exit(const Place *places, State state, const char *outcome) {
    watch_.on(Event{"exit", at(places, state), outcome});
  }
  template <class State> void caught(const Place *places, State state) {
    Run::caught(places, state);
    error(at(places, state));
  }
  template <class State>
  [[noreturn]] void undeclared(const Place *places, State state, const char *outcome) {
    exit(places, state, outcome);
    detail::undeclared(outcome);
  }
  template <class State> [[noreturn]] void failed(const Place *places, State state) {
    error(at(places, state));
    Run::failed(places, state);
  }

private:
  template <class State> static const Place &at(const Place *places, State state) {
    return places[static_cast<std::size_t>(state)];
  }
  void error(const Place &place) {
    const std::string message = detail::message_of_current();
    if (!message.empty()) {
      Event event{"error", place};
      event.message = message.c_str();
      watch_.on(event);
    }
  }

  Watch &watch_;
};

/// The context of a run with an observer: sends all events of the run to it. The destructor returns
/// after the last call of the observer by a preempt request from another thread.
class WatchedRun {
public:
  Stop &stop;

  WatchedRun(Observer &observer, Stop &own) : stop(own), observer_(observer) {
    const std::lock_guard<Mutex> hold(stop.lock_);
    stop.observer_ = &observer_;
  }
  WatchedRun(const WatchedRun &) = delete;
  WatchedRun &operator=(const WatchedRun &) = delete;
  ~WatchedRun() {
    std::unique_lock<Mutex> hold(stop.lock_);
    stop.observer_ = nullptr;
    stop.running_.clear();
    stop.uncalled_.wait(hold, [this] { return stop.calls_ == 0; });
  }

  Observer &observer() { return observer_; }

  void start(const Place &machine) {
    observer_.tell({"start", machine});
    push(machine);
  }
  template <class Outcome> Outcome finish(Outcome outcome) {
    const Place machine = stop.running_.back();
    pop();
    observer_.tell({"finish", machine, name(outcome)});
    return outcome;
  }

  template <class State> void enter(const Place *places, State state) {
    entered(places[static_cast<std::size_t>(state)]);
  }
  template <class State>
  void go(const Place *places, State &state, const char *outcome, State next) {
    const char *to = places[static_cast<std::size_t>(next)].path;
    moved(places[static_cast<std::size_t>(state)], outcome, to);
    state = next;
  }
  template <class State> void again(const Place *places, State state, const char *outcome) {
    go(places, state, outcome, state);
  }
  template <class State, class Outcome>
  Outcome end(const Place *places, State state, const char *outcome, Outcome with) {
    ended(places[static_cast<std::size_t>(state)], outcome, name(with));
    return with;
  }
  template <class State, class Outcome>
  Outcome end_asked(const Place *places, State state, const char *outcome, Outcome with) {
    return Run{stop}.end_asked(places, state, outcome, end(places, state, outcome, with));
  }
  template <class State> Stop &stop_for(const Place *places, State state) {
    return Run{stop}.stop_for(places, state);
  }
  template <class State> void exit(const Place *places, State state, const char *outcome) {
    left(places[static_cast<std::size_t>(state)], outcome);
  }

  /// An output key for a state that is about to run. `wrote` sends the event of the write after the
  /// state has ended.
  template <class T> Key<T> &out(Key<T> &key) {
    key.fresh();
    return key;
  }
  template <class Outcome, class... T> Outcome wrote(Outcome outcome, Output<T>... outputs) {
    (wrote_one(outputs), ...);
    return outcome;
  }
  template <class T, class U>
  void write(const char *name, Key<T> &key, U &&value, bool secret = false) {
    key = convert<T>(std::forward<U>(value));
    wrote_one(Output<T>{name, key, secret});
  }
  template <class State> void caught(const Place *places, State state) {
    caught_at(places[static_cast<std::size_t>(state)]);
  }
  template <class State>
  [[noreturn]] void undeclared(const Place *places, State state, const char *outcome) {
    observer_.tell({"exit", places[static_cast<std::size_t>(state)], outcome});
    detail::undeclared(outcome);
  }
  template <class State> [[noreturn]] void no_outcome(const Place *, State) {
    detail::no_outcome();
  }
  template <class State> [[noreturn]] void failed(const Place *places, State state) {
    failed_at(places[static_cast<std::size_t>(state)]);
  }

private:
  void push(const Place &place) {
    bool asked = false;
    {
      const std::lock_guard<Mutex> hold(stop.lock_);
      stop.settle(place.full());
      stop.ask_again([&](const char *each) {
        return Stop::within(place.full(), each) && std::strcmp(place.full(), each) != 0;
      });
      stop.running_.push_back(place);
      asked = stop.requested() && stop.asker_ != place.full();
    }
    if (asked) {
      observer_.tell({"preempt", place});
    }
  }
  void pop() {
    const std::lock_guard<Mutex> hold(stop.lock_);
    stop.running_.pop_back();
  }
  void entered(const Place &place) {
    push(place);
    observer_.tell({"enter", place});
  }
  void left(const Place &place, const char *outcome) {
    pop();
    observer_.tell({"exit", place, outcome});
  }
  void moved(const Place &place, const char *outcome, const char *to) {
    left(place, outcome);
    observer_.tell({"transition", place, outcome, to});
  }
  void ended(const Place &place, const char *outcome, const char *with) {
    const std::string_view path = place.path;
    std::string to(place.around != nullptr ? std::string_view(place.around)
                                           : path.substr(0, path.rfind('/')));
    to += std::string(":") + with;
    moved(place, outcome, to.c_str());
  }
  void caught_at(const Place &place) {
    if (detail::current_is_undeclared()) {
      failed_at(place);
    }
    tell_error(place, detail::message_of_current());
  }
  [[noreturn]] void failed_at(const Place &place) {
    stop.keep(place.full());
    pop();
    const std::string message = detail::message_of_current();
    tell_error(place, message);
    detail::throw_on(place, message);
  }
  void tell_error(const Place &place, const std::string &message) {
    if (!message.empty()) {
      observer_.tell({"error", place, nullptr, nullptr, nullptr, nullptr, message.c_str()});
    }
  }
  template <class T> void wrote_one(Output<T> output) {
    if (output.key.fresh() && observer_.wants_writes()) {
      const std::string value = output.secret ? "\"(secret)\"" : json(output.key.get());
      const Place place = stop.running_.back(); // only this thread changes `running_`
      observer_.tell({"write", place, nullptr, nullptr, output.name, value.c_str()});
    }
  }

  Observer &observer_;
};

#if SMACHAC_THREADS
using Thread = std::thread;
#else
/// The replacement for std::thread where the standard library has no threads: a concurrence does
/// not compile.
struct Thread {
  Thread() = default;
  template <class Function> explicit Thread(Function) {
    static_assert(!std::is_same_v<Function, Function>,
                  "a concurrence needs the threads of the standard library");
  }
  bool joinable() const { return false; }
  void join() {}
};
#endif

/// The `N` branches of a concurrence, each with its own Stop. The last branch runs in the thread of
/// the container, every other branch in a thread of its own.
template <class Run, std::size_t N> class Branches {
public:
  Branches(Run &around, const Place *places) : around_(around), places_(places) {
    around_.stop.remind(places_[0].full());
    const std::lock_guard<Mutex> hold(around_.stop.lock_);
    for (std::size_t i = 0; i < N; ++i) {
      stops_[i].next_ = i + 1 < N ? &stops_[i + 1] : nullptr;
      stops_[i].asked_.store(around_.stop.requested());
      move_kept(i, around_.stop, stops_[i]);
    }
    before_ = around_.stop.requests();
    stopped_ = around_.stop.requested();
    around_.stop.branches_ = stops_.data();
  }
  Branches(const Branches &) = delete;
  Branches &operator=(const Branches &) = delete;
  ~Branches() { leave(); }

  /// Runs `branch(i, run)` for every branch `i` and returns when all have ended. The first
  /// exception of a branch sends a preempt request to the other branches; if `any` is true, so does
  /// the end of the first branch. No such request is sent if the concurrence has received one from
  /// outside. The first exception is thrown again after all branches have ended.
  template <class Branch> void run(bool any, Branch branch) {
    {
      Threads threads;
      SMACHAC_TRY {
        for (std::size_t i = 0; i + 1 < N; ++i) {
          threads.all[i] = Thread([this, i, any, &branch] { one(i, any, branch); });
        }
        one(N - 1, any, branch);
      }
      SMACHAC_CATCH {
        // A thread could not be created.
        failure_.keep();
        ask_others();
      }
    }
    leave();
    failure_.go_on();
  }

  /// Whether the concurrence has received a preempt request from outside; the call serves it. Call
  /// it after `run`.
  bool stopped() {
    if (stopped_) {
      around_.stop.service();
    }
    return stopped_;
  }

private:
  struct Threads {
    std::array<Thread, N - 1> all{};
    ~Threads() {
      for (Thread &each : all) {
        if (each.joinable()) {
          each.join();
        }
      }
    }
  };

  /// The first exception that a branch has thrown.
  class Failure {
  public:
#if defined(__cpp_exceptions)
    void keep() {
      const std::lock_guard<Mutex> hold(lock_);
      if (!first_) {
        first_ = std::current_exception();
      }
    }
    void go_on() const {
      if (first_) {
        std::rethrow_exception(first_);
      }
    }

  private:
    Mutex lock_{};
    std::exception_ptr first_{};
#else
    void keep() {}
    void go_on() const {}
#endif
  };

  template <class Branch> void one(std::size_t i, bool any, Branch &branch) {
    bool ask = any;
    SMACHAC_TRY {
      if constexpr (std::is_same_v<Run, WatchedRun>) {
        WatchedRun own(around_.observer(), stops_[i]);
        branch(i, own);
      } else {
        Run own = around_.branch(stops_[i]);
        branch(i, own);
      }
    }
    SMACHAC_CATCH {
      ask = true;
      failure_.keep();
    }
    {
      const std::lock_guard<Mutex> hold(stops_[i].lock_);
      stops_[i].ended_ = true;
    }
    if (ask && !asked_.exchange(true) && !asked_from_outside()) {
      ask_others();
    }
  }
  /// Whether the concurrence has received a preempt request from outside; then every branch has
  /// received it too.
  bool asked_from_outside() const { return stopped_ || around_.stop.requests() != before_; }
  void ask_others() {
    for (Stop &each : stops_) {
      each.request();
    }
  }
  /// Detaches the branches from the Stop of the concurrence. A request to the concurrence is served
  /// unless one is pending in a branch. The requests that the states of a branch keep move to the
  /// Stop of the concurrence; those of a branch with a pending request are removed.
  void leave() {
    const std::lock_guard<Mutex> hold(around_.stop.lock_);
    if (around_.stop.branches_ == nullptr) {
      return;
    }
    stopped_ = asked_from_outside();
    around_.stop.branches_ = nullptr;
    bool open = false;
    for (std::size_t i = 0; i < N; ++i) {
      stops_[i].settle(places_[i].full());
      open = open || stops_[i].requested();
      if (!stops_[i].requested()) {
        move_kept(i, stops_[i], around_.stop);
      }
    }
    if (!open) {
      around_.stop.service();
    }
  }
  /// Moves the requests that the states of branch `i` keep from one Stop to another: to the branch
  /// before it starts, from the branch after it has ended.
  void move_kept(std::size_t i, Stop &from, Stop &to) {
    from.take([&](const char *path) {
      const bool found = Stop::within(path, places_[i].full());
      if (found) {
        to.put(path);
      }
      return found;
    });
  }

  Run &around_;
  const Place *places_;
  std::array<Stop, N> stops_{};
  std::atomic<bool> asked_{false};
  std::uint64_t before_ = 0;
  bool stopped_ = false;
  Failure failure_{};
};

/// A random number generator with the algorithm of Python's `random`: the same seed gives the same
/// sequence as in Python.
class Draws {
public:
  /// A generator with a seed from std::random_device: each object has another sequence in each run.
  Draws() : Draws({std::random_device{}(), std::random_device{}()}) {}

  /// A generator with a given seed: its words of 32 bits, the lowest first, at least one.
  Draws(std::initializer_list<std::uint32_t> seed) : words_(Words{seed}) {}

  /// A random whole number from 0 to `count - 1`. `count` must be from 1 to 2**32 - 1.
  std::size_t below(std::size_t count) {
    unsigned bits = 0;
    for (std::size_t rest = count; rest != 0; rest >>= 1U) {
      ++bits;
    }
    std::size_t drawn = count;
    while (drawn >= count) {
      drawn = words_() >> (32U - bits);
    }
    return drawn;
  }

private:
  /// The seed sequence of the generator: fills its state as Python's `random.seed` does
  /// (`init_by_array` of the authors of the Mersenne Twister, M. Matsumoto and T. Nishimura).
  struct Words {
    using result_type = std::uint32_t;
    std::initializer_list<std::uint32_t> seed;

    template <class Iterator> void generate(Iterator state, Iterator end) const {
      const auto size = static_cast<std::uint32_t>(end - state);
      const auto length = static_cast<std::uint32_t>(seed.size());
      std::vector<std::uint32_t> mt(size);
      mt[0] = 19650218U;
      for (std::uint32_t i = 1; i < size; ++i) {
        mt[i] = 1812433253U * (mt[i - 1] ^ (mt[i - 1] >> 30U)) + i;
      }
      std::uint32_t i = 1;
      std::uint32_t j = 0;
      const auto next = [&] {
        if (++i >= size) {
          mt[0] = mt[size - 1];
          i = 1;
        }
      };
      for (std::uint32_t k = std::max(size, length); k != 0; --k) {
        const std::uint32_t mixed = (mt[i - 1] ^ (mt[i - 1] >> 30U)) * 1664525U;
        mt[i] = (mt[i] ^ mixed) + seed.begin()[j] + j;
        next();
        j = j + 1 < length ? j + 1 : 0;
      }
      for (std::uint32_t k = size - 1; k != 0; --k) {
        mt[i] = (mt[i] ^ ((mt[i - 1] ^ (mt[i - 1] >> 30U)) * 1566083941U)) - i;
        next();
      }
      mt[0] = 0x80000000U;
      std::copy(mt.begin(), mt.end(), state);
    }
  };

  struct Seeded : std::mt19937 {
    explicit Seeded(Words words) : std::mt19937(words) {}
  };

  Seeded words_;
};

} // namespace v0_1_0
} // namespace smachac

#endif // SMACHAC_SMACHAC_HPP
