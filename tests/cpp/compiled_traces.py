"""Many machines in one C++ program, which prints their traces."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from smachac.diagnostics.diagnostic import Report
from smachac.driver import build
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, Machine
from smachac.ir.script_paths import script_paths
from smachac.runtime.tracing.writer import with_shown_paths
from smachac.targets.cpp import TARGET
from tests.cpp.compilers import Compiler
from tests.support.typed_machines import with_state_types

ROOT = Path(__file__).parents[2]
LIBRARY = disk_library(ROOT / "main.yml", [])

Event = dict[str, Any]
Asked = tuple[str, int]
"""The path of a leaf, and the number of the visit in which the machine is asked to stop."""

Part = tuple[Machine, str, Asked]
"""A machine, its header, and when it is asked to stop."""

NOBODY: Asked = ("", 0)

MAIN = """
#include <cstdio>
#include <cstdlib>

struct Asking : smachac::TraceWriter {
  Asking(const char *path, int visit, smachac::Stop &stop)
      : TraceWriter(stdout), path_(path), left_(visit), stop_(stop) {}
  void on(const smachac::Event &event) override {
    TraceWriter::on(event);
    if (std::strcmp(event.event, "enter") == 0 && std::strcmp(event.place.full(), path_) == 0 &&
        --left_ == 0) {
      stop_.request();
    }
  }
  const char *path_;
  int left_;
  smachac::Stop &stop_;
};

template <class States, class Userdata, class Run>
void traced(const char *path, int visit, Run run) {
  smachac::Stop stop;
  Asking observer(path, visit, stop);
  States states{};
  Userdata userdata;
  SMACHAC_TRY { run(states, userdata, &observer, stop); }
  SMACHAC_CATCH {}
  std::puts("--");
  if (visit == 0) {
    SMACHAC_TRY {
      States others{};
      Userdata other;
      smachac::Stop never;
      std::printf("%s", name(run(others, other, nullptr, never)));
    }
    SMACHAC_CATCH {}
  }
  std::puts("\\n--");
}
"""


def named(machine: Machine, name: str) -> Machine:
    """The machine under another name."""
    return dataclasses.replace(machine, root=dataclasses.replace(machine.root, name=name))


def header(machine: Machine, library: Library = LIBRARY) -> str | None:
    """The header of a machine, or None where C++ cannot say it."""
    report: Report = []
    files = build(Checked(with_state_types(machine, library)), TARGET, library, report)
    assert {item.code for item in report} <= {"SM601", "SM602"}
    return next(iter(files.values()), None)


def program(headers: Sequence[Part]) -> str:
    """A program that prints the traces of machines, one after the other."""
    calls = []
    for machine, _, asked in headers:
        name = machine.root.name
        calls.append(
            f"  traced<{name}::States, {name}::Userdata>"
            f"({json.dumps(asked[0])}, {asked[1]}, [](auto &&...given) {{"
            f" return {name}::run(std::forward<decltype(given)>(given)...); }});"
        )
    texts = [text.replace("#pragma once\n", "") for _, text, _ in headers]
    return "\n".join([*texts, MAIN, "int main() {", *calls, "}", ""])


def traces(
    headers: Sequence[Part], compiler: Compiler, folder: Path, *flags: str, standard: str = "c++17"
) -> list[list[Event]]:
    """What the compiled machines tell."""
    told = compiler.run(program(headers), folder, *flags, "-pthread", standard=standard)
    parts = [part.splitlines() for part in told.split("--\n")[:-1]]
    assert len(parts) == 2 * len(headers)
    # States may print as well.
    found = [[json.loads(line) for line in part if line.startswith("{")] for part in parts[::2]]
    for events, unobserved, (_, _, asked) in zip(found, parts[1::2], headers, strict=True):
        ended = [event["outcome"] for event in events if event["event"] == "finish"]
        assert asked != NOBODY or unobserved[-1] == [*ended, ""][0], unobserved
    return [
        in_full(machine, events) for (machine, _, _), events in zip(headers, found, strict=True)
    ]


def in_full(machine: Machine, events: Sequence[Event]) -> list[Event]:
    """Events with the full paths of their states, as the interpreter has them."""
    full = {shown: path for path, shown in script_paths(machine.root).items()}
    return [with_shown_paths(event, full) for event in events]
