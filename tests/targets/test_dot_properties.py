"""States in properties are marked in pictures; the path of a counterexample is highlighted."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import NOWHERE
from smachac.ir.nodes import Machine, Outcome, StateMachine
from smachac.ir.properties import Atom, Before, Property
from smachac.ir.written import written
from smachac.targets.dot.graph import picture
from tests.support.ir_machines import leaf


@pytest.mark.parametrize(
    ("earlier", "marked", "highlighted"), [("A", ["A", "B"], []), ("C", ["A", "B", "C"], ["A"])]
)
def test_marks(earlier: str, marked: list[str], highlighted: list[str]) -> None:
    children = [leaf("A", {"done": "B"}), leaf("B", {"done": "C"}), leaf("C", {"done": "done"})]
    root = StateMachine(
        name="sm",
        type="StateMachine",
        outcomes=(Outcome(name="done", span=NOWHERE),),
        children=tuple(children),
        initial="A",
        span=NOWHERE,
    )
    later, first = (Atom(subject="path", name=name, span=NOWHERE) for name in ("B", earlier))
    given = Property(name="p", form=Before(later=(later,), earlier=(first,)), span=NOWHERE)
    machine = Machine(root=root, properties=(given,))
    lines = list(picture(machine, written(machine)))
    boxes = {line.split('"')[1]: line for line in lines if "<TABLE" in line and '"sm/' in line}
    assert [name for name in "ABC" if "&#9670;" in boxes[f"sm/{name}"]] == marked
    assert [name for name in "ABC" if "penwidth" in boxes[f"sm/{name}"]] == highlighted
