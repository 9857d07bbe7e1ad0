"""An unknown field of a state and the required one that is missing belong together, where there is
one of each: that is one finding (SM003), and the missing field (SM005) is none."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence

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
    if len(wrong) != 1 or len(unknown) != 1 or len(missing) != 1:
        return {}
    entry = entries[wrong[0]]
    return {missing[0]: entry} if _has_shape(missing[0], entry.value, type_) else {}


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
    if name == "states":
        return isinstance(value, Seq) and all(isinstance(each, Map) for each in value.items)
    shape = schema.VARIABLES[name].shape
    if shape == "name":
        return isinstance(value, Scalar) and isinstance(value.value, str)
    if shape in ("names", "outcomes", "keys"):
        return isinstance(value, Seq) and all(isinstance(each, Scalar) for each in value.items)
    return isinstance(value, Map) or shape not in ("map", "pairs", "rules", "userdata")


def paired_help(word: str, meant: str | None, known: Sequence[str]) -> str | None:
    """The help for an unknown field that is not like the name of the missing one that it means:
    without an edit, because it is not certain."""
    if meant is None or guesser_of((*dict.fromkeys(known),)).sure(word) == meant:
        return None
    return f"did you mean `{meant}`?"
