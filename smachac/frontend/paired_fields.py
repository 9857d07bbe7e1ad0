"""An unknown field of a state and the required one that is missing belong together, where there is
one of each: that is one finding (SM003), and the missing field (SM005) is none."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Iterator, Mapping, Sequence

from smachac.diagnostics.spelling import guesser_of
from smachac.frontend import schema
from smachac.frontend.errors.script import FOREIGN
from smachac.frontend.schema import FieldOwner
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.ir.nodes import StateType


def paired_fields(
    unknown: Sequence[str],
    given: Collection[str],
    entries: Mapping[str, Entry],
    owner: FieldOwner,
    type_: StateType,
) -> dict[str, Entry]:
    """The only unknown field under the name of the only required one that is not `given`, where its
    value has the shape of that one."""
    inputs = {*(key.name for key in type_.input_keys), *type_.listed_inputs}
    other = {*inputs, *(each.name for each in type_.outcomes), *FOREIGN}
    wrong = [key for key in unknown if key not in other]
    required = [*schema.REQUIRED[owner]]
    required += [key for key, variable in type_.variables.items() if variable.required]
    missing = [key for key in required if key not in given and key != "template"]
    if not missing and len(unknown) == 1 and owner == "state":
        missing = [name for name in keys_meant(entries[unknown[0]].value, entries, type_)
                   if name not in given]  # fmt: skip
    if len(wrong) != 1 or len(unknown) != 1 or len(missing) != 1:
        return {}
    entry = entries[wrong[0]]
    return {missing[0]: entry} if _has_shape(missing[0], entry.value, type_) else {}


def ends_with_any(entries: Mapping[str, Entry], owner: FieldOwner) -> bool:
    """Whether a concurrence without `join` may end with its first branch: no rule of it needs two
    of them."""
    given = entries["outcome_map"].value if "outcome_map" in entries else None
    rules = [each.value for each in given.entries] if isinstance(given, Map) else []
    alone = all(not isinstance(rule, Map) or len(rule.entries) < 2 for rule in rules)
    return owner == "Concurrence" and "join" not in entries and alone


def keys_meant(value: Tree, entries: Mapping[str, Entry], type_: StateType) -> Iterator[str]:
    """The lists of keys of a state that an unknown field can be: its code in the script reads or
    sets all these keys."""
    items = value.items if isinstance(value, Seq) else ()
    names = {str(each.value) for each in items if isinstance(each, Scalar) and each.plain}
    if not names or len(names) < len(items):
        return
    fields = [(key, entries[key].value) for key in type_.variables if key in entries]
    code = [(key, each) for key, tree in fields if isinstance(tree, Map) for each in tree.entries]
    texts = [str(each.value.value) for _, each in code if isinstance(each.value, Scalar)]
    read = {name for text in texts for name in _READ.findall(text)}
    if "input_keys" in type_.given and names <= read:
        yield "input_keys"
    written = {
        str(each.key.value) for key, each in code if type_.variables[key].role == "callbacks"
    }
    if "output_keys" in type_.given and names <= written:
        yield "output_keys"


_READ = re.compile(r"\b(?:ud|userdata)\.(\w+)")
"""A key that code in a script reads."""


def _has_shape(name: str, value: Tree, type_: StateType) -> bool:
    """Whether a value can be that of a required field."""
    if isinstance(value, Scalar) and (value.value is None or value.value == ""):
        return False
    variable = type_.variables.get(name)
    if variable is not None:
        number = variable.type.name in ("float", "int")
        if number:
            given = value.value if isinstance(value, Scalar) else None
            least, most = -math.inf, math.inf
            if variable.limits is not None:
                least, most = variable.limits.least, variable.limits.most
            if not isinstance(given, int | float) or isinstance(given, bool):
                return False
            return least <= given <= most
        return variable.type.name != "str" or not isinstance(value, Map)
    return fits_field(name, value)


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
