"""SM307 and SM305 on results that a container keeps, also in a loop or in another container, and on
results with a misspelt name."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

ROUND = """\
name: delivery
outcomes: [all, some, stopped]
userdata: {stops: [a, b], refused: 0}
states:
  - ROUND:
      template: StateMachine
      outcomes: [succeeded, aborted, preempted]
      input_keys: [stop, refused]OUT
      for_each: {item: stop, in: stops}
      transitions: {succeeded: REPORT, aborted: some, preempted: stopped}
      states:
        - HAND_OVER:
            template: ScriptedState
            input_keys: [stop]
            outcomes: [taken, refused]
            transitions: {taken: succeeded, refused: COUNT}
        - COUNT:
            template: CallbacksState
            input_keys: [refused]
            output_keys: [refused]
            callbacks: {refused: 'lambda ud: ud.refused + 1'}
            transitions: {succeeded: NEXT}
        - CHECK:
            template: ConditionalOutcomeState
            input_keys: [refused]
            outcomes: [many]
            callbacks: {many: 'lambda ud: ud.refused > 3'}
            default_outcome: few
            transitions: {many: aborted, few: HAND_OVER}
  - REPORT:
      template: ConditionalOutcomeState
      input_keys: [refused]
      outcomes: [yes_]
      callbacks: {yes_: 'lambda ud: ud.refused > 0'}
      default_outcome: no_
      transitions: {yes_: some, no_: all}
"""
REPORT = ROUND[ROUND.index("  - REPORT") :]
ADD = "write `output_keys: [refused]` in `ROUND`"


def round_(*, out: str = "", after: str = "succeeded", initial: str = "HAND_OVER",
           report: bool = True) -> list[tuple[str, str, str | None]]:  # fmt: skip
    text = ROUND.replace("NEXT", after).replace("OUT", out)
    text = text.replace("      states:\n", f"      initial: {initial}\n      states:\n")
    if initial == "HAND_OVER" and after != "CHECK":
        text = text.replace(text[text.index("        - CHECK") : text.index("  - REPORT")], "")
    if not report:
        text = text.replace(REPORT, "").replace("succeeded: REPORT", "succeeded: all")
    return [item for item in reported({"main.yml": text}) if item[0] != "SM203"]


@pytest.mark.parametrize("after", ["succeeded", "CHECK"])
def test_a_state_after_the_loop_reads_the_initial_value(after: str) -> None:
    assert round_(after=after) == [("SM307", "ROUND", ADD)]


def test_the_next_item_reads_the_initial_value() -> None:
    assert round_(initial="CHECK", report=False) == [("SM307", "ROUND", ADD)]


def test_an_output_of_a_loop_is_not_lost() -> None:
    out = "\n      output_keys: [refused]"
    assert round_(out=out) == []
    assert round_(out=out, initial="CHECK") == []


def test_a_counter_of_one_turn_is_not_lost() -> None:
    assert round_(after="CHECK", report=False) == []


SHOTS = """\
name: calibrate
outcomes: [done, failed]
userdata: {images: []}
states:
  - SAFELY:
      template: Concurrence
      outcomes: [good, bad]
      default_outcome: bad
      outcome_map: {good: {SHOTS: succeeded}}
      input_keys: [images]
      output_keys: [images]
      transitions: {good: SOLVE, bad: failed}
      states:
        - SHOTS:
            template: Sequence
            outcomes: [succeeded]
            input_keys: [images]
            output_keys: [images]
            connector_outcome: succeeded
            states:
              - FIRST: {template: TakeShot, remapping: {list_in: images, list_out: images}}
              - SECOND: {template: TakeShot, remapping: {list_in: images, list_out: images}}
              - THIRD: {template: TakeShot, remapping: {list_in: images, list_out: images}}
        - LIGHT: {template: ScriptedState, outcomes: [lit]}
  - SOLVE:
      template: ScriptedState
      input_keys: [images]
      outcomes: [solved]
      transitions: {solved: done}
