"""The variables of a script, as data: long name, short name, shape, and who may have them."""

from __future__ import annotations

from typing import NamedTuple

CONTAINERS = ("StateMachine", "Sequence", "Concurrence", "Iterator")
"""The built-in container types, by the name of their template."""

_ALL = "base StateMachine Sequence Concurrence Iterator state"
_CONTAINERS = " ".join(CONTAINERS)


class Variable(NamedTuple):
    """A variable of the schema; `shape` names a reader of shapes.py."""

    name: str
    short: str
    shape: str
    owners: frozenset[str]


def _row(name: str, short: str, shape: str, owners: str) -> Variable:
    return Variable(name, short, shape, frozenset(owners.split()))


VARIABLES: dict[str, Variable] = {
    row.name: row
    for row in (
        _row("name", "n", "name", "base"),
        _row("manifest", "m", "text", "base"),
        _row("node_name", "nn", "text", "base"),
        _row("function_name", "", "text", "base"),
        _row("types", "", "map", "base"),
        _row("robot", "", "name", "base"),
        _row("frames", "", "names", "base"),
        _row("template", "T", "name", _ALL),
        _row("doc", "", "text", _ALL),
        _row("params", "p", "map", _ALL),
        _row("userdata", "ud", "map", _ALL),
        _row("input_keys", "ik", "keys", _ALL),
        _row("output_keys", "ok", "keys", _ALL),
        _row("outcomes", "o", "names", _ALL),
        _row("states", "s", "value", f"base {_CONTAINERS}"),
        _row("remapping", "r", "pairs", f"{_CONTAINERS} state"),
        _row("transitions", "t", "pairs", f"{_CONTAINERS} state"),
        _row("claims", "", "names", f"{_CONTAINERS} state"),
        _row("timeout", "", "value", f"{_CONTAINERS} state"),
        _row("retry", "", "value", f"{_CONTAINERS} state"),
        _row("for_each", "", "value", f"{_CONTAINERS} state"),
        _row("callbacks", "cb", "map", ""),
        _row("default_outcome", "do", "name", "Concurrence"),
        _row("outcome_map", "om", "rules", "Concurrence"),
        _row("join", "", "name", "Concurrence"),
        _row("initial", "", "name", "base StateMachine Sequence"),
        _row("forever", "", "flag", "base StateMachine"),
        _row("on_error", "", "name", "base StateMachine Sequence"),
        _row("connector_outcome", "", "name", "Sequence"),
        _row("it", "", "value", "Iterator"),
        _row("it_label", "", "name", "Iterator"),
        _row("exhausted_outcome", "", "name", "Iterator"),
        _row("loop_outcomes", "", "names", "Iterator"),
        _row("break_outcomes", "", "names", "Iterator"),
        _row("final_outcome_map", "", "pairs", "Iterator"),
        _row("script", "S", "name", ""),
    )
}
"""By long name. `timeout`, `retry` and `for_each` are read by sugar.py; `callbacks` and
`default_outcome` on a leaf are its state type's; `script` makes a state item a call, which may have
every variable of what it calls."""

LONG: dict[str, str] = {row.short: row.name for row in VARIABLES.values() if row.short}
"""Short name to long name."""

REQUIRED: dict[str, tuple[str, ...]] = {
    "base": ("name", "outcomes", "states"),
    "StateMachine": ("outcomes", "states"),
    "Sequence": ("outcomes", "connector_outcome", "states"),
    "Concurrence": ("outcomes", "states"),
    "Iterator": ("it", "states"),
    "state": (),
}
"""What each owner must have."""


def names_for(owner: str) -> list[str]:
    """The long names an owner may have, in the order of the schema."""
    return [row.name for row in VARIABLES.values() if owner in row.owners]
