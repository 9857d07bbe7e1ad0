"""Values that have changed places, and names or fields that are lost, are one finding, which names
the repair."""

from __future__ import annotations

import pytest

from smachac.repair.search import again, clusters
from tests.checks.test_first_scripts import reported
from tests.repair.slips import slip
from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

Row = tuple[str, str, str | None]

GRIP = """\
name: Grip
variables:
  force: FORCE
  speed: {type: float<m/s>, min: 0, exclusive: true, default: 0.5}
input_keys: {width: WIDTH}
outcomes: [held, slipped]
code: {cpp: {header: grip.hpp, class: Grip}}
"""
USE = """\
name: sm
outcomes: [done, failed]
userdata: {width: 0.05}
states:
  - GRIP: {template: Grip, force: 600, transitions: {held: done, slipped: failed}}
"""


def grip(force: str = "{type: int, min: 500}", width: str = "{type: float}") -> list[Row]:
    interface = GRIP.replace("FORCE", force).replace("WIDTH", width)
    return reported({"main.yml": USE, "templates/Grip.yml": interface})


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("{type: int, min: 500}", "{type: 500, min: int}"),
        ("{min: 500, type: int, max: 900}", "{min: 500, type: 900, max: int}"),
        ("{type: float, min: 0, exclusive: true}", "{type: float, min: true, exclusive: 0}"),
        ("{type: float, unit: N}", "{type: N, unit: float}"),
        ("{type: int, default: 700}", "{type: 700, default: int}"),
    ],
)
def test_two_facts_that_have_changed_places(right: str, wrong: str) -> None:
    interface = GRIP.replace("FORCE", right).replace("WIDTH", "{type: float}")
    found = slip({"main.yml": USE, "templates/Grip.yml": interface}, right, wrong)
    assert found.is_shown
    assert found.is_restored


@pytest.mark.parametrize(
    "force", ["{type: int, min: 500}", "{type: float, unit: N, max: 900}", "{type: Force}"]
)
def test_facts_in_their_places(force: str) -> None:
    assert [item for item in grip(force) if item[0] == "SM004"] == []


DETECT = """\
name: Detect
FIELD
code: {CODE}
"""
LOOK = """\
name: sm
outcomes: [done, failed]
states:
  - LOOK:
      template: Detect
      transitions: {found: SHOW, lost: failed}
  - SHOW:
      template: ConditionalOutcomeState
      input_keys: [part]
      outcomes: [big]
      default_outcome: small
      callbacks: {big: 'lambda ud: ud.part > 2'}
      transitions: {big: done, small: done}
"""
CLASS = """\
import smach

class Detect(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["found", "lost"], output_keys=["part"])

    def execute(self, userdata):
        part = len("abc")
        userdata.part = part
        return "found" if part else "lost"
"""


def interface(*fields: str, python: bool = True) -> str:
    code = 'python: "cell:Detect"' if python else "cpp: {header: cell.hpp, class: Detect}"
    return DETECT.replace("FIELD", "\n".join(fields)).replace("CODE", code)


def detect(*fields: str, python: bool = True) -> list[Row]:
    text = interface(*fields, python=python)
    return reported({"main.yml": LOOK, "templates/Detect.yml": text, "cell.py": CLASS})


OUTPUT, OUTCOMES = "output_keys: {part: int}", "outcomes: {found: {}, lost: {failure: true}}"


@pytest.mark.parametrize(
    ("fields", "at", "meant"),
    [
        ([OUTPUT, "lost: {found: {}, lost: {failure: true}}"], "lost", "outcomes"),
        ([OUTPUT, "lost: [found, lost]"], "lost", "outcomes"),
        ([OUTPUT, "variables: {}", "input_keys: {}", "doc: x", "states: {found: {}, lost: {}}"],
         "states", "outcomes"),
        (["part: {part: int}", OUTCOMES], "part", "output_keys"),
        (["things: [part]", OUTCOMES], "things", "output_keys"),
        (["things: [part]", OUTCOMES, "writes: {found: [part], lost: [part]}"], "things",
         "output_keys"),
    ],
)  # fmt: skip
def test_a_field_of_an_interface_under_another_name(fields: list[str], at: str, meant: str) -> None:
    files = {"main.yml": LOOK, "templates/Detect.yml": interface(*fields), "cell.py": CLASS}
    analysis = analysed(files)
    first = clusters(analysis, analysis.report, again(analysis))[0]
    assert first.finding.span.text == at
    assert first.repair is not None
    assert [(edit.span.text, edit.text) for edit in first.repair.edits] == [(at, meant)]


