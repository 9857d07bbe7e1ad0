"""The rules over the state graph: each is one function, filed by its code."""

from __future__ import annotations

from smachac.checks import (
    bodies,
    concurrence,
    coverage,
    dataflow,
    declarations,
    expressions,
    frames,
    liveness,
    masking,
    names,
    operations,
    presets,
    races,
    reach,
    robot,
    stopping,
    structure,
    types,
    waiting,
)
from smachac.diagnostics import Report, run_rules
from smachac.ir.nodes import Machine

__all__ = [
    "bodies",
    "check_machine",
    "concurrence",
    "coverage",
    "dataflow",
    "declarations",
    "expressions",
    "frames",
    "liveness",
    "masking",
    "names",
    "operations",
    "presets",
    "races",
    "reach",
    "robot",
    "stopping",
    "structure",
    "types",
    "waiting",
]


def check_machine(machine: Machine) -> Report:
    """What every rule has to say about a machine, in the order of the codes."""
    return list(run_rules(machine))
