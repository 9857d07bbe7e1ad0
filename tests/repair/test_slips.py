"""Slips of which the repair restores the text: one finding is printed, and it shows what to write.

Each row is a project, the right text in one of its files, and the wrong text in its place.
"""

from __future__ import annotations

import re

import pytest

from smachac.diagnostics.repair import edited_texts
from tests.trust.judged_repairs import shown
from tests.trust.project_text import MAIN, analysed

FIELDS = {
    MAIN: """\
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
}

INTERFACE = {
    MAIN: """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {place: shelf}
states:
  - FIND:
      template: Find
      speed: 0.5
      transitions: {found: SHOW, lost: failed}
  - SHOW: {template: PrintUserdataState, input_keys: [count], transitions: {succeeded: done}}
""",
    "templates/Find.yml": """\
name: Find
variables: {speed: {type: float, min: 0, max: 1, exclusive: true}}
input_keys: {place: str}
output_keys: {count: int}
outcomes: {found: {}, lost: {failure: true}}
code: {cpp: {header: find.hpp, class: Find}}
""",
}

KIT = {
    MAIN: """\
name: kit
template: Base
outcomes: [kitted, failed]
states:
  - FETCH:
      template: ScriptedState
      outcomes: [found, lost]
      transitions: {found: REPORT, lost: failed}
  - REPORT:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      transitions: {succeeded: kitted, aborted: failed}
"""
}

PRESS = {
    MAIN: """\
name: sm
outcomes: [done]
userdata: {label: abc, number: 3}
states:
  - PRESS:
      template: Press
      side: left
      limit: 4
      remapping: {text: label, count: number}
      transitions: {pressed: done}
""",
    "templates/Press.yml": """\
name: Press
variables: {side: str, limit: int}
input_keys: {text: str, count: int}
outcomes: [pressed]
code: {cpp: {header: press.hpp, class: Press}}
""",
}

RULES = {
    MAIN: """\
name: sm
template: Base
outcomes: [polished, failed]
states:
  - G:
      template: Concurrence
      outcomes: [polished, hot, failed]
      default_outcome: failed
      join: any
      outcome_map: {polished: {POLISH: done}, hot: {DOOR: invalid}}
      transitions: {polished: polished, hot: failed, failed: failed}
      states:
        - POLISH: {template: ScriptedState, outcomes: [done, slipped, preempted]}
        - DOOR: {template: ScriptedState, outcomes: [invalid, valid, preempted]}
"""
}

WATCH = {
    MAIN: """\
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - WATCH:
      template: MonitorState
      topic: /battery
      msg_type: std_msgs/Float32
      cond_cb: 'lambda ud, message: message.data > 0.25'
      max_checks: 3
      transitions: {valid: failed, invalid: done, preempted: failed}
"""
}

TRIES = {
    MAIN: """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - GRASP:
      template: ScriptedState
      outcomes: [held, slipped, preempted]
      retry: {on: [slipped], max: 3}
      transitions: {held: BOTH, exhausted: failed, preempted: failed}
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      default_outcome: failed
      outcome_map: {done: {LEFT: ok}}
      transitions: {done: done, failed: failed}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ok, preempted]}
"""
}

SIDES = {
    MAIN: """\
name: sm
outcomes: [done]
userdata: {left_home: 1.5, right_home: 2.5}
states:
  - LEFT:
      template: ScriptedState
      input_keys: [home]
      outcomes: [ok]
      remapping: {home: left_home}
      transitions: {ok: RIGHT}
  - RIGHT:
      template: ScriptedState
      input_keys: [home]
      outcomes: [ok]
      remapping: {home: right_home}
      transitions: {ok: done}
"""
}

GLUE = {
    MAIN: """\
name: sm
outcomes: [done]
states:
  - SEAM_A:
      template: Measure
      remapping: {seam: seam_a, volume: volume_a}
      transitions: {ok: GLUE_A}
  - GLUE_A:
      template: Glue
      remapping: {seam: seam_a, volume: volume_a}
      transitions: {ok: done}
""",
    "templates/Measure.yml": """\
