"""Findings that name the cause in the words of the script: the place, the message, the help."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse, analyse_script
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

HEAD = """
name: sm
template: Base
outcomes: [succeeded, aborted, preempted]
userdata: {parts: [1, 2]}
output_keys: [parts]
states:
"""


def found(states: str, **files: str) -> list[Diagnostic]:
    """The findings above an info, without those about what the small script leaves out."""
    text = f"{HEAD}{states}"
    report = analyse(Source("main.yml", text), memory_library(files, BUILT_IN), []).report
    left_out = ("SM104", "SM203", "SM210")
    return [
        item for item in report if item.severity is not Severity.INFO and item.code not in left_out
    ]


LOOP = """
  - EACH:
      template: Iterator
      it: {it}
      it_label: part
      input_keys: [parts]
      outcomes: [succeeded]
      exhausted_outcome: succeeded
      loop_outcomes: [succeeded]
      states: [{{A: {{template: PrintUserdataState, input_keys: [{key}]}}}}]
      transitions: {{succeeded: succeeded}}
"""

SEQUENCE = """
  - S:
      template: Sequence
      outcomes: [succeeded]
      connector_outcome: {connector}
      states:
        - A: {{template: ScriptedState, outcomes: [succeeded]}}
        - B: {{template: ScriptedState, outcomes: [succeeded]}}
      transitions: {{succeeded: succeeded}}
"""

RETRY = """
  - FIND:
      template: ScriptedState
      outcomes: [found, lost]
      retry: {on: [found], max: 3}
      transitions: {found: succeeded, lost: aborted, exhausted: aborted}
"""

CALL = """
  - FULFIL: {script: fulfil, for_each: {item: order, in: parts}, transitions: {done: succeeded}}
"""
FULFIL = """
- FULFIL:
    template: StateMachine
    outcomes: [done]
    states:
      - A: {template: PrintUserdataState, input_keys: [order], transitions: {succeeded: done}}
"""

GRIPPER = """
  - A:
      template: GripperState
      {name}: left
      command: open
      transitions: {{succeeded: succeeded, aborted: aborted, preempted: preempted}}
"""


@pytest.mark.parametrize(
    ("states", "code", "token", "words"),
    [
        (LOOP.format(it="parts", key="item"), "SM301", "item", "`A` reads `item`, which nothing"),
        (LOOP.format(it="partz", key="part"), "SM301", "partz", "`EACH` iterates over `partz`"),
        ("  - A: {template: PrintUserdataState, input_keys: [part],"
         " for_each: {item: part, in: partz}, transitions: {succeeded: succeeded}}\n",
         "SM301", "partz", "`A` reads `partz`, which nothing"),
        (SEQUENCE.format(connector="suceeded"), "SM201", "suceeded", "did you mean `succeeded`?"),
        (RETRY, "SM102", "found", "`FIND` never ends with `found`"),
        (GRIPPER.format(name="arm"), "SM003", "arm", "its variables are `command`, `limb`"),
        (GRIPPER.format(name="lim"), "SM003", "lim", "did you mean `limb`?"),
        (GRIPPER.format(name="outcome"), "SM003", "outcome", "did you mean `outcomes`?"),
    ],
)  # fmt: skip
def test_the_cause_is_at_its_token(states: str, code: str, token: str, words: str) -> None:
    (item,) = (one for one in found(states) if one.code == code)
    assert item.span.text == token
    assert words in f"{item.message} {item.help}"


def test_correct_loops_and_sequences_have_no_finding() -> None:
    assert found(LOOP.format(it="parts", key="part")) == []
    assert found(SEQUENCE.format(connector="succeeded")) == []


def test_the_loop_around_a_call_provides_the_item() -> None:
    (item,) = found(CALL, **{"fulfil.yml": FULFIL})
    assert item.code == "SM303"
    assert "the loop `FULFIL` provides" in item.message


def test_a_key_that_a_class_reads_undeclared_is_not_dead() -> None:
    files = {
        "templates/Pour.yml": (
            "name: Pour\noutcomes: {done: {}}\ncode: {python: 'cell.pour:Pour'}\n"
        ),
        "cell/__init__.py": "",
        "cell/pour.py": (
            "import smach\n\n\nclass Pour(smach.State):\n    def __init__(self):\n"
            '        super().__init__(outcomes=["done"])\n\n    def execute(self, userdata):\n'
            '        print(userdata.volume)\n        return "done"\n'
        ),
    }
    text = "name: sm\noutcomes: [done]\nuserdata: {volume: 3}\nstates: [{P: {template: Pour}}]\n"
    report = analyse(Source("main.yml", text), memory_library(files, BUILT_IN), []).report
    assert [item.code for item in report if item.severity is not Severity.INFO] == ["SM310"]


@pytest.mark.parametrize(
    ("text", "line", "token", "help"),
    [
        ("scripts: [no]\n", 1, ":", "TOML writes `scripts = [...]`"),
        ("# settings\n  scripts: [no]\n", 2, ":", "TOML writes `scripts = [...]`"),
        ("scripts = [no]\n", 1, "n", "strings have quotes"),
    ],
)
def test_a_wrong_project_file_is_marked_at_the_character(
    text: str, line: int, token: str, help: str, tmp_path: Path
) -> None:
    (tmp_path / "smachac.toml").write_text(text)
    (tmp_path / "main.yml").write_text("name: sm\noutcomes: [done]\nstates: []\n")
    report = analyse_script(tmp_path / "main.yml").report
    (item,) = (one for one in report if one.code == "SM007")
    assert (item.span.line, item.span.text) == (line, token)
    assert help in (item.help or "")
