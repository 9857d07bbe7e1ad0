"""The functions that run containers, from their entry to their end."""

from __future__ import annotations

from smachac.ir.nodes import Concurrence, Iterator
from smachac.targets.cpp.branches import concurrence
from smachac.targets.cpp.inside import Inside, Lines, indented, says, used
from smachac.targets.cpp.machines import machine
from smachac.targets.cpp.rounds import iterator


def execute(inside: Inside) -> Lines:
    """The function that runs a container from its entry to its end."""
    match inside.node:
        case Iterator():
            body = iterator(inside)
        case Concurrence():
            body = concurrence(inside)
        case _:
            body = machine(inside)
    states, userdata = used(body)
    run = next((name for name in ("around", "run") if says(body, name)), "")
    return [
        "template <class Run>",
        f"Outcome execute(States &{states}, Userdata &{userdata}, Run &{run}) {{",
        *indented(body),
        "}",
    ]
