"""Behaviors of FlexBE as scripts: their programs for FlexBE do what the behaviors do."""

from __future__ import annotations

import contextlib
import importlib
import io
import shutil
import sys
import zlib
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from smachac.commands.cli import main
from tests.flexbe.programs import engine_modules, loaded, ready
from tests.refactor.test_python_import import CASES

MODULES = ("machine", "place_sm", "arm_states")
STATES = ("Look", "Note", "Close", "Hold")
OUTCOMES = {"Look": ["seen", "nothing"], "Note": ["noted"], "Close": ["closed", "lost"],
            "Hold": ["slipped"]}  # fmt: skip
RUNS = 60


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """The project of an import of the case `flexbe`, whose modules can be imported."""
    for path in (CASES / "flexbe").glob("*.py"):
        shutil.copy(path, tmp_path)
    (tmp_path / ".git").mkdir()
    monkeypatch.chdir(tmp_path)
    assert main(["import", "machine.py", "-o", "project", "-q"]) == 0
    for name, module in engine_modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    node: Any = ModuleType("smachac.runtime.smach_ros2")  # of the program without FlexBE
    node.program = None
    monkeypatch.setitem(sys.modules, node.__name__, node)
    monkeypatch.syspath_prepend(str(tmp_path))
    importlib.invalidate_caches()
    yield tmp_path / "project"
    for name in MODULES:
        sys.modules.pop(name, None)


def files_of(project: Path) -> dict[str, str]:
    assert main(["build", str(project / "main.yml"), "--target", "flexbe", "-o", "out", "-q"]) == 0
    out = project.parent / "out"
    paths = sorted(out.rglob("*"), key=lambda path: not path.name.endswith("_sm.py"))
    return {path.relative_to(out).as_posix(): path.read_text("utf-8")
            for path in paths if path.is_file()}  # fmt: skip


def run(made: Any) -> tuple[str, dict[str, Any]]:
    """The outcome of a behavior, and the userdata of its machine at the end."""
    with contextlib.redirect_stdout(io.StringIO()):
        behavior = ready(made)
        outcome: str = behavior.execute()
        return outcome, dict(behavior._state_machine._userdata._data)


def original() -> tuple[str, dict[str, Any]]:
    return run(importlib.import_module("machine").DeliverySM)


def test_the_program_does_what_the_behavior_does(project: Path) -> None:
    outcome, held = original()
    assert outcome == "finished"
    assert held["log"] == ["HELLO", "placed"]
    assert (held["spot"], held["held"]) == (7, False)
    with loaded(files_of(project)) as made:
        assert run(made) == (outcome, held)


def test_random_outcomes(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """All calls of the states are the same, with ticks without an outcome."""
    states = importlib.import_module("arm_states")
    calls: list[str] = []
    seed = 0

    def execute(self: Any, userdata: Any) -> str | None:
        name = type(self).__name__
        number = zlib.crc32(f"{seed} {len(calls)} {self.path}".encode())
        outcome = ([None, *OUTCOMES[name]] if len(calls) < 300 else OUTCOMES[name])[
            number % (len(OUTCOMES[name]) + (len(calls) < 300))
        ]
        calls.append(f"execute {self.path} {outcome}")
        return outcome

    def noted(event: str) -> Any:
        def call(self: Any, userdata: Any = None) -> None:
            calls.append(f"{event} {self.path}")
            if event == "on_enter" and type(self).__name__ == "Look":
                userdata.place = len(calls)

        return call

    for name in STATES:
        cls = getattr(states, name)
        monkeypatch.setattr(cls, "execute", execute)
        for event in ("on_enter", "on_exit", "on_start", "on_stop"):
            monkeypatch.setattr(cls, event, noted(event), raising=False)
    ends = set()
    with loaded(files_of(project)) as made:
        for number in range(RUNS):
            seed = number
            calls.clear()
            expected, held = original()
            wanted = [*calls]
            calls.clear()
            assert run(made) == (expected, held)
            assert calls == wanted
            ends.add(expected)
    assert ends == {"finished", "failed"}
