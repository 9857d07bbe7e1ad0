"""States of another framework than SMACH: their classes are those that interfaces name for it."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.ir.nodes import NATIVE, Checked, Machine
from smachac.records import replace

WRAPPER = "native_state"
"""The function of runtime/additions.py around such a state."""


def native_types(machine: Machine, framework: str) -> dict[str, str]:
    """The classes that interfaces name for a framework, a key of `NATIVE`, by state type."""
    return {name: type_.code[framework] for name, type_ in machine.state_types.items()
            if framework in type_.code}  # fmt: skip


def native_only(machine: Machine) -> dict[str, str]:
    """The classes for another framework of the state types that have no code for SMACH, by type."""
    return {name: code for framework in NATIVE
            for name, code in native_types(machine, framework).items()
            if "python" not in machine.state_types[name].code}  # fmt: skip


def as_python(machine: Checked, native: Mapping[str, str]) -> Checked:
    """The machine for the Python target, in which a class of another framework is the code of its
    state type. The keys of such a state are no arguments of its class."""
    types = dict(machine.state_types)
    for name, code in native.items():
        given = types[name].given - {"input_keys", "output_keys", "outcomes"}
        types[name] = replace(types[name], code={"python": code}, given=given, class_facts=None)
    return Checked(replace(machine, state_types=types))
