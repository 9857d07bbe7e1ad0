"""What a transition of the bundled runtime costs, in units of a plain dict loop.

Both run the same state bodies: read a counter from the userdata, write it back plus one.
CPU time, rounds of both in turn, the minimum of nine. `python bench/runtime.py`
"""

from __future__ import annotations

import gc
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from smachac.runtime import smach

STEPS = 10_000
"""Visits of leaves in one measurement; figures are per such visit."""
ROUNDS = 9
GOAL = 12.0
FOREVER = 10**9

Table = dict[str, tuple[Callable[[dict[str, Any]], str], dict[str, str]]]


class Count(smach.State):
    """Adds one to `count`; `done` when the limit is reached."""

    def __init__(self, limit: int) -> None:
        super().__init__(["next", "done"], io_keys=["count"])
        self.limit = limit

    def execute(self, ud: Any, /) -> str:
        ud.count = count = ud.count + 1
        return "next" if count < self.limit else "done"


def body(limit: int) -> Callable[[dict[str, Any]], str]:
    """The same state as a function on a dict."""

    def count(ud: dict[str, Any]) -> str:
        ud["count"] = count = ud["count"] + 1
        return "next" if count < limit else "done"

    return count


def dict_loop(table: Table, initial: str) -> Callable[[dict[str, Any]], str]:
    """A machine as a table of functions and targets; what is no label in it ends it."""

    def run(ud: dict[str, Any]) -> str:
        state = initial
        while state in table:
            function, targets = table[state]
            state = targets[function(ud)]
        return state

    return run


PING_PONG = {
    "PING": {"next": "PONG", "done": "done"},
    "PONG": {"next": "PING", "done": "done"},
}


def plain_ping_pong(limit: int) -> Callable[[], int]:
    """Two states that take turns, as a dict loop; what runs them and gives the count."""
    run = dict_loop({label: (body(limit), targets) for label, targets in PING_PONG.items()}, "PING")

    def measured() -> int:
        ud = {"count": 0}
        run(ud)
        return ud["count"]

    return measured


def smach_ping_pong(limit: int) -> Callable[[], int]:
    """Two states that take turns, on the runtime."""
    machine = smach.StateMachine(outcomes=["done"])
    with machine:
        for label, targets in PING_PONG.items():
            smach.StateMachine.add(label, Count(limit), targets)
    return lambda: run_machine(machine)


def run_machine(machine: smach.StateMachine) -> int:
    """Run from count 0, and give the count reached."""
    machine.userdata.count = 0
    machine.execute()
    return int(machine.userdata.count)


def plain_hierarchy(limit: int) -> Callable[[], int]:
    """Three levels, each a leaf, the level below, and a leaf, over and over, as dict loops."""
    ends = {"next": "next", "done": "done"}
    run = dict_loop({"A": (body(FOREVER), {"next": "B"}), "B": (body(limit), ends)}, "A")
    for level in range(2):
        again = "next" if level == 0 else "A"
        run = dict_loop(
            {
                "A": (body(FOREVER), {"next": "SUB"}),
                "SUB": (run, {"next": "B", "done": "done"}),
                "B": (body(FOREVER), {"next": again}),
            },
            "A",
        )

    def measured() -> int:
        ud = {"count": 0}
        run(ud)
        return ud["count"]

    return measured


def smach_hierarchy(limit: int) -> Callable[[], int]:
    """The same three levels on the runtime; the counter crosses every border in and out."""
    inner = smach.StateMachine(["next", "done"], input_keys=["count"], output_keys=["count"])
    with inner:
        smach.StateMachine.add("A", Count(FOREVER), {"next": "B"})
        smach.StateMachine.add("B", Count(limit), {"next": "next", "done": "done"})
    return lambda: run_machine(_level(_level(inner, "next"), "A"))


def _level(below: smach.StateMachine, again: str) -> smach.StateMachine:
    machine = smach.StateMachine(["next", "done"], input_keys=["count"], output_keys=["count"])
    with machine:
        smach.StateMachine.add("A", Count(FOREVER), {"next": "SUB", "done": "done"})
        smach.StateMachine.add("SUB", below, {"next": "B", "done": "done"})
        smach.StateMachine.add("B", Count(FOREVER), {"next": again, "done": "done"})
    return machine


def cpu_seconds(run: Callable[[], int]) -> float:
    """CPU time of one run."""
    start = time.process_time()
    run()
    return time.process_time() - start


def compare(name: str, plain: Callable[[], int], machine: Callable[[], int]) -> float:
    """Print and return how many times the plain loop's time the machine takes."""
    assert plain() == machine(), "both must do the same work"
    best = [float("inf"), float("inf")]
    for _ in range(ROUNDS):
        best = [min(best[0], cpu_seconds(plain)), min(best[1], cpu_seconds(machine))]
    ratio = best[1] / best[0]
    loop, ours = (1e6 * seconds / STEPS for seconds in best)
    print(f"{name:<32} dict loop {loop:.3f} us  runtime {ours:.3f} us  ratio {ratio:5.1f}")
    return ratio


def main() -> int:
    """Measure both machines, without info lines and with them; 1 if over the goal without."""
    gc.disable()
    last: deque[str] = deque(maxlen=1)
    quiet = smach.log.quiet
    worst = 0.0
    for kind, info in (("no info lines", quiet), ("info lines", last.append)):
        smach.set_loggers(info, quiet, quiet, quiet)
        flat = compare(f"ping-pong, {kind}", plain_ping_pong(STEPS), smach_ping_pong(STEPS))
        deep = compare(f"three levels, {kind}", plain_hierarchy(STEPS), smach_hierarchy(STEPS))
        worst = worst or max(flat, deep)
    verdict = "within" if worst <= GOAL else "over"
    print(f"goal: {GOAL:g} times the dict loop without info lines: {verdict}")
    return int(worst > GOAL)


if __name__ == "__main__":
    raise SystemExit(main())
