"""Sweeps of a simulated arm: the rate of several workers against that of one, the memory of a
worker over many runs, and the success rate against its Markov prediction.

    python bench/sweep.py [runs [runs for the rates [rounds]]]
"""

from __future__ import annotations

import os
import statistics
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from smachac import load
from smachac.diagnostics.source import Source
from smachac.ir.outcome_names import successes
from smachac.robots.faults import read_file as read_faults
from smachac.robots.files import read_file
from smachac.sweep.database import Database
from smachac.sweep.engine import perform_runs
from smachac.sweep.local import LocalWorker, wait
from smachac.sweep.summary import Totals
from smachac.sweep.task import Runner, Task
from smachac.verify.statistics_report import forecast
from smachac.verify.trace_statistics import wilson_interval

MACHINES = Path(__file__).parent / "machines"
WARM_UP = 2
"""The runs before the clock starts."""


def task() -> Task:
    script = MACHINES / "slip.yml"
    faults = read_faults(read_file(MACHINES / "slip_faults.yml"))
    return Task(source=Source(str(script), script.read_text("utf-8")), faults=faults)


def cpu_time() -> float:
    """The CPU time of this process and of its children that have ended (s)."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


def cpu_of_one(runs: int) -> float:
    """The CPU time of a run in a loop in this process (s), after it has warmed up."""
    runner = Runner(task())
    with quiet():
        for seed in range(WARM_UP):
            runner.run(seed)
        began = time.process_time()
        for seed in range(runs):
            runner.run(seed)
        return (time.process_time() - began) / runs


@contextmanager
def quiet() -> Iterator[None]:
    """Drops the standard output of this process, also that of C++."""
    sys.stdout.flush()
    kept, nowhere = os.dup(1), os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)
        os.close(nowhere)


def sweep_of(jobs: int, runs: int) -> tuple[float, float]:
    """The CPU time of a sweep with its database, of all processes from start to end (s), and the
    share of the workers' time that they spent in runs after they had started."""
    began, busy, started = cpu_time(), 0.0, 0.0
    with TemporaryDirectory() as folder:
        database = Database(Path(folder) / "runs.db", {})
        workers = partial(LocalWorker, task())
        for number, run in enumerate(perform_runs(range(runs), workers, wait, jobs=jobs)):
            database.add(run)
            if number == jobs - 1:
                started = time.perf_counter()
            elif number >= jobs:
                busy += run.wall
        database.close()
    seconds = time.perf_counter() - started
    return cpu_time() - began, busy / (jobs * seconds)


def memory(worker: LocalWorker) -> float:
    """The resident memory of a worker (MB)."""
    status = Path(f"/proc/{worker.process.pid}/status").read_text()
    line = next(line for line in status.splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def rates(runs: int, rounds: int, jobs: int = 2) -> None:
    """The CPU time of runs in a sweep against that of the same runs in a loop in one process. Other
    work on the computer changes the rates of both, and this ratio less."""
    shares, starts = [], []
    for _ in range(rounds):
        one = cpu_of_one(runs)
        (few, _), (all_, busy) = sweep_of(jobs, jobs), sweep_of(jobs, runs)
        each = (all_ - few) / (runs - jobs)
        start = max(0.0, few - jobs * each)
        shares.append(one / each * busy)
        starts.append(start)
        print(f"CPU time of a run: {one:.3f} s in a loop, {each:.3f} s in a sweep with {jobs} jobs")
        print(
            f"  start of {jobs} processes {start:.1f} s of CPU time, in runs {busy:.1%} of the time"
        )
    rate, start = statistics.median(shares), statistics.median(starts)
    print(
        f"the middle of {rounds}: {rate:.0%} of {jobs} x the rate of one process, after the start"
    )
    whole = 1000 * one / (1000 * one / rate + start)
    print(f"1,000 runs with the start: {whole:.0%}")


def many(runs: int) -> None:
    machine = load(MACHINES / "slip.yml")
    totals = Totals(machine, successes(machine.root))
    workers: list[LocalWorker] = []

    def start() -> LocalWorker:
        workers.append(LocalWorker(task()))
        return workers[-1]

    began = time.perf_counter()
    for number, run in enumerate(perform_runs(range(runs), start, wait, jobs=1), 1):
        totals.add(run)
        if number in (20, 100) or number % max(1, runs // 4) == 0:
            print(f"after {number} runs: {memory(workers[0]):.1f} MB", flush=True)
    assert totals.runs == runs
    low, high = wilson_interval(totals.succeeded, runs)
    found = forecast(machine, totals.statistics, totals.successes)
    assert not isinstance(found, str), found
    predicted = sum(found.prediction.outcomes.get(name, 0.0) for name in totals.successes)
    print(
        f"{runs} runs in {time.perf_counter() - began:.0f} s: success {totals.succeeded / runs:.1%}"
    )
    print(f"95 % interval {low:.1%} to {high:.1%}, predicted {predicted:.1%}")
    print(f"faults {dict(totals.faults)}, one try {totals.statistics.states['slip/TRY/TRY']}")
    print("the prediction is within the interval" if low <= predicted <= high else "IT IS OUTSIDE")


if __name__ == "__main__":
    given = [int(word) for word in sys.argv[1:]]
    total, few, rounds = [*given, *(1000, 60, 3)[len(given) :]]
    many(total)
    rates(few, rounds)
