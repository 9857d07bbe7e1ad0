"""Following the help of a finding literally removes the finding, and brings no other one."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.checks.robot.workspace import unreachable
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.driver import analyse
from smachac.frontend.files import disk_library, read_source
from tests.trust.project_text import analysed

LOOP = """name: m
template: Base
outcomes: [succeeded, aborted]
userdata: {waypoints: [door, shelf]}
states:
  - ALL:
      template: Iterator
      outcomes: [succeeded, preempted]
      input_keys: [waypoints]
      it: waypoints
      it_label: wp
      exhausted_outcome: succeeded
      loop_outcomes: [done, blocked]
      final_outcome_map: {done: preempted, blocked: preempted}
      transitions: {succeeded: succeeded, preempted: aborted}
      states:
        - VISIT:
            template: ScriptedState
            outcomes: {done: {}, blocked: {failure: true}}
            input_keys: [wp]
"""

SUB = """name: m
template: Base
outcomes: [succeeded, aborted]
states:
  - GRASP:
      template: ScriptedState
      outcomes: {held: {}, slipped: {failure: true}}
      transitions: {held: succeeded, slipped: succeeded}
"""

EMPTY = "name: m\ntemplate: Base\noutcomes: [done]\nstates: []\n"

LIMIT = """name: m
template: Base
outcomes: [done]
states:
  - WAIT:
      template: SleepState
      time: 1
      timeout: 20 sec
      transitions: {succeeded: done, preempted: done, timeout: done}
"""

TYPE = """name: m
template: Base
outcomes: [done]
userdata: {width: {type: "float<m", value: 0.05}}
states:
  - PICK:
      template: ScriptedState
      input_keys: [width]
      outcomes: [ok]
      transitions: {ok: done}
"""

FIELDS = """name: m
template: Base
outcomes: [done]
states:
  - PICK:
      template: ScriptedState
      outcomes: [ok]
    transitions: {ok: done}
"""

STORE = """name: m
template: Base
outcomes: [done]
states:
  - CUP:
      template: ScriptedState
      outcomes: [found]
      output_keys: [pose]
      transitions: {found: BOX}
  - BOX:
      template: ScriptedState
      outcomes: [found]
      output_keys: [pose]
      transitions: {found: GRASP}
  - GRASP:
      template: ScriptedState
      outcomes: [held]
      input_keys: [pose]
      transitions: {held: done}
"""

TRIES = """name: m
template: Base
outcomes: [done]
userdata: {tries: 0}
states:
  - NEXT:
      template: ScriptedState
      outcomes: [found, none]
      transitions: {found: GRASP, none: done}
  - GRASP:
      template: ScriptedState
      outcomes: [held, slipped]
      transitions: {held: NEXT, slipped: COUNT}
  - COUNT:
      template: CallbacksState
      input_keys: [tries]
      output_keys: [tries]
      callbacks: {tries: 'lambda ud: ud.tries + 1'}
      transitions: {succeeded: AGAIN}
  - AGAIN:
      template: ConditionalOutcomeState
      input_keys: [tries]
      outcomes: [again]
      callbacks: {again: 'lambda ud: ud.tries < 3'}
      default_outcome: enough
      transitions: {again: GRASP, enough: NEXT}
"""

SET_TRIES = """\
{template: CallbacksState, output_keys: [tries], callbacks: {tries: 'lambda ud: 0'}, \
transitions: {succeeded: GRASP}}"""

ANGLE = """name: m
template: Base
outcomes: [done]
userdata: {angle: 0.5}
states:
  - TURN:
      template: ScriptedState
      input_keys: {angle: float}
      outcomes: [ok]
      transitions: {ok: done}
"""

BOTH = """name: m
template: Base
outcomes: [ready, failed]
states:
  - BOTH:
      template: Concurrence
      outcomes: [ready, half, failed]
      outcome_map:
        ready: {LEFT: done, RIGHT: done}
        failed: {LEFT: slipped}
      states:
        - LEFT: {template: ScriptedState, outcomes: [done, slipped]}
        - RIGHT: {template: ScriptedState, outcomes: [done, slipped]}
      transitions: {ready: ready, half: failed, failed: failed}
"""

FULL = BOTH.replace("[ready, half, failed]", "[ready, failed]").replace("half: failed, ", "")

SHORT = """name: m
template: Base
outcomes: [done]
states:
  - WAIT:
      template: SleepState
      time: 10
      timeout: 5s
      transitions: {succeeded: done, preempted: done, timeout: done}
