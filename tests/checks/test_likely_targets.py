"""Helps that name the target, the outcome or the state that the neighbours of a slip decide."""

from __future__ import annotations

import pytest

from tests.trust.project_text import MAIN, analysed

GRASP = """name: grip
template: Base
outcomes: [held, aborted]
states:
- OPEN:
    template: ScriptedState
    outcomes: [done, preempted]
    transitions: {done: GRASP, preempted: aborted}
- GRASP:
    template: ScriptedState
    outcomes: {held: {}, missed: {failure: true}, preempted: {}}
    timeout: 10s
    transitions: {held: LIFT, missed: COUNT, timeout: COUNT, preempted: LET_GO}
- LIFT:
    template: ScriptedState
    outcomes: [done, preempted]
    transitions: {done: held, preempted: LET_GO}
- COUNT:
    template: ScriptedState
    outcomes: [more, enough]
    transitions: {more: GRASP, enough: LET_GO}
- LET_GO: {template: ScriptedState, outcomes: [done], transitions: {done: aborted}}
"""

BOTH = """name: watch
template: Base
outcomes: [done, stopped, failed]
states:
- BOTH:
    template: Concurrence
    outcomes: [done, stopped, failed]
    default_outcome: failed
    join: any
    outcome_map:
      stopped: {BUTTON: invalid}
      failed: {BATTERY: invalid}
      done: {DRIVE: done}
    transitions: {done: done, stopped: stopped, failed: failed}
    states:
    - BUTTON:
        template: MonitorState
        topic: button
        msg_type: std_msgs/Bool
        cond_cb: 'lambda ud, message: message.data'
    - BATTERY:
        template: MonitorState
        topic: battery
        msg_type: std_msgs/Bool
        cond_cb: 'lambda ud, message: message.data'
    - DRIVE: {template: ScriptedState, outcomes: [done, preempted]}
"""


@pytest.mark.parametrize(
    ("text", "old", "new", "help"),
    [
        (GRASP, ", timeout: COUNT", "", "add `timeout: COUNT` to the transitions of `GRASP`"),
        (GRASP.replace("LET_GO", "HOME").replace("aborted}\n- GRASP", "HOME}\n- GRASP"),
         "LIFT, missed: COUNT, timeout: COUNT, preempted: HOME",
         "LIFT, missed: HOME, timeout: HOME",
         "add `preempted: HOME` to the transitions of `GRASP`"),
        (BOTH, "BATTERY: invalid", "BATTERY: aborted",
         "write `BATTERY: invalid`, as in the rule for `BUTTON`"),
    ],
)  # fmt: skip
def test_the_neighbours_decide_the_help(text: str, old: str, new: str, help: str) -> None:
    assert analysed({MAIN: text}).report == []
    assert old in text
    report = analysed({MAIN: text.replace(old, new)}).report
    assert [item.finding.help for item in report] == [help]
