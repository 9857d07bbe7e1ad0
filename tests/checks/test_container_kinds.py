"""A container of the wrong kind, and the outcomes `true` and `false` as other booleans."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed

BOTH = """
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
  - BOTH:
      template: StateMachine
      outcomes: [succeeded, aborted]
      default_outcome: aborted
      outcome_map: {succeeded: {A: done, B: done}}
      states:
        - A: {template: ScriptedState, outcomes: [done]}
        - B: {template: ScriptedState, outcomes: [done]}
"""
ONE_BY_ONE = """
name: sm
template: Base
outcomes: [succeeded]
states:
  - WORK:
      template: KIND
      outcomes: [succeeded]
      states:
        - A: {template: ScriptedState, outcomes: [done], transitions: {done: B}}
        - B: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
"""


def kind(text: str) -> str:
    """The kind of container that the repair writes."""
    _, repair = shown(analysed({"main.yml": text}))
    assert repair is not None
    (edit,) = repair.edits
    assert edit.span.line == 7
    return edit.text


def test_the_fields_of_another_container() -> None:
    assert kind(BOTH) == "Concurrence"


def test_a_sequence_written_as_another_container() -> None:
    text = BOTH.replace("      default_outcome: aborted\n", "      connector_outcome: done\n")
    text = text.replace("      outcome_map: {succeeded: {A: done, B: done}}\n", "").replace(
        "outcomes: [done]}", "outcomes: [done, aborted]}"
    )
    assert kind(text.replace("[succeeded, aborted]", "[done, aborted]")) == "Sequence"


@pytest.mark.parametrize("wrong", ["Concurrence", "Sequence", "Iterator"])
def test_a_container_whose_states_follow_one_another(wrong: str) -> None:
    assert kind(ONE_BY_ONE.replace("KIND", wrong)) == "StateMachine"


def test_another_word_for_the_outcome_true() -> None:
    text = """
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
  - READY:
      template: ConditionState
      cond_cb: "lambda ud: True"
      transitions: {yes: succeeded, no: aborted, preempted: aborted}
"""
    assert reported({"main.yml": text}) == [
        ("SM004", "yes", "write the outcome in quotes: 'true'"),
        ("SM004", "no", "write the outcome in quotes: 'false'"),
    ]
