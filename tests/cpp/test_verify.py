"""`smachac verify --targets cpp`: scenes played on the compiled C++."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.targets.cpp.header import Header, header_of
from smachac.targets.cpp.plan import Plan
from smachac.verify.players import cpp
from smachac.verify.players.cpp import Compiler
from tests.cpp.compilers import compilers

ROOT = Path(__file__).parents[2]
EXAMPLES = [ROOT / "examples" / name for name in ("03_concurrence", "06_callbacks", "07_iterator")]
CASES = [ROOT / "tests" / "cases" / name for name in ("sugar", "on_error")]

ROUNDS = """\
name: sm
template: Base
outcomes: [succeeded, aborted, preempted]
input_keys: {goal: float}
states:
  - BOTH:
      template: Concurrence
      outcomes: [fine, mixed, bad]
      default_outcome: bad
      input_keys: [goal]
      output_keys: [width]
      outcome_map:
        fine: {LEFT: done, RIGHT: done}
        mixed: {LEFT: done, RIGHT: failed}
      transitions: {fine: USE, mixed: BOTH, bad: aborted}
      states:
        - LEFT:
            template: ScriptedState
            outcomes: [done, failed]
            input_keys: [goal]
            output_keys: [width]
            steps: [{outcome: done, set: {width: 0.1}}]
        - RIGHT: {template: ScriptedState, outcomes: [done, failed]}
  - USE:
      template: ScriptedState
      outcomes: [done, late, failed, preempted]
      input_keys: [size, goal]
      remapping: {size: width}
      timeout: 1.0
      transitions:
        {done: succeeded, late: BOTH, failed: aborted, timeout: aborted, preempted: preempted}
"""

HERE = pytest.mark.skipif(not compilers(), reason="no C++ compiler")


@HERE
@pytest.mark.parametrize("folder", [*EXAMPLES, *CASES], ids=lambda folder: folder.name)
@pytest.mark.slow
def test_cpp_does_what_the_interpreter_does(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = str(folder / "main.yml")
    assert main(["verify", script, "--targets", "cpp", "--paths", "60", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["targets"] == ["cpp"]
    assert told["agree"]
    assert told["coverage"]["taken"] > 1


def astray(text: str) -> str:
    return text.replace('"done", Outcome::succeeded', '"done", Outcome::aborted')


def mistaken(text: str) -> str:
    return text.replace("ended.RIGHT ==", "ended.RIGHT !=")


def crossed(text: str) -> str:
    return text.replace("ud.goal, ud.width}", "ud.goal, ud.goal}")


def deaf(text: str) -> str:
    return text.replace("branches.run(true,", "branches.run(false,")


def crashing(text: str) -> str:
    return re.sub(r"return run\.end", r"std::abort(); \g<0>", text, count=1)


@HERE
@pytest.mark.parametrize("break_", [astray, mistaken, crossed, deaf, crashing])
@pytest.mark.slow
def test_a_wrong_header_is_found(
    break_: Callable[[str], str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(ROUNDS, "utf-8")
    changed = []

    def broken(planned: Plan, *, with_records: bool = True) -> Header:
        header = header_of(planned, with_records=with_records)
        changed.append(break_(header.text) != header.text)
        return header._replace(text=break_(header.text))

    monkeypatch.setattr("smachac.verify.players.cpp_program.header_of", broken)
    assert main(["verify", str(script), "--targets", "cpp", "--paths", "40"]) == 1
    assert any(changed)
    out = capsys.readouterr().out
    assert "cpp differs from the interpreter" in out
    assert "main.yml:" in next(line for line in out.splitlines() if line.startswith(" ->"))


@HERE
def test_cpp_and_python_agree_in_one_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(ROUNDS, "utf-8")
    assert main(["verify", str(script), "--targets", "python,cpp", "--paths", "40"]) == 0
    assert capsys.readouterr().out.endswith("python: agrees\ncpp: agrees\n")


def test_without_a_compiler_one_is_asked_for(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(cpp, "compilers", lambda: ())
    assert main(["verify", str(EXAMPLES[0] / "main.yml"), "--targets", "cpp"]) == 1
    assert "no C++ compiler is here: install g++ or clang++" in capsys.readouterr().err


def test_what_does_not_compile_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    failing = Compiler("g++", ("python3", "-c", "import sys; sys.exit('x: error: no')"))
    monkeypatch.setattr(cpp, "compilers", lambda: (failing,))
    assert main(["verify", str(EXAMPLES[0] / "main.yml"), "--targets", "cpp"]) == 1
    assert "the C++ program does not compile:\nx: error: no" in capsys.readouterr().err


def test_what_cpp_cannot_say_is_reported(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    text = ROUNDS.replace("- USE:", "- BOTH_:").replace("fine: USE", "fine: BOTH_")
    script.write_text(text.replace("- BOTH:", "- BOTH-:").replace(": BOTH,", ": BOTH-,"), "utf-8")
    assert main(["verify", str(script), "--targets", "cpp"]) == 1
    assert "SM601" in capsys.readouterr().err