name: Measure
output_keys: {seam: str, volume: float}
outcomes: [ok]
code: {cpp: {header: measure.hpp, class: Measure}}
""",
    "templates/Glue.yml": """\
name: Glue
input_keys: {seam: str, volume: float}
outcomes: [ok]
code: {cpp: {header: glue.hpp, class: Glue}}
""",
}

POSES = {
    MAIN: """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {rest: [0.0, 0.1], left: [1.0, 1.5]}
states:
  - LEFT:
      template: MoveArm
      remapping: {angles: left}
      transitions: {there: REST, stuck: failed}
  - REST:
      template: MoveArm
      remapping: {angles: rest}
      transitions: {there: done, stuck: failed}
""",
    "templates/MoveArm.yml": """\
name: MoveArm
input_keys: {angles: "float<rad>[2]"}
outcomes: {there: {}, stuck: {failure: true}}
code: {cpp: {header: move.hpp, class: MoveArm}}
""",
}

ROWS = [
    (POSES, "templates/MoveArm.yml", "float<rad>[2]", "float<rad>[3]"),
    (POSES, "templates/MoveArm.yml", "float<rad>[2]", "float<rad>[1]"),
    (TRIES, MAIN, "{on: [slipped], max: 3}", "{on: 3, max: [slipped]}"),
    (
        TRIES,
        MAIN,
        "[held, slipped, preempted]\n      retry: {on: [slipped], max: 3}",
        "{on: [slipped], max: 3}\n      retry: [held, slipped, preempted]",
    ),
    (
        TRIES,
        MAIN,
        "failed\n      outcome_map: {done: {LEFT: ok}}",
        "{done: {LEFT: ok}}\n      outcome_map: failed",
    ),
    (SIDES, MAIN, "home: right_home", "home: left_home"),
    (GLUE, MAIN, "seam: seam_a, volume: volume_a", "seam: volume_a, volume: seam_a"),
    (WATCH, MAIN, "template: MonitorState", "template: WaitForMsgState"),
    (RULES, MAIN, "POLISH: done", "done: POLISH"),
    (RULES, MAIN, "DOOR: invalid", "invalid: DOOR"),
    (FIELDS, MAIN, "command: close", "close: command"),
    (FIELDS, MAIN, "in: parts", "parts: in"),
    (INTERFACE, "templates/Find.yml", "exclusive: true", "true: exclusive"),
    (INTERFACE, "templates/Find.yml", "failure: true", "true: failure"),
    (INTERFACE, "templates/Find.yml", "place: str", "str: place"),
    (INTERFACE, "templates/Find.yml", "count: int", "int: count"),
    (PRESS, MAIN, "side: left\n      limit: 4", "side: 4\n      limit: left"),
    (KIT, MAIN, "outcomes: [kitted", "ends: [kitted"),
    (KIT, MAIN, "states:", "tasks:"),
    (KIT, MAIN, "name: kit", "title: kit"),
    (KIT, MAIN, "succeeded: kitted", "kitted: succeeded"),
    (KIT, MAIN, "aborted: failed", "failed: aborted"),
    (KIT, MAIN, "found: REPORT", "REPORT: found"),
]


@pytest.mark.parametrize(("files", "file", "right", "wrong"), ROWS)
def test_a_slip_is_one_finding_with_the_text_to_write(
    files: dict[str, str], file: str, right: str, wrong: str
) -> None:
    text = files[file].replace(right, wrong, 1)
    assert text != files[file]
    assert shown(analysed(files))[0] == ()
    items, repair = shown(analysed({**files, file: text}))
    assert repair is not None
    assert {source.name: new for source, new in edited_texts(repair.edits).items()} == {
        file: files[file]
    }
    assert len(items) == 1
    assert any(part in (items[0].help or "") for part in re.split(r": |\n *", right.rstrip(":")))


def test_one_list_of_another_length_changes_no_interface() -> None:
    text = POSES[MAIN].replace("[0.0, 0.1]", "[0.0]")
    _, repair = shown(analysed({**POSES, MAIN: text}))
    assert repair is None
