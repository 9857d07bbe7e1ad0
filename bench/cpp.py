"""Generated C++ against a switch loop written by hand, in one program; and what compiling costs.

    python bench/cpp.py                  # speed: nanoseconds and instructions a transition
    python bench/cpp.py --scale 1000 10000

Both run the same three machines over objects with methods whose bodies the optimiser does not see,
over a typed struct of userdata. CPU time, minimum of interleaved rounds; instructions are those of
callgrind, where valgrind is installed.
"""

from __future__ import annotations

import argparse
import gc
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import build, check, read_machine
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.state_types import find_state_type
from smachac.targets.cpp import TARGET
from smachac.targets.cpp.user_classes import interface_hash

INCLUDE = Path(__file__).parents[1] / "smachac" / "runtime" / "cpp"
PLACED = "-falign-functions=32"
"""Where code comes to lie by chance moves the times of so short loops by a third."""
STEPS = 20_000_000
ROUNDS = 9
COUNTED = 1_000_000

HIT = """
name: Hit
input_keys: {count: int}
output_keys: {count: int}
outcomes: {again: {}, done: {}}
code: {cpp: {header: hit.hpp, class: bench::Hit}}
"""
HIT_HEADER = """
#pragma once
#include "smachac/smachac.hpp"
namespace bench {
struct Hit {
  enum class Outcome : std::uint8_t { again, done };
  struct In { std::int64_t count; };
  struct Out { smachac::Key<std::int64_t> &count; };
  static constexpr std::uint32_t smachac_interface = NUMBER;
  Outcome execute(In in, Out out);
};
struct Data { std::int64_t count = 0; };
struct HandHit {
  enum class Outcome : std::uint8_t { again, done };
  Outcome execute(Data &data);
};
}
"""
BODIES = """
#include "hit.hpp"
std::int64_t most = 0;
namespace bench {
Hit::Outcome Hit::execute(In in, Out out) {
  out.count = in.count + 1;
  return in.count + 1 < most ? Outcome::again : Outcome::done;
}
HandHit::Outcome HandHit::execute(Data &data) {
  data.count = data.count + 1;
  return data.count < most ? Outcome::again : Outcome::done;
}
}
"""
MAIN = """
#include <cstdlib>
#include <ctime>
extern std::int64_t most;
static double now() {
  timespec at;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &at);
  return static_cast<double>(at.tv_sec) * 1e9 + static_cast<double>(at.tv_nsec);
}
template <class Machine> double timed(Machine machine) {
  const double start = now();
  machine();
  return (now() - start) / static_cast<double>(most);
}
static void by_hand() { bench::Data data; hand::run(data); }
static void generated() {
  smachac::Stop stop;
  sm::States states;
  sm::Userdata userdata;
  sm::run(states, userdata, nullptr, stop);
}
int main(int argc, char **argv) {
  most = std::atoll(argv[1]);
  if (argc > 2) {
    argv[2][0] == 'h' ? by_hand() : generated();
    return 0;
  }
  double best[2] = {1e9, 1e9};
  for (int round = 0; round < ROUNDS; ++round) {
    best[0] = std::min(best[0], timed(by_hand));
    best[1] = std::min(best[1], timed(generated));
  }
  std::printf("%.3f %.3f\\n", best[0], best[1]);
}
"""


def leaf(name: str, following: str, done: str = "done", indent: int = 2) -> str:
    pad = " " * indent
    return f"{pad}- {name}: {{template: Hit, transitions: {{again: {following}, done: {done}}}}}"


def ring(count: int) -> tuple[str, str]:
    """So many states in a circle: the script, and the loop by hand."""
    names = [f"S{number}" for number in range(count)]
    onward = [*names[1:], names[0]]
    lines = [leaf(*pair) for pair in zip(names, onward, strict=True)]
    head = ["name: sm", "outcomes: [done]", "userdata: {count: 0}", "states:"]
    cases = [
        f"    case State::{name}: switch (states.{name}.execute(data)) {{\n"
        f"      case bench::HandHit::Outcome::again: state = State::{to}; break;\n"
        f"      case bench::HandHit::Outcome::done: return; }} break;"
        for name, to in zip(names, onward, strict=True)
    ]
    hand = [
        "namespace hand {",
        f"struct States {{ bench::HandHit {', '.join(names)}; }};",
        f"enum class State {{ {', '.join(names)} }};",
        "void run(bench::Data &data) {",
        "  States states;",
        "  State state = State::S0;",
        "  for (;;) switch (state) {",
        *cases,
        "  }",
        "}",
        "}",
    ]
    return "\n".join([*head, *lines, ""]), "\n".join(hand)


