"""Generated C++ against loops written by hand, in one program; and what compiling costs.

    python bench/cpp.py                              # g++ and clang++, those that are installed
    python bench/cpp.py --scale 1000 10000           # compile a ring of so many states
    python bench/cpp.py --scale 10000 --containers 20    # the same in containers of 20 states
    python bench/cpp.py --step                       # stepped machines: instructions a step
    python bench/cpp.py --flash                      # stepped machines on a Cortex-M4: bytes

The machines and the loops (bench/cpp_machines) run the same bodies of states, which the optimiser
does not see. CPU time, minimum of interleaved rounds; instructions are those of callgrind, where
valgrind is installed. `watched` is the machine with an Observer that counts events, `with writes`
with one that gets the writes too, `counted` with an observer of another class (a template).
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
from collections.abc import Iterator, Mapping
from pathlib import Path

import cpp_machines as machines

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import build, check, read_machine
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.frontend.types.state_types import find_state_type
from smachac.targets.cpp import TARGET
from smachac.targets.cpp.user_classes import interface_hash

INCLUDE = Path(__file__).parents[1] / "smachac" / "runtime" / "cpp"
BODIES = Path(__file__).parent / "cpp_machines"
PLACED = "-falign-functions=32"
"""Without a fixed alignment of functions the times of such short loops differ by a third."""
STEPS = 10_000_000
COUNTED = 100_000
WAYS = ("by_hand", "alone", "watched", "with_writes", "counted")

WORKLOADS = {
    "ping-pong": (machines.ring(2), machines.ring_by_hand(2)),
    "ring of 100": (machines.ring(100), machines.ring_by_hand(100)),
    "3 levels, a number": (machines.levels("Hit"), machines.levels_by_hand("Hit")),
    "3 levels, a PoseStamped": (machines.levels("HitPose"), machines.levels_by_hand("HitPose")),
    "3 levels, a list of strings": (
        machines.levels("HitNames"),
        machines.levels_by_hand("HitNames"),
    ),
}


STEPPED = {
    "ping-pong": (machines.ring(2), machines.stepped_ring_by_hand(2)),
    "ring of 10": (machines.ring(10), machines.stepped_ring_by_hand(10)),
    "ring of 100": (machines.ring(100), machines.stepped_ring_by_hand(100)),
    "ring of 1,000": (machines.ring(1000), machines.stepped_ring_by_hand(1000)),
    "3 levels, a number": (machines.levels("Hit"), machines.stepped_levels_by_hand("Hit")),
    "3 levels, a PoseStamped": (
        machines.levels("HitPose"),
        machines.stepped_levels_by_hand("HitPose"),
    ),
    "3 levels, a list of strings": (
        machines.levels("HitNames"),
        machines.stepped_levels_by_hand("HitNames"),
    ),
}
OPTIONS = {"mode": "step", "text": "32", "list": "4"}


def library(header: str = "bodies.hpp") -> Library:
    files = {f"templates/{name}.yml": machines.interface(name, header) for name in machines.HITS}
    return memory_library(files, disk_library(Path("main.yml"), []))


def header(script: str, options: Mapping[str, str] = {}) -> tuple[str, float]:
    """The header of a script, and the seconds that printing it took."""
    types = library("step_bodies.hpp" if options else "bodies.hpp")
    report: Report = []
    machine = read_machine(Source("main.yml", script), types, report)
    assert machine is not None, report
    checked = check(machine, report)
    assert checked is not None, report
    start = time.process_time()
    files = build(checked, TARGET, types, report, options)
    assert files, report
    (text,) = files.values()
    return text.replace("#pragma once\n", ""), time.process_time() - start


def hashes() -> list[str]:
    """The compiler's flags for the hashes of the interfaces, which the classes contain."""
    types = library()
    found = {name: find_state_type(name, types, []) for name in machines.HITS}
    return [f"-DHASH_{name}={interface_hash(type_)}" for name, type_ in found.items() if type_]


def command(compiler: str, *flags: str) -> list[str]:
    return [compiler, "-std=c++17", *flags, f"-I{INCLUDE}", f"-I{BODIES}", *hashes()]


