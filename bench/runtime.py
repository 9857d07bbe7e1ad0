"""What a transition costs: the bundled runtime, the interpreter and public packages, side by side.

Two workloads, in units of a plain dict loop: two states that take turns, and three levels of
machines. All run the same state body, which reads a counter, writes it back plus one, and ends the
machine at the limit; the count reached is checked. CPU time, rounds of all in turn, the minimum.

    python bench/runtime.py [rounds]

The packages are those of the extra `bench`; one that is not installed is named and left out, and
so is SMACH itself, which is not on PyPI. What a trace costs is measured after that, bare and traced
steps in turn.
"""

from __future__ import annotations

import gc
import importlib
import sys
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from peers import HIERARCHY, PEERS, PING_PONG
from tracing import tracing

import smachac
from smachac.interpreter.interpreter import run as interpret
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf
from smachac.runtime import smach as bundled

STEPS = 10_000
"""Visits of leaves in one measurement; figures are per such visit. The state that ends the
hierarchy is the fourth of the six that take turns, so this leaves a rest of 4 when divided by 6."""
ROUNDS = 9
GOAL = 12.0

Measured = Callable[[], int]
"""Runs a machine from count 0 to its end and gives the count reached."""

Table = dict[str, tuple[Callable[[dict[str, Any]], str], dict[str, str]]]


@dataclass(frozen=True, slots=True)
class Row:
    """A line of the result: what ran, and how to run it on either workload."""

    name: str
    ping_pong: Measured
    hierarchy: Measured


def body(limit: int) -> Callable[[dict[str, Any]], str]:
    """The state of all workloads as a function on a dict."""

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


def counted(run: Callable[[dict[str, Any]], str]) -> Measured:
    """A dict loop from count 0."""

    def measured() -> int:
        ud = {"count": 0}
        run(ud)
        return ud["count"]

    return measured


def plain_row(limit: int) -> Row:
    """Both workloads as dict loops."""
    count = body(limit)
    turns = {"PING": (count, {"next": "PONG", "done": "done"})}
    turns["PONG"] = (count, {"next": "PING", "done": "done"})
    ends = {"next": "next", "done": "done"}
    run = dict_loop({"A": (count, {"next": "B", "done": "done"}), "B": (count, ends)}, "A")
    for again in ("next", "A"):
        table: Table = {
            "A": (count, {"next": "SUB", "done": "done"}),
            "SUB": (run, {"next": "B", "done": "done"}),
            "B": (count, {"next": again, "done": "done"}),
        }
        run = dict_loop(table, "A")
    return Row("dict loop", counted(dict_loop(turns, "PING")), counted(run))


def smach_row(name: str, smach: Any, limit: int, info: Callable[..., Any]) -> Row:
    """Both workloads on a module with SMACH's interface.

    The counter crosses every border of the hierarchy, in and out. `info` hears of transitions.
    """

    quiet = bundled.log.quiet
    smach.set_loggers(quiet, quiet, quiet, quiet)

    class Count(smach.State):  # type: ignore[misc]
        def __init__(self) -> None:
            smach.State.__init__(self, ["next", "done"], io_keys=["count"])

        def execute(self, ud: Any, /) -> str:
            ud.count = count = ud.count + 1
            return "next" if count < limit else "done"

    def machine(**targets: dict[str, Any]) -> Any:
        keys = {"input_keys": ["count"], "output_keys": ["count"]}
        made = smach.StateMachine(["next", "done"], **keys)
        with made:
            for label, to in targets.items():
                state = to.pop("state", None)
                smach.StateMachine.add(label, state or Count(), {"done": "done", **to})
        return made

    def measured(made: Any) -> Measured:
        def run() -> int:
            smach.set_loggers(info, quiet, quiet, quiet)
            made.userdata.count = 0
            made.execute()
            return int(made.userdata.count)

        return run

    deep = machine(A={"next": "B"}, B={"next": "next"})
    for again in ("next", "A"):
        sub = {"next": "B", "state": deep}
        deep = machine(A={"next": "SUB"}, SUB=sub, B={"next": again})
    flat = machine(PING={"next": "PONG"}, PONG={"next": "PING"})
    return Row(name, measured(flat), measured(deep))


def interpreter_row(limit: int) -> Row:
    """Both workloads as scripts, on the reference interpreter."""

    def behave(path: str, leaf: Leaf, visit: int, ud: Userdata) -> str:
        count: Any = ud["count"]
        ud["count"] = count = count + 1
        return "next" if count < limit else "done"

    def measured(name: str) -> Measured:
        machine = smachac.load(Path(__file__).parent / "machines" / f"{name}.yml")

        def run() -> int:
            count: Any = interpret(machine, behave).userdata["count"]
            return int(count)

        return run

    return Row("interpreter", measured("ping_pong"), measured("hierarchy"))


def rows(limit: int) -> list[Row]:
    """Everything that can be measured here, the dict loop first; what cannot is named."""
    last: deque[str] = deque(maxlen=1)
    quiet = bundled.log.quiet
    found = [
        plain_row(limit),
        smach_row("bundled runtime", bundled, limit, quiet),
        smach_row("... with info lines", bundled, limit, last.append),
        interpreter_row(limit),
    ]
    for peer in PEERS:
        if peer.is_installed():
            measured = [peer.build(tree, limit) for tree in (PING_PONG, HIERARCHY)]
            found.append(Row(peer.package, *measured))
        else:
            print(f"{peer.package} is left out: pip install {peer.package}")
    try:
        found.append(smach_row("SMACH", importlib.import_module("smach"), limit, quiet))
    except ImportError:
        print("SMACH is left out: it comes with ROS, not from PyPI")
    return found


def cpu_seconds(run: Measured) -> float:
    """CPU time of one run."""
    start = time.process_time()
    run()
    return time.process_time() - start


def fastest(runs: list[Measured], rounds: int) -> list[float]:
    """The least CPU time of each in so many rounds, all in turn."""
    best = [float("inf")] * len(runs)
    for _ in range(rounds):
        best = [min(known, cpu_seconds(run)) for known, run in zip(best, runs, strict=True)]
    return best


def compare(workload: str, names: list[str], runs: list[Measured], rounds: int) -> list[float]:
    """Print a table, and return how many times the time of the first each takes."""
    for name, run in zip(names, runs, strict=True):
        reached = run()
        assert reached == STEPS, f"{name} counted to {reached}, not {STEPS}"
    print(f"\n{workload:<24}{'us':>9}{'per second':>14}{'x dict loop':>14}")
    best = fastest(runs, rounds)
    ratios = [seconds / best[0] for seconds in best]
    for name, seconds, ratio in zip(names, best, ratios, strict=True):
        print(f"{name:<24}{1e6 * seconds / STEPS:9.2f}{STEPS / seconds:14,.0f}{ratio:14.1f}")
    return ratios


def main(rounds: int = ROUNDS) -> int:
    """Measure both workloads; 1 if the bundled runtime is over the goal without info lines."""
    gc.disable()
    every = rows(STEPS)
    names = [row.name for row in every]
    flat = compare("two-state ping-pong", names, [row.ping_pong for row in every], rounds)
    deep = compare("three-level hierarchy", names, [row.hierarchy for row in every], rounds)
    tracing(fastest, STEPS, rounds)
    worst = max(flat[1], deep[1])
    verdict = "within" if worst <= GOAL else "over"
    print(f"\ngoal: bundled runtime {GOAL:g} times the dict loop without info lines: {verdict}")
    return int(worst > GOAL)


if __name__ == "__main__":
    raise SystemExit(main(*(int(given) for given in sys.argv[1:2])))
