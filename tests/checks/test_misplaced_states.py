"""SM101 for states that are indented wrongly: one finding, at the state."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

SCRIPT = """
name: sm
outcomes: [done, failed]
states:
  - SORT:
      template: StateMachine
      outcomes: [sorted, lost]
      transitions: {sorted: REPORT, lost: failed}
      states:
        - LOOK: {template: ScriptedState, outcomes: [ok, x], transitions: {ok: sorted, x: COUNT}}
        - COUNT: {template: ScriptedState, outcomes: [ok], transitions: {ok: LAST}}
  - REPORT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""
COUNT = "        - COUNT: {template: ScriptedState, outcomes: [ok], transitions: {ok: LAST}}\n"


def found(text: str) -> list[tuple[str, int, str]]:
    report = analysed({"main.yml": text}).report
    return [(each.code, each.span.line, each.help or "") for each in report]


def test_a_state_that_is_not_deep_enough() -> None:
    text = SCRIPT.replace("LAST", "lost").replace("        - COUNT", "  - COUNT")
    assert found(text) == [("SM101", 11, "indent `COUNT` as a state of `SORT`")]


def test_a_state_that_is_too_deep() -> None:
    text = SCRIPT.replace("LAST", "lost").replace("  - REPORT", "        - REPORT")
    help = "write `REPORT` with the indentation of the states of `sm`"
    assert found(text) == [("SM101", 12, help)]


@pytest.mark.parametrize(
    ("last", "more"),
    [
        ("nowhere", ""),  # its own transition leads nowhere in both containers
        ("lost", "  - WAIT: {template: ScriptedState, outcomes: [ok], transitions: {ok: COUNT}}\n"),
    ],
)
def test_a_state_of_its_container(last: str, more: str) -> None:
    moved = COUNT.replace("        - COUNT", "  - COUNT").replace("LAST", last)
    text = SCRIPT.replace(COUNT, moved) + more
    assert "indent" not in str(found(text))
    assert "SM101" in str(found(text))


CONCURRENT = """
name: sm
outcomes: [done]
userdata: {n: 0}
states:
  - BOTH:
      template: Concurrence
      outcomes: [ok]
      default_outcome: ok
      output_keys: [n]
      outcome_map: {ok: {A: ok, B: succeeded}}
      transitions: {ok: COUNT}
      states:
        - A: {template: ScriptedState, outcomes: [ok], output_keys: [n]}
        - B: {template: SleepState, time: 1}
        - COUNT: {template: ScriptedState, input_keys: [n], outcomes: [ok], transitions: {ok: done}}
"""


def test_a_state_that_is_indented_into_a_concurrence() -> None:
    help = "write `COUNT` with the indentation of the states of `sm`"
    assert found(CONCURRENT) == [("SM101", 16, help)]