def test_a_field_that_can_be_several_ones_lists_these() -> None:
    found = detect(OUTPUT, OUTCOMES, "here: true")
    help = found[0][2] or ""
    assert found[0][:2] == ("SM003", "here")
    assert help.startswith("use one of its fields that are not given yet: ")
    assert "`blocking`" in help


@pytest.mark.parametrize(
    ("fields", "help"),
    [
        ([OUTCOMES, "writes: {found: [part]}"], "add `output_keys: [part]`"),
        ([OUTCOMES, "writes: {found: [part], lost: [part]}"], "add `output_keys: [part]`"),
        (["output_keys: [score]", OUTCOMES, "writes: {found: [part, score], lost: [part]}"],
         "write `output_keys: [score, part]`"),
        (["output_keys: {score: float}", OUTCOMES, "writes: {found: [part], lost: [part]}"],
         "add `part: any` to `output_keys`, or its type in place of `any`"),
    ],
)  # fmt: skip
def test_an_output_that_only_writes_has(fields: list[str], help: str) -> None:
    assert detect(*fields, python=False) == [("SM004", "part", help)]


@pytest.mark.parametrize("field", ["output_keys:", "output_keys: {}"])
def test_a_field_of_an_interface_that_has_lost_its_only_row(field: str) -> None:
    found = detect(field, OUTCOMES)
    help = "add `part` to the `output_keys` of the interface `Detect`"
    assert found[-1] == ("SM308", "part", help)


def test_an_output_that_writes_misspells() -> None:
    found = detect(OUTPUT, OUTCOMES, "writes: {found: [prat]}", python=False)
    assert found == [("SM004", "prat", "did you mean `part`?")]


SEAMS = """\
name: sm
outcomes: [done]
userdata:
  seam_a: [1.0, 2.0]
states:
  - SEAM_A:
      template: Glue
      remapping: REMAPPING
      transitions: {glued: CHECK}
  - CHECK:
      template: ConditionalOutcomeState
      input_keys: [volume_a]
      outcomes: [much]
      default_outcome: little
      callbacks: {much: 'lambda ud: ud.volume_a > 2'}
      transitions: {much: done, little: done}
"""
GLUE = """\
name: Glue
input_keys: {seam: "list[float]"}
output_keys: {volume: float}
outcomes: [glued]
code: {cpp: {header: glue.hpp, class: Glue}}
"""


@pytest.mark.parametrize(
    ("remapping", "found"),
    [
        ("{seam: seam_a, volume: volume_a}", []),
        ("{line: seam_a, volume: volume_a}", [("SM302", "line", "seam")]),
        ("{seam: seam_a, result: volume_a}", [("SM302", "result", "volume")]),
    ],
)  # fmt: skip
def test_the_key_that_an_entry_of_a_remapping_means(remapping: str, found: list[Row]) -> None:
    files = {"main.yml": SEAMS.replace("REMAPPING", remapping), "templates/Glue.yml": GLUE}
    rows = printed(files)
    assert [row[:2] for row in rows] == [row[:2] for row in found]
    assert all(
        f"did you mean `{name}`?" in row[2] for row, (*_, name) in zip(rows, found, strict=True)
    )


INNER = """\
name: sm
outcomes: [done]
userdata: {seam: [1.0], speed: 2.0}
states:
  - WORK:
      template: StateMachine
      outcomes: [glued]
      input_keys: KEYS
      transitions: {glued: done}
      states:
        - GLUE: {template: Glue, transitions: {}}
"""


