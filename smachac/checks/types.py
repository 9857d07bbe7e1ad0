"""Rules over types: what is written must fit what is read (ir/fitting.py says what fits)."""

from __future__ import annotations

from collections.abc import Iterator

from smachac.checks.arrivals import Arrivals
from smachac.checks.clashes import clash_findings
from smachac.checks.once import once
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir.fitting import Kind
from smachac.ir.inference import infer
from smachac.ir.nodes import Machine
from smachac.ir.places import Clash

types_of = once(infer)


@once
def _arriving(machine: Machine) -> dict[Kind, list[Clash]]:
    arrivals = Arrivals()
    found: dict[Kind, list[Clash]] = {"type": [], "length": [], "unit": []}
    for clash in types_of(machine).clashes:
        arrived = arrivals.arrived(clash)
        if arrived is not None:
            found[clash.misfit.kind].append(arrived)
    return found


def clashes_of(machine: Machine, kind: Kind) -> list[Clash]:
    """The clashes of one kind whose value can be there when it is read."""
    return _arriving(machine)[kind]


@rule("SM304", "type-mismatch", Severity.ERROR)
def type_mismatch(machine: Machine) -> Iterator[Finding]:
    """A value is written as one type and read as another.

    Types are those of the interfaces and of the script, of literals and of what functions return,
    followed through remaps and containers. An `int` fits a `float`, a `T` a `T?`, an enumeration
    one with more choices; `any` fits all. What does not fit fails in the middle of the task, or
    worse, is taken for something else.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: str}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK:
              template: ScriptedState
              output_keys: {found: Pose}
              remapping: {found: part}
              outcomes: [done]
              transitions: {done: PICK}
          - PICK:
              template: ScriptedState
              input_keys: {part: Pose}
              outcomes: [done]
              transitions: {done: done}
    """
    yield from clash_findings(clashes_of(machine, "type"))
