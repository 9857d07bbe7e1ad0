"""Workers of a sweep as processes of this computer."""

from __future__ import annotations

import gc
import multiprocessing
import os
import signal
import threading
from collections.abc import Sequence
from multiprocessing import connection
from multiprocessing.connection import Connection

from smachac.runtime.signals import SIGNALS
from smachac.sweep.task import Run, Runner, Task


class LocalWorker:
    """A process that performs runs of a task. What the runs print is dropped."""

    def __init__(self, task: Task) -> None:
        context = multiprocessing.get_context("spawn")  # no locks or threads of this process
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(task, theirs), daemon=True)
        self.process.start()
        theirs.close()

    def submit(self, seed: int) -> None:
        try:
            self.connection.send(seed)
        except OSError:
            return  # the process has ended: `result` has the reason

    def result(self) -> Run | str | None:
        try:
            run = self.connection.recv()
        except (EOFError, OSError):
            self.process.join()
            return _ending(self.process.exitcode or 0)
        assert run is None or isinstance(run, Run)
        return run

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.connection.close()


def wait(workers: Sequence[LocalWorker], timeout: float | None) -> list[LocalWorker]:
    """The workers that have a result or have ended."""
    by_connection: dict[object, LocalWorker] = {worker.connection: worker for worker in workers}
    ready = connection.wait([worker.connection for worker in workers], timeout)
    return [by_connection[value] for value in ready]


def _ending(code: int) -> str:
    """How a process has ended, in words."""
    if code >= 0:
        return f"exit code {code}"
    try:
        return f"signal {signal.Signals(-code).name}"
    except ValueError:
        return f"signal {-code}"


def _serve(task: Task, requests: Connection) -> None:
    """Perform the runs that are requested, until the other end closes."""
    if hasattr(signal, "pthread_sigmask"):  # they are for the process that has the results
        signal.pthread_sigmask(signal.SIG_BLOCK, SIGNALS)
    else:
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in (0, 1, 2):
        os.dup2(nowhere, stream)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    runner = Runner(task)
    runner.prepare()
    gc.collect()
    gc.freeze()  # the compiler stays: only the objects of runs are collected
    requests.send(None)
    while True:
        try:
            seed = requests.recv()
        except (EOFError, OSError):
            return
        requests.send(runner.run(seed))


def _end_with_parent() -> None:
    """End this process when the one that started it has ended, also in the middle of a run."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
