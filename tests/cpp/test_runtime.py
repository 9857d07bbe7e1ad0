"""The headers of the runtime: keys, observers and requests to stop, called from small programs."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.version import __version__
from tests.cpp.compilers import BARE, COMPILERS, SANITIZED, STRICT, THREADED, Compiler, last_with
from tests.support.examples import every

LATE_REQUESTS = """
#include <memory>
#include "smachac/smachac.hpp"
struct Counter : smachac::Observer {
  explicit Counter(std::atomic<bool> &told) : told_(told) {}
  void on(const smachac::Event &event) override {
    ++events;
    if (std::strcmp(event.event, "preempt") == 0) {
      told_ = true;
      std::this_thread::yield();
    }
  }
  std::uint64_t events = 0;

private:
  std::atomic<bool> &told_;
};
int main() {
  smachac::Stop stop;
  enum class State : std::size_t { A };
  const smachac::Place places[] = {{"sm/A", ""}};
  for (int i = 0; i < 20; ++i) {
    std::atomic<bool> told{false};
    std::thread asks;
    {
      const auto observer = std::make_unique<Counter>(told);
      smachac::WatchedRun run(*observer, stop);
      for (int depth = 0; depth < 1000; ++depth) {
        run.enter(places, State::A);
      }
      asks = std::thread([&] { stop.request(); });
      while (!told) {
      }
    }
    asks.join();
    stop.service();
  }
}
"""


@pytest.mark.parametrize("flags", [SANITIZED, THREADED], ids=["address", "thread"])
@pytest.mark.slow
def test_a_request_uses_no_observer_of_a_run_that_has_ended(
    flags: tuple[str, ...], tmp_path: Path
) -> None:
    compiler = last_with(*flags)
    assert compiler.run(LATE_REQUESTS, tmp_path, *flags, "-O1", "-pthread") == ""


KEYS = """
#include <cstdlib>
#include <new>
#include "smachac/smachac.hpp"
static int made = 0;
void *operator new(std::size_t size) {
  ++made;
  if (void *found = std::malloc(size)) {
    return found;
  }
  throw std::bad_alloc();
}
void operator delete(void *what) noexcept { std::free(what); }
void operator delete(void *what, std::size_t) noexcept { std::free(what); }
int main() {
  const std::vector<std::string> names(10, std::string(100, 'x'));
  smachac::Key<std::vector<std::string>> key;
  key.hold(names);
  const int before = made;
  key.hold(names);
  key.replace(names);
  return made - before;
}
"""


@pytest.mark.slow
def test_a_copy_into_a_key_that_has_a_value_allocates_nothing(tmp_path: Path) -> None:
    assert last_with("-O1").run(KEYS, tmp_path, "-O1", "-pthread") == ""


WRITES = """
#include "smachac/smachac.hpp"
struct Counter : smachac::Observer {
  explicit Counter(bool wanted) : wanted_(wanted) {}
  void on(const smachac::Event &event) override { writes += event.key != nullptr ? 1 : 0; }
  bool wants_writes() const override { return wanted_; }
  int writes = 0;
private:
  bool wanted_;
};
int main() {
  for (const bool wanted : {true, false}) {
    Counter counter(wanted);
    smachac::Stop stop;
    smachac::WatchedRun run(counter, stop);
    run.start({"sm", ""});
    smachac::Key<std::int64_t> count;
    run.write("count", count, std::int64_t{1});
    std::printf("%d %d\\n", counter.writes, static_cast<int>(count.get()));
  }
}
"""


@pytest.mark.slow
def test_an_observer_that_wants_no_writes_gets_none(tmp_path: Path) -> None:
    assert last_with("-O0").run(WRITES, tmp_path, "-pthread") == "1 1\n0 1\n"


EDITS = """
#include "smachac/smachac.hpp"
int main() {
  smachac::Key<std::vector<std::string>> names;
  names.edit().push_back("door");
  names.edit().push_back("window");
  std::printf("%d %s\\n", static_cast<int>(names.get().size()), names.unchecked()[1].c_str());
  std::printf("%d %d\\n", static_cast<int>(names.fresh()), static_cast<int>(names.fresh()));
}
"""


@pytest.mark.slow
def test_a_value_that_is_changed_in_place_is_set_and_written(tmp_path: Path) -> None:
    assert last_with("-O0").run(EDITS, tmp_path, "-pthread") == "2 window\n1 0\n"


FAULTS = """
#include "smachac/smachac.hpp"
template <class Action> void attempt(Action action) {
  try {
    action();
    std::puts("no error");
  } catch (const smachac::Error &error) {
    std::puts(error.what());
  }
}
int main() {
  const smachac::Key<std::int64_t> key;
  attempt([&] { static_cast<void>(key.get()); });
  attempt([&] { std::printf("%d\\n", static_cast<int>(key + 1)); });
  attempt([] { smachac::sleep(std::numeric_limits<double>::quiet_NaN()); });
  attempt([] { smachac::sleep(-std::numeric_limits<double>::infinity()); });
}
"""


@pytest.mark.slow
def test_an_unset_key_and_a_sleep_without_a_length_are_errors(tmp_path: Path) -> None:
    unset = "reads a key that holds nothing\n"
    told = last_with("-O0").run(FAULTS, tmp_path, "-pthread")
    assert told == f"{unset}{unset}waits for `nan` seconds\nno error\n"


UNUSED = """
#include "smachac/smachac.hpp"
int main() {
  const smachac::Key<std::int64_t> key{1};
  smachac::Stop stop;
  CALL;
}
"""


@pytest.mark.parametrize("call", ["key.get()", "key.set()", "stop.requested()"])
@pytest.mark.slow
def test_a_result_that_is_not_used_is_a_warning(call: str, tmp_path: Path) -> None:
    text = UNUSED.replace("CALL", call)
    with pytest.raises(AssertionError, match=r"nodiscard|unused-result"):
        last_with("-O0").compile(text, tmp_path, "-fsyntax-only", "-pthread")


VERSION = """
#include "smachac/arm.hpp"
#include "smachac/program.hpp"
template <class... Types> void same(smachac::NAME::Key<Types> &...) {}
static_assert(std::is_same_v<smachac::NAME::Stop, smachac::Stop>);
static_assert(std::is_same_v<smachac::NAME::Pose, smachac::Pose>);
static_assert(std::is_same_v<smachac::NAME::Arm, smachac::Arm>);
static_assert(std::is_same_v<smachac::NAME::Program, smachac::Program>);
int main() {}
"""


@pytest.mark.slow
def test_the_names_of_the_runtime_have_its_version(tmp_path: Path) -> None:
    """Objects of two versions in one program do not link as if they were one."""
    text = VERSION.replace("NAME", f"v{__version__.replace('.', '_')}")
    assert last_with("-O0").compile(text, tmp_path, "-c", "-pthread").exists()


HEADERS = """
#include "smachac/arm.hpp"
#include "smachac/program.hpp"
int main() {}
"""


@COMPILERS
@pytest.mark.parametrize("bare", every(2, [BARE, ()]), ids=["bare", ""])
def test_the_headers_have_no_warnings(
    compiler: Compiler, bare: tuple[str, ...], tmp_path: Path
) -> None:
    assert compiler.compile(HEADERS, tmp_path, *STRICT, *bare, "-pthread", "-c").exists()
