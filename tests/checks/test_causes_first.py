"""One fault is one finding: the consequences of a fault are not reported beside it."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Severity
from tests.trust.judged_repairs import printed, shown
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
    code = "SM005" if misspelt == "tempalte" else "SM003"
    assert sorted(given) == sorted([*usual, f"{code} {misspelt}"])


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


@pytest.mark.parametrize(
    ("field", "wrong", "misspelt", "meant"),
    [
        ("retry: {on: [nothing], max: 3}", "retry: {on: [nothing], tims: 3}", "tims", "max"),
        ("retry: {on: [nothing], max: 3}", "retry: {outcoms: [nothing], max: 3}", "outcoms", "on"),
        ("{item: x, in: [1, 2], on", "{item: x, lsit: [1, 2], on", "lsit", "in"),
        ("{item: x, in: [1, 2], on", "{varable: x, in: [1, 2], on", "varable", "item"),
    ],
)
def test_a_misspelt_word_for_a_part_of_sugar_is_one_finding(
    field: str, wrong: str, misspelt: str, meant: str
) -> None:
    right = RETRIES.replace("nothin]", "nothing]").replace("exhuasted", "exhausted")
    right = right.replace("fuond", "found")
    text = right.replace(field, wrong)
    report = analysed({"main.yml": text, "templates/Find.yml": FIND}).report
    new = [(item.code, item.span.text, item.help) for item in report if item.code != "SM105"]
    count = right.count(field)
    assert new == [("SM003", misspelt, f"did you mean `{meant}`?")] * count


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
    help = f"write `template:` in place of `{word}:`"
    assert [(item.code, item.help) for item in new] == [("SM005", help)]
    interface = files["templates/Find.yml"]
    expected = [*found(FIELDS, Find=interface), f"SM005 {word}"]
    assert sorted(found(text, Find=interface)) == sorted(expected)


def test_another_word_for_template_with_an_unknown_type_is_one_finding() -> None:
    text = FIELDS.replace("template: Find", "class: arm.find:Find", 1)
    report = analysed({"main.yml": text}).report
    new = [(item.code, item.span.text, item.help) for item in report if "Find" in str(item)]
    assert ("SM005", "class", "write `template:` in place of `class:`") in new
    assert all(item.code not in ("SM004", "SM013") for item in report)


ARROWS = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - LIFT:
      template: ScriptedState
      outcomes: [held, slipped]
      transitions: TRANSITIONS
  - PLACE:
      template: ScriptedState
      outcomes: [placed]
      transitions: {placed: done}
"""


@pytest.mark.parametrize(
    "written",
    [
        "[held -> PLACE, slipped -> failed]",
        "held -> PLACE, slipped -> failed",
        "\n        - held -> PLACE\n        - slipped => failed",
    ],
)
def test_transitions_written_as_arrows_are_one_finding(written: str) -> None:
    text = ARROWS.replace("TRANSITIONS", written)
    (item,) = analysed({"main.yml": text}).report
    help = "`{held: PLACE, slipped: failed}`"
    assert (item.code, (item.help or "")[-len(help) :]) == ("SM004", help)
    assert found(ARROWS.replace("TRANSITIONS", help.strip("`"))) == []


CONDITION = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
userdata: {n: 1}
states:
  - WAIT:
      template: ConditionState
      cond_cb: CODE
      input_keys: [n]
      transitions: {'true': done, 'false': failed, preempted: preempted}
"""


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ("ud.n > 0", ["SM316 ud"]),
        ("'userdata.n > 0'", ["SM316 userdata"]),
        ("'lambda ud: ud.n > 0'", []),
        ("1 > 0; 2", ["SM004 1 > 0; 2"]),
    ],
)
def test_a_condition_that_is_no_function_is_one_finding(code: str, expected: list[str]) -> None:
    assert found(CONDITION.replace("CODE", code)) == expected


SCRIPTS = """\
name: sm
template: Base
outcomes: [done, failed, preempted]
params: {limb: left}
states:
  - FIND:
      script: ["find_", [params, limb]]
      params: {arm: [params, limb]}
      transitions: {found: done, nothing: failed, preempted: preempted}
