"""A wrong or missing `for_each` is one finding, with the names of the script in its help."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

SCRIPT = """
name: rounds
template: Base
outcomes: [succeeded, aborted, preempted]
userdata: {waypoints: [door, window]}
states:
  - VISIT:
      template: ScriptedState
      input_keys: [wp]
      outcomes: [succeeded, lost]
      FIELD
      transitions: {succeeded: succeeded, lost: aborted, preempted: preempted}
"""


def found(field: str) -> list[tuple[str, str, str | None]]:
    return reported({"main.yml": SCRIPT.replace("FIELD", field)})


def test_a_right_loop() -> None:
    assert found("for_each: {item: wp, in: waypoints}") == []


@pytest.mark.parametrize(
    ("field", "code", "place", "help"),
    [
        ("for_each: waypoints", "SM004", "waypoints",
         "write `for_each: {item: wp, in: waypoints}`"),
        ("for_each: [door, window]", "SM004", "[door, window]",
         "write `for_each: {item: wp, in: [door, window]}`"),
        ("for_each: wp in waypoints", "SM004", "wp in waypoints",
         "write `for_each: {item: wp, in: waypoints}`"),
        ("for_each:", "SM004", "", "write `for_each: {item: wp, in: KEY}`"),
        ("for_each: {in: waypoints}", "SM005", "for_each", "add `item: wp`"),
        ("for_each: {item: wp}", "SM005", "for_each", "add `in: KEY`"),
        ("for_each: {var: wp, in: waypoints}", "SM003", "var", "did you mean `item`?"),
        ("for_each: {item: [wp], in: waypoints}", "SM004", "[wp]",
         "write `wp` without brackets"),
        ("for_each: {item: wp, in: 3}", "SM004", "3",
         "a loop of 3 turns has the items `[0, 1, 2]`"),
        ("claims: []", "SM301", "wp",
         "write `for_each: {item: wp, in: waypoints}` in `VISIT`, or set `wp` on every path before"
         " `VISIT`, or give it an initial value in `rounds`: `userdata: {wp: ...}`"),
    ],
)  # fmt: skip
def test_a_wrong_loop_is_one_finding(field: str, code: str, place: str, help: str) -> None:
    assert (code, place, help) in found(field)
    assert len(printed({"main.yml": SCRIPT.replace("FIELD", field)})) == 1


def test_a_number_of_tries_in_quotes() -> None:
    text = SCRIPT.replace("wp: ", "").replace("input_keys: [wp]", "input_keys: [waypoints]")
    text = text.replace("lost: aborted", "exhausted: aborted")
    text = text.replace("FIELD", 'retry: {on: [lost], max: "3"}')
    help = "quotes make it a text: write the number `3`"
    assert reported({"main.yml": text}) == [("SM004", '"3"', help)]


NESTED = """\
name: sm
template: Base
outcomes: [done]
userdata: {holes: [1, 2]}
states:
  - ALL:
      template: StateMachine
      outcomes: [ok]
      input_keys: [hole]
      transitions: {ok: done}
      states:
        - SCREW:
            template: ScriptedState
            outcomes: [ok]
            input_keys: [hole]
            for_each: {item: hole, in: holes, on: [ok]}
"""


@pytest.mark.parametrize(
    ("old", "new", "codes"),
    [
        ("", "", ["SM306", "SM303"]),
        ("input_keys: [hole]\n      tr", "input_keys: [holes]\n      tr", []),
        ("input_keys: [hole]\n      tr", "input_keys: [holes, hole]\n      tr", ["SM306"]),
    ],
)
def test_a_loop_in_a_body_with_the_item_as_input(old: str, new: str, codes: list[str]) -> None:
    assert old in NESTED
    report = analysed({"main.yml": NESTED.replace(old, new)}).report
    found = [item for item in report if item.code in ("SM303", "SM306")]
    assert [item.code for item in found] == codes
