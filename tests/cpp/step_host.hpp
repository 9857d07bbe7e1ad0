// The leaves of recorded machines that are stepped: what they do is told by whoever reads our
// output, line by line.
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <iostream>
#include <string>

#include "smachac/step_trace.hpp"

namespace vectors {

inline void print(void *, const char *text, std::size_t size) {
  std::fwrite(text, 1, size, stdout);
}

template <class T> std::string json(const T &value) {
  std::string text;
  smachac::step::write_json({&text,
                             [](void *self, const char *part, std::size_t size) {
                               static_cast<std::string *>(self)->append(part, size);
                             }},
                            value);
  return text;
}

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
  template <class T> void give(T &to) {
    const char kind = text[place++];
    if constexpr (std::is_same_v<T, bool>) {
      to = kind == 't';
    } else if constexpr (std::is_integral_v<T>) {
      std::size_t used = 0;
      to = std::stoll(text.substr(place), &used);
      place += used;
    } else if constexpr (smachac::detail::is_text<T>::value) {
      const std::size_t size = count();
      to.assign(std::string_view(text).substr(place, size));
      place += size;
    } else if constexpr (smachac::detail::is_array<T>::value) {
      count();
      for (auto &item : to) {
        give(item);
      }
    } else if constexpr (smachac::detail::is_list<T>::value) {
      to.clear();
      for (std::size_t left = count(); left > 0; --left) {
        typename T::value_type item{};
        give(item);
        to.push_back(item);
      }
    } else if constexpr (smachac::detail::is_optional<T>::value) {
      to.reset();
      if (kind != 'n') {
        --place;
        give(to.emplace());
      }
    }
  }
};

/// A key of a leaf, whatever its type: shown as JSON, empty where it holds nothing, and written.
struct View {
  const char *name;
  void *key;
  std::string (*show)(const void *key);
  void (*write)(void *key, Reader reader);
};
template <class T> View view(const char *name, smachac::step::Key<T> &key) {
  return {name, &key,
          [](const void *held) {
            const auto &own = *static_cast<const smachac::step::Key<T> *>(held);
            return own.set() ? json(own.get()) : std::string();
          },
          [](void *held, Reader reader) {
            reader.give(static_cast<smachac::step::Key<T> *>(held)->edit());
          }};
}
template <class T> View view(const char *name, const std::optional<T> &value) {
  return {name, const_cast<std::optional<T> *>(&value),
          [](const void *held) {
            const auto &own = *static_cast<const std::optional<T> *>(held);
            return own.has_value() ? json(*own) : std::string();
          },
          nullptr};
}

/// Asks what to do.
class Host : public smachac::step::TraceWriter {
public:
  Host() : TraceWriter({nullptr, print}, true) {}

  void (*request_stop)(void *machine) = nullptr;
  void *machine = nullptr;

  /// One visit of a leaf; the number of the outcome that it is to end with, -1 for an error.
  int act(const char *path, smachac::step::Context &context, std::initializer_list<View> views) {
    std::string line = std::string("ask ") + path + " " + (context.stop_requested() ? "1" : "0");
    for (const View &view : views) {
      const std::string value = view.show(view.key);
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
        return rest == "-1" ? 255 : std::stoi(rest);
      }
      if (word == "raise") {
        say("left");
        static std::deque<std::string> kept;
        context.error(kept.emplace_back(rest).c_str());
        return -1;
      }
      if (word == "preempt") {
        request_stop(machine);
      } else if (word == "service") {
        context.service();
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
      if (name == view.name && view.write != nullptr) {
        view.write(view.key, Reader{value});
      }
    }
  }
};

/// The kind of a failure.
inline std::string kind_of(const smachac::step::Failure &failure) {
  const std::string message = failure.message;
  return message == "ended without an outcome"              ? "no_outcome"
         : message == "reads a key that holds nothing"      ? "missing_key"
         : message == "ended with an outcome that leads nowhere" ? "invalid_transition"
         : message.find(' ') == std::string::npos           ? message
                                                            : "other";
}

template <class T> void tell(std::string &line, const char *name, const smachac::step::Key<T> &key) {
  if (key.set()) {
    line += std::string(line.back() == '{' ? "" : ", ") + json(std::string_view(name)) + ": " +
            json(key.get());
  }
}

/// Run a machine so often; `tell_userdata` prints what its userdata holds.
template <class Machine, class Tell>
void play(const char *name, int runs, bool asked, Tell tell_userdata) {
  Host host;
  host.say(std::string("case ") + name);
  Machine machine(host, host);
  host.machine = &machine;
  host.request_stop = [](void *self) { static_cast<Machine *>(self)->request_stop(); };
  if (asked) {
    machine.request_stop();
  }
  for (int i = 0; i < runs; ++i) {
    std::int64_t now = 0;
    auto result = machine.step(now);
    while (result.is_running()) {
      result = machine.step(++now);
    }
    host.say(result.has_failed() ? "error " + kind_of(machine.failure())
                                 : std::string("outcome ") + name_of(result.outcome()));
    tell_userdata(host, machine.userdata);
    host.say("run");
  }
}

} // namespace vectors
