// Made by smachac, as it is for every machine: do not edit.
//
// What generated state machines stand on. C++17, header only, no dependency.
//
// Userdata keys (Key), requests to stop (Stop), who hears what a run does (Observer, TraceWriter),
// the threads of a concurrence (Branches). A machine runs with a Run, or with a WatchedRun where
// somebody listens; the hooks of a Run are empty, so they cost nothing. Builds with -fno-exceptions
// and -fno-rtti: then a failure ends the program.
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

#include "smachac/values.hpp"

#if defined(__cpp_exceptions)
#define SMACHAC_TRY try
#define SMACHAC_CATCH catch (...)
#else
#define SMACHAC_TRY
#define SMACHAC_CATCH if constexpr (false)
#endif

// Whether the standard library has threads: that of GCC has none over a bare Newlib.
#if defined(__GLIBCXX__) && !defined(_GLIBCXX_HAS_GTHREADS)
#define SMACHAC_THREADS 0
#else
#define SMACHAC_THREADS 1
#endif

namespace smachac {
inline namespace v0_1_0 {

/// Whether the compiler has exceptions; machines whose states catch exceptions need them.
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
/// A lock in a program that has one thread.
struct Mutex {
  void lock() {}
  void unlock() {}
};
using RecursiveMutex = Mutex;

/// A condition in a program that has one thread: nobody can change it while this thread waits.
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

/// Fails because a key was read that holds nothing.
[[noreturn, gnu::cold, gnu::noinline]] inline void unset_key() {
  fail("reads a key that holds nothing");
}

/// A userdata key: a value, once somebody has put one there. A read of an unset key is an Error.
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
  /// The value of a key that surely holds one, without a check.
  [[nodiscard]] const T &unchecked() const { return value_; }
  /// The value, to be changed in place; the key counts as written. A key that holds nothing starts
  /// with the default value of its type.
  [[nodiscard]] T &edit() {
    state_ = written;
    return value_;
  }
  [[nodiscard]] bool set() const { return state_ != unset; }

  /// What containers do at their borders: no state has written it, so no trace tells of it.
  template <class U> void hold(const U &value) {
    replace(value);
    state_ = held;
  }
  /// The same, where it holds a value already.
  template <class U> void replace(const U &value) {
    if constexpr (std::is_same_v<T, U>) {
      value_ = value; // keeps the memory that the value has
    } else {
      value_ = convert<T>(value);
    }
  }
  /// Hold what another key holds, if it does.
  template <class U> void take(const Key<U> &other) {
    if (other.set()) {
      hold(other.get());
    }
  }
  /// Whether a state has written it since it was last looked at.
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

/// A key was read that holds nothing.
struct MissingKey : Error {
  explicit MissingKey(const char *key)
      : Error(std::string("reads `") + key + "`, which holds nothing") {}
};

/// The value of a key that has to hold one. Throws MissingKey.
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

/// The value of a key that may hold none.
template <class Optional, class T> [[nodiscard]] Optional maybe(const Key<T> &key) {
  return key.set() ? convert<Optional>(key.get()) : Optional();
}

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wundefined-var-template"
#endif

/// What the compiler tells the fields of a class apart by: objects that are nowhere defined, as
/// only their places are looked at, and only while compiling.
template <class T> struct Marks {
  static T one;
  static T other;
};

/// A value for a field of the type `T`, marked or not.
template <class T> constexpr T with_mark(bool marked) {
  if constexpr (std::is_reference_v<T>) {
    using Object = std::remove_const_t<std::remove_reference_t<T>>;
    return marked ? Marks<Object>::one : Marks<Object>::other;
  } else {
    return marked ? T(1) : T(0);
  }
}

template <class T> constexpr bool is_marked(const T &field) {
  if constexpr (std::is_arithmetic_v<T>) {
    return field == T(1);
  } else {
    return &field == &Marks<T>::one;
  }
}

#if defined(__clang__)
#pragma clang diagnostic pop
#endif

/// How many fields stand before the one that is marked.
template <class... Fields> constexpr std::size_t before_mark(const Fields &...fields) {
  std::size_t count = 0;
  static_cast<void>((... || (is_marked(fields) || (++count, false))));
  return count;
}

template <std::size_t at, class Keys, class... Types, class Fields, std::size_t... all>
constexpr auto has_at(Fields fields, std::index_sequence<all...>)
    -> decltype(Keys{with_mark<Types>(all == at)...}, true) {
  return fields(Keys{with_mark<Types>(all == at)...}) == at;
}
template <std::size_t at, class Keys, class... Types, class Fields>
constexpr bool has_at(Fields, ...) {
  return false;
}
template <class Keys, class... Types, class Fields, std::size_t... all>
constexpr bool in_order(Fields fields, std::index_sequence<all...> each) {
  return (has_at<all, Keys, Types...>(fields, each) && ...);
}

/// Whether the class `Keys` has its fields in the order of `Types`, which `fields` tells by name.
template <class Keys, class... Types, class Fields> constexpr bool in_order(Fields fields) {
  return in_order<Keys, Types...>(fields, std::index_sequence_for<Types...>());
}

/// A state in the script: its path, `sm/PICK/OPEN`, and where it stands, `main.yml:12`. Where a
/// time limit, retry or loop is around it, also its path in the machine, and the path in the script
/// of the container around it (docs/language.md, Paths).
struct Place {
  const char *path;
  const char *src;
  const char *in_machine = nullptr;
  const char *around = nullptr;

  [[nodiscard]] const char *full() const { return in_machine != nullptr ? in_machine : path; }
};

/// One thing that happened. What an event does not have is null.
struct Event {
  const char *event; ///< start enter exit transition write preempt error finish
  Place place;
  const char *outcome = nullptr; ///< of exit, transition and finish
  const char *to = nullptr;      ///< of transition: the path of a state, or `path:outcome`
  const char *key = nullptr;     ///< of write
  const char *value = nullptr;   ///< of write: JSON
  const char *message = nullptr; ///< of error
};

/// Hears what a machine does. Branches of a concurrence and whoever asks it to stop call from
/// their threads, one at a time.
class Observer {
public:
  Observer() = default;
  Observer(const Observer &) = delete;
  Observer &operator=(const Observer &) = delete;
  virtual ~Observer() = default;

  /// What to do with an event, which is gone after the call.
  virtual void on(const Event &event) = 0;
  /// Whether `on` is called for writes. Without, no value is turned into JSON.
  [[nodiscard]] virtual bool wants_writes() const { return true; }

  void tell(const Event &event) {
    const std::lock_guard<RecursiveMutex> hold(lock_);
    on(event);
  }

private:
  RecursiveMutex lock_{};
};

/// Writes each event as a line of JSON, at once: what has happened is in the file.
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

/// Requests to stop, as one thread of control sees them: that of the machine, or of a branch.
///
/// Any thread may request. A signal handler may not: let it set a flag that a thread looks at.
class Stop {
public:
  Stop() = default;
  Stop(const Stop &) = delete;
  Stop &operator=(const Stop &) = delete;

  /// Ask what runs to stop. It goes on until a state answers; until then each next state is asked.
  /// A state that ends its machine without an answer keeps the request: it is asked when it runs
  /// again.
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
  /// Whether a request waits for an answer.
  [[nodiscard]] bool requested() const { return asked_.load(std::memory_order_relaxed); }
  /// Answer it: what comes next runs on.
  void service() { asked_.store(false, std::memory_order_relaxed); }
  /// How many requests there were.
  [[nodiscard]] std::uint64_t requests() const { return requests_.load(std::memory_order_relaxed); }

  /// Wait for so many seconds, or for a request; whether one has come. NaN is an Error.
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

  /// The end of a request that calls observers: the run that they watch may end.
  struct EndOfCalls {
    Stop &stop;
    ~EndOfCalls() {
      const std::lock_guard<Mutex> hold(stop.lock_);
      --stop.calls_;
      stop.uncalled_.notify_all();
    }
  };

  /// To be called under the lock.
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
  /// A state starts: it is asked again where it, or a container around it, keeps a request.
  [[gnu::cold, gnu::noinline]] void remind(const char *path) noexcept {
    const std::lock_guard<Mutex> hold(lock_);
    settle(path);
    ask_again([path](const char *each) { return within(path, each); });
  }
  /// A machine ends: its last state keeps a request that waits for an answer.
  [[gnu::cold, gnu::noinline]] void keep(const char *path) noexcept {
    const std::lock_guard<Mutex> hold(lock_);
    settle(path);
    if (asked_.load() && (asker_ == nullptr || !within(asker_, path))) {
      put(path);
    }
  }
  /// An iterator ends because of a request: states in it keep none.
  void forget(const char *path) {
    const std::lock_guard<Mutex> hold(lock_);
    take([path](const char *each) { return within(each, path); });
  }

  // These are called under the lock.

  /// A request that a state had kept ends with that state: it keeps it again.
  void settle(const char *path) {
    if (asker_ == nullptr || within(path, asker_)) {
      return;
    }
    if (asked_.exchange(false)) {
      put(asker_);
    }
    asker_ = nullptr;
  }
  /// Ask for some that keep a request, all of which are around one state.
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
  /// Take some paths out.
  template <class Which> void take(Which which) {
    kept_.erase(std::remove_if(kept_.begin(), kept_.end(), which), kept_.end());
  }

  std::atomic<bool> asked_{false};
  std::atomic<std::uint64_t> requests_{0};
  Mutex lock_{};
  Condition wake_{};
  // Whether a look at those that keep a request is worth it; only the thread of control does.
  bool keeps_ = false;
  // Under the lock: the paths of the states that keep a request, and of the one whose own request
  // `asked_` is; null where it is everybody's.
  std::vector<const char *> kept_{};
  const char *asker_ = nullptr;
  // Under the lock: the branches of the concurrence that runs, and what an observer is told of.
  Stop *branches_ = nullptr;
  Stop *next_ = nullptr;
  bool ended_ = false;
  Observer *observer_ = nullptr;
  std::vector<Place> running_{};
  // Under the lock: the requests that call observers now. A watched run waits for their end.
  unsigned calls_ = 0;
  Condition uncalled_{};
};

/// The items of an iterator that are left, and requests to stop: it ends after the item that runs
/// then, even if its state has answered. A request from before reaches the first item.
class Round {
public:
  Round(Stop &stop, const Place &item, std::size_t items)
      : stop_(stop), item_(item), before_(stop.requests()), left_(items) {
    stop_.remind(item_.full());
    early_ = stop_.requested();
  }
  /// An item is done: whether a request ends the iterator.
  bool over() {
    --left_;
    if (!early_ && stop_.requests() == before_) {
      return false;
    }
    stop_.service();
    stop_.forget(item_.full());
    return true;
  }
  /// Whether that was the last item.
  bool last() const { return left_ == 0; }

private:
  Stop &stop_;
  const Place &item_;
  std::uint64_t before_;
  std::size_t left_;
  bool early_ = false;
};

/// An output of a state, by its own name for it.
template <class T> struct Output {
  const char *name;
  Key<T> &key;
};
template <class T> Output(const char *, Key<T> &) -> Output<T>;

#if defined(__cpp_exceptions)
/// What a state threw, with the path of the state and its place in the script. The cause is nested
/// in it, see std::rethrow_if_nested.
class StateError : public std::runtime_error {
public:
  StateError(const Place &state, const char *what)
      : std::runtime_error(std::string(state.path) + " (" + state.src + "): " + what),
        place(state) {}
  Place place;
};
#endif

namespace detail {

/// The message of what is being thrown; empty for a StateError, which was told of before.
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

/// A state ended with an outcome that its container knows nothing of: the container's failure, so
/// it is no outcome of the state.
struct Undeclared : Error {
  using Error::Error;
};

/// A state ended with a value that is no outcome at all: a number cast to one.
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

/// Where no machine can come.
[[noreturn]] inline void never() { __builtin_unreachable(); }

/// Prints a key as PrintUserdataState does.
template <class T> void print(const char *key, const T &value) {
  const std::string line = std::string(key) + ": " + py::text(value) + "\n";
  std::fwrite(line.data(), 1, line.size(), stdout);
}

/// Sleep so many seconds, whoever asks to stop.
inline void sleep(double seconds) { Stop().wait(seconds); }

/// What a machine runs with where nobody watches. `places` are those of a container's states.
struct Run {
  Stop &stop;

  template <class State> void enter(const Place *, State) {}
  template <class State> void go(const Place *, State &state, const char *, State next) {
    state = next;
  }
  template <class State> void again(const Place *, State, const char *) {}
  template <class State, class Outcome>
  Outcome end(const Place *, State, const char *, Outcome outcome) {
    return outcome;
  }
  /// The same, of a state that can be asked to stop.
  template <class State, class Outcome>
  Outcome end_asked(const Place *places, State state, const char *, Outcome outcome) {
    if (stop.requested()) {
      stop.keep(places[static_cast<std::size_t>(state)].full());
    }
    return outcome;
  }
  /// The requests, for a state that is about to run.
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
  template <class T, class U> void write(const char *, Key<T> &key, U &&value) {
    key = convert<T>(std::forward<U>(value));
  }
  /// To be called in SMACHAC_CATCH: what the state threw is its outcome.
  template <class State> void caught(const Place *places, State state) {
    if (detail::current_is_undeclared()) {
      failed(places, state);
    }
  }
  /// The state ended as it should not: with an outcome that its container knows nothing of.
  template <class State> [[noreturn]] void undeclared(const Place *, State, const char *outcome) {
    detail::undeclared(outcome);
  }
  /// The state ended with a value that is none of its outcomes.
  template <class State> [[noreturn]] void no_outcome(const Place *, State) {
    detail::no_outcome();
  }
  /// To be called in SMACHAC_CATCH: what was thrown goes on as a StateError.
  template <class State> [[noreturn]] void failed(const Place *places, State state) {
    give_up(stop, places[static_cast<std::size_t>(state)]);
  }

private:
  // Out of the way, so that machines are small enough to become one with those around them.
  [[noreturn, gnu::cold, gnu::noinline]] static void give_up(Stop &stop, const Place &place) {
    stop.keep(place.full());
    detail::throw_on(place, detail::message_of_current());
  }
};

/// What a machine runs with where an observer hears of all that it does.
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

  /// A key that a state may write: what it writes there is told when it has ended.
  template <class T> Key<T> &out(Key<T> &key) {
    key.fresh();
    return key;
  }
  template <class Outcome, class... T> Outcome wrote(Outcome outcome, Output<T>... outputs) {
    (wrote_one(outputs), ...);
    return outcome;
  }
  template <class T, class U> void write(const char *name, Key<T> &key, U &&value) {
    key = convert<T>(std::forward<U>(value));
    wrote_one(Output<T>{name, key});
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
      const std::string value = json(output.key.get());
      const Place place = stop.running_.back(); // only this thread changes it
      observer_.tell({"write", place, nullptr, nullptr, output.name, value.c_str()});
    }
  }

  Observer &observer_;
};

#if SMACHAC_THREADS
using Thread = std::thread;
#else
/// What stands for a thread where there is none: no concurrence compiles.
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

/// The branches of a concurrence: a thread and a Stop for each of `N`.
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

