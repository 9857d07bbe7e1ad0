"""One slip in a loop, a concurrence, a transition or a unit gives one finding, at the word that is
wrong."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.repair.slips import slip
from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

Row = tuple[str, str, str | None]

LOOP = """\
name: rounds
outcomes: [succeeded, aborted, preempted]
userdata: {waypoints: [door, window]}
states:
  - VISIT:
      template: ScriptedState
      input_keys: [wp]
      outcomes: [succeeded, lost]
      for_each: {FIELDS}
      transitions: {succeeded: succeeded, lost: aborted, preempted: preempted}
"""


@pytest.mark.parametrize(
    ("fields", "found"),
    [
        ("item: wp, in: waypoints", []),
    ],
)  # fmt: skip
def test_a_loop_over_a_key(fields: str, found: list[Row]) -> None:
    assert reported({"main.yml": LOOP.replace("FIELDS", fields)}) == found


def test_a_list_of_the_name_of_a_key() -> None:
    files = {"main.yml": LOOP.replace("FIELDS", "item: wp, in: waypoints")}
    found = slip(files, "in: waypoints", "in: [waypoints]")
    assert found.is_shown
    assert found.is_restored


TRAY = """\
name: sorting
outcomes: [sorted, stopped]
userdata: {tray: [bolt, nut]}
states:
  - EACH:
      template: Iterator
      outcomes: [exhausted, preempted]
      input_keys: [tray]
      it: ITEMS
      it_label: LABEL
      loop_outcomes: [placed]
      final_outcome_map: {placed: preempted}
      transitions: {exhausted: sorted, preempted: stopped}
      states:
        - PLACE: {template: ScriptedState, input_keys: [part], outcomes: [placed]}
"""


@pytest.mark.parametrize("turned", ["preempted: placed", "preempted: placed, lost: exhausted"])
def test_a_turned_final_outcome_map_is_one_finding(turned: str) -> None:
    text = TRAY.replace("ITEMS", "tray").replace("LABEL", "part")
    text = text.replace("placed: preempted", turned).replace("[placed]}", "[placed, lost]}")
    text = text.replace("[exhausted, preempted]", "[exhausted, lost, preempted]")
    text = text.replace("{exhausted: sorted", "{exhausted: sorted, lost: stopped")
    help = "write `placed: preempted`: the outcome that is renamed comes first"
    assert reported({"main.yml": text})[-1] == ("SM403", "preempted", help)
    assert not [code for code, *_ in reported({"main.yml": text}) if code == "SM208"]


LINE_UP = """\
name: docking
outcomes: [docked, failed]
states:
  - APPROACH:
      template: ScriptedState
      outcomes: [there, blocked]
      transitions: {there: ALIGN, blocked: failed}
  - ALIGN:
      template: ScriptedState
      outcomes: [aligned, unseen]
      output_keys: [offset]
      transitions: {aligned: DOCK, unseen: failed}
  - DOCK:
      template: ScriptedState
      input_keys: [distance]
      remapping: {distance: offset}
      outcomes: [done]
      transitions: {done: docked}
"""


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("there: ALIGN", "there: DOCK", ["SM201 ALIGN"]),
        ("there: ALIGN", "there: docked", ["SM201 ALIGN"]),
        ("distance: offset", "distance: ofset", ["SM302 ofset"]),
        ("aligned: DOCK, unseen: failed", "aligned: DOCK, unseen: DOCK", []),
    ],
)
def test_a_key_of_a_state_that_is_led_past(old: str, new: str, expected: list[str]) -> None:
    """The key is set once the transition leads to the state."""
    found = [f"{code} {word}" for code, word, _ in printed({"main.yml": LINE_UP.replace(old, new)})]
    assert found == expected


FOLLOW = """\
name: follow
outcomes: [done]
userdata: {person: anna, tries: 3, side: left}
states:
  - FOLLOW:
      template: StateMachine
      outcomes: [done]
LISTS
      transitions: {done: done}
      states:
        - TRACK:
            template: PrintUserdataState
            input_keys: [person, tries, side]
            transitions: {succeeded: done}
