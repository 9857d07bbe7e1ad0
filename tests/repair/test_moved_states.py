"""States that are indented wrongly: the repair moves them into the list that was meant."""

from __future__ import annotations

import pytest

from tests.repair.slips import slip
from tests.trust.judged_repairs import shown
from tests.trust.project_text import MAIN, analysed

SCRIPT = """\
name: sm
outcomes: [done, failed]
states:
  - SORT:
      template: StateMachine
      outcomes: [sorted, lost]
      transitions: {sorted: REPORT, lost: failed}
      states:
        - LOOK: {template: ScriptedState, outcomes: [ok, x], transitions: {ok: sorted, x: COUNT}}
        - COUNT: {template: ScriptedState, outcomes: [ok], transitions: {ok: lost}}
  - REPORT: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""

CONCURRENT = """\
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
BRANCH = """\
name: sm
outcomes: [done, failed]
doc: two arms
states:
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      default_outcome: failed
      outcome_map: {done: {LEFT: ok, RIGHT: ok}}
      transitions: {done: done, failed: failed}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ok, lost]}
        - RIGHT: {template: ScriptedState, outcomes: [ok, lost]}
"""


@pytest.mark.parametrize(
    ("text", "right", "wrong"),
    [
        (SCRIPT, "        - COUNT", "  - COUNT"),
        (SCRIPT, "  - REPORT", "        - REPORT"),
        (CONCURRENT, "  - COUNT", "        - COUNT"),
        (BRANCH, "        - RIGHT", "  - RIGHT"),
    ],
)
def test_a_state_with_a_wrong_indentation(text: str, right: str, wrong: str) -> None:
    files = {MAIN: text}
    assert shown(analysed(files))[0] == ()
    found = slip(files, right, wrong)
    assert found.is_restored
    assert found.is_shown
    assert len(found.items) == 1