  /// Run every branch, `branch(i, run)`, and wait for all. When the first ends (`any`), or one
  /// fails, the others are asked to stop. What failed first goes on outwards.
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
        // No thread was to be had.
        failure_.keep();
        ask_others();
      }
    }
    leave();
    failure_.go_on();
  }

  /// Whether there was a request to stop, from outside; it is served. To be called after `run`.
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

  /// The first failure of several threads.
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
        Run own{stops_[i]};
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
  /// Whether every branch has a request already, which came from outside.
  bool asked_from_outside() const { return stopped_ || around_.stop.requests() != before_; }
  void ask_others() {
    for (Stop &each : stops_) {
      each.request();
    }
  }
  /// A request to the concurrence is served unless a branch has left one open. What states of such
  /// a branch keep is gone.
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
  /// What states of a branch keep, when it starts and when it has ended.
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

/// Random numbers as Python draws them: the same seed gives the same row.
class Draws {
public:
  /// Seeded by the platform: each object, in each run, gives another row.
  Draws() : Draws({std::random_device{}(), std::random_device{}()}) {}

  /// The seed in words of 32 bits, the lowest first.
  Draws(std::initializer_list<std::uint32_t> seed) : words_(Words{seed}) {}

  /// A whole number from 0 up to `count`, without it.
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
  /// Fills the state of the generator as Python's `random.seed` does (`init_by_array` of the
  /// authors of the Mersenne Twister, M. Matsumoto and T. Nishimura).
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
