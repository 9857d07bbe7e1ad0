"""What a trace costs, part of `runtime.py`: a step bare and traced to a file, in turn.

Two states that take turns, one kind idle (enter, exit, transition), one that reads and writes a
key (and one write more). The file is a real one, every event is in the kernel before the next.
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from functools import partial
from typing import Any

from smachac.runtime import smach
from smachac.runtime.tracing.trace import attach
from smachac.runtime.tracing.writer import TraceWriter

SMACH = {"ping-pong": 6.6, "hierarchy": 9.1}
"""Microseconds of a transition of SMACH itself, measured on another machine; so what is said in
shares of them is derived, not measured."""

FOREVER = 10**9

Fastest = Callable[[list[Callable[[], int]], int], list[float]]


class Idle(smach.State):
    """Ends as told, without a look at the userdata."""

    def __init__(self, visits: int) -> None:
        super().__init__(["next", "done"])
        self.visits, self.left = visits, visits

    def execute(self, ud: Any, /) -> str:
        self.left -= 1
        if self.left:
            return "next"
        self.left = self.visits
        return "done"


class Count(smach.State):
    """Adds one to `n`."""

    def __init__(self, limit: int) -> None:
        super().__init__(["next", "done"], io_keys=["n"])
        self.limit = limit

    def execute(self, ud: Any, /) -> str:
        ud.n = n = ud.n + 1
        return "next" if n % self.limit else "done"


def ping_pong(first: smach.State, second: smach.State, file: int | None) -> Callable[[], int]:
    """Two states in turn; `file` takes the trace, and holds that of the last run only."""
    machine = smach.StateMachine(["done"])
    machine.userdata.n = 0
    with machine:
        smach.StateMachine.add("PING", first, {"next": "PONG", "done": "done"})
        smach.StateMachine.add("PONG", second, {"next": "PING", "done": "done"})
    if file is not None:
        places = {"sm/PING": "machine.yml:3", "sm/PONG": "machine.yml:9"}
        attach(machine, "sm", TraceWriter(partial(os.write, file)), places)

    def run() -> int:
        if file is not None:
            os.ftruncate(file, 0)
            os.lseek(file, 0, os.SEEK_SET)
        machine.execute()
        return 0

    return run


def tracing(fastest: Fastest, steps: int, rounds: int) -> None:
    """Print what a traced step costs."""
    quiet = smach.log.quiet
    smach.set_loggers(quiet, quiet, quiet, quiet)
    with tempfile.TemporaryFile() as stream:
        file = stream.fileno()
        runs = [
            run
            for traced in (None, file)
            for run in (
                ping_pong(Idle(FOREVER), Idle(steps // 2), traced),
                ping_pong(Count(steps), Count(steps), traced),
            )
        ]
        chunk = b"x" * 200
        runs.append(lambda: sum(os.write(file, chunk) for _ in range(steps)))
        best = [1e6 * seconds / steps for seconds in fastest(runs, rounds)]
    print(f"\n{'trace to a file':<24}{'bare us':>9}{'traced us':>11}{'ratio':>8}{'cost us':>9}")
    for name, bare, traced in zip(
        ("idle state", "state that counts"), best, best[2:], strict=False
    ):
        print(f"{name:<24}{bare:9.2f}{traced:11.2f}{traced / bare:8.1f}{traced - bare:9.2f}")
        shares = ", ".join(f"{(traced - bare) / us:.0%} of {us} ({of})" for of, us in SMACH.items())
        print(f"  derived, as shares of SMACH's transition in us: {shares}")
    share = (best[2] - best[0]) / best[1]
    print(
        f"  an idle step's trace costs {share:.1f} steps that count; a bare write {best[4]:.2f} us"
    )
