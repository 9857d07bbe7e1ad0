"""The arguments of findings about concurrences, robots and targets: names of the script itself."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.checks.robot.workspace import unreachable
from smachac.diagnostics.diagnostic import Report
from smachac.driver import CODES, analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.report.explain_code import MAIN, explanation
from smachac.targets import load_target

SCRIPT = """
name: sm
template: Base
outcomes: [done]
userdata: {one: ONE, two: TWO}
states:
  - A: {script: sub, remapping: {limb: one}, transitions: {done: B}}
  - B: {script: sub, remapping: {limb: two}, transitions: {done: done}}
"""
SUB = """
- SUB:
    template: Concurrence
    outcomes: [done]
    default_outcome: done
    input_keys: [limb]
    states:
      - LEFT: {template: Grasp}
      - RIGHT: {template: Grasp}
"""
GRASP = """
name: Grasp
input_keys: {limb: str}
claims: ["arm.{limb}"]
outcomes: {done: {}}
"""


def findings(folder: Path, files: dict[str, str], target_name: str = "python") -> Report:
    """The findings of check, and of a build if there are no errors."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    report: Report = []
    library = disk_library(folder / MAIN, report)
    source = read_source(folder / MAIN, report)
    assert source is not None
    analysis = analyse(source, library, report, unreachable)
    target = load_target(target_name)
    assert target is not None
    if analysis.checked is not None:
        build(analysis.checked, target, library, analysis.report)
    return analysis.report


@pytest.mark.parametrize(
    ("code", "target", "arguments"),
    [
        ("SM401", "python", ("LEFT", "done", "RIGHT", "slipped")),
        ("SM402", "python", ("left", "right", "LEFT", "found", "RIGHT", "found")),
        ("SM403", "python", ("ready", "RIHGT", "done")),
        ("SM405", "python", ("pose", "LOOK_LEFT", "LOOK_RIGHT")),
        ("SM406", "python", ("arm.left", "HOME", "UP")),
        ("SM408", "python", ("BOTH",)),
        ("SM502", "python", ("home", "4")),
        ("SM503", "python", ("grasp", "1.0", "0.0", "0.0", "1.0")),
        ("SM505", "python", ("from_frame", "hnad")),
        ("SM506", "python", ("goal", "GO", "(1.900, 0.000, 0.100)")),
        ("SM601", "cpp", ("C++", "COUNT", "lambda ud: [x for x in range(3)]")),
        ("SM602", "cpp", ("C++", "Grasp")),
        ("SM603", "python", ("python", "Grasp", "robot_states.grasp:Grasp")),
        ("SM604", "cpp", ("Grasp", "robot_states::Grasp")),
        ("SM606", "python", ("except ValueError, error:",)),
        ("SM607", "python", ("Say", "FIRST", "SECOND")),
    ],
)
def test_arguments_are_the_names_of_the_fault(
    code: str, target: str, arguments: tuple[str, ...], tmp_path: Path
) -> None:
    if code == "SM506":
        pytest.importorskip("pybullet")
    report = findings(tmp_path, dict(explanation(CODES[code]).wrong), target)
    found = [item.finding.arguments for item in report if item.code == code]
    assert set(found) == {arguments}


def test_a_claim_stands_in_the_arguments_as_it_is_written(tmp_path: Path) -> None:
    """Two calls of a sub-script fill in two limbs: the messages differ, the fault is one."""
    files = {MAIN: SCRIPT, "sub.yml": SUB, "templates/Grasp.yml": GRASP}
    found = [item.finding for item in findings(tmp_path, files) if item.code == "SM406"]
    assert [one.message.split("`")[5] for one in found] == ["arm.ONE"]
    assert {one.arguments for one in found} == {("arm.{limb}", "LEFT", "RIGHT")}


def test_two_keys_that_cpp_cannot_store_differ(tmp_path: Path) -> None:
    files = {
        MAIN: """
name: sm
outcomes: [done]
userdata: {one: 9223372036854775808, two: 9223372036854775808}
states:
  - LOOK: {template: PrintUserdataState, input_keys: [one, two], transitions: {succeeded: done}}
"""
    }
    found = [item.finding for item in findings(tmp_path, files, "cpp") if item.code == "SM601"]
    assert [one.arguments for one in found] == [("C++", "one"), ("C++", "two")]
