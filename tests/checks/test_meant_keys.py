"""A key that nothing reads and one that nothing sets belong together: one finding, at the name with
fewer uses."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

COUNT = """\
name: sm
template: Base
outcomes: [done]
userdata: {count: 0, label: none_yet}
states:
  - COUNT:
      template: CallbacksState
      input_keys: [count]
      output_keys: [count]
      callbacks: {count: 'lambda ud: ud.count + 1'}
      transitions: {succeeded: SHOW}
  - SHOW:
      template: PrintUserdataState
      input_keys: [count, label]
      transitions: {succeeded: done}
"""


@pytest.mark.parametrize("wrong", ["cunt", "Count"])
def test_a_misspelt_preset(wrong: str) -> None:
    assert reported({"main.yml": COUNT}) == []
    text = COUNT.replace("{count: 0", f"{{{wrong}: 0")
    assert reported({"main.yml": text}) == [("SM305", wrong, "did you mean `count`?")]


def test_a_misspelt_reader() -> None:
    text = COUNT.replace("[count, label]", "[count, labell]")
    ((code, place, help),) = printed({"main.yml": text})
    assert (code, place) == ("SM301", "labell")
    assert help.startswith("did you mean `label`?")


def test_a_preset_turned_round() -> None:
    text = COUNT.replace("label: none_yet", "none_yet: label")
    help = "write `label: none_yet`: the name of the key comes first"
    assert reported({"main.yml": text}) == [("SM305", "none_yet", help)]


def test_no_initial_values_at_all() -> None:
    text = COUNT.replace("userdata: {count: 0, label: none_yet}\n", "")
    ((code, place, help),) = reported({"main.yml": text})
    assert (code, place) == ("SM301", "count")
    assert help is not None
    assert help.startswith("give them initial values in `sm`: `userdata: {")
    assert "count: 0" in help or "count: ..." in help
    assert "label: ..." in help


def test_a_counter_without_an_initial_value() -> None:
    text = COUNT.replace("{count: 0, ", "{")
    ((code, _, help),) = reported({"main.yml": text})
    assert code == "SM301"
    assert help is not None
    assert help.startswith("give `count` an initial value in `sm`")


INSIDE = """\
name: sm
template: Base
outcomes: [done]
userdata: {pushes: 0, place: shelf}
states:
  - OPEN:
      template: StateMachine
      outcomes: [done]
      input_keys: [pushes, place]
      output_keys: [pushes]
      transitions: {done: done}
      states:
        - PUSH:
            template: CallbacksState
            input_keys: [pushes]
            output_keys: [pushes]
            callbacks: {pushes: 'lambda ud: ud.pushes + 1'}
            transitions: {succeeded: SHOW}
        - SHOW:
            template: PrintUserdataState
            input_keys: [pushes, place]
            transitions: {succeeded: done}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "place", "key"),
    [
        ("output_keys: [pushes]", "output_keys: [Pushes]", "Pushes", "pushes"),
        ("input_keys: [pushes, place]", "input_keys: [pushes, palce]", "palce", "place"),
    ],
)
def test_a_misspelt_key_of_a_container(right: str, wrong: str, place: str, key: str) -> None:
    text = INSIDE.replace(right, wrong, 1)
    assert reported({"main.yml": text}) == [("SM306", place, f"did you mean `{key}`?")]


JUDGE = """\
name: sm
template: Base
outcomes: [low, high]
userdata: {level: 0.5}
states:
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [low]
      input_keys: [level]
      CALLBACKS
      default_outcome: high
      transitions: {low: low, high: high}
"""


def test_a_state_of_conditions_without_any() -> None:
    text = JUDGE.replace("CALLBACKS", "callbacks: {low: 'lambda ud: ud.level < 0.3'}")
    assert reported({"main.yml": text}) == []
    help = "write `callbacks: {low: 'lambda ud: ...'}`, with `ud.level`"
    text = JUDGE.replace("      CALLBACKS\n", "")
    assert reported({"main.yml": text}) == [("SM306", "low", help)]


def test_a_remapping_of_a_key_that_only_the_code_sets() -> None:
    text = COUNT.replace("      output_keys: [count]\n", "      remapping: {total: count}\n")
    text = text.replace("{count: 'lambda", "{total: 'lambda")
    assert [row[0] for row in reported({"main.yml": text})] == ["SM308"]


CALL = """\
name: sm
template: Base
outcomes: [done]
userdata: {count: 0}
states:
  - DROP: {script: drop, transitions: {done: SHOW}}
  - SHOW: {template: PrintUserdataState, input_keys: [count, spot], transitions: {succeeded: done}}
"""
DROP = """\
- DROP:
    template: StateMachine
    outcomes: [done]
    input_keys: [count]
    output_keys: [spot]
    states:
      - COUNT:
          template: CallbacksState
          input_keys: [count]
          output_keys: [count, spot]
          callbacks: {count: 'lambda ud: ud.count + 1', spot: 'lambda ud: 1.5'}
          transitions: {succeeded: done}
"""


def test_an_output_that_a_sub_script_lacks() -> None:
    help = "write `output_keys: [spot, count]` in the outermost state in `drop.yml`"
    assert reported({"main.yml": CALL, "drop.yml": DROP}) == [("SM307", "spot", help)]
    both = DROP.replace("[spot]", "[spot, count]")
    assert reported({"main.yml": CALL, "drop.yml": both}) == []


FILL = """\
name: sm
template: Base
outcomes: [done]
userdata: {well: {row: A}, count: 0}
states:
  - DISPENSE: {template: Dispense, transitions: {dosed: COUNT}}
  - COUNT:
      template: CallbacksState
      input_keys: [count]
      output_keys: [count]
      callbacks: {count: 'lambda ud: ud.count + 1'}
      transitions: {succeeded: REPORT}
  - REPORT:
      template: PrintUserdataState
      input_keys: [in_well, count]
      transitions: {succeeded: done}
"""
DISPENSE = """\
input_keys: {well: "{row: str}"}
output_keys: {dispensed: float<ul>}
outcomes: {dosed: {}}
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("in_well", "welll"),  # one slip
        ("", ""),
        ("[in_well, count]", "[in_well, count, dispensed]"),
    ],
)
def test_the_search_finds_the_near_name_of_a_key_that_nothing_sets(old: str, new: str) -> None:
    files = {"main.yml": FILL.replace(old, new), "templates/Dispense.yml": DISPENSE}
    found = [each for each in printed(files) if each[0] == "SM301"]
    assert [each[1] for each in found] == [new if new == "welll" else "in_well"]
    assert found[0][2].startswith("did you mean `well`?")


def test_the_place_of_an_unread_key_is_named_once() -> None:
    text = """\
name: sm
template: Base
outcomes: [done]
userdata: {home: [0.0, -0.8, 0.5]}
states:
  - GO_HOME: {template: Go, transitions: {there: done}}
"""
    type_ = 'input_keys: {positions: "float[3]"}\noutcomes: {there: {}}\n'
    (one,) = analysed({"main.yml": text, "templates/Go.yml": type_}).report
    assert one.code == "SM301"
    assert [each.message for each in one.related] == ["nothing reads `home`"]
