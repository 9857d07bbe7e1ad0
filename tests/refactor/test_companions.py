"""Scenarios and faults follow a refactoring of the script that they belong to."""

from __future__ import annotations

import json
import random
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.ir.nodes import Leaf
from smachac.ir.script_paths import walk_script
from smachac.ir.traversal import outcome_names
from tests.refactor.test_refactorings import SEEDS, machine
from tests.refactor.test_refactorings import project as project

SUB = """\
- DELIVER:
    template: StateMachine
    outcomes: [done, failed]
    states:
      - PICK:
          template: ScriptedState
          outcomes: [held, lost]
          output_keys: [part]
          transitions: {held: GIVE, lost: failed}
      - GIVE:
          template: ScriptedState
          outcomes: [given, failed]
          input_keys: [part]
          retry: {on: [failed], max: 2}
          transitions: {given: done, exhausted: failed, preempted: failed}
"""
MAIN = """\
name: main
template: Base
outcomes: [ok, bad]
states:
  - FIRST: {script: deliver, transitions: {done: SECOND, failed: bad}}
  - SECOND: {script: deliver, transitions: {done: ok, failed: bad}}
"""
OTHER = """\
name: other
template: Base
outcomes: [ok, bad]
states:
  - ONLY: {script: deliver, transitions: {done: ok, failed: bad}}
"""
SCENARIO = """\
# a comment
states:
  main/FIRST/PICK:   # the first one
    - {outcome: held, set: {part: 3}}
    - lost
  FIRST/GIVE: {outcome: {given: 0.5, failed: 0.5}}
  "SECOND/PICK": held
"""
ONLY = "states: {ONLY/PICK: held, GIVE: given}\n"
FAULTS = """\
faults:
  - {kind: limp, state: FIRST/PICK}
  - {kind: limp, state: GIVE}
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def files() -> dict[str, str]:
    """A project with two scripts that share a sub-script, scenarios of both, and faults."""
    found = {
        "deliver.yml": SUB,
        "main.yml": MAIN,
        "other.yml": OTHER,
        "scenarios/main.yml": SCENARIO,
        "scenarios/only.yml": ONLY,
        "faults.yml": FAULTS,
        "notes.yml": "states: {FIRST/PICK: held, PLACE: gone}\n",  # of another machine
    }
    for name, text in found.items():
        Path(name).parent.mkdir(exist_ok=True)
        Path(name).write_text(text, "utf-8")
    return found


@pytest.mark.parametrize(
    ("words", "changed"),
    [
        (
            ["rename", "main.yml", "FIRST/PICK", "GRASP"],
            {
                "scenarios/main.yml": SCENARIO.replace("PICK", "GRASP"),
                "scenarios/only.yml": ONLY.replace("PICK", "GRASP"),
                "faults.yml": FAULTS.replace("PICK", "GRASP"),
            },
        ),
        (
            ["rename", "main.yml", "FIRST", "BEGIN"],
            {
                "scenarios/main.yml": SCENARIO.replace("FIRST", "BEGIN"),
                "faults.yml": FAULTS.replace("FIRST", "BEGIN"),
            },
        ),
        (
            ["rename", "deliver.yml", "GIVE/given", "gone"],
            {
                "scenarios/main.yml": SCENARIO.replace("given", "gone"),
                "scenarios/only.yml": ONLY.replace("given", "gone"),
            },
        ),
        (
            ["rename", "deliver.yml", "FIRST/part", "block"],
            {"scenarios/main.yml": SCENARIO.replace("part", "block")},
        ),
        (["rename", "deliver.yml", "PICK/held", "two words"], {}),
        (
            ["contain", "main.yml", "ALL", "StateMachine", "FIRST", "SECOND"],
            {"scenarios/main.yml": SCENARIO.replace("main/FIRST", "main/ALL/FIRST")},
        ),
        (
            ["edit", "main.yml", "remove", "SECOND"],
            {"scenarios/main.yml": SCENARIO.replace('  "SECOND/PICK": held\n', "")},
        ),
        (["extract", "main.yml", "FIRST", "--diff"], {}),
    ],
)
def test_files_that_follow(
    words: list[str], changed: dict[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    before = files()
    main(words)
    told = capsys.readouterr().out
    beside = [
        name
        for name in before
        if name.startswith("scenarios") or name in ("faults.yml", "notes.yml")
    ]
    for name in beside:
        assert Path(name).read_text("utf-8") == changed.get(name, before[name])
        assert (f"changed {name}" in told) == (name in changed)


def test_a_name_that_two_states_have_then_gets_longer() -> None:
    files()
    second = """\
  - SECOND:
      template: StateMachine
      outcomes: [done, failed]
      states: [{TAKE: {template: ScriptedState, outcomes: [done], transitions: {done: done}}}]
      transitions: {done: ok, failed: bad}