@pytest.mark.parametrize(
    ("keys", "found"),
    [("[seam]", []), ("[right]", [("SM306", "right", "did you mean `seam`?")]),
     ("{right: any}", [("SM306", "right", "did you mean `seam`?")])],
)  # fmt: skip
def test_an_input_that_no_state_in_a_container_reads(keys: str, found: list[Row]) -> None:
    text = INNER.replace("KEYS", keys).replace("speed: 2.0", "")
    files = {"main.yml": text.replace("[1.0], }", "[1.0]}"), "templates/Glue.yml": GLUE}
    rows = [(code, place, help.partition("\n")[0]) for code, place, help in printed(files)]
    assert rows == found


JUDGE = """\
name: sm
outcomes: [done, rejected]
userdata: {torque: 2.0}
states:
  - JUDGE:
      template: ConditionalOutcomeState
      input_keys: [torque]
      outcomes: OUTCOMES
      default_outcome: bad
      callbacks: {good: 'lambda ud: 1.0 < ud.torque and ud.torque < 1.4'}
      transitions: {good: done, bad: rejected}
"""


@pytest.mark.parametrize(
    ("outcomes", "wrong"),
    [("[good, bad]", "[good, Bad]"), ("[good, bad]", "[Good, bad]")],
)  # fmt: skip
def test_an_outcome_that_misspells_the_default_one(outcomes: str, wrong: str) -> None:
    files = {"main.yml": JUDGE.replace("OUTCOMES", outcomes)}
    assert reported(files) == []
    assert slip(files, outcomes, wrong).is_shown


FEEDERS = """\
name: sm
outcomes: [done]
PARAMS
states:
  - LEFT: {script: feed, params: {side: left}, transitions: {fed: RIGHT}}
  - RIGHT: {script: feed, params: {side: right}, transitions: {fed: AGAIN}}
  - AGAIN: {script: ANOTHER, params: {side: right}, transitions: {fed: done}}
"""
FEED = """\
- FEED:
    template: ScriptedState
    doc: [[params, side], ' at ', [params, speed]]
    outcomes: [fed]
"""


@pytest.mark.parametrize(("params", "another"), [("", "feed"), ("params: {fast: 2}\n", "feed2")])
def test_a_param_that_several_calls_lack(params: str, another: str) -> None:
    main = FEEDERS.replace("PARAMS\n", params).replace("ANOTHER", another)
    found = reported({"main.yml": main, "feed.yml": FEED, "feed2.yml": FEED})
    help = "add `speed: ...` to the `params` of `LEFT`, of a container around it, or of the script"
    assert [item for item in found if item[0] == "SM015"] == [("SM015", "script: feed", help)]


def test_a_param_of_a_call_that_is_turned_round() -> None:
    feed = FEED.replace("template", "params: {side: left}\n    template")
    main = FEEDERS.replace("PARAMS", "params: {speed: 2}").replace("ANOTHER", "feed")
    main = main.replace("{side: left}", "{left: side}")
    ((code, place, help),) = printed({"main.yml": main, "feed.yml": feed})
    assert (code, place) == ("SM306", "left")
    assert help.startswith("write `side: left`")


RECORDS = """\
name: sm
outcomes: [done]
types: {Seam: {name: str, length: float}}
userdata:
  seams: {type: "list[Seam]", value: [{name: left, length: 2.5}, ITEM]}
states:
  - GLUE: {template: ScriptedState, input_keys: [seams], outcomes: [done]}
"""


@pytest.mark.parametrize(
    ("item", "found"),
    [
        ("{name: right, length: 3.5}", []),
        ("{right: name, length: 3.5}",
         [("SM304", "right", "write `name: right`: the name of the field comes first")]),
        ("{nmae: right, length: 3.5}",
         [("SM304", "nmae", "did you mean `name`?")]),
        ("{name: 3.5, length: right}", [("SM304", "3.5", "write `name: right, length: 3.5`")]),
    ],
)  # fmt: skip
def test_an_item_of_data_with_a_slip(item: str, found: list[Row]) -> None:
    rows = printed({"main.yml": RECORDS.replace("ITEM", item)})
    assert [(code, place, help.partition("\n")[0]) for code, place, help in rows] == found


