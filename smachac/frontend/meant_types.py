"""The built-in state type that a state means whose template is another one: the type that has all
its variables and outcomes."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser_of
from smachac.frontend import schema
from smachac.frontend.errors.script import Owner, unknown_variable
from smachac.frontend.yaml_tree import Entry, Map
from smachac.ir.nodes import StateType


def has_unknown_variable(entries: Mapping[str, Entry], type_: StateType) -> bool:
    """Whether a state of a built-in type has a variable that the type does not have."""
    own = schema.OWN_FIELDS["state"]
    if own.issuperset(entries) or not type_.built_in or type_.open or type_.any_variable:
        return False
    return any(key not in own and key not in type_.variables for key in entries)


def meant_type(
    entries: Mapping[str, Entry],
    type_: StateType,
    names: Iterable[str],
    find: Callable[[str, Collection[str]], StateType | None],
    report: Report,
) -> StateType | None:
    """The only built-in type that has the variables and the outcomes of a state with an unknown
    variable of a built-in type (SM003), or None. `names` are those of all state types."""
    fields = schema.names_for("state")
    own = [key for key in entries if key not in fields]
    unknown = [key for key in own if key not in type_.variables]
    sure = guesser_of((*fields, *type_.variables)).sure
    if any(sure(key) is not None for key in unknown):
        return None
    steps = entries.get("transitions")
    ends = {
        str(each.key.value)
        for each in (steps.value.entries if steps and isinstance(steps.value, Map) else ())
    }
    fitting = []
    for name in names:
        other = find(name, own)
        if other is not None and _fits(other, own, ends, entries):
            fitting.append(other)
    if len(fitting) != 1:
        return None
    key = entries[unknown[0]].key
    word, owner = Word(str(key.value), key.span), Owner(type_.name, f"state type `{type_.name}`")
    report.append(unknown_variable(word, owner, type_.variables, type_name=fitting[0].name))
    return fitting[0]


def _fits(
    type_: StateType, variables: Iterable[str], ends: set[str], entries: Mapping[str, Entry]
) -> bool:
    """Whether a built-in type has some variables and outcomes, and lacks none that it requires."""
    if not type_.built_in or type_.open or type_.any_variable:
        return False
    required = [key for key, each in type_.variables.items() if each.required]
    return (
        type_.variables.keys() >= {*variables}
        and entries.keys() >= {*required}
        and {each.name for each in type_.outcomes} >= ends - {"error"}
    )
