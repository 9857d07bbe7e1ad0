"""Names that a declaration misspells or lacks: what is printed shows the line of the slip, and the
repair restores the text where only one text is possible."""

from __future__ import annotations

import pytest

from tests.repair.slips import slip
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed

SCRIPT = """\
name: sm
template: Base
outcomes: [put, failed, stopped]
states:
  - TAKE:
      template: Take
      transitions: {done: PLACE, missed: failed, preempted: stopped}
  - PLACE:
      template: StateMachine
      outcomes: [put, lost]
      states:
        - LOOK:
            template: ConditionalOutcomeState
            outcomes: [free, taken]
            callbacks: {free: 'lambda ud: True', taken: 'lambda ud: False'}
            default_outcome: dark
            transitions: {free: PUT, taken: lost, dark: LOOK}
        - PUT:
            template: ScriptedState
            outcomes: [ok, bad]
            transitions: {ok: put, bad: LOOK}
      transitions: {put: put, lost: failed}
"""

TAKE = """\
name: Take
outcomes: {done: {}, missed: {failure: true}, preempted: {}}
code: {python: "take:Take"}
"""

CLASS = """\
import smach


class Take(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done", "missed", "preempted"])

    def execute(self, userdata):
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "done" if self.close() else "missed"

    def close(self):
        return True
"""


FILES = {"main.yml": SCRIPT, "templates/Take.yml": TAKE, "take.py": CLASS}


def test_the_project_is_correct() -> None:
    assert shown(analysed(FILES))[0] == ()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("{done: {}", "{doe: {}"),
        ("{done: {}", "{Done: {}"),
        ("[free, taken]", "[free, takn]"),
        ("[free, taken]", "[free]"),
        ("[put, lost]", "[put, lsot]"),
        ("[put, lost]", "[put]"),
        ("[put, failed, stopped]", "[put, fialed, stopped]"),
        ("- LOOK:", "- look:"),
        ("ok: put", "ok: putt"),
        ("done: PLACE", "doen: PLACE"),
    ],
)
def test_a_slip_that_is_restored(right: str, wrong: str) -> None:
    found = slip(FILES, right, wrong)
    assert found.is_shown
    assert found.is_restored


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("{done: {}", "{ended: {}"),
        ("{done: {}, ", "{"),
        ("[put, failed, stopped]", "[put, stopped]"),
    ],
)
def test_a_slip_that_is_shown(right: str, wrong: str) -> None:
    assert slip(FILES, right, wrong).is_shown


def test_an_interface_without_outcomes() -> None:
    line = TAKE.splitlines(keepends=True)[1]
    (item,) = slip(FILES, line, "").items
    assert (item.code, item.span.source.name) == ("SM005", "templates/Take.yml")


def test_names_of_a_c_plus_plus_class() -> None:
    interface = TAKE.replace('python: "take:Take"', "cpp: {header: take.hpp, class: Take}")
    header = "class Take {\npublic:\n  enum class Outcome { done, missed, preempted };\n};\n"
    files = {"main.yml": SCRIPT, "templates/Take.yml": interface, "take.hpp": header}
    found = slip(files, "{done: {}", "{doe: {}")
    assert found.is_shown
    assert found.is_restored