@pytest.mark.parametrize(
    ("type_", "example"),
    [
        ("{type: float<m/s>, min: 0, exclusive: true}", "1.5"),
        ("{type: float, min: 0, max: 0.11}", "0.055"),
        ("{type: int, min: 10, max: 11}", "10"),
        ("{type: int, min: 0, max: 1, exclusive: true}", "..."),
        ("{type: float, min: 0.1, max: 0.3}", "0.2"),
        ("{type: str, names: joint}", "..."),
        ("{one_of: ['off', 'on']}", '"off"'),
        ("{type: int, one_of: [4, 8]}", "4"),
    ],
)
def test_the_example_of_a_missing_variable_is_one_that_it_can_have(
    type_: str, example: str
) -> None:
    interface = GRIP.replace("FORCE", type_).replace("WIDTH", "float")
    main = USE.replace("force: 600, ", "")
    found = reported({"main.yml": main, "templates/Grip.yml": interface})
    assert found == [("SM005", "GRIP", f"add `force: {example}`")]


LISTS = """\
name: sm
outcomes: [done, failed]
userdata: {count: 1, most: 3}
states:
  - COUNT:
      template: CallbacksState
      INPUTS
      OUTPUTS
      callbacks:
        more: 'lambda ud: ud.count + 1'
        left: 'lambda ud: ud.most - ud.count'
      transitions: {succeeded: JUDGE}
  - JUDGE:
      template: ConditionalOutcomeState
      input_keys: [more, left]
      outcomes: [few, many]
      default_outcome: many
      callbacks: {few: 'lambda ud: ud.more < 2 and ud.left > 1'}
      transitions: {few: done, many: failed}
"""


@pytest.mark.parametrize(
    ("inputs", "outputs", "found"),
    [
        ("input_keys: [count, most]", "output_keys: [more, left]", []),
        ("input_keys: [count, most]", "tags: []",
         [("SM308", "left", "add `output_keys: [left, more]` to `COUNT`")]),
        ("tags: []", "output_keys: [more, left]",
         [("SM310", "most", "add `input_keys: [most, count]` to `COUNT`")]),
        ("input_keys: [count, most]", "output_keys: [more]",
         [("SM308", "left", "write `output_keys: [more, left]` in `COUNT`")]),
    ],
)  # fmt: skip
def test_a_state_that_has_lost_its_list_of_keys(
    inputs: str, outputs: str, found: list[Row]
) -> None:
    text = LISTS.replace("INPUTS", inputs).replace("OUTPUTS", outputs)
    assert reported({"main.yml": text}) == found


def test_a_list_in_place_of_a_look_up() -> None:
    text = LOOK_UPS.replace("TIME", "[params, height]").replace("RETRY", "{on: [missed], max: 2}")
    found = slip({"main.yml": text}, "[params, height]", "[height]")
    assert found.is_shown
    assert found.is_restored


LOOK_UPS = """\
name: sm
outcomes: [done]
params: {height: 2.5, text: HIGH}
states:
  - WAIT: {template: SleepState, time: TIME, transitions: {succeeded: SHOW, preempted: done}}
  - SHOW: {template: ScriptedState, doc: [params, text], retry: RETRY, outcomes: [shown, missed],
           transitions: {shown: done, exhausted: done, preempted: done}}
"""


@pytest.mark.parametrize(
    ("time", "retry", "found"),
    [
        ("[params, height]", "{on: [missed], max: 2}", []),
        ("[params, height]", "{on: [missed], max: [params, tries]}",
         [("SM015", "tries", "add `tries: ...` to the `params` of the script; in scope are"
           " `height`, `text`")]),
    ],
)  # fmt: skip
def test_a_look_up_that_is_none(time: str, retry: str, found: list[Row]) -> None:
    text = LOOK_UPS.replace("TIME", time).replace("RETRY", retry)
    assert reported({"main.yml": text}) == found
