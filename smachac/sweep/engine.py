"""The runs of a sweep in workers: each worker performs one run after the other.

A worker is a process that can end at any moment: its run is then repeated once in a new one. A run
that ends two workers, or that lasts longer than the limit, is a failed run.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Generator, Iterable, Sequence
from typing import Protocol, TypeVar

from smachac.records import dataclass
from smachac.sweep.task import Run

MOST_TRIES = 2
"""The workers that may end during one run before it counts as failed."""

MOST_STARTS = 3
"""The workers in sequence that may end before they are ready."""


class WorkerError(Exception):
    """No worker starts; the message has the reason."""


class Worker(Protocol):
    """A process that performs runs. It starts with the object, and is then not ready yet."""

    def submit(self, seed: int) -> None:
        """Start the run with a seed; the worker has no other run."""

    def result(self) -> Run | str | None:
        """After `wait` has returned this worker: the result of its run, None if it is now ready for
        its first one, or how the process has ended."""

    def stop(self) -> None:
        """End the process."""


AnyWorker = TypeVar("AnyWorker", bound=Worker)

Start = Callable[[], AnyWorker]
"""Starts a worker."""

Wait = Callable[[Sequence[AnyWorker], "float | None"], Sequence[AnyWorker]]
"""Waits until `result` of some workers does not block, at most for some seconds; these."""


@dataclass(slots=True)
class _Busy:
    """The run of a worker: its seed, how many workers have ended during it before, and when it is
    to be ended (s of the monotonic clock)."""

    seed: int
    tries: int
    deadline: float | None


def perform_runs(
    seeds: Iterable[int],
    start: Start[AnyWorker],
    wait: Wait[AnyWorker],
    *,
    jobs: int,
    limit: float | None = None,
    is_done: Callable[[int], bool] = lambda seed: False,
) -> Generator[Run, None, None]:
    """The runs with these seeds, in the order in which they end, by `jobs` workers.

    A seed that `is_done` when its turn comes is left out. `limit` is the longest wall time of a run
    (s). The workers are stopped when the iteration ends, for whatever reason. Raises WorkerError.
    """
    waiting = deque((seed, 0) for seed in seeds)
    idle: list[AnyWorker] = []
    running: dict[AnyWorker, _Busy | None] = {}  # None: it starts
    failed_starts = 0
    try:
        while True:
            while idle and waiting:
                seed, tries = waiting.popleft()
                if not is_done(seed):
                    worker = idle.pop()
                    running[worker] = _Busy(seed, tries, _deadline(limit))
                    worker.submit(seed)
            starting = sum(now is None for now in running.values())
            for _ in range(min(len(waiting) - starting, jobs - len(running))):
                running[start()] = None
            if not waiting and not any(running.values()):
                return
            for worker in wait(list(running), _left(running.values())):
                now = running.pop(worker)
                result = worker.result()
                if not isinstance(result, str):
                    idle.append(worker)
                    failed_starts = 0
                    if result is not None:
                        yield result
                    continue
                worker.stop()
                if now is None:
                    failed_starts += 1
                    if failed_starts == MOST_STARTS:
                        raise WorkerError(f"the worker processes end when they start: {result}")
                elif now.tries + 1 < MOST_TRIES:
                    waiting.appendleft((now.seed, now.tries + 1))
                else:
                    yield Run(seed=now.seed, error=f"the process of the run ended: {result}")
            yield from _stop_late(running, limit)
    finally:
        for worker in (*idle, *running):
            worker.stop()


def _stop_late(
    running: dict[AnyWorker, _Busy | None], limit: float | None
) -> Generator[Run, None, None]:
    """Stop the workers whose runs have lasted longer than the limit; these runs have failed."""
    for worker, late in [*running.items()]:
        if late is not None and late.deadline is not None and time.monotonic() >= late.deadline:
            del running[worker]
            worker.stop()
            yield Run(seed=late.seed, error=f"the run did not end within {limit:g} s")


def _deadline(limit: float | None) -> float | None:
    return None if limit is None else time.monotonic() + limit


def _left(runs: Iterable[_Busy | None]) -> float | None:
    """The time until the first deadline (s)."""
    deadlines = [run.deadline for run in runs if run is not None and run.deadline is not None]
    return max(0.0, min(deadlines) - time.monotonic()) if deadlines else None
