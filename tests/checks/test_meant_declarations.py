"""Declarations that lack or misspell a name which several places use: one finding, there."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Severity
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


def found(*changes: tuple[str, str]) -> list[tuple[str, str, str | None]]:
    """What is found above an info after changes of the texts: code, marked text, help."""
    files = {"main.yml": SCRIPT, "templates/Take.yml": TAKE, "take.py": CLASS}
    for old, new in changes:
        assert any(old in text for text in files.values()), old
        files = {name: text.replace(old, new, 1) for name, text in files.items()}
    return [
        (item.code, item.span.text, item.help)
        for item in analysed(files).report
        if item.severity is not Severity.INFO
    ]


def test_the_project_is_correct() -> None:
    assert found() == []


@pytest.mark.parametrize(
    ("change", "marked", "help"),
    [
        (("{done: {}", "{doe: {}"), "doe", "did you mean `done`?"),
        (("{done: {}", "{Done: {}"), "Done", "did you mean `done`?"),
        (("{done: {}", "{ended: {}"), "ended", "write `done` in place of `ended`"),
        (("{done: {}, ", "{"), "{missed: {failure: true}, preempted: {}}",
         "write `outcomes: {missed: {failure: true}, preempted: {}, done: {}}`"),
        (("outcomes: {done: {}, missed: {failure: true}, preempted: {}}\n", ""), "name",
         "write `outcomes: [done, missed, preempted]`"),
        (("[free, taken]", "[free, takn]"), "takn", "did you mean `taken`?"),
        (("[free, taken]", "[free]"), "[free]", "write `outcomes: [free, taken]`"),
    ],
)  # fmt: skip
def test_the_outcomes_of_a_state(change: tuple[str, str], marked: str, help: str) -> None:
    assert found(change) == [("SM102", marked, help)]


@pytest.mark.parametrize(
    ("change", "marked", "help"),
    [
        (("[put, lost]", "[put, lsot]"), "lsot", "did you mean `lost`?"),
        (("[put, lost]", "[put, gone]"), "gone", "write `lost` in place of `gone`"),
        (("[put, lost]", "[put]"), "[put]", "write `outcomes: [put, lost]`"),
        (("[put, failed, stopped]", "[put, fialed, stopped]"), "fialed", "did you mean `failed`?"),
        (("[put, failed, stopped]", "[put, stopped]"), "[put, stopped]",
         "write `outcomes: [put, stopped, failed]`"),
        (("- LOOK:", "- look:"), "look", "did you mean `LOOK`?"),
    ],
)  # fmt: skip
def test_the_outcomes_and_states_of_a_container(
    change: tuple[str, str], marked: str, help: str
) -> None:
    changes = [change] if "LOOK" not in change[0] else [change, ("PUT, taken", "PUT, taken")]
    assert found(*changes) == [("SM101", marked, help)]


def test_a_name_with_one_use_is_wrong_at_its_use() -> None:
    assert found(("ok: put", "ok: putt")) == [("SM101", "putt", "did you mean `put`?")]
    assert found(("done: PLACE", "doen: PLACE")) == [("SM102", "doen", "did you mean `done`?")]


def test_a_second_fault_is_found_beside_it() -> None:
    codes = [code for code, *_ in found(("{done: {}", "{doe: {}"), ("bad: LOOK", "bda: LOOK"))]
    assert sorted(codes) == ["SM102", "SM102"]


def test_names_of_a_c_plus_plus_class_count() -> None:
    header = "class Take {\npublic:\n  enum class Outcome { done, missed, preempted };\n};\n"
    files = {
        "main.yml": SCRIPT,
        "templates/Take.yml": TAKE.replace("done", "doe").replace(
            'python: "take:Take"', "cpp: {header: take.hpp, class: Take}"
        ),
        "take.hpp": header,
    }
    found = [(item.code, item.span.text) for item in analysed(files).report]
    assert [each for each in found if each[0] != "SM609"] == [("SM102", "doe")]


def test_a_pair_of_an_unknown_target_and_a_state_that_nothing_leads_to() -> None:
    assert found(("free: PUT", "free: STORE"), ("bad: LOOK", "bad: lost")) == [
        ("SM101", "STORE", "write `PUT`, to which no transition leads, or add the state `STORE`")
    ]


def test_a_pair_of_an_unknown_outcome_and_a_stop() -> None:
    assert found(("preempted: stopped", "seam: stopped")) == [
        ("SM102", "seam", "did you mean `preempted`?")
    ]
