"""The functions that run containers, from their entry to their end."""

from __future__ import annotations

from itertools import islice

from smachac.ir.nodes import Concurrence, Iterator
from smachac.ir.walk import walk
from smachac.targets.cpp.branches import concurrence
from smachac.targets.cpp.inside import Inside, Lines, indented, says, used
from smachac.targets.cpp.machines import MOST_STATES, machine
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
    # A container is run from one place only: if it is small, what surrounds it takes it in.
    few = len(list(islice(walk(inside.node), MOST_STATES + 1))) <= MOST_STATES
    inline = "[[gnu::always_inline]] inline" if few else "inline"
    return [
        "template <class Run>",
        f"{inline} Outcome execute(States &{states}, Userdata &{userdata}, Run &{run}) {{",
        *indented(body),
        "}",
    ]
