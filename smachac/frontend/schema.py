"""The schema of scripts: each field with its long name, short name, shape and owners."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, TypeAlias, get_args

from smachac.ir.nodes import ContainerKind

FieldOwner: TypeAlias = Literal["base", "state"] | ContainerKind
"""What has fields: the script itself, a state that is no container, or a container."""

CONTAINERS: Mapping[str, ContainerKind] = {kind: kind for kind in get_args(ContainerKind)}
"""The built-in container types by name."""

CONTAINER_DOCS: Mapping[ContainerKind, str] = {
    "StateMachine": "States that follow one another along transitions.",
    "Sequence": "States in a row, linked by one outcome.",
    "Concurrence": "States that run at once; an outcome map says what their outcomes mean.",
    "Iterator": "One state, run once for each item of a list.",
}
"""The descriptions of the container types, as `smachac states` prints them."""

_CONTAINERS = " ".join(CONTAINERS)
_ALL = f"base {_CONTAINERS} state"


class Field(NamedTuple):
    """A field of a script or state; `shape` names its reader in fields.py."""

    name: str
    short: str
    shape: str
    owners: frozenset[str]


def _row(name: str, short: str, shape: str, owners: str) -> Field:
    return Field(name, short, shape, frozenset(owners.split()))


VARIABLES: dict[str, Field] = {
    row.name: row
    for row in (
        _row("name", "n", "name", "base"),
        _row("manifest", "m", "text", "base"),
        _row("node_name", "nn", "text", "base"),
        _row("function_name", "", "text", "base"),
        _row("types", "", "map", "base"),
        _row("robot", "", "name", "base"),
        _row("frames", "", "names", "base"),
        _row("properties", "", "value", "base"),
        _row("template", "T", "name", _ALL),
        _row("doc", "", "text", _ALL),
        _row("params", "p", "map", _ALL),
        _row("userdata", "ud", "userdata", _ALL),
        _row("input_keys", "ik", "keys", _ALL),
        _row("output_keys", "ok", "keys", _ALL),
        _row("outcomes", "o", "outcomes", _ALL),
        _row("states", "s", "value", f"base {_CONTAINERS}"),
        _row("remapping", "r", "pairs", f"{_CONTAINERS} state"),
        _row("transitions", "t", "pairs", f"{_CONTAINERS} state"),
        _row("claims", "", "names", f"{_CONTAINERS} state"),
        _row("tags", "", "names", f"{_CONTAINERS} state"),
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
"""The fields by long name. sugar.py reads `timeout`, `retry` and `for_each`. `callbacks`, and
`default_outcome` of a leaf, are variables of the state type. A state with `script` is a call of a
sub-script and may have each field that the called state may have."""

LONG: dict[str, str] = {row.short: row.name for row in VARIABLES.values() if row.short}
"""Short name to long name."""

REQUIRED: Mapping[FieldOwner, tuple[str, ...]] = {
    "base": ("name", "outcomes", "states"),
    "StateMachine": ("outcomes", "states"),
    "Sequence": ("outcomes", "connector_outcome", "states"),
    "Concurrence": ("outcomes", "states"),
    "Iterator": ("it", "states"),
    "state": (),
}
"""The required fields of each owner."""


def names_for(owner: str) -> list[str]:
    """The long names of the fields of an owner, in the order of the schema."""
    return [row.name for row in VARIABLES.values() if owner in row.owners]
