"""Workers of a sweep as actors of a Ray cluster.

`RAY_ADDRESS` names a cluster; without it Ray starts one on this computer. Scripts, scenes and
modules of the user must have the same paths on all computers.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Sequence
from functools import partial
from importlib import import_module
from typing import Any

from smachac.sweep.engine import perform_runs
from smachac.sweep.task import Run, Runner, Task


def _ray() -> Any:
    """The package, imported when it is needed; it has no types for a computer without it."""
    return import_module("ray")


class RayWorker:
    """An actor that performs runs of a task."""

    def __init__(self, task: Task) -> None:
        ray = _ray()
        self.actor: Any = ray.remote(num_cpus=1, max_restarts=0)(Runner).remote(task)
        self.reference: Any = self.actor.prepare.remote()

    def submit(self, seed: int) -> None:
        self.reference = self.actor.run.remote(seed)

    def result(self) -> Run | str | None:
        ray = _ray()
        try:
            run = ray.get(self.reference)
        except ray.exceptions.RayError as error:
            return type(error).__name__
        assert run is None or isinstance(run, Run)
        return run

    def stop(self) -> None:
        ray = _ray()
        ray.kill(self.actor)


def wait(workers: Sequence[RayWorker], timeout: float | None) -> list[RayWorker]:
    """The workers that have a result or have ended."""
    ray = _ray()
    by_reference = {worker.reference: worker for worker in workers}
    ready, _ = ray.wait(list(by_reference), timeout=timeout)
    return [by_reference[item] for item in ready]


def runs(
    task: Task,
    seeds: Iterable[int],
    *,
    jobs: int | None = None,
    limit: float | None = None,
    is_done: Callable[[int], bool] = lambda seed: False,
    start: Callable[[Task], RayWorker] = RayWorker,
) -> Generator[Run, None, None]:
    """The runs with these seeds, in the order in which they end, by `jobs` actors; without a
    number by as many as the cluster has cores."""
    ray = _ray()
    began = not ray.is_initialized()
    if began:
        ray.init(log_to_driver=False, include_dashboard=False, logging_level="error")
    try:
        count = jobs or int(ray.cluster_resources().get("CPU", 1))
        yield from perform_runs(
            seeds, partial(start, task), wait, jobs=count, limit=limit, is_done=is_done
        )
    finally:
        if began:
            ray.shutdown()