"""

CASES = [
    (
        "SM212",
        SHORT,
        "write a time limit of more than 10 s, such as `timeout: 15s`",
        "timeout: 5s",
        "timeout: 15s",
    ),
    (
        "SM304",
        ANGLE.replace("angle: float", "angle: {type: float}"),
        "write `angle: float` in the `input_keys` of `TURN`: only userdata and interfaces have",
        "{type: float}",
        "float",
    ),
    (
        "SM004",
        ANGLE.replace("angle: float", "angle: {type: float, min: 0.1}"),
        "write `angle: float`: only userdata",
        "{type: float, min: 0.1}",
        "float",
    ),
    (
        "SM004",
        ANGLE.replace("angle: float", "angle: {type: float, doc: how far}"),
        "write `angle: float`: only userdata",
        "{type: float, doc: how far}",
        "float",
    ),
    (
        "SM004",
        ANGLE.replace("angle: float", 'angle: {type: "float<rad>", value: 0.5}'),
        'write `angle: "float<rad>"`, and `userdata: {angle: 0.5}` beside the keys',
        'angle: {type: "float<rad>", value: 0.5}}',
        'angle: "float<rad>"}\n      userdata: {angle: 0.5}',
    ),
    (
        "SM401",
        BOTH,
        "write `default_outcome: failed` for all combinations without a rule, or add a rule, as in"
        " `half: {LEFT: done, RIGHT: slipped}`",
        "        failed: {LEFT",
        "        half: {LEFT: done, RIGHT: slipped}\n        failed: {LEFT",
    ),
    (
        "SM205",
        EMPTY,
        "write `states: [NAME: {template: ScriptedState, outcomes: [done], transitions:"
        " {done: done}}]`",
        "states: []",
        "states: [NAME: {template: ScriptedState, outcomes: [done], transitions: {done: done}}]",
    ),
    (
        "SM404",
        LOOP,
        "remove `blocked` from the `loop_outcomes` of `ALL`: then the loop ends with `preempted`",
        "loop_outcomes: [done, blocked]",
        "loop_outcomes: [done]",
    ),
    (
        "SM206",
        SUB,
        "lead `slipped` of `GRASP` to a state that recovers, or to `aborted`",
        "slipped: succeeded",
        "slipped: aborted",
    ),
    ("SM004", LIMIT, "write it as `20s`", "20 sec", "20s"),
    ("SM017", TYPE, "close the bracket, as in `float<m>`", "float<m", "float<m>"),
    (
        "SM001",
        FIELDS,
        "indent `transitions` by 6 spaces, like `outcomes`",
        "    transitions: {ok",
        "      transitions: {ok",
    ),
    (
        "SM320",
        STORE,
        "write `remapping: {pose: pose_2}` at one of the two",
        "outcomes: [found]\n      output_keys: [pose]\n      transitions: {found: BOX}",
        "outcomes: [found]\n      output_keys: [pose]\n      remapping: {pose: pose_2}\n"
        "      transitions: {found: BOX}",
    ),
    (
        "SM319",
        TRIES,
        f"add `- SET_TRIES: {SET_TRIES}`, and lead `found` of `NEXT` to it",
        "{found: GRASP, none: done}\n",
        f"{{found: SET_TRIES, none: done}}\n  - SET_TRIES: {SET_TRIES}\n",
    ),
]
"""For each finding: its code, a script with it, the start of its help, and the text that the help
replaces with another one."""


PARTLY = FULL.replace("failed: {LEFT: slipped}", "partly: {LEFT: slipped}").replace(
    "      outcome_map", "      default_outcome: failed\n      outcome_map"
)

ENDLESS = """name: m
template: Base
outcomes: [done]
states:
  - PICK: {template: ScriptedState, outcomes: [ok, far], transitions: {ok: done, far: LOOK}}
  - LOOK: {template: ScriptedState, outcomes: [seen, lost], transitions: {seen: LOOK, lost: LOOK}}
"""


@pytest.mark.parametrize(
    ("code", "script", "help", "changes"),
    [
        (
            "SM103",
            PARTLY,
            "add `partly` to the outcomes of `BOTH`, and `partly: failed` to its transitions",
            {"[ready, failed]\n      d": "[ready, failed, partly]\n      d",
             "{ready: ready, failed": "{ready: ready, partly: failed, failed"},
        ),
        (
            "SM202",
            ENDLESS,
            "lead an outcome of `LOOK` to an outcome of `m`, as in `lost: done`, or write",
            {"lost: LOOK": "lost: done"},
        ),
    ],
)  # fmt: skip
def test_a_help_in_two_places_removes_the_finding(
    tmp_path: Path, code: str, script: str, help: str, changes: dict[str, str]
) -> None:
    found = [item.help or "" for item in _report(tmp_path, script) if item.code == code]
    assert [one for one in found if one.startswith(help)] != []
    for old, new in changes.items():
        assert old in script
        script = script.replace(old, new)
    left = _report(tmp_path, script)
    assert [f"{item.code} {item.finding.message}" for item in left
            if item.severity is not Severity.INFO or item.code == code] == []  # fmt: skip


@pytest.mark.parametrize(("code", "script", "help", "old", "new"), CASES)
def test_a_help_followed_literally_removes_the_finding(
    tmp_path: Path, code: str, script: str, help: str, old: str, new: str
) -> None:
    found = [item for item in _report(tmp_path, script) if item.code == code]
    assert [item.help for item in found if (item.help or "").startswith(help)] != []
    left = _report(tmp_path, script.replace(old, new))
    assert [item for item in left if item.severity is not Severity.INFO] == []


@pytest.mark.parametrize(
    ("code", "script", "marked"),
    [
        ("SM205", EMPTY, ["[]"]),
        ("SM205", EMPTY.replace("states: []", "states: []\ninitial: GO"), ["m"]),
        ("SM212", SHORT, ["5s"]),
    ],
)
def test_the_smallest_wrong_text_is_marked(
    tmp_path: Path, code: str, script: str, marked: list[str]
) -> None:
    found = [item.span.text for item in _report(tmp_path, script) if item.code == code]
    assert found == marked


def test_a_rule_is_never_added_for_an_outcome_that_has_one(tmp_path: Path) -> None:
    [found] = [item for item in _report(tmp_path, FULL) if item.code == "SM401"]
    assert found.help == "write `default_outcome: failed` for all combinations without a rule"


def _report(folder: Path, script: str) -> Report:
    path = folder / "main.yml"
    path.write_text(script, "utf-8")
    report: Report = []
    library = disk_library(path, report)
    source = read_source(path, report)
    assert source is not None
    return analyse(source, library, report, unreachable).report


def test_the_item_of_a_loop_has_another_name_than_its_state_reads() -> None:
    script = """\
