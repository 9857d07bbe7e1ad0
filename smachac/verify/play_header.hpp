// The part of a verify program for a header on disk: stand-ins for its states find the state that
// runs by the events of the machine. It is included after play.hpp and before the header.
#include <cstdlib>
#include <memory>
#include <set>
#include <string_view>
#include <type_traits>

namespace verify {

/// What a stand-in has no parameter for.
struct Nothing {};
inline Nothing nothing;

inline thread_local smachac::Place current{"", ""};
inline smachac::Stop unknown_stop;
inline thread_local smachac::Stop *current_stop = &unknown_stop;
inline std::set<std::size_t> live;

/// Writes the trace, and keeps the state that runs in each thread. A machine that never ends fails
/// after `most_events`.
class Watcher : public smachac::TraceWriter {
public:
  using TraceWriter::TraceWriter;

  void on(const smachac::Event &event) override {
    TraceWriter::on(event);
    if (++events_ > most_events) {
      std::fflush(stdout);
      std::_Exit(3);
    }
    if (std::string_view(event.event) == "enter") {
      current = event.place;
    }
  }

private:
  static constexpr long most_events = 1000000;
  long events_ = 0;
};

/// A state starts in this thread; `run` has the requests to stop.
template <class Run> void starts(Run &run) { current_stop = &run.stop; }

/// A leaf whose code lost the parameter for requests to stop gets none.
inline bool preempted(Nothing &, bool waits, bool requests) {
  if (requests) {
    machine->request();
  }
  if (waits) {
    throw std::runtime_error("was not asked to stop");
  }
  return false;
}
inline void service(Nothing &) {}

/// Whether a leaf follows the test case. One that runs its own code uses up a visit here.
inline bool scripted(std::size_t leaf) {
  if (live.count(leaf) == 0) {
    return true;
  }
  if (--left < 0) {
    throw std::runtime_error("is not in the script");
  }
  return false;
}

template <class T> void read_value(const smachac::Place &place, const char *key, const T &value) {
  const std::string text = smachac::json(value);
  if (text != "null") {
    read(place, key, text);
  }
}
template <class T>
void read_key(const smachac::Place &place, const char *key, const smachac::Key<T> &from) {
  if (from.set()) {
    read_value(place, key, from.get());
  }
}
template <class T>
void write_key(const smachac::Place &place, const char *name, smachac::Key<T> &key,
               const std::common_type_t<T> &value) {
  key = value;
  key.fresh();
  const std::string text = smachac::json(key.get());
  observer->tell({"write", place, nullptr, nullptr, name, text.c_str()});
}

/// An argument for any parameter of a constructor of `T`; stand-ins use no argument.
template <class T> struct Anything {
  template <class P, std::enable_if_t<!std::is_same_v<std::remove_cv_t<P>, T>, int> = 0>
  operator P &() const {
    alignas(std::max_align_t) static unsigned char here[4096] = {};
    return reinterpret_cast<P &>(here);
  }
};
inline constexpr std::size_t most_parameters = 16;

/// An object, with as many arguments as its constructor has parameters.
template <class T, class... Given> std::unique_ptr<T> made() {
  if constexpr (std::is_constructible_v<T, Given...>) {
    return std::make_unique<T>(Given{}...);
  } else {
    static_assert(sizeof...(Given) < most_parameters, "States cannot be constructed");
    return made<T, Given..., Anything<T>>();
  }
}

inline void read_live() {
  std::size_t count = 0;
  std::cin >> count;
  live.clear();
  for (std::size_t leaf = 0; count > 0 && std::cin >> leaf; --count) {
    live.insert(leaf);
  }
}

/// The number of the leaf that runs in this thread.
std::size_t here();

} // namespace verify
