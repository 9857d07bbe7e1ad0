"""One slip of a script, an interface or the settings gives one finding, at the word that is
wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import CODES
from smachac.frontend.config import Project, read_project
from tests.checks.test_first_scripts import reported
from tests.repair.test_moved_fields import CHOOSE, JOIN
from tests.trust.judged_repairs import printed

Row = tuple[str, str, str | None]

OUTCOMES_LIKE_FIELDS = """\
name: sm
outcomes: [done, late]
states:
  - WAIT: {template: ScriptedState, outcomes: [retry, it], transitions: {retry: done, it: late}}
"""


def test_an_outcome_may_have_the_name_of_a_field() -> None:
    assert reported({"main.yml": OUTCOMES_LIKE_FIELDS}) == []


@pytest.mark.parametrize("value", ["any", "'lambda outcomes: True'", "first"])
def test_the_callback_of_smach_in_place_of_join(value: str) -> None:
    text = JOIN.replace("join: any", f"child_termination_cb: {value}")
    rows = reported({"main.yml": text})
    assert ("SM003", "child_termination_cb") in [row[:2] for row in rows]
    assert all(str(help).startswith("write `join: any`") for *_, help in rows)


def test_keys_and_outcomes_with_names_of_fields() -> None:
    text = CHOOSE.replace("low", "default_outcome").replace("enough", "low")
    text = text.replace("      default_outcome: low\n", "").replace("low: done", "default: done")
    assert reported({"main.yml": text}) == []
    text = """\
name: sm
outcomes: [done, failed]
states:
  - COUNT:
      template: CallbacksState
      userdata: {outcomes: [a, b]}
      input_keys: [outcomes]
      output_keys: [retry]
      callbacks: {retry: 'lambda ud: len(ud.outcomes)'}
      transitions: {succeeded: CHOOSE}
  - CHOOSE:
      template: ConditionalOutcomeState
      outcomes: [again]
      input_keys: [retry]
      callbacks: {again: 'lambda ud: ud.retry < 3'}
      transitions: {again: failed, default: done}
"""
    assert reported({"main.yml": text}) == []


TYPE = """\
name: Detect
output_keys: {dock: float, range: float}
outcomes: [found, not_found]
writes: WRITES
code: {python: "dock.detect:Detect"}
"""
USE = """\
name: sm
outcomes: [done, failed]
output_keys: [dock, range]
states:
  - LOOK: {template: Detect, transitions: {found: done, not_found: failed}}
"""


@pytest.mark.parametrize(
    ("writes", "found"),
    [
        ("{found: [dock, range]}", []),
        ("{dock: [found]}", [("SM004", "dock", "write `writes: {found: [dock]}`")]),
        ("{dock: [found], range: [found, not_found]}",
         [("SM004", "dock", "write `writes: {found: [dock, range], not_found: [range]}`")]),
        ("{dokc: [found]}",
         [("SM004", "dokc", "add it to `outcomes`, or remove it here"),
          ("SM004", "found", "add it to `output_keys`, or remove it here")]),
    ],
)  # fmt: skip
def test_an_inverted_writes(writes: str, found: list[Row]) -> None:
    files = {"main.yml": USE, "templates/Detect.yml": TYPE.replace("WRITES", writes)}
    assert [item for item in reported(files) if item[0] == "SM004"] == found


def project(text: str) -> tuple[Project | None, Report]:
    report: Report = []
    return read_project(Source("smachac.toml", text), Path("smachac.toml"), report, CODES), report


def test_a_misspelt_setting_has_its_value() -> None:
    found, report = project('script = ["lib"]\n')
    assert found is not None
    assert [str(script) for script in found.scripts] == ["lib"]
    assert [item.finding.help for item in report] == ["did you mean `scripts`?"]


def test_a_misspelt_setting_beside_the_right_one() -> None:
    found, report = project('script = ["lib"]\nscripts = ["parts"]\n')
    assert found is not None
    assert [str(script) for script in found.scripts] == ["parts"]
    assert len(report) == 1


def test_an_unknown_setting_with_folders_may_be_any_of_them() -> None:
    found, report = project('folders = ["lib"]\n')
    assert found is not None
    assert not found.readable
    assert len(report) == 1


CALLS = """\
name: show
outcomes: [done]
states:
  - LEFT: {script: move_arm, params: {limb: left, speed: 0.3}, transitions: {moved: SHOW}}
  - SHOW: {script: move_arm, params: PARAMS, transitions: {moved: done}}
"""
MOVE = """\
- MOVE:
    template: ScriptedState
    doc: ['Moves the ', [params, limb], ' arm with ', [params, speed]]
    tags: [[[limb]]]
    outcomes: [moved]
"""
MISSING = "add `limb: ...` to the `params` of `SHOW`, of a container around it, or of the script"


@pytest.mark.parametrize(
    ("params", "found"),
    [
        ("{limb: right, speed: 0.3}", []),
        ("{speed: 0.3}", [("SM015", "script: move_arm", MISSING)]),
        ("{arm: left, speed: 0.3}",
         [("SM015", "arm", "write `limb:` in place of `arm:`, or add it")]),
        ("{lim: left, speed: 0.3}", [("SM015", "lim", "did you mean `limb`?")]),
    ],
)  # fmt: skip
def test_a_param_that_a_call_does_not_give(params: str, found: list[Row]) -> None:
    files = {"main.yml": CALLS.replace("PARAMS", params), "move_arm.yml": MOVE}
    assert reported(files) == found


def test_a_misspelt_look_up_in_a_sub_script_stays_there() -> None:
    move = MOVE.replace("[[limb]]", "[[lmib]]")
    files = {"main.yml": CALLS.replace("PARAMS", "{limb: right, speed: 0.3}"), "move_arm.yml": move}
    assert {item[:2] for item in reported(files)} == {("SM015", "lmib")}


TRAY = """\
name: sorting
outcomes: [sorted, stopped]
userdata: {tray: [bolt, nut]}
states:
  - EACH:
      template: Iterator
      outcomes: [tray_empty, preempted]
      input_keys: [tray]
      it: tray
      it_label: part
      FIELDS
      loop_outcomes: [placed]
      transitions: {tray_empty: sorted, preempted: stopped}
      states:
        - PLACE: {template: ScriptedState, input_keys: [part], outcomes: [placed]}
"""
NO_WAY = "`EACH` has no other way to end with `tray_empty`"


@pytest.mark.parametrize(
    ("fields", "found"),
    [
        ("exhausted_outcome: tray_empty", []),
        ("final_outcome_map: {exhausted: tray_empty}", []),
        ("exhausted_outcome: empty",
         [("SM104", "empty", f"write `exhausted_outcome: tray_empty`: {NO_WAY}")]),
        ("tags: []", [("SM104", "EACH", f"write `exhausted_outcome: tray_empty`: {NO_WAY}")]),
    ],
)  # fmt: skip
def test_the_outcome_after_the_last_item(fields: str, found: list[Row]) -> None:
    assert [
        item for item in printed({"main.yml": TRAY.replace("FIELDS", fields)})
        if item[0] not in ("SM208", "SM209")
    ] == found  # fmt: skip
