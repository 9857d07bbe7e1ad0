"""What the evaluator calls known is what Python gives, whatever the unknown conditions are."""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.python_sources import ReadMachine, ReadState, read_machines
from tests.support.random_programs import RealState, Writer, runs


def fits(read: ReadState, real: RealState) -> bool:
    """Whether a state that was added is one of those that the evaluator holds for possible."""
    if read.label is not None and read.label != real.label:
        return False
    if read.outcomes is not None and read.outcomes != frozenset(real.outcomes):
        return False
    if read.transitions is None:
        return True
    return read.transitions.keys() == real.transitions.keys() and all(
        values is None or real.transitions[key] in values
        for key, values in read.transitions.items()
    )


def wrong(machine: ReadMachine, real: Sequence[RealState]) -> list[object]:
    """What the evaluator has said that is not so in a run."""
    found: list[object] = []
    if machine.complete:
        found += [one for one in real if not any(fits(read, one) for read in machine.states)]
    found += [
        read
        for read in machine.states
        if not read.possible and not any(fits(read, one) for one in real)
    ]
    labels = [read.label for read in machine.states]
    certain = [read.label for read in machine.states if not read.possible]
    certain = [label for label in certain if labels.count(label) == 1]
    order = [*dict.fromkeys(one.label for one in real if one.label in certain)]
    if order != certain:
        found.append(("order", order, certain))
    return found


@settings(max_examples=examples(300))
@given(st.data())
def test_what_is_known_is_what_python_gives(data: st.DataObject) -> None:
    writer = Writer(lambda below: data.draw(st.integers(0, below - 1)))
    program = writer.program()
    machines = read_machines(program)
    for real in runs(program):
        assert machines, program
        assert wrong(machines[0], real) == [], program
