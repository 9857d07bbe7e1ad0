"""The cost of a live view for the running machine, in CPU time of its process.

The machine's thread pays for each event; this is measured with states that do nothing, with the
view and without it. The other threads, which encode and send, are measured beside the machine's
thread in the same run, so that other programs on the computer matter less. The reader is another
process.

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
    "states of 5 ms, 800 events a second": (200, 5e-3),
    "states of 1 ms, 4,000 events a second": (1_000, 1e-3),
    "states of 0.4 ms, 10,000 events a second": (2_500, 0.4e-3),
}
"""The number of visits of a run, and the CPU time of one (s). Each visit writes a key: 4 events."""

IDLE = 30_000
"""The number of visits of a run of states that do nothing."""


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


def cpu(run: Callable[[], object]) -> tuple[float, float]:
    """CPU time of this thread, and of all others of the process (s)."""
    whole, own = time.process_time(), time.thread_time()
    run()
    mine = time.thread_time() - own
    return mine, time.process_time() - whole - mine


def bare(visits: int, turns: int) -> tuple[float, float]:
    return cpu(machine_of(visits, turns).execute)


def viewed(visits: int, turns: int, reader: str) -> tuple[float, float]:
    """With a server and, unless `reader` is empty, a process that reads, or never does."""
    feed = Feed()
    trace = LiveTrace(feed)
    control = Control(None, trace.send)
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
    turns_a_second = 1e7 / cpu(lambda: _spin(10_000_000))[0]
    without = min(bare(IDLE, 0)[0] for _ in range(rounds))
    runs = [viewed(IDLE, 0, "reads") for _ in range(rounds)]
    own = (min(mine for mine, _ in runs) - without) / IDLE
    other = min(others for _, others in runs) / IDLE
    bare_us = without / IDLE * 1e6
    print(f"machine's thread, a visit of 4 events: {own * 1e6:.1f} us, untraced {bare_us:.2f}")
    print(f"the other threads: {other * 1e6:.1f} us")
    print(f"states that do nothing: {(own + other) * IDLE / without:.0%} of the machine's CPU time")
    for name, (visits, seconds) in MACHINES.items():
        for reader in ("", "reads", "dead"):
            runs = [viewed(visits, int(seconds * turns_a_second), reader) for _ in range(rounds)]
            others = median(others / mine for mine, others in runs)
            share = others + own / seconds
            print(f"{name}, reader {reader or 'none'}: {share:.1%} of the machine's CPU time")


def _spin(turns: int) -> None:
    for _ in range(turns):
        pass


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