"""
TAKE = """\
name: TakeShot
input_keys: {list_in: "list[str]"}
output_keys: {list_out: "list[str]"}
outcomes: [succeeded]
code: {python: "cal.shots:TakeShot"}
"""


def shots(old: str = "", new: str = "") -> list[tuple[str, str, str | None]]:
    files = {"main.yml": SHOTS.replace(old, new), "templates/TakeShot.yml": TAKE}
    return [item for item in reported(files) if item[0] not in ("SM404", "SM608", "SM401")]


def test_a_result_goes_through_two_containers() -> None:
    assert shots() == []
    lost = shots("            output_keys: [images]\n")
    assert lost == [("SM307", "SHOTS", "write `output_keys: [images]` in `SHOTS`")]


def test_a_remapped_result_with_a_misspelt_name() -> None:
    second = "SECOND: {template: TakeShot, remapping: {list_in: images, list_out: "
    help = "did you mean `images`? Write `list_out: images`"
    assert shots(f"{second}images", f"{second}image") == [("SM305", "image", help)]


def test_a_result_that_nobody_wants_has_any_other_name() -> None:
    second = "SECOND: {template: TakeShot, remapping: {list_in: images, list_out: "
    assert shots(f"{second}images", f"{second}unused") == []


def test_a_state_sets_a_key_that_it_also_takes_in() -> None:
    both = TAKE.replace("list_in", "list_").replace("list_out", "list_")
    text = SHOTS.replace("list_in: images, list_out: images", "list_: images")
    assert reported({"main.yml": text, "templates/TakeShot.yml": both}) == []
    text = text.replace("            output_keys: [images]\n", "")
    found = reported({"main.yml": text, "templates/TakeShot.yml": both})
    assert found == [("SM307", "SHOTS", "write `output_keys: [images]` in `SHOTS`")]


COUNT = """\
name: sm
outcomes: [done]
userdata: {n: 0}
states:
  - INNER:
      template: StateMachine
      outcomes: [done]
      input_keys: [n]
      states:
        - ADD: {template: Add, LIMITtransitions: {ok: NEXT, timeout: done}}
        - SHOW_IT: {template: PrintUserdataState, input_keys: [n], transitions: {succeeded: done}}
      transitions: {done: SHOW}
  - SHOW: {template: PrintUserdataState, input_keys: [n], transitions: {succeeded: done}}
"""
ADD_ONE = """\
name: Add
input_keys: {n: int}
output_keys: {n: int}
outcomes: [ok]
"""


def added(text: str) -> list[tuple[str, str, str | None]]:
    files = {"main.yml": text, "templates/Add.yml": ADD_ONE}
    return [item for item in reported(files) if item[0] in ("SM305", "SM307")]


def test_only_the_interface_lists_the_key_that_is_lost() -> None:
    text = COUNT.replace(COUNT[COUNT.index("        - SHOW_IT") : COUNT.index("      trans")], "")
    text = text.replace("NEXT", "done")
    help = "write `output_keys: [n]` in `INNER`"
    plain = text.replace("LIMIT", "").replace(", timeout: done", "")
    assert added(plain) == [("SM307", "INNER", help)]
    assert added(text.replace("LIMIT", "timeout: 9s, ")) == [("SM307", "INNER", help)]
    whole = plain.replace(
        "input_keys: [n]\n      states", "input_keys: [n]\n      output_keys: [n]\n      states"
    )
    assert added(whole) == []


def test_a_key_of_an_interface_that_a_state_inside_reads_is_not_lost() -> None:
    plain = COUNT.replace("LIMIT", "").replace(", timeout: done", "").replace("NEXT", "SHOW_IT")
    assert added(plain) == []


def test_a_key_of_an_interface_that_is_no_input_is_not_lost() -> None:
    only = COUNT.replace(
        "      input_keys: [n]\n      states", "      userdata: {n: 1}\n      states"
    )
    only = only.replace("LIMIT", "").replace(", timeout: done", "").replace("NEXT", "SHOW_IT")
    assert added(only) == []


CLEAR = """\
name: deliver
outcomes: [delivered, failed]
userdata: {tries: 0, max_tries: 3}
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [arrived, blocked]DRIVE
      transitions: {arrived: delivered, blocked: CLEAR}
  - CLEAR:
      template: StateMachine
      outcomes: [again, give_up]
      input_keys: [tries, max_tries]OUT
      transitions: {again: DRIVE, give_up: failed}
      states:
        - COUNT:
            template: CallbacksState
            input_keys: [tries]
            output_keys: [tries]
            callbacks: {tries: 'lambda ud: CODE'}
            transitions: {succeeded: ENOUGH}
        - ENOUGH:
            template: ConditionalOutcomeState
            outcomes: [give_up]
            input_keys: [tries, max_tries]
            callbacks: {give_up: 'lambda ud: ud.tries > ud.max_tries'}
            default_outcome: go_on
            transitions: {give_up: give_up, go_on: WAIT}
        - WAIT:
            template: SleepState
            time: 2.0
            transitions: {succeeded: again, preempted: give_up}