"""


@pytest.mark.parametrize(
    ("lists", "expected"),
    [
        ("input_keys: [tries, side]", "write `input_keys: [tries, side, person]` in `FOLLOW`"),
        ("input_keys: {tries: int, side: str}", "add `person` to the `input_keys` of `FOLLOW`"),
        (
            "input_keys:\n      - tries\n      - side",
            "add `person` to the `input_keys` of `FOLLOW`",
        ),
        ("input_keys: [tries, side]  # all", "write `input_keys: [tries, side, person]` in"),
        ("input_keys: [tries, side, a, b, c]", "add `person` to the `input_keys` of `FOLLOW`"),
    ],
)
def test_the_whole_list_of_keys(lists: str, expected: str) -> None:
    rows = reported({"main.yml": FOLLOW.replace("LISTS", f"      {lists}")})
    (help,) = [help for code, _, help in rows if code == "SM303"]
    assert (help or "").startswith(expected)


def test_a_list_of_keys_that_is_missing() -> None:
    text = FOLLOW.replace("LISTS\n", "").replace("[person, tries, side]", "[person]")
    helps = [help for code, _, help in reported({"main.yml": text}) if code == "SM303"]
    assert helps == ["write `input_keys: [person]` in `FOLLOW`"]


@pytest.mark.parametrize(
    ("code", "expected"),
    [
        ('"lambda ud: ud.part.length < 3"', "write `ud.part['length']` for"),
        ("'lambda ud: ud.part.length < 3'", 'write `ud.part["length"]` for'),
    ],
)
def test_quotes_that_fit_the_scalar(code: str, expected: str) -> None:
    text = f"""\
name: sm
outcomes: [done]
userdata: {{part: {{length: 3.0}}}}
states:
  - CHOOSE:
      template: ConditionalOutcomeState
      outcomes: [ok]
      input_keys: [part]
      callbacks: {{ok: {code}}}
      transitions: {{ok: done, default: done}}
"""
    ((found, word, help),) = reported({"main.yml": text})
    assert (found, word) == ("SM311", "length")
    assert (help or "").startswith(expected)


@pytest.mark.parametrize(
    ("items", "label", "found"),
    [
        ("tray", "part", []),
    ],
)
def test_an_iterator_over_a_key(items: str, label: str, found: list[Row]) -> None:
    assert reported({"main.yml": TRAY.replace("ITEMS", items).replace("LABEL", label)}) == found


def test_an_iterator_over_a_list_of_the_name_of_a_key() -> None:
    files = {"main.yml": TRAY.replace("ITEMS", "tray").replace("LABEL", "part")}
    found = slip(files, "it: tray", "it: [tray]")
    assert found.is_shown
    assert found.is_restored


BINS = """\
name: bins
outcomes: [done, failed]
userdata: {weight: 1.0}
states:
  - WHICH:
      template: ScriptedState
      outcomes: [heavy, light, lost, jammed]
      transitions: {heavy: HEAVY, light: LEFT, lost: STOP, jammed: STOP}
  - LEFT: {template: ScriptedState, outcomes: [placed], transitions: {placed: done}}
  - RIGHT: {template: ScriptedState, outcomes: [placed], transitions: {placed: done}}
  - STOP: {template: ScriptedState, outcomes: [placed], transitions: {placed: failed}}
"""


SAFELY = """\
name: shots
outcomes: [done, failed, unsafe]
states:
  - SAFELY:
      template: Concurrence
      JOIN
      outcomes: [done, failed, broken]
      default_outcome: failed
      outcome_map: {RULES}
      transitions: {done: done, failed: failed, broken: unsafe}
      states:
        - WORK: {template: ScriptedState, outcomes: [ok, bad, preempted]}
        - CURTAIN: {template: Curtain}
