"""Arguments of findings about userdata, types and expressions: what the finding is about."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source
from smachac.driver import CODES, read_machine
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.report.explain_code import MAIN, explanation

BUILT_IN = disk_library(Path("main.yml"), [])

EXAMPLES: Mapping[str, list[tuple[str, ...]]] = {
    "SM016": [("lambda ud: ud.n +",)],
    "SM301": [("pose",)],
    "SM302": [("psoe", "block_pose")],
    "SM303": [("pose",)],
    "SM304": [("part", "str", "Pose")],
    "SM305": [("old_pose",)],
    "SM306": [("input", "speed")],
    "SM307": [("pose",)],
    "SM308": [("n",)],
    "SM310": [("level",)],
    "SM311": [("ud.limb + 1",)],
    "SM312": [("ud.gripper == 'shut'",)],
    "SM313": [("speed",)],
}
"""The arguments of the findings in the example of each code."""


def checked(text: str, **files: str) -> Report:
    library = memory_library({f"{name}.yml": each for name, each in files.items()}, BUILT_IN)
    machine = read_machine(Source(MAIN, text), library, [])
    assert machine is not None
    return [item for item in check_machine(machine) if item.severity is not Severity.INFO]


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_example_of_a_code_has_its_names_as_arguments(code: str) -> None:
    report = checked(explanation(CODES[code]).wrong[MAIN])
    assert [item.finding.arguments for item in report] == EXAMPLES[code]


PART = """
- PART:
    template: StateMachine
    outcomes: [done]
    input_keys: [spare]
    userdata: {left_over: 1, word: left}
    states:
      - READ:
          template: PrintUserdataState
          input_keys: [goal]
          remapping: {gaol: place}
          transitions: {succeeded: COUNT}
      - COUNT:
          template: CallbacksState
          input_keys: [word]
          callbacks: {tries: 'lambda ud: ud.word + 1', more: 'lambda ud: ud.unknown'}
          transitions: {succeeded: LAST}
      - LAST:
          template: PrintUserdataState
          input_keys: [never]
          transitions: {succeeded: done}
"""
CALLS = """
name: sm
template: Base
outcomes: [done]
userdata: {a: 1, b: text}
states:
  - FIRST: {script: part, remapping: {spare: a}, transitions: {done: SECOND}}
  - SECOND: {script: part, remapping: {spare: b}, transitions: {done: done}}
"""


def test_arguments_do_not_depend_on_the_caller_of_a_sub_script() -> None:
    report = [item for item in checked(CALLS, part=PART) if item.span.source.name == "part.yml"]
    inside: dict[str, set[tuple[object, ...]]] = {"FIRST": set(), "SECOND": set()}
    for item in report:
        caller = (item.finding.node or "").split("/")[1]
        inside[caller].add((item.code, item.span, item.finding.arguments))
    assert inside["FIRST"] == inside["SECOND"]
    assert {code for code, *_ in inside["FIRST"]} >= {
        "SM301", "SM302", "SM305", "SM306", "SM308", "SM310", "SM311",
    }  # fmt: skip


def test_two_faults_in_one_function_have_different_places_and_arguments() -> None:
    text = """
name: sm
template: Base
outcomes: [done]
states:
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [done]
      callbacks: {done: 'lambda ud: ud.one and ud.two'}
      default_outcome: done
      transitions: {done: done}
"""
    items = [item for item in checked(text) if item.code == "SM310"]
    assert [(item.span.text, item.finding.arguments) for item in items] == [
        ("one", ("one",)),
        ("two", ("two",)),
    ]
