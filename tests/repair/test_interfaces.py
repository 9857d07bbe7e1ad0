"""Interfaces that differ from the class and the script: what is printed shows the line of the slip,
and the repair restores the interface where only one text is possible."""

from __future__ import annotations

import pytest

from tests.repair.slips import slip
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed

FIND = """\
name: sm
template: Base
outcomes: [done, failed, stopped]
userdata: {tries: 3}
states:
  - FIND:
      template: Find
      speed: 0.5
      remapping: {pose: part}
      transitions: {found: SHOW, lost: failed, preempted: stopped}
  - SHOW: {template: PrintUserdataState, input_keys: [part], transitions: {succeeded: done}}
"""
FIND_INTERFACE = """\
variables: {speed: float}
input_keys: {tries: int}
output_keys: {pose: Pose}
outcomes: {found: {}, lost: {failure: true}, preempted: {}}
writes: {found: [pose]}
code: {python: "find:Find"}
"""
FIND_CLASS = """\
import smach


class Find(smach.State):
    def __init__(self, speed):
        super().__init__(outcomes=["found", "lost", "preempted"], input_keys=["tries"],
                         output_keys=["pose"])
        self.speed = speed

    def execute(self, userdata):
        for _ in range(userdata.tries):
            if self.preempt_requested():
                self.service_preempt()
                return "preempted"
            if self.speed > 1.0:
                userdata.pose = [[self.speed, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
                return "found"
        return "lost"
"""
ARMS = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {pose: 3}
states:
  - HOLD: {template: Hold, transitions: {held: RELEASE, missed: failed}}
  - RELEASE: {template: Release, transitions: {released: done}}
"""
HOLD = """\
name: Hold
input_keys: {pose: int}
outcomes: {held: {}, missed: {failure: true}}
code: {python: "arms:Hold"}
"""
RELEASE = """\
name: Release
outcomes: {released: {}}
code: {python: "arms:Release"}
"""
CODE = """\
import smach


class Hold(smach.State):
    def __init__(self):
        super().__init__(outcomes=["held", "missed"], input_keys=["pose"])

    def execute(self, userdata):
        return "missed" if userdata.pose < 3 else "held"


class Release(smach.State):
    def __init__(self):
        super().__init__(outcomes=["released"])

    def execute(self, userdata):
        return "released"
"""
HEADER = """\
#include "smachac/smachac.hpp"
namespace arms {
class Hold {
public:
  enum class Outcome { held, missed };
  Outcome execute() { return closed() ? Outcome::held : Outcome::missed; }
};
class Release {
public:
  enum class Outcome { released };
  Outcome execute() { return Outcome::released; }
};
}
"""

FILES = {"templates/Find.yml": FIND_INTERFACE, "main.yml": FIND, "find.py": FIND_CLASS}
CLASSES = {
    "main.yml": ARMS,
    "templates/Hold.yml": HOLD,
    "templates/Release.yml": RELEASE,
    "arms.py": CODE,
    "arms.hpp": HEADER,
}


@pytest.mark.parametrize("files", [FILES, CLASSES])
def test_a_correct_project(files: dict[str, str]) -> None:
    assert shown(analysed(files))[0] == ()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("lost: {failure", "lots: {failure"),
        ("found: {}", "Found: {}"),
        ("speed: float", "sped: float"),
        ("{tries: int}", "{trys: int}"),
        ("{pose: Pose}", "{poes: Pose}"),
        ("outcomes: {", "outcome: {"),
        ("outcomes: {", "results: {"),
    ],
)
def test_a_name_of_an_interface_that_is_restored(right: str, wrong: str) -> None:
    found = slip(FILES, right, wrong)
    assert found.file == "templates/Find.yml"
    assert found.is_shown
    assert found.is_restored


@pytest.mark.parametrize(
    ("right", "wrong"), [("preempted: {}", "claims: {}"), ("{found: {}, ", "{")]
)
def test_a_name_of_an_interface_that_is_shown(right: str, wrong: str) -> None:
    assert slip(FILES, right, wrong).is_shown


@pytest.mark.parametrize("line", ["variables: {speed: float}\n", "input_keys: {tries: int}\n"])
def test_a_part_of_an_interface_that_is_lost(line: str) -> None:
    """The findings are in the class, and name the interface."""
    found = slip(FILES, line, "")
    assert {item.span.source.name for item in found.items} <= {"find.py", "main.yml"}
    assert any("Find" in (item.help or "") for item in found.items)


def test_a_script_that_uses_the_name_of_the_interface() -> None:
    """Then the class is wrong."""
    script = FIND.replace("lost: failed", "missing: failed")
    interface = FIND_INTERFACE.replace("lost:", "missing:")
    report = analysed({**FILES, "main.yml": script, "templates/Find.yml": interface}).report
    assert [(item.code, item.span.source.name) for item in report] == [("SM309", "find.py")]


def test_two_slips() -> None:
    files = {**FILES, "main.yml": FIND.replace("found: SHOW", "found: SHOWS")}
    found = slip(files, "lost: {failure", "lots: {failure")
    assert {item.code for item in found.items} >= {"SM102", "SM101"}


def test_an_interface_that_names_the_class_of_another_one() -> None:
    found = slip(CLASSES, "arms:Release", "arms:Hold")
    assert found.is_shown
    assert found.is_restored


def test_a_class_of_another_interface_in_c_plus_plus() -> None:
    code = '{cpp: {header: arms.hpp, class: "arms::Release"}}'
    interface = RELEASE.replace('{python: "arms:Release"}', code)
    files = {**CLASSES, "templates/Release.yml": interface}
    assert slip(files, "arms::Release", "arms::Hold").is_shown
