"""docs/semantics.md says what is true: its scripts are run, and print what the page shows."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.commands.cli import main
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.runtime.tracing.compare import compare

PAGE = Path(__file__).parents[2] / "docs" / "semantics.md"
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL)
FILES = {text.split("\n", 1)[0].removeprefix("# "): text for kind, text in BLOCKS if kind == "yaml"}
ROWS = re.findall(
    r"^\| (grasped|slipped) \| (\w+) \|.*\| (\w+)[^|]*\|$", PAGE.read_text("utf-8"), re.MULTILINE
)
"""Of the table of rules: how LEFT and RIGHT end, and GRASP."""
MACHINES = sorted(name for name, text in FILES.items() if "\nname: " in text)


def commands() -> Iterator[tuple[str, str]]:
    """Every command of the page, and what is shown to come of it."""
    for kind, text in BLOCKS:
        if kind == "console":
            for part in re.split(r"^\$ smachac ", text, flags=re.MULTILINE)[1:]:
                command, _, shown = part.partition("\n")
                yield command, shown


def without_times(text: str) -> str:
    return re.sub(r"\d+\.\d\d s$", "0.00 s", text, flags=re.MULTILINE)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The files of the page, where its commands are given."""
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_blocks_are_found() -> None:
    assert all(re.fullmatch(r"\w+\.yml", name) for name in FILES)
    assert set(MACHINES) > {"fetch.yml", "carry.yml"}
    assert len(list(commands())) >= len(MACHINES) - 1
    assert len(ROWS) == 4
    assert {kind for kind, _ in BLOCKS} == {"yaml", "console", "json"}


@pytest.mark.parametrize(("command", "shown"), list(commands()))
def test_a_command_prints_what_is_shown(
    command: str, shown: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(shlex.split(command))
    out, err = capsys.readouterr()
    printed = out or err[err.index("the run failed") :]
    if "--mock" not in command:
        printed, shown = without_times(printed), without_times(shown)
    assert printed == shown


@pytest.mark.parametrize("name", MACHINES)
def test_a_machine_has_no_error(name: str, folder: Path) -> None:
    assert smachac.load(name).root.children


APART = {"carry.yml", "late.yml", "look.yml", "speed.yml"}
"""They wait in real time, have a race, or fail; their commands are tested above."""


@pytest.mark.parametrize("name", sorted(set(MACHINES) - APART))
def test_the_interpreter_and_the_program_agree(name: str, folder: Path) -> None:
    program: list[dict[str, Any]] = []
    interpreter: list[dict[str, Any]] = []
    outcome = smachac.run(name, observe=program.append).outcome
    assert run(smachac.load(name), builtin_behaviour(), interpreter.append).outcome == outcome
    assert compare(program, interpreter) is None


@pytest.mark.parametrize(("left", "right", "outcome"), ROWS)
def test_the_table_of_rules(
    left: str, right: str, outcome: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "play.yml").write_text(f"states: {{LEFT: {left}, RIGHT: {right}}}\n")
    assert main(["run", "both.yml", "--mock", "play.yml", "--quiet", "--expect", outcome]) == 0


def test_the_trace_is_the_one_that_is_written(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(["run", "carry.yml", "--mock", "as_written.yml", "--quiet", "--trace", "trace.jsonl"])
    (shown,) = [text for kind, text in BLOCKS if kind == "json"]
    assert shown in (folder / "trace.jsonl").read_text("utf-8")


@pytest.mark.parametrize("name", ["fetch", "both"])
def test_pictures_of_machines_show_all_of_them(name: str, folder: Path) -> None:
    """They are made by `smachac build --target dot --option rankdir=LR` and `dot -Tsvg`."""
    picture = (PAGE.parent / "images" / f"{name}.svg").read_text("utf-8")
    machine = smachac.load(f"{name}.yml")
    states = re.findall(r"- ([A-Z]+):", FILES[f"{name}.yml"])
    outcomes = [one.name for one in machine.root.outcomes]
    assert [word for word in [*states, *outcomes] if f">{word}<" not in picture] == []
