"""Fields under a name that is not theirs, and params that are not there: one finding each."""

from __future__ import annotations

from tests.checks.test_first_scripts import reported

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
