"""C++ classes that do not exist or cannot work as a state."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library

SCRIPT = """
name: sm
outcomes: [done, lost]
states:
  - GRASP: {template: Grasp, transitions: {held: done, missed: lost}}
"""
INTERFACE = """
name: Grasp
outcomes: {held: {}, missed: {}}
code: {cpp: {header: arm/grasp.hpp, class: "arm::Grasp"}}
"""
CLASS = """\
#include "smachac/smachac.hpp"
namespace arm {
class Grasp {
public:
  enum class Outcome { held, missed };
  // Outcome::dropped was removed
  Outcome execute() { return closed() ? Outcome::held : Outcome::missed; }
};
}
"""
BUILT_IN = disk_library(Path("main.yml"), [])


def found(**headers: str) -> list[str]:
    files = {"main.yml": SCRIPT, "templates/Grasp.yml": INTERFACE}
    files |= {f"arm/{name}.hpp": text for name, text in headers.items()}
    report = analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report
    return [f"{item.code} {item.span} {item.message} {item.help}" for item in report]


def test_a_correct_class() -> None:
    assert found(grasp=CLASS) == []


@pytest.mark.parametrize(
    ("headers", "place", "words"),
    [
        ({"grasp": CLASS.replace(": Outcome::missed", ": Outcome::mised")},
         "SM609 arm/grasp.hpp:7:66",
         "`Outcome` of `arm::Grasp` has no `mised` did you mean `missed`?"),
        ({"grasp": CLASS.replace("execute", "run")}, "SM609 arm/grasp.hpp:3:7",
         "the class `arm::Grasp` has no method `execute`"),
        ({"grasp": CLASS.replace("class Grasp", "class Grip")}, "SM608 main.yml:5:5",
         "the header that `Grasp` names did you mean `Grip`?"),
        ({"grisp": CLASS}, "SM608 main.yml:5:5", "did you mean `arm/grisp.hpp`?"),
    ],
)  # fmt: skip
def test_a_fault(headers: dict[str, str], place: str, words: str) -> None:
    (line,) = found(**headers)
    assert line.startswith(f"{place} ")
    assert words in line


@pytest.mark.parametrize(
    "text",
    [
        CLASS.replace("class Grasp {", "class Grasp : public Skill {").replace("execute", "run"),
        CLASS.replace("class Grasp", "class Grip") + '#include "arm/other.hpp"\n',
        CLASS.replace("class Grasp", "class Grip") + "using Grasp = Grip;\n",
        CLASS.replace("class Grasp", "SKILL(Grip)") + "#define SKILL(name) class name\n",
        CLASS.replace(": Outcome::missed", ": other::Outcome::mised"),
        CLASS.replace("{ held, missed }", "{ held, missed [[deprecated]] }").replace(
            "::held", "::h"
        ),
    ],
)
def test_what_cannot_be_judged(text: str) -> None:
    assert found(grasp=text) == []


def test_a_header_elsewhere_can_be_installed() -> None:
    assert found() == []


@pytest.mark.parametrize(("header", "known"), [("grsap.hpp", True), ("skills.hpp", False)])
def test_a_header_without_a_folder(header: str, known: bool) -> None:
    files = {
        "main.yml": SCRIPT,
        "templates/Grasp.yml": INTERFACE.replace("arm/grasp.hpp", header),
        "grasp.hpp": CLASS,
    }
    report = analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report
    expected = ["SM608 did you mean `grasp.hpp`?"] if known else []
    assert [f"{item.code} {item.help}" for item in report] == expected