"""
    Path("main.yml").write_text(MAIN[: MAIN.index("  - SECOND")] + second)
    Path("short.yml").write_text("states: {PICK: held}\n")
    assert main(["rename", "main.yml", "SECOND/TAKE", "PICK"]) == 0
    assert Path("short.yml").read_text() == "states: {FIRST/PICK: held}\n"


def test_a_sub_script_is_changed_with_its_caller(capsys: pytest.CaptureFixture[str]) -> None:
    files()
    assert main(["rename", "deliver.yml", "PICK", "GRASP", "--check"]) == 1
    assert "deliver.yml is a part of main.yml\n" in capsys.readouterr().out
    Path("main.yml").unlink()
    Path("other.yml").unlink()
    assert main(["rename", "deliver.yml", "PICK", "GRASP"]) == 1
    assert "this list is a sub-script" in capsys.readouterr().err


def played(scenario: str) -> list[tuple[str, str]]:
    """The states that a scenario visits, and how each of them ends."""
    trace = Path("trace.jsonl")
    assert main(["run", "main.yml", "--mock", scenario, "--trace", str(trace)]) == 0
    events = [json.loads(line) for line in trace.read_text("utf-8").splitlines()]
    leaves = {path.full for path in walk_script(machine().root) if isinstance(path.node, Leaf)}
    shown = {path.shown for path in walk_script(machine().root) if path.full in leaves}
    return [
        (event["path"].rpartition("/")[2], event.get("outcome", ""))
        for event in events
        if event["event"] in ("enter", "exit") and event["path"] in shown
    ]


@pytest.mark.parametrize("project", SEEDS, indirect=True)
def test_scenarios_run_as_before(
    project: random.Random, capsys: pytest.CaptureFixture[str]
) -> None:
    """A scenario of a random project visits the same states after a state and an outcome were
    renamed, and after states were moved into a container."""
    main(["new", "scenario", "main.yml", "-q"])
    scenarios = (
        sorted(map(str, Path("scenarios").glob("*.yml"))) if Path("scenarios").exists() else []
    )
    before = {name: played(name) for name in scenarios}
    names: dict[str, str] = {}
    states = [path for path in walk_script(machine().root) if isinstance(path.node, Leaf)]
    for number in range(2):
        state = project.choice(states)
        if main(["rename", "main.yml", state.plain, f"NEW_{number}"]) == 0:
            names[state.node.name] = f"NEW_{number}"
            break
    outcomes: dict[tuple[str, str], str] = {}
    state = project.choice(
        [path for path in walk_script(machine().root) if isinstance(path.node, Leaf)]
    )
    outcome = project.choice(outcome_names(state.node))
    if (
        main(["rename", "main.yml", f"{state.plain}/{outcome}", "renamed", "--kind", "outcome"])
        == 0
    ):
        outcomes[state.node.name, outcome] = "renamed"
    capsys.readouterr()
    for name, visits in before.items():
        wanted = [(names.get(state, state), end) for state, end in visits]
        assert [(state, outcomes.get((state, end), end)) for state, end in wanted] == played(
            name
        ), (name, names, outcomes)