"""
FIND_LEFT = "- FIND: {template: Find, arm: [params, arm]}\n"


def test_a_sub_script_whose_look_up_fails_is_one_finding() -> None:
    files = {
        "find_left.yml": FIND_LEFT,
        "templates/Find.yml": FIND + "variables: {arm: {type: str}}\n",
    }

    def codes(text: str, **more: str) -> list[str]:
        report = analysed({"main.yml": text, **files, **more}).report
        return [f"{item.code} {item.span.text}".partition(" [")[0] for item in report]

    assert codes(SCRIPTS) == []
    assert codes(SCRIPTS.replace('"find_", [params, limb]', '"find_", [params, lim]')) == [
        "SM015 lim"
    ]
    assert codes(SCRIPTS.replace("arm: [params, limb]", "arm: [params, lim]")) == ["SM015 lim"]
    assert codes(SCRIPTS.replace("{limb: left}", "{limb: right}")) == ["SM011"]
    both = SCRIPTS.replace("limb: left", "limb: right").replace("[params, limb]}", "[params, lim]}")
    assert codes(both) == ["SM011", "SM015 lim"]


FLAT = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - FIND:
      template: ScriptedState
      outcomes: [found, nothing]
      transitions:
        found: done
        nothing: failed
"""


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("        nothing: failed", "      nothing: failed", ["SM003 nothing"]),
        ("nothing: failed", "nothing:", ["SM004 "]),
        ("        found: done\n        n", "        - found: done\n        - n", ["SM004 -"]),
        ("        nothing: failed\n", "", ["SM104 FIND"]),
        ("nothing: failed", "nothing: ''", ["SM101 ''"]),
        ("states:\n  - FIND", "initial: FIND\nstates:\n  FIND", ["SM004 FIND"]),
        ("states:", "initial: MOVE\nstates:\n  - MOVE", ["SM004 MOVE"]),
        ("states:", "initial: MOVE\nstates:", ["SM205 MOVE"]),
        (FLAT.partition("states:")[2], " []\n", ["SM205 []"]),
        (FLAT.partition("states:")[2], "\n", ["SM004 "]),
        (FLAT.partition("states:")[2], " {}\n", ["SM004 {}"]),
        (FLAT.partition("states:")[2], " FIND\n", ["SM004 FIND"]),
        (FLAT.partition("states:")[2], " [params, x]\n", ["SM004 [params, x]"]),
        (FLAT.partition("outcomes: [done, failed]\n")[2], "", ["SM005 sm"]),
    ],
)
def test_a_wrong_shape_is_one_finding(before: str, after: str, expected: list[str]) -> None:
    codes = found(FLAT.replace(before, after, 1))
    assert [code.partition("\n")[0][: len(expected[0])] for code in codes] == expected


SEEN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {pose: [0.1, 0.2, 0.3]}
states:
  - FIND: {template: Find, transitions: {found: USE, nothing: failed}}
  - USE:
      template: ScriptedState
      outcomes: [ok]
      input_keys: [grasp]
      transitions: {ok: done}
"""
SEES = """\
input_keys: {pose: Pose}
output_keys: {grasp: Pose}
outcomes: {found: {}, nothing: {}}
writes: {found: [grasp]}
"""
SEEING = """\
import smach


class Find(smach.State):
    def __init__(self):
        super().__init__(
            outcomes=["found", "nothing"], input_keys=["pose"], output_keys=["grasp"]
        )

    def execute(self, ud):
        if ud.pose is None:
            return "nothing"
        ud.grasp = ud.pose
        return "found"
