"""The stub of a state type for C++ is what the target wants: a machine that uses it compiles."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.cpp.compilers import Compiler, compilers

COMPILERS = pytest.mark.parametrize("compiler", compilers()[:1], ids=str)

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
userdata: {part: {type: Pose, value: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}}
states:
  - GRASP:
      template: GraspPart
      remapping: {target: part}
      transitions: {held: done, preempted: done}
"""
PROGRAM = """
#include "sm.hpp"
int main() {
  sm::States states;
  sm::Userdata userdata;
  smachac::Stop stop;
  return sm::run(states, userdata, nullptr, stop) == sm::Outcome::done ? 0 : 1;
}
"""


@COMPILERS
def test_a_stub_compiles_and_runs(
    compiler: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT)
    words = ["--input", "target=Pose", "--output", "width=float<m>", "--output", "seen=list[str]"]
    words += ["--outcome", "held", "--outcome", "preempted"]
    assert main(["new", "state", "GraspPart", "--target", "cpp", *words]) == 0
    assert main(["build", "main.yml", "--target", "cpp"]) == 0
    compiler.run(PROGRAM, tmp_path, f"-I{tmp_path}", f"-I{tmp_path / 'include'}", "-pthread")


@pytest.mark.slow
@COMPILERS
def test_variables_become_arguments(
    compiler: Compiler, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("main.yml").write_text(SCRIPT.replace("GraspPart", "GraspPart\n      speed: 0.5"))
    assert main(["new", "state", "GraspPart", "--input", "target=Pose", "--outcome", "held",
                 "--outcome", "preempted"]) == 0  # fmt: skip
    interface = Path("templates/GraspPart.yml")
    code = 'code: {cpp: {header: robot_states/grasp_part.hpp, class: "robot_states::GraspPart"}}\n'
    text = interface.read_text().rpartition("code:")[0]
    variables = "variables: {speed: {type: float}, name: {type: str, default: one}}\n"
    interface.write_text(text + variables + "blocking: true\n" + code)
    assert main(["new", "state", "GraspPart", "--target", "cpp"]) == 0
    assert main(["build", "main.yml", "--target", "cpp"]) == 0
    compiler.run(PROGRAM, tmp_path, f"-I{tmp_path}", f"-I{tmp_path / 'include'}", "-pthread")
