"""The rules over the state graph: each is one function, filed by its code."""

from __future__ import annotations

from smachac.checks import (
    concurrence,
    declarations,
    expressions,
    failures,
    initial_values,
    loops,
    names,
    races,
    reachability,
    robot,
    timeouts,
    types,
    userdata,
    workspace,
)
from smachac.diagnostics.diagnostic import Report, run_rules
from smachac.ir.nodes import Machine

__all__ = [
    "check_machine",
    "concurrence",
    "declarations",
    "expressions",
    "failures",
    "initial_values",
    "loops",
    "names",
    "races",
    "reachability",
    "robot",
    "timeouts",
    "types",
    "userdata",
    "workspace",
]


def check_machine(machine: Machine) -> Report:
    """What every rule has to say about a machine, in the order of the codes."""
    return list(run_rules(machine))