"""


@pytest.mark.parametrize(
    ("before", "after", "expected"),
    [
        ("{found: [grasp]}", "{fuond: [grasp]}", "SM004 fuond"),
        ("{found: [grasp]}", "{good: [grasp]}", "SM004 good"),
        ("{found: [grasp]}", "{found: [graps]}", "SM004 graps"),
        ("writes:", "wriets:", "SM003 wriets"),
        ("output_keys:", "outputs:", "SM003 outputs"),
        ("input_keys:", "inputs:", "SM003 inputs"),
        ("output_keys:", "ouput_keys:", "SM003 ouput_keys"),
        (
            "input_keys: {pose: Pose}\noutput_keys: {grasp: Pose}",
            "io_keys: {pose: Pose, grasp: Pose}",
            "SM003 io_keys",
        ),
        ("{found: [grasp]}", "{nothing: [grasp]}", "SM301 grasp"),  # the consequence alone
    ],
)
@pytest.mark.parametrize("has_class", [True, False])
def test_a_misspelt_part_of_an_interface_is_one_finding(
    before: str, after: str, expected: str, has_class: bool
) -> None:
    interface = SEES.replace(before, after)
    files = {"cell/find.py": SEEING}
    if has_class:
        interface += 'code: {python: "cell.find:Find"}\n'
    assert found(SEEN, Find=SEES) == []
    if expected.startswith("SM301") and has_class:
        return  # the class is a second witness
    report = analysed({"main.yml": SEEN, "templates/Find.yml": interface, **files}).report
    assert [f"{item.code} {item.span.text}" for item in report] == [expected]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ([('["found"', '["fuond"'), ('return "found"', 'return "fuond"')], ["SM309"]),
        ([('["found"', '["fuond"')], ["SM603"]),
        ([('["pose"]', '["pos"]'), ("ud.pose is", "ud.pos is")], ["SM310"]),
        ([('["pose"]', '["pos"]')], ["SM603"]),
        ([('["grasp"]', '["graps"]'), ("ud.grasp", "ud.graps")], ["SM308"]),
        ([('["grasp"]', '["graps"]')], ["SM603"]),
        ([('input_keys=["pose"], output_keys=["grasp"]', 'io_keys=["pose", "grasp"]')], ["SM603"]),
        ([('"found", "n', '"n'), ("ud.pose is", "ud.size is")], ["SM310", "SM603"]),
    ],
)
def test_a_fault_of_a_class_is_one_finding(
    changes: list[tuple[str, str]], expected: list[str]
) -> None:
    code = SEEING
    for before, after in changes:
        code = code.replace(before, after)
    interface = SEES.replace("writes: {found: [grasp]}\n", 'code: {python: "cell.find:Find"}\n')
    files = {"templates/Find.yml": interface, "cell/find.py": code}
    report = analysed({"main.yml": SEEN, **files}).report
    faults = [item.code for item in report if item.code not in ("SM314", "SM315")]
    assert sorted(faults) == expected


def test_a_misspelt_type_is_one_finding() -> None:
    limits = "{type: %s, min: 0, max: 2, unit: m/s}"
    interface = FIND + f"input_keys: {{where: str}}\nvariables: {{speed: {limits}}}\n"
    text = FIELDS.replace("template: Find", "template: Find\n      speed: 1.5")
    usual = found(text, Find=interface % "float")
    assert sorted(found(text, Find=interface % "flaot")) == sorted([*usual, "SM017 flaot"])


def test_a_misspelt_output_of_an_interface_is_one_finding() -> None:
    misspelt = SEES.replace("{grasp", "{gasp").replace("[grasp]", "[gasp]")
    files = {
        "main.yml": SEEN,
        "templates/Find.yml": misspelt + 'code: {python: "sees:Find"}\n',
        "sees.py": SEEING,
    }
    (item,) = [one for one in analysed(files).report if one.severity is Severity.ERROR]
    assert item.code == "SM308"
    assert "write `grasp` in place of `gasp` in `Find.yml`" in str(item.help)


REACHED = FIELDS.replace(
    "[ok], transitions: {ok: good}", "[ok, nope], transitions: {ok: good, nope: SIT}"
)
REACHED = REACHED.replace("initial: SIT", "initial: LIE")


@pytest.mark.parametrize(
    ("main", "expected", "help"),
    [
        (REACHED.replace("outcomes: [done, failed, preempted]\n", ""), "SM005 sm", "[failed, "),
        (
            REACHED.replace("outcomes: [good, bad]\n      states", "states"),
            "SM005 WORK",
            "[good, bad]",
        ),
        (
            REACHED.replace("outcomes: [good, bad]\n      default", "default"),
            "SM005 BOTH",
            "[good, bad]",
        ),
        (REACHED.replace("{good: {A: ok}}", "{good: [A]}"), "SM004 [A]", "{STATE: OUTCOME}"),
        (REACHED.replace("{good: {A: ok}}", "{good: all}"), "SM004 all", "{STATE: OUTCOME}"),
        (REACHED.replace("{ok: good, nope: SIT}", "[good]"), "SM004 [good]", "`{good: ...}`"),
        (
            REACHED.replace("{ok: good, nope: SIT}", "[{ok: good, nope: SIT}]"),
            "SM004 [{ok: good, nope: SIT}]",
            "`{ok: good, nope: SIT}`",
        ),
        (REACHED.replace("{ok: good, nope: SIT}", "good"), "SM004 good", "{name: value}"),
    ],
)
def test_missing_outcomes_and_wrong_shapes_are_one_finding(
    main: str, expected: str, help: str
) -> None:
    """The script uses the outcomes that a container does not declare; a rule or transitions of a
    wrong shape are not judged."""
    files = {"main.yml": main, "templates/Find.yml": FIND + "input_keys: {where: str}\n"}
    report = [item for item in analysed(files).report if item.severity is Severity.ERROR]
    assert [f"{item.code} {item.span.text}" for item in report] == [expected]
    assert help in (report[0].help or "")


KEYS = """\
name: sm
template: Base
outcomes: [done]
userdata: {grip: soft, heat: 1.0}
states:
  - GRASP:
      template: Find
      remapping: {kind: grip}
      transitions: {found: WARM, nothing: done, preempted: done}
  - WARM:
      template: CallbacksState
      input_keys: [heat]
      output_keys: [warmth]
      callbacks: {warmth: 'lambda ud: ud.heat + 1.0'}
      transitions: {succeeded: SHOW}
  - SHOW:
      template: PrintUserdataState
      input_keys: [warmth]
      transitions: {succeeded: done}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("", "", []),
        ("{kind: grip}", "{kind: gripp}", ["SM302 gripp"]),
        ("{kind: grip}", "{grip: kind}", ["SM302 grip"]),
        ("{warmth: 'l", "{warmht: 'l", ["SM308 warmht"]),
    ],
)
def test_a_slip_in_a_key_is_one_finding(old: str, new: str, expected: list[str]) -> None:
    interface = FIND + "input_keys: {kind: str}\n"
    files = {"main.yml": KEYS.replace(old, new, 1), "templates/Find.yml": interface}
    assert [f"{code} {place}" for code, place, _ in printed(files)] == expected


