"""`smachac verify --targets yasmin` and `flexbe`: paths played on the stand-ins."""

from __future__ import annotations

import json
import os
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.commands.cli import main
from smachac.verify.players.yasmin import modules
from tests.flexbe.programs import engine_modules as flexbe_modules
from tests.support.examples import every
from tests.yasmin import stand_in as yasmin_stand_in

ROOT = Path(__file__).parents[2]
EXAMPLES = [ROOT / "examples" / name for name in ("03_concurrence", "06_callbacks", "07_iterator")]
CASES = [ROOT / "tests" / "cases" / name for name in ("sugar", "on_error", "containers")]

ROUNDS = """\
name: sm
outcomes: [succeeded, aborted, preempted]
input_keys: {goal: float}
userdata: {sizes: [0.1, 0.2]}
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
      retry: {max: 3, on: [failed]}
      transitions:
        {done: EACH, late: BOTH, exhausted: aborted, timeout: aborted, preempted: preempted}
  - EACH:
      for_each: {item: size, in: sizes}
      template: ScriptedState
      outcomes: [done, failed, preempted]
      input_keys: [size]
      transitions: {done: succeeded, failed: aborted, preempted: preempted}
"""


ENGINES = pytest.mark.parametrize("target", ["yasmin", "flexbe"])


@pytest.fixture
def _engine(monkeypatch: pytest.MonkeyPatch, silent_smach: None) -> None:
    """The stand-ins are the YASMIN, and the FlexBE with its ROS 2, that are installed."""
    monkeypatch.setitem(sys.modules, "yasmin", yasmin_stand_in)
    for name, module in flexbe_modules().items():
        monkeypatch.setitem(sys.modules, name, module)


@pytest.fixture
def rounds(tmp_path: Path) -> str:
    script = tmp_path / "main.yml"
    script.write_text(ROUNDS, "utf-8")
    return str(script)


