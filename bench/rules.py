"""What the rules over concurrences take: wide ones with many rules, and many in a row.

    python bench/rules.py [rounds]

CPU time of `check_machine` alone, on machines made in memory; the least of several rounds.
"""

from __future__ import annotations

import random
import sys
import time

from smachac.checks import check_machine
from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import (
    Concurrence,
    Condition,
    Leaf,
    Machine,
    Outcome,
    OutcomeRule,
    StateMachine,
    Transition,
)

ENDS = ("succeeded", "aborted", "lost", "preempted")


def outcomes(names: list[str]) -> tuple[Outcome, ...]:
    return tuple(Outcome(name=name, span=NOWHERE) for name in names)


def concurrence(number: int, branches: int, rules: int, target: str) -> Concurrence:
    """Branches of four outcomes, and rules over two to six of them, drawn by `number`."""
    source = random.Random(number)
    names = [f"B{item}" for item in range(branches)]
    results = [f"r{item}" for item in range(rules)] + ["rest"]

    def when() -> tuple[Condition, ...]:
        asked = source.sample(names, source.randint(2, min(branches, 6)))
        return tuple(
            Condition(child=name, outcome=source.choice(ENDS), span=NOWHERE) for name in asked
        )

    return Concurrence(
        name=f"C{number}",
        type="Concurrence",
        outcomes=outcomes(results),
        children=tuple(
            Leaf(name=name, type="T", outcomes=outcomes([*ENDS]), span=NOWHERE) for name in names
        ),
        default_outcome="rest",
        rules=tuple(OutcomeRule(outcome=name, when=when(), span=NOWHERE) for name in results[:-1]),
        transitions=tuple(
            Transition(outcome=name, target=target, span=NOWHERE) for name in results
        ),
        span=NOWHERE,
    )


def row(count: int, branches: int, rules: int) -> Machine:
    """So many concurrences one after the other."""
    targets = [*(f"C{number}" for number in range(1, count)), "done"]
    children = tuple(
        concurrence(each, branches, rules, target) for each, target in enumerate(targets)
    )
    root = StateMachine(
        name="sm",
        type="StateMachine",
        outcomes=outcomes(["done"]),
        children=children,
        initial="C0",
        span=NOWHERE,
    )
    return Machine(root=root)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 7
    machines = {
        "1 of 12 branches, 40 rules": row(1, 12, 40),
        "1 of 40 branches, 40 rules": row(1, 40, 40),
        "100 of 4 branches, 6 rules": row(100, 4, 6),
        "1000 of 4 branches, 6 rules": row(1000, 4, 6),
    }
    least = dict.fromkeys(machines, float("inf"))
    for _ in range(rounds):
        for name, machine in machines.items():
            before = time.process_time()
            check_machine(machine)
            least[name] = min(least[name], time.process_time() - before)
    for name, taken in least.items():
        print(f"{name:<28} {1000 * taken:8.1f} ms")
    hundred, thousand = list(least.values())[2:]
    print(f"1000 / 100: {thousand / hundred:.1f}")


if __name__ == "__main__":
    main()
