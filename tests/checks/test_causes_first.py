"""One fault is one finding: the consequences of a fault are not reported beside it."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Severity
from tests.trust.project_text import analysed

FIND = "outcomes: {found: {}, nothing: {}, preempted: {}}\n"


def found(main: str, **files: str) -> list[str]:
    """The codes of what is found above an info, each with the text at its place."""
    given = {f"templates/{name}.yml": text for name, text in files.items()}
    report = analysed({"main.yml": main, **given}).report
    return [
        f"{item.code} {item.span.text}" for item in report if item.severity is not Severity.INFO
    ]


FIELDS = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
userdata: {place: shelf}
states:
  - FIND:
      template: Find
      remapping: {where: place}
      timeout: 5s
      transitions: {found: WORK, timeout: failed, nothing: failed, preempted: preempted}
  - WORK:
      template: StateMachine
      outcomes: [good, bad]
      states:
        - LIE: {template: ScriptedState, outcomes: [ok], transitions: {ok: good}}
        - SIT: {template: ScriptedState, outcomes: [ok], transitions: {ok: bad}}
      transitions: {good: BOTH, bad: failed}
      initial: SIT
  - BOTH:
      template: Concurrence
      outcomes: [good, bad]
      default_outcome: bad
      outcome_map: {good: {A: ok}}
      states:
        - A: {template: ScriptedState, outcomes: [ok]}
        - B: {template: ScriptedState, outcomes: [ok]}
      transitions: {good: done, bad: failed}
"""


@pytest.mark.parametrize(
    ("name", "misspelt"),
    [
        ("template: Find", "tempalte"),
        ("remapping: {w", "remaping"),
        ("timeout: 5s", "timout"),
        ("transitions: {found", "transitons"),
        ("transitions: {found", "transition"),
        ("outcomes: [good, bad]\n      states", "outcoms"),
        ("states:\n        - LIE", "sates"),
        ("default_outcome", "defautl_outcome"),
        ("outcome_map", "outcome_mpa"),
        ("userdata", "userdat"),
    ],
)
def test_a_misspelt_field_is_one_finding(name: str, misspelt: str) -> None:
    usual = found(FIELDS, Find=FIND + "input_keys: {where: str}\n")
    text = FIELDS.replace(name, misspelt + name[name.find(":") if ":" in name else len(name) :], 1)
    given = found(text, Find=FIND + "input_keys: {where: str}\n")
    assert sorted(given) == sorted([*usual, f"SM003 {misspelt}"])


LOOK_UPS = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
params: {limb: left, poses: {home: [0, 0, 0]}}
userdata:
  goal: [params, posse]
  n: [params, limbb]
states:
  - FIND:
      template: Find
      arm: [params, lmib]
      userdata: {speed: [params, spede]}
      transitions: {found: MOVE, nothing: failed, preempted: preempted}
  - MOVE:
      template: Find
      arm: left
      transitions: {found: done, nothing: failed, preempted: [params, limmb]}
"""
LOOKING = """\
variables: {arm: {type: "one_of[left, right]"}}
input_keys: {goal: Point, n: str, speed: float}
outcomes: {found: {}, nothing: {}, preempted: {}}
claims: ["arm.{arm}"]
"""


def test_a_look_up_that_fails_is_one_finding() -> None:
    names = ["posse", "limbb", "lmib", "spede", "limmb"]
    assert found(LOOK_UPS, Find=LOOKING) == [f"SM015 {name}" for name in names]


RETRIES = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
states:
  - FIND:
      template: Find
      retry: {on: [nothin], max: 3}
      transitions: {found: MOVE, exhausted: failed, preempted: preempted}
  - MOVE:
      template: Find
      retry: {on: [nothing], max: 3}
      transitions: {found: EACH, exhuasted: failed, preempted: preempted}
  - EACH:
      template: Find
      for_each: {item: x, in: [1, 2], on: [fuond]}
      transitions: {found: done, nothing: failed, preempted: preempted}
"""


def test_an_unknown_outcome_in_sugar_is_one_finding() -> None:
    expected = ["SM004 nothin", "SM102 exhuasted", "SM004 fuond"]
    assert found(RETRIES, Find=FIND) == expected
    gone = RETRIES.replace("[nothin]", "[gone]")
    assert found(gone, Find=FIND) == ["SM004 gone", *expected[1:]]


def test_a_missing_template_is_one_finding() -> None:
    text = FIELDS.replace("template: Find", "template: Fnid")
    usual = found(FIELDS, Find=FIND + "input_keys: {where: str}\n")
    assert sorted(found(text, Find=FIND)) == sorted([*usual, "SM013 Fnid"])


AGAIN = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
states:
  - FIND:
      template: Find
      transitions: {found: done, nothing: failed, preempted: FIND}
"""


def test_a_stop_that_starts_a_state_again_makes_no_impossible_outcome() -> None:
    assert found(AGAIN, Find=FIND) == ["SM209 preempted"]


CLASS = """\
import smach


class Find(smach.State):
    def __init__(self):
        super().__init__(outcomes=["found", "nothing", "lost"])

    def execute(self, userdata):
        if userdata:
            return "lost"
        if userdata == 3:
            return "found"
        return "nothing"
"""


def test_an_undeclared_outcome_of_a_class_is_one_finding() -> None:
    main = AGAIN.replace("preempted: FIND", "preempted: preempted")
    interface = FIND.replace(", preempted: {}", "") + 'code: {python: "cell.find:Find"}\n'
    files = {"templates/Find.yml": interface, "cell/find.py": CLASS}
    text = main.replace(", preempted: preempted", "").replace(", preempted]", "]")
    report = analysed({"main.yml": text, **files}).report
    assert [item.code for item in report if item.severity is not Severity.INFO] == ["SM309"]
    unused = CLASS.replace('return "lost"', 'return "found"')
    report = analysed({"main.yml": text, **files, "cell/find.py": unused}).report
    assert [item.code for item in report if item.severity is not Severity.INFO] == ["SM603"]


@pytest.mark.parametrize("word", ["class", "type", "state_type", "kind", "Template"])
@pytest.mark.parametrize("type_", ["Find", "StateMachine"])
def test_another_word_for_template_is_one_finding(word: str, type_: str) -> None:
    field = "template: Find" if type_ == "Find" else "template: StateMachine"
    files = {"templates/Find.yml": FIND + "input_keys: {where: str}\n"}
    text = FIELDS.replace(field, f"{word}: {type_}", 1)
    report = analysed({"main.yml": text, **files}).report
    new = [item for item in report if item.span.text == word]
    assert [(item.code, item.help) for item in new] == [("SM003", "did you mean `template`?")]
    interface = files["templates/Find.yml"]
    expected = [*found(FIELDS, Find=interface), f"SM003 {word}"]
    assert sorted(found(text, Find=interface)) == sorted(expected)


def test_another_word_for_template_with_an_unknown_type_is_one_finding() -> None:
    text = FIELDS.replace("template: Find", "class: arm.find:Find", 1)
    report = analysed({"main.yml": text}).report
    new = [(item.code, item.span.text, item.help) for item in report if "Find" in str(item)]
    assert ("SM005", "class", "write `template:` in place of `class:`") in new
    assert all(item.code not in ("SM004", "SM013") for item in report)