"""
KEPT = [("SM307", "CLEAR", "write `output_keys: [tries]` in `CLEAR`")]


def cleared(code: str = "ud.tries + 1", *, drive: str = "", out: str = "", old: str = "",
            new: str = "") -> list[tuple[str, str, str | None]]:  # fmt: skip
    text = CLEAR.replace("CODE", code).replace("OUT", out)
    text = text.replace("blocked]DRIVE", f"blocked]{drive}").replace(old, new)
    return [item for item in reported({"main.yml": text}) if item[0] != "SM203"]


@pytest.mark.parametrize(
    ("code", "initial"),
    [
        ("ud.tries + 1", "0"),
        ("1 + ud.tries", "0"),
        ("ud.tries - 1", "9"),
        ('ud["tries"] + 2', "0"),
        ("ud.tries + [ud.max_tries]", "[]"),
    ],
)
def test_a_count_begins_again_in_each_run(code: str, initial: str) -> None:
    compared = "len(ud.tries) > ud.max_tries" if initial == "[]" else "ud.tries > ud.max_tries"
    text = CLEAR.replace("tries: 0", f"tries: {initial}").replace(
        "DRIVE\n      trans", "\n      trans"
    )
    text = text.replace("ud.tries > ud.max_tries", compared).replace("OUT", "")
    found = reported({"main.yml": text.replace("CODE", code)})
    assert [item for item in found if item[0] == "SM307"] == KEPT


def test_a_count_of_a_renamed_container_key() -> None:
    text = CLEAR.replace("{tries: 0", "{rounds: 0").replace(
        "OUT", "\n      remapping: {tries: rounds}"
    )
    text = text.replace("blocked]DRIVE", "blocked]").replace("CODE", "ud.tries + 1")
    assert [item for item in reported({"main.yml": text}) if item[0] == "SM307"] == KEPT


def test_a_count_that_is_passed_on_is_not_lost() -> None:
    assert cleared(out="\n      output_keys: [tries]") == []


def test_a_count_of_one_run_is_not_lost() -> None:
    assert cleared(old="succeeded: again", new="succeeded: COUNT") == []
    assert cleared(old="again: DRIVE", new="again: failed") == []


def test_a_key_that_the_loop_sets_is_not_lost() -> None:
    drive = "\n      output_keys: [tries]\n      steps: [{outcome: blocked, set: {tries: 2}}]"
    assert cleared(drive=drive) == []


def test_a_value_that_is_no_count_is_not_lost() -> None:
    assert cleared("ud.tries * 2") == []
    assert cleared("max(ud.tries, 1)") == []


def test_the_item_of_a_loop_is_not_lost() -> None:
    text = CLEAR[: CLEAR.index("  - DRIVE")] + CLEAR[CLEAR.index("  - CLEAR") :]
    text = text.replace("tries: 0", "steps: [1, 2]").replace("CODE", "ud.tries + 1")
    text = text.replace("OUT", "\n      for_each: {item: tries, in: steps, on: [again]}")
    text = text.replace("again: DRIVE, ", "").replace(
        "give_up: failed}", "give_up: failed, succeeded: delivered}"
    )
    assert [item for item in reported({"main.yml": text}) if item[0] == "SM307"] == []


SLOTS = """\
name: carton
outcomes: [full, short]
userdata: {slots: [a, b], placed: 0}
states:
  - WORK:
      template: Concurrence
      outcomes: [done, stopped]
      default_outcome: stopped
      input_keys: [slots, placed]
      output_keys: [placed]
      outcome_map: {done: {FILL: all}}
      transitions: {done: JUDGE, stopped: short}
      states:
        - FILL:
            template: Iterator
            outcomes: [all, preempted]
            input_keys: [slots, placed]OUT
            it: slots
            it_label: slot
            exhausted_outcome: all
            loop_outcomes: [succeeded]
            states:
              - ADD:
                  template: CallbacksState
                  input_keys: [placed]
                  output_keys: [placed]
                  callbacks: {placed: 'lambda ud: ud.placed + 1'}
        - GUARD:
            template: ScriptedState
            outcomes: [closed]
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [enough]
      input_keys: [placed]
      callbacks: {enough: 'lambda ud: ud.placed >= 2'}
      default_outcome: few
      transitions: {enough: full, few: short}
"""


@pytest.mark.parametrize("out", ["", "\n            output_keys: [placed]"])
def test_a_count_of_an_iterator_leaves_a_concurrence(out: str) -> None:
    found = [item for item in reported({"main.yml": SLOTS.replace("OUT", out)}) if "7" in item[0]]
    help = "write `output_keys: [placed]` in `FILL`"
    assert found == ([] if out else [("SM307", "FILL", help)])