@pytest.mark.usefixtures("_engine")
@ENGINES
@pytest.mark.parametrize(
    "folder", every(2, [*EXAMPLES, *CASES]), ids=lambda folder: getattr(folder, "name", None)
)
def test_the_executive_does_what_the_interpreter_does(
    folder: Path, target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    script = str(folder / "main.yml")
    assert main(["verify", script, "--targets", target, "--paths", "60", "--format", "json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["targets"] == [target]
    assert told["agree"]
    assert told["coverage"]["taken"] > 1


@pytest.mark.usefixtures("_engine")
def test_retries_time_limits_loops_and_stop_requests_agree(
    rounds: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", rounds, "--targets", "python,yasmin,flexbe", "--paths", "80"]) == 0
    out = capsys.readouterr().out
    assert out.endswith("python: agrees\nyasmin: agrees\nflexbe: agrees\n")
    assert re.search(r"[1-9]\d* stopped", out)


SECRET = """\
name: door
outcomes: [open]
userdata:
  pin: {type: str, value: "1", secret: true}
states:
  - ENTER:
      template: ScriptedState
      outcomes: [done]
      input_keys: [code]
      output_keys: [code]
      remapping: {code: pin}
      steps: [{outcome: done, set: {code: "2"}}]
      transitions: {done: SAY}
  - SAY:
      template: CallbacksState
      input_keys: [code]
      output_keys: [code]
      remapping: {code: pin}
      callbacks: {code: 'lambda ud: ud.code + "#"'}
      transitions: {succeeded: open}
"""


@pytest.mark.usefixtures("_engine")
@ENGINES
def test_secret_values_are_hidden(
    tmp_path: Path, target: str, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(SECRET, "utf-8")
    assert main(["verify", str(script), "--targets", target]) == 0
    assert capsys.readouterr().out.endswith(f"{target}: agrees\n")


FAULTS = {
    "a transition": {
        "yasmin": ('"late": "BOTH"', '"late": "aborted"'),
        "flexbe": ("'late': 'BOTH'", "'late': 'aborted'"),
    },
    "an outcome of a concurrence": {
        "yasmin": ('("mixed", {"LEFT": "done"', '("mixed", {"LEFT": "failed"'),
        "flexbe": ("('mixed', [('LEFT', 'done')", "('mixed', [('LEFT', 'failed')"),
    },
    "a remapping": {
        "yasmin": ('remapping={"size": "width"}', 'remapping={"size": "goal"}'),
        "flexbe": ("remapping={'size': 'width', 'goal'", "remapping={'size': 'goal', 'goal'"),
    },
    "the outcomes of a retry": {
        "yasmin": ('again=["failed"]', "again=[]"),
        "flexbe": ('again=["failed"]', "again=[]"),
    },
    "the transition of a stop": {
        "yasmin": ('"preempted": "preempted"}', '"preempted": "aborted"}'),
        "flexbe": ("'timeout': 'aborted', 'preempted_': 'preempted'",
                   "'timeout': 'aborted', 'preempted_': 'aborted'"),
    },
}  # fmt: skip
"""Wrong programs: the text that is replaced, and the new one, by target."""

MAIN_TEXT = {
    "yasmin": "smachac.targets.yasmin.module_text",
    "flexbe": "smachac.targets.flexbe.behavior_text",
}
"""The function that makes the text with the containers, by target."""


@pytest.mark.usefixtures("_engine")
@ENGINES
@pytest.mark.parametrize("fault", FAULTS)
def test_a_wrong_program_is_found(
    fault: str,
    target: str,
    rounds: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    emit = pkgutil.resolve_name(MAIN_TEXT[target])
    changed = []

    def broken(*arguments: Any) -> str:
        text: str = emit(*arguments)
        wrong = text.replace(*FAULTS[fault][target])
        changed.append(wrong != text)
        return wrong

    monkeypatch.setattr(MAIN_TEXT[target], broken)
    assert main(["verify", rounds, "--targets", target, "--paths", "80"]) == 1
    assert changed == [True]
    assert f"{target} differs from the interpreter" in capsys.readouterr().out


def run_verify(
    rounds: str, folder: Path, target: str = "yasmin"
) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "smachac", "verify", rounds, "--targets", target]
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    return subprocess.run(
        [*command, "--paths", "20"], capture_output=True, encoding="utf-8", env=environment
    )


def test_the_yasmin_of_this_python_is_used(rounds: str, tmp_path: Path) -> None:
    text = Path(yasmin_stand_in.__file__).read_text("utf-8")
    (tmp_path / "yasmin.py").write_text(text, "utf-8")
    done = run_verify(rounds, tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("yasmin: agrees\n")


def test_without_yasmin_it_is_named(rounds: str, tmp_path: Path) -> None:
    (tmp_path / "yasmin.py").write_text("raise ImportError('no shared library')\n", "utf-8")
    done = run_verify(rounds, tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    assert "YASMIN is not here: build it from its repository" in done.stderr
    assert "(no shared library)" in done.stderr


def test_without_flexbe_it_is_named(rounds: str, tmp_path: Path) -> None:
    (tmp_path / "flexbe_core.py").write_text("raise ImportError('no messages')\n", "utf-8")
    done = run_verify(rounds, tmp_path, "flexbe")
    assert (done.returncode, done.stdout) == (1, "")
    assert "FlexBE is not here: build flexbe_core and flexbe_msgs" in done.stderr
    assert "(no messages)" in done.stderr


@pytest.mark.usefixtures("_engine")
def test_packages_that_do_not_load_are_named(
    rounds: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "import no_such_module\n"
    monkeypatch.setattr(MAIN_TEXT["flexbe"], lambda *_: text)
    assert main(["verify", rounds, "--targets", "flexbe"]) == 1
    assert "the packages for FlexBE cannot be loaded" in capsys.readouterr().err
    assert not [name for name in sys.modules if "main_flexbe" in name]


@pytest.mark.usefixtures("_engine")
def test_a_program_that_does_not_load_is_named(
    rounds: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("smachac.targets.yasmin.module_text", lambda *_: "import no_such_module\n")
    assert main(["verify", rounds, "--targets", "yasmin"]) == 1
    assert "the program for YASMIN cannot be loaded" in capsys.readouterr().err
    assert "smachac_yasmin" not in sys.modules


OWN = """\
import smachac.runtime.smach as smach


class One(smach.State):
    def __init__(self):
        super().__init__(outcomes=["ok"])

    def execute(self, userdata):
        return "ok"


class Mine(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["ok"])
        with self:
            smach.StateMachine.add("ONE", One(), transitions={"ok": "ok"})
"""


@pytest.mark.usefixtures("_engine")
def test_a_state_whose_class_is_a_container(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the script it is one state; it also runs as one."""
    script = tmp_path / "main.yml"
    state = "{template: Mine, transitions: {ok: done}}"
    script.write_text(f"name: own\noutcomes: [done]\nstates:\n  - X: {state}\n", "utf-8")
    (tmp_path / "templates").mkdir()
    interface = 'outcomes: [ok]\ncode: {python: "own_container:Mine"}\n'
    (tmp_path / "templates" / "Mine.yml").write_text(interface, "utf-8")
    (tmp_path / "own_container.py").write_text(OWN, "utf-8")
    assert main(["verify", str(script), "--targets", "python,yasmin,flexbe"]) == 0
    ends = "python: agrees\nyasmin: agrees\nflexbe: agrees\n"
    assert capsys.readouterr().out.endswith(ends)
    monkeypatch.syspath_prepend(tmp_path)
    with modules(smachac.compile(script, "yasmin")) as module:
        assert module.run().execute() == "done"
