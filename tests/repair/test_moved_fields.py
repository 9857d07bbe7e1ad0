"""Fields that are indented too far: the repair moves them out of the field that they are in."""

from __future__ import annotations

import pytest

from tests.repair.slips import slip
from tests.trust.judged_repairs import shown
from tests.trust.project_text import MAIN, analysed

DOCK = """\
name: docking
outcomes: [docked, gave_up, stopped]
states:
  - LINE_UP:
      template: ScriptedState
      outcomes: [aligned, slipped]
      transitions:
        aligned: WAIT
        exhausted: gave_up
        preempted: stopped
      retry: {on: [slipped], max: 3, delay: 500ms}
  - WAIT:
      template: SleepState
      tags: [rest]
      transitions:
        succeeded: docked
        preempted: stopped
      time: 2
"""
REMAPPED = """\
name: sm
outcomes: [docked]
userdata: {target: 1}
states:
  - SHOW:
      template: PrintUserdataState
      input_keys: [pose]
      remapping:
        pose: target
      transitions: {succeeded: docked}
"""
CHOOSE = """\
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {n: 1}
states:
  - CHOOSE:
      template: ConditionalOutcomeState
      outcomes: [low]
      input_keys: [n]
      callbacks:
        low: 'lambda ud: ud.n < 3'
      default_outcome: enough
      transitions:
        low: failed
        enough: done
"""
JOIN = """\
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - BOTH:
      template: Concurrence
      outcomes: [moved, hit]
      default_outcome: hit
      outcome_map:
        moved: {MOVE: succeeded}
        hit: {WATCH: invalid}
      join: any
      transitions:
        moved: done
        hit: failed
      states:
        - MOVE: {template: SleepState, time: 3}
        - WATCH: {template: MonitorState, topic: bumper, msg_type: std_msgs/Bool, cond_cb: 'lambda
            ud, msg: msg.data'}
"""


def moved(text: str, field: str, after: str) -> str:
    """A text with a field directly after a line."""
    return text.replace(f"      {field}\n", "").replace(f"{after}\n", f"{after}\n      {field}\n")


@pytest.mark.parametrize(
    ("text", "field", "after"),
    [
        (DOCK, "retry: {on: [slipped], max: 3, delay: 500ms}", "        preempted: stopped"),
        (DOCK, "time: 2", "        preempted: stopped"),
        (REMAPPED, "transitions: {succeeded: docked}", "        pose: target"),
        (CHOOSE, "default_outcome: enough", "        low: 'lambda ud: ud.n < 3'"),
        (CHOOSE, "default_outcome: enough", "        enough: done"),
        (CHOOSE, "input_keys: [n]", "        low: 'lambda ud: ud.n < 3'"),
        (CHOOSE, "outcomes: [low]", "        low: 'lambda ud: ud.n < 3'"),
        (JOIN, "join: any", "        hit: {WATCH: invalid}"),
        (JOIN, "default_outcome: hit", "        hit: {WATCH: invalid}"),
        (JOIN, "join: any", "        hit: failed"),
    ],
)
def test_a_field_that_is_one_level_too_deep(text: str, field: str, after: str) -> None:
    files = {MAIN: text if text is DOCK else moved(text, field, after)}
    assert shown(analysed(files))[0] == ()
    found = slip(files, f"      {field}\n", f"        {field}\n")
    assert found.is_restored
    assert found.is_shown
    assert len(found.items) == 1


def test_two_fields() -> None:
    """Each of them has a finding and a repair."""
    right = "      retry: {on: [slipped], max: 3, delay: 500ms}\n      tags: [moves]\n"
    files = {MAIN: DOCK.replace(right[: right.index("\n") + 1], right)}
    found = slip(files, right, right.replace("      ", "        "))
    assert [item.span.text for item in found.items] == ["retry", "tags"]


def test_a_field_in_braces() -> None:
    script = JOIN.replace(
        "{template: SleepState, time: 3}", "{template: SleepState, time: 3, RULE}"
    )
    found = slip({MAIN: script}, ", RULE", ", outcome_map: {moved: {MOVE: succeeded}}")
    assert found.is_shown


BRANCH = """\
name: sm
template: Base
outcomes: [both, failed]
states:
  - G:
      template: Concurrence
      outcomes: [both, failed]
      default_outcome: failed
      transitions: {both: both, failed: failed}
      states:
        - LEFT:
            template: ScriptedState
            outcomes: [done, slipped]
        - RIGHT:
            template: ScriptedState
            outcomes: [done, slipped]
            outcome_map:
              both: {LEFT: done, RIGHT: done}
"""


def test_an_outcome_map_in_a_branch() -> None:
    """It is moved beside the list of states."""
    items, repair = shown(analysed({MAIN: BRANCH}))
    assert len(items) == 1
    assert repair is not None
    (edit,) = repair.edits
    assert edit.text == "      outcome_map:\n        both: {LEFT: done, RIGHT: done}\n"