def test_branches_of_one_name_are_no_race() -> None:
    text = FIELDS.replace("- B: {template: S", "- A: {output_keys: [k], template: S")
    text = text.replace("- A: {template: S", "- A: {output_keys: [k], template: S")
    text = text.replace("default_outcome: bad", "default_outcome: bad\n      output_keys: [k]")
    codes = [item.split()[0] for item in found(text, Find=FIND + "input_keys: {where: str}\n")]
    assert "SM106" in codes
    assert "SM405" not in codes


def test_a_missing_remapping_is_one_finding() -> None:
    script = """\
name: sm
template: Base
outcomes: [done]
userdata: {grip: soft}
states:
  - GRASP:
      template: ScriptedState
      outcomes: [done]
      input_keys: {kind: str}
      transitions: {done: done}
"""
    interface = "input_keys: {kind: str}\noutcomes: [done]\n"
    script = script.replace("ScriptedState", "Grasp").replace("      input_keys: {kind: str}\n", "")
    script = script.replace("      outcomes: [done]\n", "")
    ((code, place, help),) = printed({"main.yml": script, "templates/Grasp.yml": interface})
    assert (code, place) == ("SM301", "GRASP")
    assert help == "write `remapping: {kind: grip}` in `GRASP`"
    other = interface.replace("str", "int")  # the value does not fit
    codes = {code for code, *_ in printed({"main.yml": script, "templates/Grasp.yml": other})}
    assert codes == {"SM301", "SM305"}


def test_an_output_that_no_callback_sets_is_no_race() -> None:
    script = """\
name: sm
template: Base
outcomes: [done]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      output_keys: [part]
      transitions: {done: done}
      states:
        - FIND: {template: ScriptedState, outcomes: [ok], output_keys: [part]}
        - WARM:
            template: CallbacksState
            output_keys: [part]
            callbacks: {heat: 'lambda ud: 3'}
"""
    report = analysed({"main.yml": script}).report
    found = [(item.code, item.help) for item in report if item.severity is not Severity.INFO]
    help = "write `output_keys: [part, heat]` in `WARM`; nothing in `WARM` sets `part`"
    assert found == [("SM308", help)]
    both = script.replace("{heat:", "{part:")
    assert "SM405" in [item.code for item in analysed({"main.yml": both}).report]


def test_the_name_of_a_param_as_a_text() -> None:
    script = """\
name: sm
template: Base
outcomes: [done]
params: {greeting: hello}
states:
  - SAY: {template: Say, text: greeting, transitions: {said: done}}
"""
    interface = "variables: {text: str}\noutcomes: {said: {}}\n"
    items, repair = shown(analysed({"main.yml": script, "templates/Say.yml": interface}))
    assert [(item.code, item.span.text) for item in items] == [("SM306", "greeting")]
    assert repair is not None
    assert [edit.text for edit in repair.edits] == ["[params, greeting]"]
    assert repair.edits[0].span.start == script.index("greeting, ")
