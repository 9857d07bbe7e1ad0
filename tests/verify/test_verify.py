"""`smachac verify`: paths that reach everything, targets compared, differences shown."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.commands.cli import main
from smachac.interpreter.scenario import scenario_text
from smachac.ir.nodes import Machine
from smachac.runtime import smach
from smachac.runtime.tracing import trace
from smachac.verify import verify
from smachac.verify.generate import PathGenerator
from smachac.verify.players.python import player
from smachac.verify.result import Verdict, render_json, render_text
from smachac.verify.sample_values import SampleValues
from tests.support.examples import every
from tests.support.ir_machines import iterator, leaf
from tests.support.ir_machines import machine as state_machine

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*/main.yml"))
CASES = [ROOT / "tests" / "cases" / name / "main.yml" for name in ("containers", "flows")]

ROUNDS = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
  - BOTH:
      template: Concurrence
      outcomes: [fine, mixed, bad]
      default_outcome: bad
      output_keys: [width]
      outcome_map:
        fine: {LEFT: done, RIGHT: done}
        mixed: {LEFT: done, RIGHT: failed}
      transitions: {fine: USE, mixed: BOTH, bad: aborted}
      states:
        - LEFT: {template: ScriptedState, outcomes: [done, failed], output_keys: [width]}
        - RIGHT: {template: ScriptedState, outcomes: [done, failed]}
  - USE:
      template: ScriptedState
      outcomes: [done, late, failed]
      input_keys: [size]
      remapping: {size: width}
      timeout: 1.0
      transitions:
        {done: succeeded, late: BOTH, failed: aborted, timeout: aborted, preempted: aborted}
"""

FOREVER = """\
name: sm
template: Base
outcomes: []
forever: true
states:
  - A: {template: ScriptedState, outcomes: [go, stay], transitions: {go: B, stay: A}}
  - B: {template: ScriptedState, outcomes: [go], transitions: {go: A}}
"""


STOPPABLE = """\
name: sm
template: Base
outcomes: [succeeded, aborted, preempted]
states:
  - GO:
      template: StateMachine
      outcomes: [succeeded, preempted]
      states:
        - WALK:
            template: ScriptedState
            outcomes: [succeeded, preempted]
            transitions: {succeeded: WAVE, preempted: preempted}
        - WAVE:
            template: ScriptedState
            outcomes: [succeeded]
            transitions: {succeeded: succeeded}
      transitions: {succeeded: REST, preempted: preempted}
  - REST:
      template: ScriptedState
      outcomes: [succeeded, preempted]
      transitions: {succeeded: succeeded, preempted: preempted}
"""

COUNTING = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
userdata: {count: 0}
states:
  - COUNT:
      template: CallbacksState
      input_keys: [count]
      output_keys: [count]
      callbacks: {count: "lambda ud: ud.count + 1"}
      transitions: {succeeded: ENOUGH}
  - ENOUGH:
      template: ConditionalOutcomeState
      outcomes: ["true", "false"]
      input_keys: [count]
      default_outcome: "false"
      callbacks: {"true": "lambda ud: ud.count >= 2"}
      transitions: {"true": succeeded, "false": COUNT}
"""

GIVEN = """\
name: sm
template: Base
outcomes: [succeeded]
input_keys: {goal: float, name: str}
states:
  - USE:
      template: ScriptedState
      outcomes: [succeeded]
      input_keys: [goal, name]
      transitions: {succeeded: succeeded}
"""

PYTHON_CODE = """\
name: sm
template: Base
outcomes: [succeeded]
userdata:
  stock: {a: 1, b: 2}
  names: '`"x, y".split(", ")`'
  many: [3, 4]
