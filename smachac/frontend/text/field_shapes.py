"""The fields that an unknown field of a state can be, by the shape of its value."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from smachac.diagnostics.spelling import guesser_of
from smachac.frontend import schema
from smachac.frontend.schema import FieldOwner
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.ir.nodes import StateType


def ends_with_any(entries: Mapping[str, Entry], owner: FieldOwner) -> bool:
    """Whether a concurrence without `join` may end with its first branch: no rule of it needs two
    of them."""
    given = entries["outcome_map"].value if "outcome_map" in entries else None
    rules = [each.value for each in given.entries] if isinstance(given, Map) else []
    alone = all(not isinstance(rule, Map) or len(rule.entries) < 2 for rule in rules)
    return owner == "Concurrence" and "join" not in entries and alone


def fits_field(name: str, value: Tree) -> bool:
    """Whether a value has the shape of a field of the schema."""
    text = value.value if isinstance(value, Scalar) else None
    items = value.items if isinstance(value, Seq) else ()
    match schema.VARIABLES[name].shape if name not in _SHAPES else _SHAPES[name]:
        case "states":
            return isinstance(value, Seq) and all(isinstance(each, Map) for each in items)
        case "name" | "text":
            return isinstance(text, str)
        case "flag":
            return isinstance(text, bool)
        case "duration":
            return isinstance(value, Scalar) and not isinstance(text, bool)
        case "names" | "outcomes" | "keys" as shape:
            listed = isinstance(value, Seq) and all(isinstance(each, Scalar) for each in items)
            return listed or (shape != "names" and isinstance(value, Map))
        case "items":
            return isinstance(value, Seq) or isinstance(text, str)
        case "map" | "userdata" | "fields":
            return isinstance(value, Map)
        case "pairs" as shape:
            return _has_values(value, Scalar)
        case "rules":
            return _has_values(value, Map)
    return True


_SHAPES = {
    "states": "states",
    "properties": "states",
    "timeout": "duration",
    "retry": "fields",
    "for_each": "fields",
}
"""The shapes of the fields that the schema reads as any value."""


def _has_values(value: Tree, kind: type[Scalar] | type[Map]) -> bool:
    """Whether a value is a mapping with values of one kind."""
    return isinstance(value, Map) and all(isinstance(each.value, kind) for each in value.entries)


def fitting_fields(
    value: Tree, known: Sequence[str], entries: Collection[str], type_: StateType
) -> list[str]:
    """The names among `known` that are not given yet, those of fields only if they can have the
    value."""
    free = [name for name in known if name not in entries]
    own = type_.variables
    return [name for name in free if name in own or fits_field(name, value)]


def paired_help(word: str, meant: str | None, known: Sequence[str]) -> str | None:
    """The help for an unknown field that is not like the name of the missing one that it means:
    without an edit, because it is not certain."""
    if meant is None or guesser_of((*dict.fromkeys(known),)).sure(word) == meant:
        return None
    return f"did you mean `{meant}`?"
