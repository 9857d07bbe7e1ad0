"""The cost of a live view for the running machine: CPU time of the whole process with the view, by
that without it, the minima of several rounds in turn. The reader is another process.

`python bench/view.py [ROUNDS]`
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable
from statistics import median
from typing import Any

from smachac.runtime import smach
from smachac.runtime.tracing.trace import attach
from smachac.view.control import Control
from smachac.view.feed import Feed
from smachac.view.live import LiveTrace
from smachac.view.server import HOST, ViewServer

READER = """
import sys, time
from http.client import HTTPConnection
connection = HTTPConnection(sys.argv[1], int(sys.argv[2]))
connection.request("GET", "/events")
stream = connection.getresponse()
print("ready", flush=True)
if sys.argv[3] == "dead":
    time.sleep(3600)
while stream.read1(1 << 20):
    pass
"""

MACHINES = {
    "states of 5 ms, 800 events a second": (400, 5e-3),
    "states of 0.4 ms, 10,000 events a second": (5_000, 0.4e-3),
    "states that do nothing, the worst case": (30_000, 0.0),
}
"""The number of visits of a run, and the CPU time of one (s). Each visit writes a key: 4 events."""


class Works(smach.State):
    """Computes for some time, and writes a number."""

    def __init__(self, visits: int, turns: int) -> None:
        super().__init__(["next", "done"], io_keys=["n"])
        self._visits, self._turns = visits, turns

    def execute(self, ud: Any, /) -> str:
        for _ in range(self._turns):
            pass
        ud.n = n = ud.n + 1
        return "next" if n % self._visits else "done"


def machine_of(visits: int, turns: int) -> smach.StateMachine:
    """Two states in turn."""
    machine = smach.StateMachine(["done"])
    machine.userdata.n = 0
    with machine:
        smach.StateMachine.add("PING", Works(visits, turns), {"next": "PONG", "done": "done"})
        smach.StateMachine.add("PONG", Works(visits, turns), {"next": "PING", "done": "done"})
    return machine


def cpu(run: Callable[[], object]) -> float:
    """CPU time of the process, with all its threads (s)."""
    before = time.process_time()
    run()
    return time.process_time() - before


def bare(visits: int, turns: int) -> float:
    return cpu(machine_of(visits, turns).execute)


def viewed(visits: int, turns: int, reader: str) -> float:
    """With a server and, unless `reader` is empty, a process that reads, or never does."""
    feed = Feed()
    trace = LiveTrace(feed)
    control = Control({}, trace.send)
    server = ViewServer(0, str, feed)
    server.start()
    trace.start()
    process = None
    if reader:
        words = [sys.executable, "-c", READER, HOST, str(server.port), reader]
        process = subprocess.Popen(words, stdout=subprocess.PIPE)
        assert process.stdout is not None
        process.stdout.readline()
    machine = machine_of(visits, turns)
    attach(machine, "sm", trace, {"sm/PING": "machine.yml:3"}, gate=control)

    def run() -> None:
        machine.execute()
        trace.close()

    try:
        return cpu(run)
    finally:
        if process is not None:
            process.kill()
            process.communicate()
        server.stop()


def main(rounds: int) -> None:
    quiet = smach.log.quiet
    smach.set_loggers(quiet, quiet, quiet, quiet)
    turns_a_second = 1e7 / cpu(lambda: _spin(10_000_000))
    for name, (visits, seconds) in MACHINES.items():
        turns = int(seconds * turns_a_second)
        runs: dict[str, Callable[[], float]] = {
            "": lambda visits=visits, turns=turns: bare(visits, turns),
            **{
                kind: lambda visits=visits, turns=turns, kind=kind: viewed(
                    visits, turns, kind.removeprefix("no reader")
                )
                for kind in ("no reader", "reads", "dead")
            },
        }
        times: dict[str, list[float]] = {kind: [] for kind in runs}
        for _ in range(rounds):
            for kind, run in runs.items():
                times[kind].append(run())
        least = {kind: min(found) for kind, found in times.items()}
        shares = ", ".join(f"{kind} {least[kind] / least['']:.3f}" for kind in runs if kind)
        pairs = zip(times["reads"], times[""], strict=True)
        middle = median(one / other for one, other in pairs)
        more = (least["reads"] - least[""]) / visits * 1e6
        print(f"{name}: with the view / without it, CPU: {shares} (middle of pairs: {middle:.3f})")
        print(f"  {more:.1f} us a visit")


def _spin(turns: int) -> None:
    for _ in range(turns):
        pass


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