name: sm
template: Base
outcomes: [done]
userdata: {poses: [1, 2]}
states:
  - VISIT:
      template: PrintUserdataState
      input_keys: [pose]
      for_each: {item: point, in: poses}
      transitions: {succeeded: done, preempted: done}
"""
    found = [item for item in analysed({"main.yml": script}).report if item.code == "SM301"]
    assert [[place.message for place in item.related] for item in found] == [
        ["`VISIT` reads `pose` here", "the loop calls its item `point`"]
    ]


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("ud.tries < '3'", "write `3` without quotes"),
        ("ud.tries - '0.5' > 0", "write `0.5` without quotes"),
        ("ud.tries == '3'", "write `3` without quotes"),
        ("ud.tries < 'three'", "convert a text that contains a number with `float(...)`"),
    ],
)
def test_a_number_in_quotes(code: str, help: str) -> None:
    text = f"""
name: sm
template: Base
outcomes: [done]
userdata: {{tries: 0}}
states:
  - MORE:
      template: CallbacksState
      input_keys: [tries]
      output_keys: [more]
      callbacks: {{more: "lambda ud: {code}"}}
      transitions: {{succeeded: done}}
output_keys: [more]
"""
    report = analysed({"main.yml": text}).report
    assert [item.help for item in report if item.code in ("SM311", "SM312")] == [help]


SENSE = """\
name: sm
template: Base
outcomes: [explored]
states:
  - SENSE:
      template: Concurrence
      outcomes: [safe, gas, blind]
      outcome_map:
        safe: {CAMERA: clear, GAS: clean}
        gas: {GAS: methane, CAMERA: clear}
        blind: {CAMERA: dusty, GAS: clean}
      transitions: {safe: explored, gas: explored, blind: explored}
      states:
        - CAMERA: {template: ScriptedState, outcomes: [clear, dusty]}
        - GAS: {template: ScriptedState, outcomes: [clean, methane]}
"""


@pytest.mark.parametrize(
    ("old", "new", "help"),
    [
        (
            "",
            "",
            "remove `CAMERA: clear` from the rule for `gas`, or remove `GAS: clean` from the rule"
            " for `blind`; or write a `default_outcome` for all combinations without a rule",
        ),
        (
            "        gas: {GAS: methane, CAMERA: clear}\n",
            "",
            "write a `default_outcome` for all combinations without a rule, or add a rule, as in"
            " `gas: {GAS: methane}`",
        ),
        (
            "blind",
            "failed",
            "write `default_outcome: failed` for all combinations without a rule",
        ),
    ],
)
def test_no_outcome_is_chosen_for_a_combination_but_a_failure(
    tmp_path: Path, old: str, new: str, help: str
) -> None:
    report = _report(tmp_path, SENSE.replace(old, new) if old else SENSE)
    assert [item.help for item in report if item.code == "SM401"] == [help]


@pytest.mark.parametrize(
    ("old", "new", "help"),
    [
        (
            "gas: {GAS: methane, CAMERA: clear}",
            "clear: {CAMERA: gas}",
            "write `gas: {CAMERA: clear}`: a rule begins with an outcome of `SENSE`",
        ),
        (
            "gas: {GAS: methane, CAMERA: clear}",
            "methane: {GAS: gas}",
            "write `gas: {GAS: methane}`: a rule begins with an outcome of `SENSE`",
        ),
        (
            "gas: {GAS: methane, CAMERA: clear}",
            "toxic: {GAS: methane}",
            "add `toxic` to the outcomes of `SENSE` and to its transitions",
        ),
    ],
)
def test_a_transposed_rule_is_one_finding(tmp_path: Path, old: str, new: str, help: str) -> None:
    report = _report(tmp_path, SENSE.replace(old, new))
    assert [item.help for item in report if item.code == "SM103"] == [help]
    assert "SM403" not in [item.code for item in report]
