// The leaves of recorded machines: what they do is told by whoever reads our output, line by line.
#include <cstdio>
#include <iostream>

#include "smachac/smachac.hpp"

namespace vectors {

/// A leaf was told to throw; the words say what for.
struct Told : std::exception {
  explicit Told(std::string given) : kind(std::move(given)) {}
  const char *what() const noexcept override { return kind.c_str(); }
  std::string kind;
};

/// Reads a value as it is told: `i5` `t` `f` `n` `s3:abc` `l2:i1i2`.
struct Reader {
  const std::string &text;
  std::size_t place = 0;

  std::size_t count() {
    const std::size_t colon = text.find(':', place);
    const auto found = static_cast<std::size_t>(std::stoll(text.substr(place, colon - place)));
    place = colon + 1;
    return found;
  }
  std::any any() {
    switch (text[place++]) {
    case 'i': {
      std::size_t used = 0;
      const std::int64_t found = std::stoll(text.substr(place), &used);
      place += used;
      return found;
    }
    case 't':
      return true;
    case 'f':
      return false;
    case 's': {
      const std::size_t size = count();
      place += size;
      return text.substr(place - size, size);
    }
    case 'l': {
      std::vector<std::any> found(count());
      for (std::any &each : found) {
        each = any();
      }
      return found;
    }
    default:
      return {};
    }
  }
};

template <class T> void give(T &to, const std::any &from) {
  if constexpr (std::is_same_v<T, std::any>) {
    to = from;
  } else if constexpr (smachac::detail::is_optional<T>::value) {
    give(to.emplace(), from);
  } else if constexpr (smachac::detail::is_list<T>::value) {
    std::vector<typename T::value_type> found;
    for (const std::any &each : std::any_cast<std::vector<std::any>>(from)) {
      give(found.emplace_back(), each);
    }
    to = smachac::convert<T>(found);
  } else {
    to = std::any_cast<T>(from);
  }
}

/// What is done with keys of one type: shown as JSON, empty where one holds nothing, and written.
struct Kind {
  std::string (*show)(const void *key);
  void (*write)(void *key, const std::any &value);
};
template <class T>
inline constexpr Kind kind_of{
    [](const void *key) {
      const auto &held = *static_cast<const smachac::Key<T> *>(key);
      return held.set() ? smachac::json(held.get()) : std::string();
    },
    [](void *key, const std::any &value) {
      T found{};
      give(found, value);
      *static_cast<smachac::Key<T> *>(key) = found;
    }};
template <class T>
inline constexpr Kind kind_of_input{[](const void *value) {
                                      const auto &held = *static_cast<const T *>(value);
                                      return held.has_value() ? smachac::json(*held) : std::string();
                                    },
                                    nullptr};

/// A key of a leaf, whatever its type.
struct View {
  const char *name;
  void *key;
  const Kind *kind;
};
template <class T> View view(const char *name, smachac::Key<T> &key) {
  return {name, &key, &kind_of<T>};
}
template <class T> View view(const char *name, const std::optional<T> &value) {
  return {name, const_cast<std::optional<T> *>(&value), &kind_of_input<std::optional<T>>};
}

/// Asks what to do. Branches ask one at a time.
class Host : public smachac::TraceWriter {
public:
  explicit Host(smachac::Stop &root) : TraceWriter(stdout), root_(root) {}

  /// Writes events with full paths, as those of the interpreter.
  void on(const smachac::Event &event) override {
    smachac::Event shown = event;
    shown.place.path = event.place.full();
    TraceWriter::on(shown);
  }

  /// One visit of a leaf; the number of the outcome that it is to end with.
  int act(const char *path, smachac::Stop &stop, std::initializer_list<View> views) {
    const std::lock_guard<std::mutex> hold(asking_);
    std::string line = std::string("ask ") + path + " " + (stop.requested() ? "1" : "0");
    for (const View &view : views) {
      const std::string value = view.kind->show(view.key);
      line += value.empty() ? "" : std::string("\t") + view.name + "=" + value;
    }
    say(line);
    for (;;) {
      std::string reply;
      if (!std::getline(std::cin, reply)) {
        std::exit(3);
      }
      const std::string word = reply.substr(0, reply.find(' '));
      const std::string rest = reply.size() > word.size() ? reply.substr(word.size() + 1) : "";
      if (word == "end") {
        say("left");
        return std::stoi(rest);
      }
      if (word == "raise") {
        say("left");
#if defined(__cpp_exceptions)
        throw Told(rest);
#else
        std::exit(4);
#endif
      }
      if (word == "preempt") {
        root_.request();
      } else if (word == "service") {
        stop.service();
      } else {
        set(views, rest);
      }
    }
  }
  void say(const std::string &line) {
    std::puts(line.c_str());
    std::fflush(stdout);
  }

private:
  static void set(std::initializer_list<View> views, const std::string &rest) {
    const std::string name = rest.substr(0, rest.find(' '));
    const std::string value = rest.substr(name.size() + 1);
    for (const View &view : views) {
      if (name == view.name && view.kind->write != nullptr) {
        view.kind->write(view.key, Reader{value}.any());
      }
    }
  }

  smachac::Stop &root_;
  std::mutex asking_;
};

/// The kind of what was thrown at first.
inline std::string kind_of_current() {
#if defined(__cpp_exceptions)
  try {
    throw;
  } catch (const smachac::detail::NoOutcome &) {
    return "no_outcome";
  } catch (const smachac::MissingKey &) {
    return "missing_key";
  } catch (const smachac::detail::Undeclared &) {
    return "invalid_transition";
  } catch (const Told &told) {
    return told.kind;
  } catch (const std::exception &error) {
    try {
      std::rethrow_if_nested(error);
    } catch (...) {
      return kind_of_current();
    }
    return "other";
  }
#else
  return "other";
#endif
}

template <class T> void tell(std::string &line, const char *name, const smachac::Key<T> &key) {
  if (key.set()) {
    line += std::string(line.back() == '{' ? "" : ", ") + smachac::json(std::string(name)) + ": " +
            smachac::json(key.get());
  }
}

/// Run a machine so often; `tell_userdata` prints what its userdata holds.
template <class States, class Userdata, class Run, class Tell>
void play(const char *name, int runs, bool asked, Run run, Tell tell_userdata) {
  smachac::Stop stop;
  Host host(stop);
  host.say(std::string("case ") + name);
  States states(host);
  Userdata userdata;
  if (asked) {
    stop.request();
  }
  for (int i = 0; i < runs; ++i) {
    SMACHAC_TRY {
      host.say(std::string("outcome ") + name_of(run(states, userdata, &host, stop)));
    }
    SMACHAC_CATCH {
      host.say("error " + kind_of_current());
    }
    tell_userdata(host, userdata);
    host.say("run");
  }
}

} // namespace vectors
