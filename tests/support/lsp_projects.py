"""Projects of several files, for checks after changes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

FILES = {
    "main.yml": """\
name: sm
template: Base
outcomes: [done, stuck]
types: {Joints: "float[7]"}
params: {seconds: 2}
userdata: {target: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]], tries: 0}
states:
- FIRST: {script: part, remapping: {pose: target}, transitions: {ok: SECOND, bad: stuck}}
- SECOND:
    script: part
    params: {seconds: 3}
    remapping: {pose: target}
    transitions: {ok: THIRD, bad: stuck}
- THIRD: {script: wait, transitions: {succeeded: LAST, preempted: stuck}}
- LAST: {script: grasp, transitions: {succeeded: done, lost: stuck}}
""",
    "part.yml": """\
- PART:
    template: StateMachine
    outcomes: [ok, bad]
    input_keys: [pose]
    states:
    - PLAN:
        template: PoseToJointPositionsState
        remapping: {joints: positions}
        transitions: {succeeded: MOVE, aborted: bad}
    - MOVE:
        template: MoveToJointPositionsState
        timeout: 5
        transitions: {succeeded: WAIT, aborted: bad, preempted: bad, timeout: bad}
    - WAIT: {script: wait, transitions: {succeeded: ok, preempted: bad}}
""",
    "wait.yml": """\
- WAIT:
    template: SleepState
    time: [params, seconds]
""",
    "grasp.yml": """\
- GRASP:
    template: Grasp
    outcomes: [succeeded, lost]
    retry: {on: [lost], max: 2}
    transitions: {exhausted: lost}
""",
    "templates/Grasp.yml": """\
name: Grasp
output_keys: {width: float}
outcomes: {succeeded: {}, lost: {failure: true}}
code: {python: "cell:Grasp"}
""",
    "cell.py": """\
import smach


class Grasp(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded", "lost"], output_keys=["width"])

    def execute(self, userdata):
        userdata.width = 0.1
        return "succeeded" if userdata.width else "lost"
""",
}
"""A project in which sub-scripts call others, with params, a state type and a class of its own."""

FAULTY = {
    "main.yml": """\
name: sm
template: Base
outcomes: [done, stuck]
states:
- FIRST: {script: faults, transitions: {ok: SECOND, bad: stuck}}
- SECOND: {script: wait, transitions: {succeeded: done, preempted: stuck}}
""",
    "wait.yml": """\
- WAIT:
    template: SleepState
    time: 1
""",
    "faults.yml": """\
- FAULTS:
    template: StateMachine
    outcomes: [ok, bad]
    input_keys: [nothing]
    userdata: {level: 1, unread: 2}
    states:
    - REMAP:
        template: PrintUserdataState
        input_keys: [level]
        remapping: {levle: level}
        transitions: {succeeded: CALLS, sucess: bad}
    - CALLS:
        template: CallbacksState
        input_keys: [level]
        output_keys: [sum, unset]
        callbacks: {sum: 'lambda ud: ud.lvl + factor', more: 'lambda ud: ud.level'}
        transitions: {succeeded: SLIP}
    - SLIP:
        template: CallbacksState
        output_keys: [sum]
        callbacks: {sum: 'lambda ud: ('}
        transitions: {succeeded: AWAY}
    - AWAY:
        template: StateMachine
        outcomes: [back]
        states:
        - LEAVE: {template: SleepState, time: 1, transitions: {succeeded: nowhere}}
        transitions: {back: LAST}
    - LAST:
        template: ScriptedState
        outcomes: [ended, left]
        output_keys: [sum]
        transitions: {ended: ok}
""",
}
"""A project in which one sub-script has many faults, and another one none."""


def project(folder: Path, files: Mapping[str, str] = FILES) -> dict[str, str]:
    """Write a project; its texts by real path."""
    texts = {}
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True, parents=True)
        path.write_text(text, "utf-8")
        texts[os.path.realpath(path)] = text
    return texts