HIERARCHY = """
name: sm
outcomes: [done]
userdata: {count: 0}
states:
  - OUTER:
      template: StateMachine
      outcomes: [again, done]
      input_keys: [count]
      output_keys: [count]
      transitions: {again: OUTER, done: done}
      states:
        - INNER:
            template: StateMachine
            outcomes: [again, done]
            input_keys: [count]
            output_keys: [count]
            transitions: {again: LAST, done: done}
            states:
              - A: {template: Hit, transitions: {again: B, done: done}}
              - B: {template: Hit, transitions: {again: again, done: done}}
        - LAST: {template: Hit, transitions: {again: again, done: done}}
"""
HIERARCHY_HAND = """
namespace hand {
// Each level has data of its own, as SMACH's have: what comes in and goes out is copied.
using Outcome = bench::HandHit::Outcome;
struct Inner {
  bench::HandHit A, B;
  bench::Data data;
  Outcome run() {
    enum class State { A, B } state = State::A;
    for (;;) switch (state) {
      case State::A: switch (A.execute(data)) {
        case Outcome::again: state = State::B; break;
        case Outcome::done: return Outcome::done; } break;
      case State::B: return B.execute(data);
    }
  }
};
struct Outer {
  Inner INNER;
  bench::HandHit LAST;
  bench::Data data;
  Outcome run() {
    enum class State { INNER, LAST } state = State::INNER;
    for (;;) switch (state) {
      case State::INNER: {
        INNER.data.count = data.count;
        const Outcome outcome = INNER.run();
        data.count = INNER.data.count;
        switch (outcome) {
        case Outcome::again: state = State::LAST; break;
        case Outcome::done: return Outcome::done; } break;
      }
      case State::LAST: return LAST.execute(data);
    }
  }
};
void run(bench::Data &data) {
  Outer outer;
  for (;;) {
    outer.data.count = data.count;
    const Outcome outcome = outer.run();
    data.count = outer.data.count;
    if (outcome == Outcome::done) return;
  }
}
}
"""


def header(script: str) -> tuple[str, float]:
    """The header of a script, and the seconds that printing it took."""
    library = memory_library({"templates/Hit.yml": HIT}, disk_library(Path("main.yml"), []))
    report: Report = []
    machine = read_machine(Source("main.yml", script), library, report)
    assert machine is not None, report
    checked = check(machine, report)
    assert checked is not None, report
    start = time.process_time()
    (text,) = build(checked, TARGET, library, []).values()
    return text, time.process_time() - start


def number() -> str:
    library = memory_library({"templates/Hit.yml": HIT}, disk_library(Path("main.yml"), []))
    type_ = find_state_type("Hit", library, [])
    assert type_ is not None
    return interface_hash(type_)


def compiled(folder: Path, script: str, hand: str, compiler: str) -> Path:
    text, _ = header(script)
    (folder / "hit.hpp").write_text(HIT_HEADER.replace("NUMBER", number()))
    (folder / "bodies.cpp").write_text(BODIES)
    (folder / "main.cpp").write_text(
        text.replace("#pragma once\n", "") + hand + MAIN.replace("ROUNDS", str(ROUNDS))
    )
    program = folder / "program"
    call = [compiler, "-std=c++17", "-O2", PLACED, f"-I{INCLUDE}", f"-I{folder}", "-pthread"]
    files = [str(folder / "main.cpp"), str(folder / "bodies.cpp")]
    subprocess.run([*call, *files, "-o", str(program)], check=True)
    return program


def instructions(program: Path, which: str) -> float:
    """Instructions a transition."""
    call = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program)]
    counts = []
    for steps in (COUNTED, 2 * COUNTED):
        ended = subprocess.run([*call, str(steps), which], capture_output=True, text=True)
        found = re.search(r"Collected : (\d+)", ended.stderr)
        assert found is not None, ended.stderr
        counts.append(int(found.group(1)))
    return (counts[1] - counts[0]) / COUNTED


def speed(compiler: str, steps: int) -> Iterator[str]:
    """Lines of a table."""
    yield "| machine | by hand, ns | smachac | ratio | by hand, instructions | smachac | ratio |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    machines = {
        "ping-pong": ring(2),
        "ring of 100": ring(100),
        "3 levels": (HIERARCHY, HIERARCHY_HAND),
    }
    for name, (script, hand) in machines.items():
        with tempfile.TemporaryDirectory() as folder:
            program = compiled(Path(folder), script, hand, compiler)
            told = subprocess.run([program, str(steps)], capture_output=True, text=True, check=True)
            ours, theirs = map(float, told.stdout.split())
            row = [f"{ours:.2f}", f"{theirs:.2f}", f"{theirs / ours:.2f}"]
            if shutil.which("valgrind"):
                counts = [instructions(program, which) for which in ("hand", "generated")]
                row += [f"{counts[0]:.1f}", f"{counts[1]:.1f}", f"{counts[1] / counts[0]:.2f}"]
            yield f"| {name} | {' | '.join(row)} |"


USED = """
sm::Outcome used(sm::States &states, sm::Userdata &ud, smachac::Stop &stop) {
  return sm::run(states, ud, nullptr, stop);
}
"""
"""Without it there is nothing to compile: all of a header is inline."""


def scale(counts: list[int], compiler: str, flags: list[str]) -> Iterator[str]:
    yield f"| states | smachac prints, s | {compiler} {' '.join(flags)}, s | MB |"
    yield "| --- | --- | --- | --- |"
    for count in counts:
        text, seconds = header(ring(count)[0])
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "hit.hpp").write_text(HIT_HEADER.replace("NUMBER", number()))
            main = Path(folder) / "main.cpp"
            main.write_text(text.replace("#pragma once\n", "") + USED)
            call = [compiler, "-std=c++17", *flags, f"-I{INCLUDE}", f"-I{folder}", "-c", str(main)]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run([*call, "-o", str(Path(folder) / "main.o")], check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        yield f"| {count} | {seconds:.2f} | {spent:.1f} | {after.ru_maxrss / 1024:.0f} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scale", type=int, nargs="*", help="numbers of states to compile")
    parser.add_argument("--compiler", default="g++")
    parser.add_argument("--flags", default="-O1", help="of the compiler, for --scale")
    parser.add_argument("--steps", type=int, default=STEPS)
    given = parser.parse_args()
    gc.disable()  # as `smachac` does
    if given.scale:
        lines = scale(given.scale, given.compiler, given.flags.split())
    else:
        lines = speed(given.compiler, given.steps)
    for line in lines:
        print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
