"""The field `doc` of states and containers in programs and pictures."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from tests.targets.test_hostile_text import HOSTILE, assert_harmless, programs

HOSTILE_DOCS = (
    *HOSTILE,
    "*/ evil() /*",
    "ends with a backslash \\\nevil()",
    "a trigraph ??/\nevil()",
    "x\0\nevil()",
    "x\r\nevil()\revil()",
    "x\u2028evil()\x0cevil()\x85evil()",
    '"""\nevil()\n"""',
    "'''\nevil()\n'''",
    '"quoted"',
    "\\N \\G \\\\",
    "\U0001f916",
    "{{ evil() }} {% set evil = 1 %}",
    "-*- coding: utf-7 -*-",
)


def script(doc: str) -> str:
    """A script with a text as `doc` of its base, a state, a small and a large container, and a
    state with a time limit."""

    def state(name: str, target: str, **more: object) -> dict[str, object]:
        return {name: {"template": "SleepState", "time": 1, "doc": doc, **more,
                       "transitions": {"succeeded": target, "preempted": "done",
                                       **({"timeout": "done"} if more else {})}}}  # fmt: skip

    def box(name: str, count: int, target: str) -> dict[str, object]:
        names = [f"{name}_{number}" for number in range(count)]
        states = [state(each, to) for each, to in zip(names, [*names[1:], "done"], strict=True)]
        return {name: {"template": "StateMachine", "doc": doc, "outcomes": ["done"],
                       "transitions": {"done": target}, "states": states}}  # fmt: skip

    states = [state("A", "SMALL"), box("SMALL", 1, "LARGE"), box("LARGE", 9, "LIMITED")]
    states.append(state("LIMITED", "done", timeout=3))
    return json.dumps(
        {"name": "sm", "template": "Base", "doc": doc, "outcomes": ["done"], "states": states},
        ensure_ascii=False,
    )


@pytest.mark.parametrize("doc", HOSTILE_DOCS)
def test_hostile_documentation_stays_text(doc: str, tmp_path: Path) -> None:
    files = programs(script(doc), tmp_path)
    assert files is not None
    assert {name.rpartition(".")[2] for name in files} >= {"py", "hpp", "dot"}
    assert_harmless(files)
    for name, text in files.items():
        if name.endswith(".py"):
            assert "build_large" in text
        else:
            assert not any(line.startswith("evil") for line in text.split("\n"))


def test_documentation_is_above_each_state(tmp_path: Path) -> None:
    files = programs(script("Lifts the block."), tmp_path)
    assert files is not None
    python = files["sm.py"]
    assert '"""Lifts the block."""' in python
    for name in ("A", "SMALL_0", "LARGE_3", "SMALL", "LARGE", "LIMITED"):
        above = rf'# Lifts the block\.\n +smach\.StateMachine\.add\( *(#.*)?\n? *"{name}",'
        assert (re.search(above, python) is None) == (name in ("SMALL", "LARGE"))
    assert "# Lifts the block.\n        sm_small = " in python
    assert 'machine `LARGE`.\n\n    Lifts the block.\n    """' in python
    header = files["sm.hpp"]
    assert "  // Lifts the block.\n  types::A A;" in header
    assert "// Lifts the block.\nnamespace sm::LARGE {" in header
    assert files["sm.dot"].count('tooltip="Lifts the block."') == 15


def test_long_documentation_is_wrapped(tmp_path: Path) -> None:
    files = programs(script("The arm lifts the block. " * 40 + "\n\nThen it waits."), tmp_path)
    assert files is not None
    for name, width in (("sm.py", 99), ("sm.hpp", 88)):
        lines = [line for line in files[name].splitlines() if "lifts" in line or "waits" in line]
        assert len(lines) > 100
        assert max(map(len, lines)) <= width
        assert min(len(line) for line in lines if line.endswith("the")) > 70


def test_documentation_does_not_make_a_program_a_ros_node(tmp_path: Path) -> None:
    files = programs(script("As rospy.sleep, but smach_ros.X needs no node."), tmp_path)
    plain = programs(script("As sleep."), tmp_path)
    assert files is not None
    assert plain is not None
    assert "import rospy" not in files["sm.py"]
    assert "import smach_ros" not in files["sm.py"]
    assert files["sm.py"].count("\ndef ") == plain["sm.py"].count("\ndef ")
