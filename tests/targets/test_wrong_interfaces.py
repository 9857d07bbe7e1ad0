"""An interface that differs from the class and the script: one finding, at the interface."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report, Severity
from tests.trust.project_text import analysed

MAIN = """\
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
INTERFACE = """\
variables: {speed: float}
input_keys: {tries: int}
output_keys: {pose: Pose}
outcomes: {found: {}, lost: {failure: true}, preempted: {}}
writes: {found: [pose]}
code: {python: "find:Find"}
"""
CLASS = """\
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


def found(interface: str = INTERFACE, main: str = MAIN, code: str = CLASS) -> Report:
    files = {"main.yml": main, "templates/Find.yml": interface, "find.py": code}
    return [item for item in analysed(files).report if item.severity is not Severity.INFO]


def test_a_correct_project() -> None:
    assert found() == []


@pytest.mark.parametrize(
    ("old", "new", "text", "help"),
    [
        ("lost: {failure", "lots: {failure", "lots", "did you mean `lost`?"),
        ("found: {}", "Found: {}", "Found", "did you mean `found`?"),
        ("preempted: {}", "claims: {}", "claims", "write `preempted` in place of `claims`"),
        (
            "{found: {}, ",
            "{",
            "{lost: {failure: true}, preempted: {}}",
            "write `outcomes: {lost: {failure: true}, preempted: {}, found: {}}`",
        ),
        ("speed: float", "sped: float", "sped", "write `speed` in place of `sped`"),
        ("variables: {speed: float}\n", "", "input_keys", "add `variables: {speed: {}}`"),
        ("{tries: int}", "{trys: int}", "trys", "write `tries` in place of `trys`"),
        ("input_keys: {tries: int}\n", "", "variables", "add `input_keys: {tries: {}}`"),
        ("{pose: Pose}", "{poes: Pose}", "poes", "write `pose` in place of `poes`"),
        ("outcomes: {", "outcome: {", "outcome", "did you mean `outcomes`?"),
        ("outcomes: {", "results: {", "results", "did you mean `outcomes`?"),
    ],
)
def test_an_interface_that_is_wrong(old: str, new: str, text: str, help: str) -> None:
    assert old in INTERFACE
    (item,) = found(INTERFACE.replace(old, new, 1))
    assert item.span.source.name == "templates/Find.yml"
    assert (item.span.text, item.help, item.severity) == (text, help, Severity.ERROR)


def test_a_script_that_uses_the_name_of_the_interface() -> None:
    """Then the class is wrong."""
    main = MAIN.replace("lost: failed", "missing: failed")
    report = found(INTERFACE.replace("lost:", "missing:"), main)
    (item,) = report
    assert (item.code, item.span.source.name) == ("SM309", "find.py")


def test_a_second_fault_is_found() -> None:
    main = MAIN.replace("found: SHOW", "found: SHOWS")
    codes = {item.code for item in found(INTERFACE.replace("lost:", "lots:"), main)}
    assert codes == {"SM102", "SM101"}


def test_an_interface_that_is_no_yaml() -> None:
    (item,) = found(INTERFACE.replace("outcomes: {", "outcomes {"))
    assert item.code == "SM001"
