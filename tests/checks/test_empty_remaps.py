"""Remappings of optional keys to keys that nothing sets."""

from __future__ import annotations

import pytest

from tests.trust.judged_repairs import printed
from tests.trust.project_text import analysed

CELL = """
name: cell
template: PyBulletBase
outcomes: [done, lost, preempted]
userdata:
  spot: [[0.4, 0.0, 0.2], [1.0, 0.0, 0.0, 0.0]]
  above: [[0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]
states:
  - PICK:
      template: StateMachine
      outcomes: [done, lost, preempted]
      input_keys: [INPUTS]
      states:
        - OVER:
            template: MoveAlongState
            remapping: {pose: spot, offset: OFFSET}
            transitions: {succeeded: done, aborted: lost, preempted: preempted}
      transitions: {done: done, lost: lost, preempted: preempted}
"""


def text_with(inputs: str, offset: str) -> str:
    return CELL.replace("INPUTS", inputs).replace("OFFSET", offset)


def found(inputs: str, offset: str) -> list[tuple[str, str, str, str | None]]:
    report = analysed({"main.yml": text_with(inputs, offset)}).report
    return [(item.code, item.severity.value, item.span.text, item.help) for item in report]


@pytest.mark.parametrize(
    ("inputs", "offset", "help"),
    [
        ("spot, above", "abov", "did you mean `above`?"),
        ("spot, above", "above_table", "did you mean `above`?"),
    ],
)
def test_an_optional_key_of_a_key_that_nothing_sets(inputs: str, offset: str, help: str) -> None:
    assert ("SM302", "warning", offset, help) in found(inputs, offset)
    assert [item[:2] for item in printed({"main.yml": text_with(inputs, offset)})] == [
        ("SM302", offset)
    ]


def test_a_value_in_place_of_a_key() -> None:
    (*_, (code, _, text, help)) = found("spot, above", "0.1")
    assert (code, text) == ("SM302", "0.1")
    assert help is not None
    assert help.startswith("a remapping takes the name of a key: set `offset`")


@pytest.mark.parametrize("name", ["nothing", "no_above", "somewhere"])
def test_a_key_that_is_unset_on_purpose(name: str) -> None:
    assert "SM302" not in [code for code, *_ in found("spot, above", name)]


def test_an_optional_key_that_is_set() -> None:
    assert found("spot, above", "above") == []