def compiled(folder: Path, script: str, by_hand: str, compiler: str) -> Path:
    """The program of a machine and its loop by hand."""
    text, _ = header(script)
    main = folder / "main.cpp"
    main.write_text(f'{text}{by_hand}#include "main.hpp"\n')
    program = folder / "program"
    call = command(compiler, "-O2", PLACED, "-pthread")
    subprocess.run([*call, main, BODIES / "bodies.cpp", "-o", program], check=True)
    return program


def instructions(program: Path, count: int, way: str) -> float:
    """Instructions of one of `count` transitions or, if it is negative, of one step that waits."""
    call = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", str(program)]
    counts = []
    for steps in (count, 2 * count):
        ended = subprocess.run([*call, way, str(steps)], capture_output=True, text=True)
        found = re.search(r"Collected : (\d+)", ended.stderr)
        assert found is not None, ended.stderr
        counts.append(int(found.group(1)))
    return (counts[1] - counts[0]) / abs(count)


def speed(compiler: str, steps: int) -> Iterator[str]:
    """Lines of a table."""
    yield f"| {compiler} | by hand | smachac | ratio | watched | with writes | counted |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for name, (script, by_hand) in WORKLOADS.items():
        with tempfile.TemporaryDirectory() as folder:
            program = compiled(Path(folder), script, by_hand, compiler)
            ran = subprocess.run(
                [program, "all", str(steps)], capture_output=True, text=True, check=True
            )
            rows = {"ns": [float(each) for each in ran.stdout.split()]}
            if shutil.which("valgrind"):
                rows["instructions"] = [instructions(program, COUNTED, way) for way in WAYS]
            for unit, (hand, alone, watched, writes, counted) in rows.items():
                cells = [f"{hand:.1f}", f"{alone:.1f}", f"{alone / hand:.2f}"]
                cells += [f"{watched:.0f}", f"{writes:.0f}", f"{counted:.1f}"]
                yield f"| {name}, {unit} | {' | '.join(cells)} |"


USED = """
sm::Outcome used(sm::States &states, sm::Userdata &ud, smachac::Stop &stop) {
  return sm::run(states, ud, nullptr, stop);
}
"""
"""Without it there is nothing to compile: all of a header is inline."""


def stepped(compiler: str) -> Iterator[str]:
    """Lines of a table: instructions of a step with a transition, and of one that waits."""
    yield f"| {compiler}, stepped | by hand | smachac | ratio | counted | waits, by hand | waits |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    for name, (script, by_hand) in STEPPED.items():
        with tempfile.TemporaryDirectory() as folder:
            text, _ = header(script, OPTIONS)
            main = Path(folder) / "main.cpp"
            main.write_text(f'{text}{by_hand}#include "step_main.hpp"\n')
            program = Path(folder) / "program"
            call = command(compiler, "-O2", "-fno-exceptions", "-fno-rtti")
            files = [str(main), str(BODIES / "step_bodies.cpp"), "-o", str(program)]
            subprocess.run([*call, *files], check=True)
            hand, own, counted = (
                instructions(program, COUNTED, way) for way in ("by_hand", "stepped", "counted")
            )
            waits = [instructions(program, -COUNTED, way) for way in ("by_hand", "stepped")]
            cells = [f"{hand:.1f}", f"{own:.1f}", f"{own / hand:.2f}", f"{counted:.1f}"]
            yield f"| {name} | {' | '.join([*cells, *(f'{each:.1f}' for each in waits)])} |"


FLASH_ENTRY = """
static {machine} machine;
extern "C" bool entry(std::int64_t now) {{ return machine.step(now){running}; }}
"""
HAND = """
#include <cstdint>
namespace bench::by_hand {
struct Data { std::int64_t now = 0, count = 0; };
enum class Outcome : std::uint8_t { running, again, done };
struct Hit { Outcome step(Data &data); };
}
"""
"""The state and the data of a ring by hand, without those of other machines."""

