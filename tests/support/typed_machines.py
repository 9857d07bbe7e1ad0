"""State types for machines that no script describes."""

from __future__ import annotations

from dataclasses import replace

from smachac.frontend.loader import Library
from smachac.frontend.state_types import find_state_type
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk


def with_state_types(machine: Machine, library: Library) -> Machine:
    """The machine with the state types of its states and its base, as a library has them."""
    names = dict.fromkeys([machine.base, *(node.type for _, node in walk(machine.root))])
    types = {name: find_state_type(name, library, []) for name in names}
    known = {name: type_ for name, type_ in types.items() if type_ is not None}
    return replace(machine, state_types=known)
