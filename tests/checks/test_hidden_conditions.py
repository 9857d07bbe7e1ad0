"""Conditions that an earlier condition hides (SM203)."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [a, b, c]
userdata: {n: 4, m: 2}
states:
  - NEXT:
      template: ScriptedState
      outcomes: [done]
      output_keys: [n, m]
      transitions: {done: CHECK}
  - CHECK:
      template: ConditionalOutcomeState
      input_keys: [n, m]
      outcomes: [high, top]
      callbacks: {high: 'lambda ud: FIRST', top: 'lambda ud: SECOND'}
      default_outcome: low
      transitions: {high: a, top: b, low: c}
"""


def hidden(first: str, second: str) -> list[tuple[str, str]]:
    text = MAIN.replace("FIRST", first).replace("SECOND", second)
    found = analysed({"main.yml": text}).report
    return [(item.span.text, item.help or "") for item in found if item.code == "SM203"]


ORDER = [("top", "list `top` before `high` in the `outcomes` of `CHECK`")]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("ud.n > 3", "ud.n > 5"), ("ud.n >= 3", "ud.n > 3"), ("ud.n < 3", "ud.n < 1 and ud.m > 2"),
        ("ud.n < 3", '3 > ud["n"] > -1'), ("0 < ud.n < 10", "2 <= ud.n <= 9"),
        ("ud.n > 3", "ud.n == 5"),
    ],
)  # fmt: skip
def test_a_hidden_condition(first: str, second: str) -> None:
    assert hidden(first, second) == ORDER


def test_the_same_condition_twice() -> None:
    help = "correct one of the two conditions: they are the same"
    assert hidden("ud.n == 3", "ud.n == 3") == [("top", help)]


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ("ud.n > 5", "ud.n > 3"), ("ud.n > 3", "ud.n >= 3"), ("ud.n != 3", "ud.n > 3"),
        ("ud.n < 3 and ud.m > 2", "ud.n < 1"), ("ud.n > 3", "ud.n > 5 or ud.m > 3"),
        ("ud.n > 3", "ud.m > 5"), ("0 < ud.n < 10", "2 <= ud.n <= 10"),
        ("ud.n > 3", "not ud.n > 5"), ("ud.n > ud.m", "ud.n > 5"),
    ],
)  # fmt: skip
def test_a_condition_that_can_be_the_first_true_one(first: str, second: str) -> None:
    assert hidden(first, second) == []
