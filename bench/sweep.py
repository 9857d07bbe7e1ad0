"""Sweeps of a simulated arm: the rate of several workers against that of one, the memory of a
worker over many runs, and the success rate against its Markov prediction.

    python bench/sweep.py [runs [runs for the rates [rounds]]]
"""

from __future__ import annotations

import statistics
import sys
import time
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from smachac import load
from smachac.diagnostics.source import Source
from smachac.ir.outcome_names import successes
from smachac.robots.faults import read_file as read_faults
from smachac.robots.files import read_file
from smachac.sweep.engine import perform_runs
from smachac.sweep.local import LocalWorker, wait
from smachac.sweep.summary import Totals
from smachac.sweep.task import Task
from smachac.verify.statistics_report import forecast
from smachac.verify.trace_statistics import wilson_interval

MACHINES = Path(__file__).parent / "machines"
WARM_UP = 2
"""The runs of each worker before the clock starts."""


def task() -> Task:
    script = MACHINES / "slip.yml"
    faults = read_faults(read_file(MACHINES / "slip_faults.yml"))
    return Task(source=Source(str(script), script.read_text("utf-8")), faults=faults)


def rate(jobs: int, runs: int) -> tuple[float, float]:
    """Runs per second after each worker has started and warmed up, and the share of the workers'
    time that they spent in runs, which other work on the computer does not change."""
    warm = WARM_UP * jobs
    found = perform_runs(range(warm + runs), partial(LocalWorker, task()), wait, jobs=jobs)
    for _ in range(warm):
        next(found)
    began = time.perf_counter()
    walls = [run.wall for run in found]
    seconds = time.perf_counter() - began
    return len(walls) / seconds, sum(walls) / (jobs * seconds)


def memory(worker: LocalWorker) -> float:
    """The resident memory of a worker (MB)."""
    status = Path(f"/proc/{worker.process.pid}/status").read_text()
    line = next(line for line in status.splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024


def rates(runs: int, rounds: int, jobs: int = 2) -> None:
    ratios, shares = [], []
    for _ in range(rounds):
        (one, _), (more, busy) = rate(1, runs), rate(jobs, runs)
        ratios.append(more / (jobs * one))
        shares.append(busy)
        print(
            f"{one:.2f} runs/s in 1 process, {more:.2f} in {jobs}: {ratios[-1]:.0%} of {jobs} x 1"
        )
        print(f"  the {jobs} processes were in runs for {busy:.1%} of the time", flush=True)
    middle = statistics.median(ratios)
    print(f"the middle of {rounds}: {middle:.0%}, {statistics.median(shares):.1%}")


def many(runs: int) -> None:
    machine = load(MACHINES / "slip.yml")
    totals = Totals(successes(machine.root))
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
