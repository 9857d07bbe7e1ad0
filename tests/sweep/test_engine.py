"""Workers that crash, hang or are killed: no run is lost, none is counted twice."""

from __future__ import annotations

from functools import partial
from pathlib import Path

import pytest

from smachac.diagnostics.source import Source
from smachac.sweep.engine import perform_runs
from smachac.sweep.local import LocalWorker, wait
from smachac.sweep.task import Run, Task
from tests.support.sweeps import ONCE, work_folder

KILL = "os.kill(os.getpid(), signal.SIGKILL)"


def runs(folder: Path, count: int, limit: float | None = None) -> dict[int, Run]:
    path = folder / "main.yml"
    task = Task(source=Source(str(path), path.read_text("utf-8")))
    start = partial(LocalWorker, task)
    found = list(perform_runs(range(count), start, wait, jobs=2, limit=limit))
    by_seed = {run.seed: run for run in found}
    assert len(found) == len(by_seed) == count
    return by_seed


def test_a_run_whose_process_was_killed_is_repeated(tmp_path: Path) -> None:
    found = runs(work_folder(tmp_path, ONCE.format(KILL)), 8)
    assert [found[seed].outcome for seed in range(8)] == ["succeeded"] * 8
    assert len((tmp_path / "begun").read_text().split()) == 9


@pytest.mark.slow
def test_a_run_that_always_ends_its_process_has_failed(tmp_path: Path) -> None:
    found = runs(work_folder(tmp_path, KILL), 8)
    assert found.pop(3).error == "the process of the run ended: signal SIGKILL"
    assert {run.outcome for run in found.values()} == {"succeeded"}
    assert len((tmp_path / "begun").read_text().split()) == 9


@pytest.mark.slow
def test_a_run_that_does_not_end_has_failed(tmp_path: Path) -> None:
    found = runs(work_folder(tmp_path, "threading.Event().wait()"), 6, limit=5)
    assert found.pop(3).error == "the run did not end within 5 s"
    assert {run.outcome for run in found.values()} == {"succeeded"}


@pytest.mark.parametrize(
    ("action", "error"),
    [
        ("raise ValueError('no grip')", "ValueError: no grip"),
        pytest.param("raise SystemExit(3)", "SystemExit", marks=pytest.mark.slow),
    ],
)
def test_a_run_with_an_exception_has_failed(tmp_path: Path, action: str, error: str) -> None:
    found = runs(work_folder(tmp_path, action), 5)
    assert found[3].outcome is None
    assert found[3].error.startswith(error)
    assert {found[seed].outcome for seed in (0, 1, 2, 4)} == {"succeeded"}


def test_workers_end_when_the_iteration_is_left(tmp_path: Path) -> None:
    path = work_folder(tmp_path, "pass") / "main.yml"
    task = Task(source=Source(str(path), path.read_text("utf-8")))
    workers: list[LocalWorker] = []

    def start() -> LocalWorker:
        workers.append(LocalWorker(task))
        return workers[-1]

    found = perform_runs(range(100), start, wait, jobs=2)
    next(found)
    found.close()
    assert len(workers) == 2
    assert not any(worker.process.is_alive() for worker in workers)