"""
CURTAIN = """\
name: Curtain
outcomes: {cut: {failure: true}, preempted: {}}
blocking: true
code: {python: "cal.curtain:Curtain"}
"""
APART = "done: {WORK: ok}, broken: {CURTAIN: cut}"
JOIN = "write `join: any` in `SAFELY`: then the first branch that ends stops the others"


@pytest.mark.parametrize(
    ("join", "rules", "found"),
    [
        ("join: any", APART, []),
        ("claims: []", APART, [("SM407", "SAFELY", JOIN)]),
        ("claims: []", "done: {WORK: ok, CURTAIN: cut}, broken: {CURTAIN: cut}",
         [("SM207", "CURTAIN", "write a time limit, as in `timeout: 20s`, for `CURTAIN`")]),
    ],
)  # fmt: skip
def test_a_branch_that_waits_without_a_limit(join: str, rules: str, found: list[Row]) -> None:
    text = SAFELY.replace("JOIN", join).replace("RULES", rules)
    codes = ("SM207", "SM402", "SM407")
    files = {"main.yml": text, "templates/Curtain.yml": CURTAIN}
    assert [item for item in reported(files) if item[0] in codes] == found


UNITS = """\
name: weigh
outcomes: [done]
userdata: {weight: {type: "float<kg>", value: 0.3}, limit: {type: "float<UNIT>", value: 250.0}}
states:
  - A:
      template: ConditionalOutcomeState
      outcomes: [heavy]
      input_keys: [weight, limit]
      callbacks: {heavy: 'lambda ud: ud.weight > ud.limit'}
      default_outcome: light
      transitions: {heavy: done, light: done}
"""


@pytest.mark.parametrize(
    ("unit", "help"),
    [
        ("kg", None),
        ("g", "1 kg is 1000 g: write `ud.limit / 1000`, or write `limit: {type: float<kg>, value:"
         " 0.25}` in the `userdata` of `weigh`"),
        ("t", "1 t is 1000 kg: write `ud.limit * 1000`, or write `limit: {type: float<kg>, value:"
         " 250000}` in the `userdata` of `weigh`"),
        ("m", "use a number in `kg` in place of `ud.limit`, or correct the unit of one of the two"),
    ],
)  # fmt: skip
def test_two_units(unit: str, help: str | None) -> None:
    found = [item[2] for item in reported({"main.yml": UNITS.replace("UNIT", unit)})]
    assert found == ([help] if help else [])


STOPS = """\
name: delivery
outcomes: [done]
types:
  Stop: {room: str, floor: int, kind: "one_of[ward, lab]"}
userdata:
  stops:
    type: "TYPE"
    value:
      - {room: A12, floor: 1, kind: ward}
      - {room: A14, floor: FLOOR, kind: KIND}
states:
  - A: {template: PrintUserdataState, input_keys: [stops], transitions: {succeeded: done}}
"""
RECORD = "list[{room: str, floor: int}]"


@pytest.mark.parametrize(
    ("type_", "floor", "kind", "message"),
    [
        ("list[Stop]", "2", "lab", None),
        ("list[Stop]", "ground", "lab", "`floor` of the second item of `stops` is the text"
         " `ground`, but `Stop` has `floor: int`"),
        ("list[Stop]", "1", "shop", "`kind` of the second item of `stops` is the text `shop`, but"
         " `Stop` has `kind: one_of[ward, lab]`"),
        (RECORD, "ground", "lab", "`floor` of the second item of `stops` is the text `ground`, but"
         f" `delivery` declares `stops` as `{RECORD}`"),
    ],
)  # fmt: skip
def test_a_wrong_part_of_a_value(type_: str, floor: str, kind: str, message: str | None) -> None:
    text = STOPS.replace("TYPE", type_).replace("FLOOR", floor).replace("KIND", kind)
    found = [item.message for item in analysed({"main.yml": text}).report if item.code == "SM304"]
    assert found == ([message] if message else [])


COUNTED = """\
name: rounds
outcomes: [succeeded, aborted]
userdata: {made: 0}
states:
  - WORK: {template: ScriptedState, outcomes: [done, lost],
      transitions: {done: COUNT, lost: aborted}}
  - COUNT:
      template: CallbacksState
      input_keys: [made]
      output_keys: [made]
      callbacks: {made: 'lambda ud: ud.made + 1'}
      transitions: {succeeded: ALL}
  - ALL:
      template: ConditionalOutcomeState
      input_keys: [made]
      outcomes: [full]
      callbacks: {full: 'lambda ud: ud.made >= 12'}
      default_outcome: open
      transitions: {full: succeeded, open: WORK}
"""


def test_a_counter_without_its_output_is_one_finding() -> None:
    assert analysed({"main.yml": COUNTED}).report == []
    text = COUNTED.replace("      output_keys: [made]\n", "")
    assert [item.code for item in analysed({"main.yml": text}).report] == ["SM308"]
    text = COUNTED.replace("transitions: {done: COUNT", "transitions: {done: ALL")
    assert [item.code for item in analysed({"main.yml": text}).report] == ["SM201"]
