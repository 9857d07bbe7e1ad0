"""1,000 concurrences of eight branches in a row: what one costs, and what is left afterwards.

    python bench/concurrences.py [count]

Memory is the resident set that the system reports, after as many for warming up; Linux only.
"""

from __future__ import annotations

import gc
import resource
import sys
import threading
import time
from pathlib import Path
from typing import Any

from smachac.runtime import smach

COUNT = 1000
BRANCHES = 8


class Done(smach.State):
    """Ends at once; the first of eight may do so by an exception."""

    def __init__(self, fails: bool) -> None:
        super().__init__(["done"])
        self.fails = fails

    def execute(self, ud: Any, /) -> str:
        if self.fails:
            raise ValueError
        return "done"


def one(ends: str) -> None:
    """Build one concurrence and run it to this end."""
    join_any: Any = (lambda ended: True) if ends == "join any" else None
    container = smach.Concurrence(["done"], "done", child_termination_cb=join_any)
    with container:
        for number in range(BRANCHES):
            smach.Concurrence.add(str(number), Done(ends == "an exception" and number == 0))
    if ends == "a preempt request":
        container.request_preempt()
    try:
        container.execute()
    except smach.InvalidStateError:
        assert ends == "an exception"


def resident() -> int:
    """Bytes of the process in memory now."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize()


def main(count: int = COUNT) -> int:
    """Print a line for each kind of end; 1 if a thread is left."""
    quiet = smach.log.quiet
    smach.set_loggers(quiet, quiet, quiet, quiet)
    threads = threading.active_count()
    print(f"{count} concurrences of {BRANCHES}    us each  threads left  KiB grown")
    for ends in ("join all", "join any", "an exception", "a preempt request"):
        for _ in range(count):
            one(ends)
        gc.collect()
        memory, start = resident(), time.perf_counter()
        for _ in range(count):
            one(ends)
        seconds = time.perf_counter() - start
        gc.collect()
        left = threading.active_count() - threads
        grown = (resident() - memory) / 1024
        print(f"{ends:<26}{1e6 * seconds / count:9.0f}{left:14}{grown:11.0f}")
    return int(threading.active_count() > threads)


if __name__ == "__main__":
    raise SystemExit(main(*(int(given) for given in sys.argv[1:2])))
