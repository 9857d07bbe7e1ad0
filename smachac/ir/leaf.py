"""Leaves: the values of their variables, their functions and their default outcome."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from smachac.ir.nodes import Data, Expression, Key, Leaf, Struct, Variable, VariableRole
from smachac.ir.outcome_names import GOOD_OUTCOMES
from smachac.ir.traversal import own_outcomes


def default_outcome(leaf: Leaf) -> str:
    """The usual outcome of a leaf: the first declared one with the name of a success, else the
    first one."""
    declared = own_outcomes(leaf) or tuple(edge.outcome for edge in leaf.transitions)
    good = [name for name in declared if name in GOOD_OUTCOMES]
    return [*good, *declared, GOOD_OUTCOMES[0]][0]


def variable(leaf: Leaf, name: str) -> Data:
    """The value of a leaf's variable in the script; None if it has none."""
    for candidate in leaf.variables:
        if candidate.name == name:
            return candidate.value.data
    return None


def variable_of(leaf: Leaf, role: VariableRole) -> Variable | None:
    """The variable of a leaf with a role; None if the script does not set it."""
    for candidate in leaf.variables:
        if candidate.role == role:
            return candidate
    return None


def type_text(held: Variable) -> str:
    """The name of a type of ROS in a variable; `std_srvs.srv.Trigger` is read as code."""
    data = held.value.data
    return data.text if isinstance(data, Expression) else str(data or "")


def functions(leaf: Leaf, role: VariableRole) -> Mapping[str, Expression] | None:
    """The functions in the variable with a role, by name; None where they are not known."""
    for held in leaf.variables:
        if held.role == role and held.value.data is not None:
            if not isinstance(held.value.data, Struct):
                return None
            entries = held.value.data.entries
            return {key: code for key, code in entries if isinstance(code, Expression)}
    return {}


def key_names(keys: tuple[Key, ...], *roles: str) -> frozenset[str]:
    """The names of the keys with one of these roles."""
    return frozenset([key.name for key in keys if key.role in roles])


def given_fields(variables: Iterable[Variable], role: str) -> tuple[str, ...]:
    """The names of the fields that the variables of a role give to a message: keys of a mapping,
    and names in a list."""
    names: set[str] = set()
    for held in variables:
        data = held.value.data
        if held.role == role and isinstance(data, Struct):
            names.update(name for name, _ in data.entries)
        elif held.role == role and isinstance(data, tuple):
            names.update(text for text in data if isinstance(text, str))
    return tuple(sorted(names))
