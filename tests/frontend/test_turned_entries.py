"""Entries that are turned round, and fields under a name that is not theirs: one finding each, with
the text to write."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

SCRIPT = """\
name: sm
template: PyBulletBase
outcomes: [done, failed]
userdata: {parts: [1, 2], last: 0}
states:
  - CLOSE:
      template: GripperState
      command: close
      transitions: {succeeded: COUNT, aborted: failed, preempted: failed}
  - COUNT:
      template: CallbacksState
      for_each: {item: part, in: parts}
      input_keys: [part]
      output_keys: [last]
      callbacks: {last: 'lambda ud: ud.part'}
      transitions: {succeeded: SHOW, preempted: failed}
  - SHOW: {template: PrintUserdataState, input_keys: [last], transitions: {succeeded: done}}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "place"),
    [("command: close", "close: command", "close"), ("in: parts", "parts: in", "parts")],
)
def test_a_field_of_a_state_turned_round(right: str, wrong: str, place: str) -> None:
    found = reported({"main.yml": SCRIPT.replace(right, wrong)})
    assert found == [("SM003", place, f"write `{right}`: the name comes first")]


def test_the_name_of_a_part_as_the_name_of_a_key() -> None:
    text = SCRIPT.replace("parts", "in").replace("in: in", "list: in")
    assert reported({"main.yml": text}) == [("SM003", "list", "did you mean `in`?")]


FIND = """\
name: Find
variables: {speed: {type: float, min: 0, max: 1, exclusive: true}}
input_keys: {place: str, part: {type: {name: str, at: Pose}}}
output_keys: {count: int}
outcomes: {found: {}, lost: {failure: true}}
"""
USE = """\
name: sm
template: Base
outcomes: [done]
userdata: {place: shelf, part: {name: gear, at: [[0, 0, 0], [0, 0, 0, 1]]}}
output_keys: [count]
states:
  - FIND:
      template: Find
      speed: 0.5
      transitions: {found: done, lost: AGAIN}
  - AGAIN: {template: SleepState, time: 1, transitions: {succeeded: FIND}}
"""


@pytest.mark.parametrize(
    ("right", "wrong", "place"),
    [
        ("exclusive: true", "true: exclusive", "true"),
        ("failure: true", "true: failure", "true"),
        ("place: str", "str: place", "str"),
        ("count: int", "int: count", "int"),
    ],
)
def test_an_entry_of_an_interface_turned_round(right: str, wrong: str, place: str) -> None:
    files = {"main.yml": USE, "templates/Find.yml": FIND.replace(right, wrong)}
    found = [row for row in reported(files) if row[0] not in ("SM204", "SM602")]
    assert found == [("SM003", place, f"write `{right}`: the name comes first")]


def test_a_field_of_a_record_turned_round() -> None:
    files = {"main.yml": USE, "templates/Find.yml": FIND.replace("name: str", "str: name")}
    found = [row for row in reported(files) if row[0] not in ("SM204", "SM602")]
    help = "write `name: str`: the name of the field comes first"
    assert found == [("SM017", "name", help)]


WAIT = """\
name: sm
template: Base
outcomes: [done]
states:
  - WAIT:
      template: SleepState
      time: 2
      transitions: {succeeded: done}
"""


@pytest.mark.parametrize(
    ("right", "wrong"), [("outcomes", "ends"), ("states", "tasks"), ("name", "title")]
)
def test_an_unknown_field_means_the_one_that_is_missing(right: str, wrong: str) -> None:
    text = WAIT.replace(f"{right}:", f"{wrong}:", 1)
    assert reported({"main.yml": text}) == [("SM003", wrong, f"did you mean `{right}`?")]


def test_an_unknown_field_that_has_another_shape_than_the_missing_one() -> None:
    text = WAIT.replace("states:", "tasks: {a: b}\nother:", 1)
    assert [row[0] for row in reported({"main.yml": text})] == ["SM005", "SM003", "SM003"]


def test_a_misspelt_section_of_params() -> None:
    text = WAIT.replace("outcomes:", "parmas: {pause: 2}\noutcomes:").replace("2\n", "[[pause]]\n")
    assert reported({"main.yml": text}) == [("SM003", "parmas", "did you mean `params`?")]
    text = WAIT.replace("outcomes:", "params: {room: hall}\nuserdata: {topic: [/, [parmas, room]]}"
                        "\noutput_keys: [topic]\noutcomes:")  # fmt: skip
    found = reported({"main.yml": text})
    assert found == [("SM004", "parmas", "did you mean `[params, room]`?")]


def test_a_param_turned_round() -> None:
    text = WAIT.replace("outcomes:", "params: {hall: room}\noutcomes:").replace("2\n", "[[room]]\n")
    help = "write `room: hall` in `params`: the name of the param comes first"
    assert reported({"main.yml": text}) == [("SM015", "room", help)]


def test_look_ups_of_one_param_are_one_finding() -> None:
    text = WAIT.replace("2\n", "[[pause]]\n      timeout: [[pause]]\n")
    text = text.replace("{succeeded: done}", "{succeeded: done, timeout: done, preempted: done}")
    help = "add `pause: ...` to the `params` of the script"
    assert reported({"main.yml": text}) == [("SM015", "pause", help)]
