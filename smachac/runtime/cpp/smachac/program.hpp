// Made by smachac, as it is for every machine: do not edit.
//
// The program around a machine: reads the option `--trace FILE`, makes Ctrl-C, SIGTERM and SIGHUP
// preempt requests, prints the outcome at the end. For POSIX.
#ifndef SMACHAC_PROGRAM_HPP
#define SMACHAC_PROGRAM_HPP

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <thread>

#include "smachac/smachac.hpp"

namespace smachac {
inline namespace v0_1_0 {

namespace detail {

/// The signal handling of a program, during the lifetime of the object: the first SIGINT, SIGTERM
/// or SIGHUP sends a preempt request, the second one ends the program with the exit code 128 +
/// signal number. Signals that are ignored, as SIGHUP is below nohup, stay so. A thread of the
/// object receives the signals. They are blocked in the thread that creates the object and in the
/// threads that it starts later.
class Listener {
public:
  explicit Listener(Stop &stop) {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGTERM); // always, the destructor sends it
    for (const int number : {SIGINT, SIGHUP}) {
      struct sigaction known {};
      sigaction(number, nullptr, &known);
      if (known.sa_handler != SIG_IGN) {
        sigaddset(&signals_, number);
      }
    }
    pthread_sigmask(SIG_BLOCK, &signals_, &before_);
    thread_ = std::thread([this, &stop] { listen(stop); });
  }
  Listener(const Listener &) = delete;
  Listener &operator=(const Listener &) = delete;

  /// The number of the first signal; 0 if there was none.
  int signal() const { return first_; }

  ~Listener() {
    over_ = true;
    pthread_kill(thread_.native_handle(), SIGTERM);
    thread_.join();
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  }

private:
  void listen(Stop &stop) {
    int signal = 0;
    sigwait(&signals_, &signal);
    if (over_) {
      return;
    }
    first_ = signal;
    stop.request();
    sigwait(&signals_, &signal);
    if (!over_) {
      std::_Exit(128 + signal);
    }
  }

  sigset_t signals_{};
  sigset_t before_{};
  std::atomic<bool> over_{false};
  std::atomic<int> first_{0};
  std::thread thread_{};
};

} // namespace detail

/// The command line of a program and the run of its machine.
class Program {
public:
  /// Reads the arguments. Prints the usage and exits with the code 2 if they are invalid.
  Program(int count, char **arguments) {
    for (int i = 1; i < count; ++i) {
      if (std::strcmp(arguments[i], "--trace") != 0 || i + 1 == count) {
        std::fprintf(stderr, "usage: %s [--trace FILE]\n", arguments[0]);
        std::exit(2);
      }
      trace_ = arguments[++i];
    }
  }

  /// Runs a machine and prints the name of its outcome. `machine` takes an Observer * and a Stop &
  /// and returns this name. Returns the exit code for `main`: after a signal 128 + its number, else
  /// 0, or 1 if the machine threw an exception or the trace file could not be opened or completely
  /// written.
  template <class Machine> int run(Machine machine) {
    std::FILE *file = nullptr;
    if (trace_ != nullptr) {
      file = std::fopen(trace_, "w");
      if (file == nullptr) {
        std::perror(trace_);
        return 1;
      }
    }
    TraceWriter writer(file);
    Stop stop;
    const detail::Listener listener(stop);
    int code = ended(machine, file != nullptr ? &writer : nullptr, stop);
    if (file != nullptr) {
      const bool bad = std::ferror(file) != 0;
      if (std::fclose(file) != 0 || bad) {
        std::fprintf(stderr, "%s: not all of the trace was written\n", trace_);
        code = 1;
      }
    }
    std::fflush(stdout);
    return listener.signal() != 0 ? 128 + listener.signal() : code;
  }

private:
  template <class Machine> int ended(Machine &machine, Observer *observer, Stop &stop) {
#if defined(__cpp_exceptions)
    try {
      std::printf("outcome: %s\n", machine(observer, stop));
    } catch (const std::exception &error) {
      std::fprintf(stderr, "error: %s\n", error.what());
      return 1;
    }
#else
    std::printf("outcome: %s\n", machine(observer, stop));
#endif
    return 0;
  }

  const char *trace_ = nullptr;
};

} // namespace v0_1_0
} // namespace smachac

#endif
