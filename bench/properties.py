"""CPU time of a property over 10,000 states: the search alone, the minimum of some runs.

Usage: python bench/properties.py [ROUNDS]
"""

from __future__ import annotations

import sys
import time

from smachac.analysis.properties import judge
from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import Leaf, Outcome, StateMachine, Transition
from smachac.ir.properties import (
    After,
    AlwaysEnds,
    AtMost,
    Atom,
    Atoms,
    Before,
    Form,
    Never,
    Property,
)

STATES = 10_000


def state(name: str, **targets: str) -> Leaf:
    outcomes = tuple(Outcome(name=outcome, span=NOWHERE) for outcome in targets)
    steps = tuple(
        Transition(outcome=outcome, target=target, span=NOWHERE)
        for outcome, target in targets.items()
    )
    return Leaf(name=name, type="Move", outcomes=outcomes, transitions=steps, span=NOWHERE)


def chain() -> StateMachine:
    """A chain of states, each with a failure and a stop that lead to the last one."""
    names = [f"S{number}" for number in range(STATES)]
    states = [
        state(name, ok=following, failed="LET_GO", preempted="LET_GO")
        for name, following in zip(names, [*names[1:], "done"], strict=True)
    ]
    return StateMachine(
        name="sm",
        type="StateMachine",
        outcomes=(Outcome(name="done", span=NOWHERE),),
        children=(*states, state("LET_GO", ok="done")),
        initial="S0",
        span=NOWHERE,
    )


def main(rounds: int) -> None:
    root = chain()

    def atom(*names: str) -> Atoms:
        return tuple(Atom(subject="path", name=name, span=NOWHERE) for name in names)

    last = f"S{STATES - 1}"
    forms: dict[str, Form] = {
        "never": Never(after=atom(f"S{STATES - 9}"), until=atom("LET_GO"), enter=atom("S5")),
        "before": Before(later=atom("LET_GO"), earlier=atom("S0")),
        "after": After(first=atom("S0"), answer=atom("LET_GO", last)),
        "whenever": After(first=atom(last), answer=atom("LET_GO", "S0"), within=3),
        "at_most": AtMost(event=atom("S5"), times=1),
        "always_ends": AlwaysEnds(),
    }
    for name, form in forms.items():
        given = Property(name=name, form=form, span=NOWHERE)
        best = float("inf")
        for _ in range(rounds):
            start = time.process_time()
            (found,) = judge([given], root, {})
            best = min(best, time.process_time() - start)
        print(f"{name:<12} {found.verdict:<8} {best:.2f} s")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
