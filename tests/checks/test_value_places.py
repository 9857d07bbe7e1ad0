"""Findings about a part of a value mark that part; their help is text that the script can have."""

from __future__ import annotations

import pytest

from smachac.checks.findings.value_places import place_of_part
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Source, Span
from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: PyBulletBase
robot: panda
outcomes: [done, failed]
params: {field: force}
userdata:
  home: HOME
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {positions: home}
      transitions: {succeeded: WORK, aborted: failed, preempted: failed}
  - WORK:
      template: Work
      FIELDS
      transitions: {ok: SAY}
  - SAY:
      template: ScriptedState
      outcomes: [done]
      output_keys: [width]
      steps: STEPS
"""

WORK = """\
variables:
  spread: {type: "float[3]", default: [0.1, 0.1, 0.1]}
  parts: {type: "list[{name: str, shelf: one_of[left, right]}]", default: []}
  place: {type: Pose, default: [[0, 0, 0], [0, 0, 0, 1]]}
  stiff: {type: dict, names: joint, default: {}}
  slots: {keys: input, default: []}
  words: {type: "list[str]", default: []}
outcomes: {ok: {}}
"""

HOME = "[0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]"


def report(fields: str = "doc: x", steps: str = "[]", home: str = HOME) -> list[Diagnostic]:
    main = MAIN.replace("FIELDS", fields).replace("STEPS", steps).replace("HOME", home)
    return analysed({"main.yml": main, "templates/Work.yml": WORK}).report


def loud(**parts: str) -> list[Diagnostic]:
    return [item for item in report(**parts) if item.severity is not Severity.INFO]


def found(**parts: str) -> list[tuple[str, str, str]]:
    """Code, text at the place and help of what is found, without unused and unset keys."""
    kept = [item for item in loud(**parts) if item.code not in ("SM305", "SM306")]
    return [(item.code, item.span.text, item.help or "") for item in kept]


@pytest.mark.parametrize(
    ("parts", "code", "place", "help"),
    [
        ({"fields": "spread: [0.1m, 0.2, 0]"}, "SM304", "0.1m", "write the number without its"),
        ({"fields": "spread: [1, 2]"}, "SM501", "[1, 2]", "add 1 item: 3 are needed, or change"),
        ({"fields": "spread: '1 2 3'"}, "SM304", "'1 2 3'", "`[1, 2, 3]`"),
        (
            {"fields": "parts: [{name: a, shelf: left}, {name: b, shelv: left}]"},
            "SM304",
            "shelv",
            "did you mean `shelf` in place of `shelv`?",
        ),
        (
            {"fields": "parts:\n        - name: a\n          shelf: lefft"},
            "SM304",
            "lefft",
            "did you mean `left`?",
        ),
        ({"fields": "place: [[0, 0, 0], [0, 0, 1]]"}, "SM501", "[0, 0, 1]", "[qx, qy, qz, qw]"),
        ({"fields": "stiff: {panda_joint1: 1, panda_joint9: 1}"}, "SM505", "panda_joint9", "did"),
        ({"steps": "{outcome: done}"}, "SM304", "{outcome: done}", "write `[{outcome: done}]`"),
        ({"steps": "[done]"}, "SM304", "done", "write `{outcome: done}`"),
        ({"steps": "[{outcom: done}]"}, "SM304", "outcom", "did you mean `outcome`"),
        ({"steps": "[{outcome: dnoe}]"}, "SM102", "dnoe", "did you mean `done`?"),
        ({"steps": "[{outcome: done, set: {widht: 1}}]"}, "SM308", "widht", "did you mean `width`"),
        ({"home": HOME.replace("-2.356", "2.356")}, "SM502", "2.356", "write an angle from"),
        (
            {"home": "[0, -45, 0, -135, 0, 90, 45]"},
            "SM502",
            "[0, -45, 0, -135, 0, 90, 45]",
            "`[0, -0.7854, 0, -2.356, 0, 1.571, 0.7854]`",
        ),
    ],
)
def test_a_finding_marks_the_part_that_is_wrong(
    parts: dict[str, str], code: str, place: str, help: str
) -> None:
    ((own, text, given),) = found(**parts)
    assert (own, text) == (code, place)
    assert help in given


def test_a_built_in_type_cannot_be_changed() -> None:
    (item,) = found(home="5")
    assert "change" not in item[2]
    (item,) = found(fields="spread: [1, 2]")
    assert "change the type of `spread` in the interface `Work`" in item[2]


@pytest.mark.parametrize(
    ("fields", "kept"),
    [
        ("slots: [[params, field]]", ["SM301"]),
        ("words: [[params, field], [params, field]]", []),
        ("words: [a, [params, field]]", []),
    ],
)
def test_a_look_up_in_a_list_stays_an_item(fields: str, kept: list[str]) -> None:
    assert [code for code, _, _ in found(fields=fields)] == kept


@pytest.mark.parametrize(
    ("text", "steps", "place"),
    [
        ("[a, {b: c}]", (1, "b"), "c"),
        ("  - a\n  - b: [c, d]\n", (1, "b", 1), "d"),
        ("[a, *x]", (0,), "[a, *x]"),
        ("[a, b]", (5,), "[a, b]"),
        ("[]", (), "[]"),
    ],
)
def test_the_place_of_a_part_is_in_the_text(
    text: str, steps: tuple[int | str, ...], place: str
) -> None:
    source = Source("x.yml", f"k:\n{text}\n")
    start = 3 + len(text) - len(text.lstrip())
    whole = Span(source, start, 3 + len(text.rstrip()))
    assert place_of_part(whole, steps).text == place