states:
  - EACH:
      template: Iterator
      outcomes: [done]
      it: '`lambda ud: list(ud.stock.items())`'
      it_label: pair
      exhausted_outcome: done
      input_keys: [stock]
      userdata: {more: '`[n for n in (1, 2)]`'}
      states:
        - TAKE: {template: ScriptedState, outcomes: [ok], input_keys: [pair, more]}
      loop_outcomes: [ok]
      transitions: {done: TWICE}
  - TWICE:
      template: Iterator
      outcomes: [done, lost]
      it: '`lambda ud: [2 * n for n in ud.many]`'
      exhausted_outcome: done
      input_keys: [many]
      states:
        - LOOK: {template: ScriptedState, outcomes: [ok, lost], input_keys: [it_data]}
      loop_outcomes: [ok]
      transitions: {done: WHICH, lost: WHICH}
  - WHICH:
      template: ConditionalOutcomeState
      outcomes: [found, nothing]
      input_keys: [names]
      default_outcome: nothing
      callbacks: {found: "lambda ud: any(name == 'x' for name in ud.names)"}
      transitions: {found: USE, nothing: JOIN}
  - JOIN:
      template: CallbacksState
      input_keys: [names]
      output_keys: [text]
      callbacks: {text: 'lambda ud: ", ".join(ud.names)'}
      transitions: {succeeded: SHOW}
  - SHOW:
      template: CallbacksState
      input_keys: [text]
      output_keys: [shown]
      callbacks: {shown: 'lambda ud: "names: %s" % ud.text'}
      transitions: {succeeded: USE}
  - USE:
      template: ScriptedState
      outcomes: [succeeded]
      input_keys: [names]
      transitions: {succeeded: succeeded}
"""


def program(script: Path) -> tuple[str, str]:
    ((name, text),) = smachac.compile(script, "python").items()
    return name, text


def judged(script: Path, break_: Callable[[str], str] = lambda text: text, **how: Any) -> Verdict:
    machine, (name, text) = smachac.load(script), program(script)
    played = player(name, break_(text), machine, folders=[script.parent])
    return verify(machine, {"python": played}, script=script.name, **how)


def script_of(text: str, folder: Path) -> Path:
    (folder / "main.yml").write_text(text, "utf-8")
    return folder / "main.yml"


@pytest.fixture
def rounds(tmp_path: Path) -> Path:
    return script_of(ROUNDS, tmp_path)


MANY_PATHS = {"14_delivery_round"}
"""Examples in which 60 paths do not take every transition."""


@pytest.mark.parametrize("script", every(2, [*EXAMPLES, *CASES]), ids=lambda path: path.parent.name)
def test_examples_agree_and_are_covered(script: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(script), "--format", "json", "--paths", "60"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["agree"]
    if script.parent.name in MANY_PATHS:
        return
    assert told["coverage"]["missing"] == []
    assert told["coverage"]["taken"] == told["coverage"]["total"] > 0


@pytest.mark.slow
def test_what_cannot_be_taken_has_its_reason() -> None:
    verdict = judged(ROOT / "tests" / "cases" / "sugar" / "main.yml")
    assert verdict.disagreements == []
    assert {(way.path, way.outcome, why.text) for way, _, why in verdict.missing} == {
        ("tour/TRIES", "good", "the state never has this outcome"),
        ("tour/WITHOUT", "succeeded", "the state is never entered"),
        ("tour/WITHOUT", "preempted", "the state never has this outcome"),
    }


@pytest.mark.slow
def test_exceptions_that_are_caught_are_covered() -> None:
    verdict = judged(ROOT / "tests" / "cases" / "on_error" / "main.yml")
    assert verdict.disagreements == []
    assert [(way.path, why.never) for way, _, why in verdict.missing] == [
        ("fetch/CARRY", True),
        ("fetch/EACH", False),
    ]

    def uncaught(text: str) -> str:
        wrong = """\
def error_as_outcome(state, outcome):
    state.register_outcomes([outcome])
    return state


"""
        return text.replace("def build():", f"{wrong}def build():")

    assert len(judged(ROOT / "tests/cases/on_error/main.yml", uncaught).disagreements) == 1


@pytest.mark.slow
def test_combinations_of_branches_and_time_limits_are_covered(rounds: Path) -> None:
    verdict = judged(rounds)
    assert verdict.disagreements == []
    assert verdict.missing == []
    assert verdict.taken == verdict.total == 11


def swapped(text: str) -> str:
    return text.replace('"done": "succeeded"', '"done": "aborted"')


def astray(text: str) -> str:
    return text.replace('{"size": "width"}', '{"size": "widths"}')


def endless(text: str) -> str:
    return text.replace('"done": "succeeded"', '"done": "USE"')


def waiting_for_all(text: str) -> str:
    wrong = """\