CORTEX = ("-mcpu=cortex-m4", "-mthumb", "-Os", "-ffreestanding", "-fno-exceptions", "-fno-rtti")
SECTIONS = ("-fno-threadsafe-statics", "-ffunction-sections", "-fdata-sections")


def flash() -> Iterator[str]:
    """Lines of a table: flash and RAM of machines on a Cortex-M4, with the bodies of the states."""
    yield "| Cortex-M4, -Os | flash by hand, bytes | smachac | ratio | RAM by hand | smachac |"
    yield "| --- | --- | --- | --- | --- | --- |"
    for count in (5, 20, 100):
        text, _ = header(machines.ring(count), OPTIONS)
        by_hand = machines.stepped_ring_by_hand(count)
        hand = HAND + by_hand + FLASH_ENTRY.format(machine="hand::Machine", running="")
        own = text + FLASH_ENTRY.format(machine="sm::Machine<>", running=".is_running()")
        sizes = [_sizes(each) for each in (hand, own)]
        ratio = sizes[1][0] / sizes[0][0]
        cells = [sizes[0][0], sizes[1][0], f"{ratio:.2f}", sizes[0][1], sizes[1][1]]
        yield f"| ring of {count} | {' | '.join(map(str, cells))} |"


def _sizes(text: str) -> tuple[int, int]:
    """The bytes of flash and RAM that a machine adds."""
    with tempfile.TemporaryDirectory() as folder:
        unit = Path(folder) / "unit.cpp"
        unit.write_text(text)
        call = command("arm-none-eabi-g++", *CORTEX, *SECTIONS)
        subprocess.run([*call, "-c", str(unit), "-o", f"{folder}/unit.o"], check=True)
        link = ["arm-none-eabi-g++", *CORTEX, "-nostdlib", "-Wl,--gc-sections,-eentry,-uentry"]
        link += ["-Wl,--unresolved-symbols=ignore-all", f"{folder}/unit.o"]
        subprocess.run([*link, "-lgcc", "-o", f"{folder}/unit.elf"], check=True)
        listed = subprocess.run(
            ["arm-none-eabi-size", f"{folder}/unit.elf"], capture_output=True, text=True, check=True
        )
        code, data, zero = map(int, listed.stdout.splitlines()[1].split()[:3])
        return code + data, data + zero


def scale(counts: list[int], size: int, compiler: str, flags: list[str]) -> Iterator[str]:
    """Lines of a table: what compiling machines of so many states costs."""
    yield f"| states | generation, s | {compiler} {' '.join(flags)}, s | MB |"
    yield "| --- | --- | --- | --- |"
    for count in counts:
        script = machines.containers(count, size) if size else machines.ring(count)
        text, seconds = header(script)
        with tempfile.TemporaryDirectory() as folder:
            main = Path(folder) / "main.cpp"
            main.write_text(text + USED)
            call = [*command(compiler, *flags), "-c", str(main), "-o", f"{folder}/main.o"]
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            subprocess.run(call, check=True)
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
        spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        yield f"| {count} | {seconds:.2f} | {spent:.1f} | {after.ru_maxrss / 1024:.0f} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scale", type=int, nargs="*", help="numbers of states to compile")
    parser.add_argument("--containers", type=int, default=0, help="states a container, for --scale")
    parser.add_argument("--compiler", nargs="*", default=["g++", "clang++"])
    parser.add_argument("--flags", default="-O1", help="of the compiler, for --scale")
    parser.add_argument("--flash", action="store_true", help="flash and RAM on a Cortex-M4")
    parser.add_argument("--step", action="store_true", help="stepped machines")
    parser.add_argument("--steps", type=int, default=STEPS)
    given = parser.parse_args()
    gc.disable()  # as `smachac` does
    if given.flash:
        print("\n".join(flash()))
        return 0
    for compiler in filter(shutil.which, given.compiler):
        if given.step:
            lines = stepped(compiler)
        elif given.scale:
            lines = scale(given.scale, given.containers, compiler, given.flags.split())
        else:
            lines = speed(compiler, given.steps)
        for line in lines:
            print(line, flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
