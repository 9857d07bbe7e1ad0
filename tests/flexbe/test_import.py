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
from tests.flexbe import stand_in
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
    monkeypatch.setattr(stand_in.EventState, "PERIOD", 0)
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


def test_the_program_does_what_the_behavior_does(project: Path) -> None:
    outcome, held = run(importlib.import_module("machine").DeliverySM)
    assert outcome == "finished"
    assert held["log"] == ["HELLO", "placed"]
    assert (held["spot"], held["held"]) == (7, False)
    with loaded(files_of(project)) as made:
        assert run(made) == (outcome, held)


class Calls:
    """The calls of the states, with outcomes and ticks without one by `seed`. The behavior gets a
    request to stop in the call of the number `preempted`."""

    def __init__(self) -> None:
        self.made: list[str] = []
        self.seed, self.preempted = 0, -1

    def execute(self, state: Any) -> str | None:
        if len(self.made) == self.preempted:
            stand_in.PreemptableState.preempt = True
        name = type(state).__name__
        ends = [*([None] if len(self.made) < 300 else []), *OUTCOMES[name]]
        outcome = ends[zlib.crc32(f"{self.seed} {len(self.made)} {state.path}".encode()) % len(ends)]
        self.made.append(f"execute {state.path} {outcome}")
        return outcome

    def called(self, event: str) -> Any:
        def call(state: Any, userdata: Any = None) -> None:
            self.made.append(f"{event} {state.path}")
            if event == "on_enter" and type(state).__name__ == "Look":
                userdata.place = len(self.made)

        return call

    def of(self, made: Any) -> tuple[str, dict[str, Any], list[str]]:
        """The outcome, the userdata and the calls of a run."""
        self.made.clear()
        return (*run(made), [*self.made])


@pytest.fixture
def calls(project: Path, monkeypatch: pytest.MonkeyPatch) -> Calls:
    states, found = importlib.import_module("arm_states"), Calls()
    for name in STATES:
        cls = getattr(states, name)
        monkeypatch.setattr(cls, "execute", lambda self, userdata: found.execute(self))
        for event in ("on_enter", "on_exit", "on_start", "on_stop"):
            monkeypatch.setattr(cls, event, found.called(event), raising=False)
    return found


def test_random_outcomes(project: Path, calls: Calls) -> None:
    """All calls of the states are the same."""
    ends = set()
    behavior = importlib.import_module("machine").DeliverySM
    with loaded(files_of(project)) as made:
        for calls.seed in range(RUNS):
            expected = calls.of(behavior)
            assert calls.of(made) == expected
            ends.add(expected[0])
    assert ends == {"finished", "failed"}


def test_requests_to_stop(project: Path, calls: Calls) -> None:
    """FlexBE ends the behavior with `preempted`: the states are left without their `on_exit`."""
    behavior = importlib.import_module("machine").DeliverySM
    ends = set()
    with loaded(files_of(project)) as made:
        for calls.seed in range(RUNS):
            calls.preempted = 4 + calls.seed % 12
            expected = calls.of(behavior)
            assert calls.of(made) == expected
            ends.add(expected[0])
    assert "preempted" in ends