def with_timeout(state, seconds, label, made=with_timeout):
    container = made(state, seconds, label)
    container._child_termination_cb = None
    return container


"""
    return text.replace("def build():", f"{wrong}def build():")


@pytest.mark.parametrize("break_", [swapped, astray, endless, waiting_for_all])
def test_a_wrong_target_is_found(
    rounds: Path, break_: Callable[[str], str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(trace, "LONGEST_WAIT", 0.05)
    _, text = program(rounds)
    assert break_(text) != text
    (difference,) = judged(rounds, break_).disagreements
    assert difference.target == "python"
    assert difference.at > 0


def test_a_difference_shows_both_traces_and_a_scenario_to_replay(
    rounds: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    verdict = judged(rounds, swapped)
    text = render_text(verdict)
    marked = next(line for line in text.splitlines() if line.startswith(" ->"))
    assert "transition sm/USE (timeout) done -> sm:succeeded  main.yml:" in marked
    assert "| transition sm/USE (timeout) done -> sm:aborted  main.yml:" in marked
    assert text.endswith("python: differs\n")
    assert json.loads(render_json(verdict))["differences"][0]["target"] == "python"
    scenario = rounds.parent / "scenario.yml"
    scenario.write_text(scenario_text(verdict.disagreements[0].steps), "utf-8")
    assert main(["run", str(rounds), "--mock", str(scenario), "-q"]) == 0
    last = verdict.disagreements[0].expected[-1]
    assert capsys.readouterr().out == f"outcome: {last['outcome']}\n"


def test_a_value_has_the_type_of_the_key_that_holds_it() -> None:
    child = leaf("LOOK", outcomes="seen", outs="n", remaps={"n": "other"})
    each = iterator("EACH", "exhausted", child, held={"n": 1}, items=[0], loop="seen")
    machine = Machine(root=state_machine("sm", "seen", each))
    ((key, value),) = SampleValues(machine).outputs("sm/EACH/LOOK", child, "seen", 0)
    assert (key, type(value)) == ("n", int)


def test_the_same_seed_makes_the_same_paths() -> None:
    machine = smachac.load(EXAMPLES[7])
    paths = [list(PathGenerator(machine, most=80, seed=seed).paths()) for seed in (1, 1, 2)]
    assert paths[0] == paths[1] != paths[2]


def test_paths_are_no_more_than_asked_for(rounds: Path) -> None:
    scenarios = PathGenerator(smachac.load(rounds), most=3)
    assert len(list(scenarios.paths())) == 3
    assert scenarios.left_out != []


def test_a_long_machine_is_gone_through_within_bounds(tmp_path: Path) -> None:
    rows = ["name: sm", "template: Base", "outcomes: [succeeded, aborted]", "states:"]
    for number in range(1000):
        to = f"S{number + 1}" if number < 999 else "succeeded"
        rows.append(
            f"  - S{number}: {{template: ScriptedState, outcomes: [succeeded, again, aborted],"
            f" transitions: {{succeeded: {to}, again: S{number // 2}, aborted: aborted}}}}"
        )
    script = tmp_path / "main.yml"
    script.write_text("\n".join(rows), "utf-8")
    scenarios = PathGenerator(smachac.load(script), most=5)
    assert len(list(scenarios.paths())) == 5
    assert scenarios.left_out != []
    assert scenarios.runner.spent < 100_000


def test_a_machine_without_an_end_is_cut_off(tmp_path: Path) -> None:
    verdict = judged(script_of(FOREVER, tmp_path))
    assert verdict.disagreements == []
    assert verdict.missing == []


def unasked(text: str) -> str:
    return text.replace('"preempted": "preempted"', '"preempted": "succeeded"', 1)


def one_off(text: str) -> str:
    return text.replace("ud.count + 1", "ud.count + 2")


def silent(text: str) -> str:
    """The machine inside does not hear that it is to stop."""
    return text.replace(
        "    return sm\n", "    sm_go.request_preempt = lambda: None\n    return sm\n"
    )


@pytest.mark.parametrize(
    ("script", "break_"), [(STOPPABLE, unasked), (STOPPABLE, silent), (COUNTING, one_off)]
)
def test_requests_to_stop_and_expressions_are_compared(
    script: str, break_: Callable[[str], str], tmp_path: Path
) -> None:
    path = script_of(script, tmp_path)
    verdict = judged(path)
    assert verdict.disagreements == []
    assert verdict.missing == []
    assert break_(program(path)[1]) != program(path)[1]
    assert len(judged(path, break_).disagreements) == 1


def test_a_machine_finds_its_inputs(tmp_path: Path) -> None:
    path = script_of(GIVEN, tmp_path)
    assert judged(path).disagreements == []

    def without(text: str) -> str:
        return text.replace('["goal", "name"]', '["name"]')

    assert len(judged(path, without).disagreements) == 1


def test_code_that_only_python_evaluates_makes_no_difference(tmp_path: Path) -> None:
    """Items, initial values and functions outside the portable expressions: samples replace the
    values on both sides, and such functions do not run."""
    path = script_of(PYTHON_CODE, tmp_path)
    verdict = judged(path)
    assert verdict.disagreements == []
    assert verdict.missing == []

    def without_end(text: str) -> str:
        return text.replace('"found": "USE"', '"found": "EACH"')

    assert len(judged(path, without_end).disagreements) == 1


def test_a_script_with_an_error_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    script = tmp_path / "main.yml"
    script.write_text(ROUNDS.replace("late: BOTH", "late: BOHT"), "utf-8")
    assert main(["verify", str(script)]) == 1
    assert "SM101" in capsys.readouterr().err


def test_a_target_asked_for_twice_is_played_once(
    rounds: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["verify", str(rounds), "--targets", "python,python", "--paths", "9"]) == 0
    assert capsys.readouterr().out.count("python: agrees") == 1


def test_a_target_that_cannot_be_played_is_wrong_usage(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(EXAMPLES[0]), "--targets", "pyhton"]) == 2
    assert "did you mean `python`?" in capsys.readouterr().err


def test_what_a_build_says_is_told_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A warning is no reason not to play; an error is, though it was a warning before."""
    case = ROOT / "tests" / "cases" / "bad_code"
    for path in (path for path in sorted(case.rglob("*")) if path.is_file()):
        target = tmp_path / path.relative_to(case)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(path.read_text("utf-8"), "utf-8")
    monkeypatch.chdir(tmp_path)
    script = Path("main.yml").read_text("utf-8")
    Path("main.yml").write_text(script.partition("  - DROP:")[0].replace("DROP", "done"), "utf-8")
    assert main(["verify", "main.yml"]) == 1
    told = capsys.readouterr().err
    assert told.count("[SM603]") == told.count("error[SM603]") == 1
    look = Path("arm_skills/look.py")
    look.write_text(look.read_text().replace("none", "nothing").replace(', "speed"', ""))
    assert main(["verify", "main.yml"]) == 0
    assert "warning[SM604]" in capsys.readouterr().err


def test_a_program_that_cannot_be_loaded_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(FOREVER, "utf-8")

    def refuse(*_: object, **__: object) -> None:
        raise ImportError("no module named robot")

    monkeypatch.setattr("smachac.targets.python.runner.compile", refuse, raising=False)
    assert main(["verify", str(script)]) == 1
    told = capsys.readouterr().err
    words = "the Python program cannot be loaded: ImportError: no module named robot\n"
    assert words in told


def test_ctrl_c_ends_it(rounds: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("smachac.verify.expected_trace", interrupted)
    before = smach.loginfo
    assert main(["verify", str(rounds)]) == 130
    assert smach.loginfo is before


def test_text_report(rounds: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(rounds), "--paths", "30"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("30 paths (")
    assert "10 of 10 transitions taken (100 %)" in lines
    assert lines[-1] == "python: agrees"
    assert main(["verify", str(rounds), "--paths", "30", "--generated"]) == 0
    assert "14 of 14 transitions taken (100 %)" in capsys.readouterr().out.splitlines()
