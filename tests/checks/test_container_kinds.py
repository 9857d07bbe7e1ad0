"""A container of the wrong kind, and the outcomes `true` and `false` as other booleans."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

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


def test_the_fields_of_another_container() -> None:
    help = "write `template: Concurrence`"
    assert reported({"main.yml": BOTH}) == [("SM004", "StateMachine", help)]


def test_a_sequence_written_as_another_container() -> None:
    text = BOTH.replace("      default_outcome: aborted\n", "      connector_outcome: done\n")
    text = text.replace("      outcome_map: {succeeded: {A: done, B: done}}\n", "").replace(
        "outcomes: [done]}", "outcomes: [done, aborted]}"
    )
    found = reported({"main.yml": text.replace("[succeeded, aborted]", "[done, aborted]")})
    assert found == [("SM004", "StateMachine", "write `template: Sequence`")]


@pytest.mark.parametrize("kind", ["Concurrence", "Sequence", "Iterator"])
def test_a_container_whose_states_follow_one_another(kind: str) -> None:
    help = (
        "write `template: StateMachine`; the states of a container of type"
        f" `{kind}` have no such transitions"
    )
    assert reported({"main.yml": ONE_BY_ONE.replace("KIND", kind)}) == [("SM004", kind, help)]


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
