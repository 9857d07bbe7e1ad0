"""The runtime of stepped machines: bounds, failures, first steps, time limits and stop requests."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import build, check, read_machine
from smachac.frontend.loader import memory_library
from smachac.frontend.types.state_types import find_state_type
from smachac.targets.cpp import TARGET
from smachac.targets.cpp.user_classes import interface_hash
from tests.cpp.compiled_traces import LIBRARY
from tests.cpp.compilers import BARE, COMPILERS, Compiler

SCRIPT = """
name: sm
outcomes: [done, late, failed, stopped]
input_keys: {ticks: int}
userdata: {names: []}
states:
  - COUNT:
      template: Count
      timeout: 1.0
      transitions: {done: GROW, timeout: late, preempted: stopped}
  - GROW:
      template: Grow
      transitions: {done: GROW, full: done}
"""
COUNT = """
name: Count
input_keys: {ticks: int}
outcomes: {done: {}, preempted: {}}
code: {cpp: {header: states.hpp, class: "own::Count", with: "own::Log& log"}}
"""
GROW = """
name: Grow
output_keys: {names: "list[str<=4]<=2"}
outcomes: {done: {}, full: {}}
code: {cpp: {header: states.hpp, class: "own::Grow"}}
"""
CLASSES = """
#include <cstdio>
#include <cstdlib>
#include "smachac/step.hpp"
#define CHECK(test) \\
  if (!(test)) { std::fprintf(stderr, "line %d: %s\\n", __LINE__, #test); std::exit(1); }
namespace own {
struct Log { int starts = 0, firsts = 0, steps = 0; };
class Count {
public:
  enum class Outcome : std::uint8_t { done, preempted };
  struct In { std::int64_t ticks; };
  static constexpr std::uint32_t smachac_interface = HASH_Count;
  constexpr explicit Count(Log &log) : log_(log) {}
  void start(smachac::step::Context &, In) { ++log_.starts; left_ = 0; }
  smachac::step::Result<Outcome> step(smachac::step::Context &context, In in) {
    log_.firsts += context.first ? 1 : 0;
    ++log_.steps;
    if (context.stop_requested()) {
      context.service();
      return Outcome::preempted;
    }
    return ++left_ < in.ticks ? smachac::step::Result<Outcome>(smachac::step::running)
                              : Outcome::done;
  }
private:
  Log &log_;
  std::int64_t left_ = 0;
};
class Grow {
public:
  enum class Outcome : std::uint8_t { done, full };
  struct Out { smachac::step::Key<smachac::step::List<smachac::step::TextOf<4>>> &names; };
  static constexpr std::uint32_t smachac_interface = HASH_Grow;
  smachac::step::Result<Outcome> step(smachac::step::Context &, Out out) {
    out.names.push_back("ab");
    return Outcome::done;
  }
};
}
"""
MAIN = """
void texts() {
  smachac::step::TextOf<4> text("abcd");
  CHECK(!text.assign("abcde") && text == "abcd" && text.went_over() && !text.went_over());
  CHECK(!text.append("e") && text.size() == 4);
  const auto &same = text;
  text = same;
  CHECK(text == "abcd");
  smachac::step::Key<smachac::step::ListOf<std::int64_t, 4>> list;
  smachac::step::Fault fault;
  list.write(fault, "list", std::array<std::int64_t, 2>{1, 2});
  using smachac::step::py::concat;
  list.write(fault, "list",
             concat<std::int64_t>(fault, std::array<std::int64_t, 1>{7}, list.get()));
  CHECK(list.size() == 3 && list[0] == 7 && list[1] == 1 && list[2] == 2 && !fault.has_failed());
  list.write(fault, "list", concat<std::int64_t>(fault, list.get(), list.get()));
  CHECK(fault.has_failed() && std::string_view(fault.key()) == "list" && list.size() == 3);
  CHECK(smachac::step::nanoseconds(0.5) == 500'000'000 && smachac::step::nanoseconds(-1.0) == 0);
}

int main() {
  texts();
  own::Log log;
  sm::Machine<> machine(log);
  smachac::step::Fault fault;
  machine.userdata.ticks.hold(fault, "ticks", std::int64_t{3});
  // Three steps of COUNT, the first of which is `first`; then one of GROW for each step.
  CHECK(machine.step(0).is_running() && log.starts == 1 && log.firsts == 1);
  CHECK(machine.step(1).is_running() && machine.step(2).is_running() && log.steps == 3);
  CHECK(log.starts == 1 && log.firsts == 1);
  CHECK(machine.step(3).is_running() && machine.userdata.names.size() == 1);
  CHECK(machine.step(4).is_running() && machine.userdata.names.size() == 2);
  auto result = machine.step(5);
  CHECK(result.has_failed() && std::string_view(machine.failure().key) == "names");
  CHECK(std::string_view(machine.failed_state().path) == "sm/GROW");
  CHECK(machine.userdata.names.size() == 2);
  // After a failure the machine starts again. Its time limit begins with its first step.
  machine.userdata.ticks.hold(fault, "ticks", std::int64_t{100});
  CHECK(machine.step(1'000'000'000).is_running() && log.starts == 2);
  CHECK(machine.step(1'999'999'999).is_running());
  result = machine.step(2'000'000'000); // asked to stop, after its turn
  CHECK(result.is_running());
  result = machine.step(2'000'000'001);
  CHECK(result.has_ended() && result.outcome() == sm::Outcome::late);
  // A state that ends in the step in which its time is over has its own outcome.
  machine.userdata.ticks.hold(fault, "ticks", std::int64_t{2});
  CHECK(machine.step(0).is_running() && machine.step(1'000'000'000).is_running());
  machine.userdata.names.edit().clear();
  CHECK(machine.step(1'000'000'001).is_running() && machine.userdata.names.size() == 1);
  // A stop request before the start reaches the first state.
  sm::Machine<> other(log);
  other.userdata.ticks.hold(fault, "ticks", std::int64_t{5});
  other.request_stop();
  result = other.step(0);
  CHECK(result.has_ended() && result.outcome() == sm::Outcome::stopped);
  // An unset key.
  sm::Machine<> unset(log);
  result = unset.step(0);
  CHECK(result.has_failed() && std::string_view(unset.failure().key) == "ticks");
  return 0;
}
"""


@COMPILERS
def test_runtime(compiler: Compiler, tmp_path: Path) -> None:
    library = memory_library({"templates/Count.yml": COUNT, "templates/Grow.yml": GROW}, LIBRARY)
    report: Report = []
    machine = read_machine(Source("main.yml", SCRIPT), library, report)
    assert machine is not None, report
    checked = check(machine, report)
    assert checked is not None, report
    options = {"mode": "step", "text": "4", "list": "2"}
    (header,) = build(checked, TARGET, library, report, options).values() or [""]
    text = "\n".join(line for line in header.splitlines() if not line.startswith("#"))
    flags = []
    for name in ("Count", "Grow"):
        type_ = find_state_type(name, library, [])
        assert type_ is not None
        flags.append(f"-DHASH_{name}={interface_hash(type_)}")
    compiler.run(CLASSES + text + MAIN, tmp_path, *BARE, *flags)


def test_a_generated_header_has_the_layout_of_clang_format(tmp_path: Path) -> None:
    import shutil
    import subprocess

    from tests.cpp.compilers import CLANG_FORMAT

    tool = shutil.which("clang-format")
    if tool is None:
        pytest.skip("no clang-format")
    from tests.cpp.test_step_example import generated

    folder = generated(tmp_path / "generated").removeprefix("-I")
    style = f"--style={{{', '.join(CLANG_FORMAT.splitlines())}}}"
    call = [tool, style, "--dry-run", "-Werror", f"{folder}/grip.hpp"]
    run = subprocess.run(call, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr[:3000]
