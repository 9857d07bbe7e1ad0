"""Templates that are missing or were not found: the types that a state means by the names it uses,
and one finding for all states that name the same template."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser_of, respelt, words_of
from smachac.diagnostics.wording import both, either, listed
from smachac.frontend import schema
from smachac.frontend.errors.references import template_not_found
from smachac.frontend.errors.script import Owner, missing_variable
from smachac.frontend.script.state_fields import FIELDS_OF_STATES, TEMPLATE_WORDS
from smachac.frontend.text.fields import pairs_of
from smachac.frontend.text.yaml_tree import Entry
from smachac.ir.nodes import StateType

CALLED_HERE = "in the sub-script called here"

MOST_TYPES = 200
"""Among more types than these, none is proposed: each has to be read."""

MOST_SUGGESTED = 3
"""If more types than these have the names that a state uses, none is proposed."""


def types_with_the_names(
    entries: Mapping[str, Entry],
    word: str,
    names: Sequence[str],
    find: Callable[[str, Collection[str]], StateType | None],
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The names of the types that have all variables, keys and outcomes of a state, and those
    variables and keys. Types that share a word with the unknown name `word` come alone, if there
    are any. `names` are those of all types."""
    fields = schema.names_for("state")
    variables = [key for key in entries if key not in fields]
    keys = [inner.text for inner, _ in pairs_of(entries["remapping"].value)] \
        if "remapping" in entries else []  # fmt: skip
    used = tuple(dict.fromkeys([*keys, *variables]))
    if not used or len(names) > MOST_TYPES:
        return (), ()
    steps = pairs_of(entries["transitions"].value) if "transitions" in entries else ()
    ends = {outcome.text for outcome, _ in steps}
    types = [type_ for name in names if (type_ := find(name, used)) is not None]
    fitting = [type_ for type_ in types if _has(type_, used, ends)]
    common = words_of(word) - {"state"}
    near = [type_ for type_ in fitting if words_of(type_.name) & common]
    found = tuple(type_.name for type_ in near or fitting)
    return (found, used) if len(found) <= MOST_SUGGESTED else ((), ())


def type_of_other_framework(
    word: str,
    entries: Mapping[str, Entry],
    names: Sequence[str],
    find: Callable[[str, Collection[str]], StateType | None],
) -> str:
    """The help for a state whose `template` is the name of a type in another framework: the type
    here, and the fields and outcomes of the state that have another name; empty without one."""
    if len(names) > MOST_TYPES:
        return ""
    types = (find(name, (word,)) for name in names)
    type_ = next((type_ for type_ in types if type_ and word in type_.other_names), None)
    if type_ is None:
        return ""
    steps = pairs_of(entries["transitions"].value) if "transitions" in entries else ()
    used = [*entries, *(outcome.text for outcome, _ in steps)]
    renamed = type_.other_names[word]
    changes = [f"`{renamed[text]}` in place of `{text}`" for text in used if text in renamed]
    return f"write `template: {type_.name}`" + (f", with {', '.join(changes)}" if changes else "")


class Searched(NamedTuple):
    """Where a template was searched: the folders, the names of all types, those and the kinds of
    containers, the names of sub-scripts, and a folder that has the file but was not searched."""

    folders: Sequence[str]
    types: Sequence[str]
    known: Sequence[str]
    scripts: Sequence[str]
    other: str


def unknown_template(
    word: Word,
    entries: Mapping[str, Entry],
    searched: Searched,
    find: Callable[[str, Collection[str]], StateType | None],
) -> Diagnostic:
    """SM013 for a template that was not found: with the type that is meant by its name or by the
    `entries` of the state."""
    folders, types, known, scripts, other = searched
    help = ""
    if word.text in scripts:
        help = f"`{word.text}` is a sub-script: write `script: {word.text}`"
    elif not other and guesser_of(tuple(known)).unique_match(word.text) is None:
        help = type_of_other_framework(word.text, entries, types, find) if entries else ""
        kind, field = _only_kind(entries) if "states" in entries else ("", "")
        fitting, used = types_with_the_names(entries, word.text, types, find)
        if kind and not help:
            help = f"did you mean `{kind}`? Only a {kind} has `{field}`"
        elif fitting and not help:
            help = f"did you mean {either(fitting)}, with {both(used)}?"
    return template_not_found(word, folders, known, other, help)


def suggested_container(word: str, entries: Mapping[str, Entry]) -> str:
    """The kind of container that is meant by an unknown type of a state with `states`: the one with
    a name near to it, else the only one that has the fields of the state; empty without one."""
    if "states" not in entries:
        return ""
    return guesser_of(tuple(schema.CONTAINERS))(word) or _only_kind(entries)[0]


def missing_template_help(
    name: str,
    entries: Mapping[str, Entry],
    scripts: Sequence[str],
    names: Sequence[str],
    find: Callable[[str, Collection[str]], StateType | None],
) -> str | None:
    """The help for a state without a template: the sub-script of its name, else the types that have
    the names that it uses; None if there are neither. `scripts` are the names of sub-scripts."""
    script = next((script for script in scripts if script.casefold() == name.casefold()), None)
    if script is not None:
        return f"add `script: {script}`, or `template: TYPE` if it is no call of that sub-script"
    kind, field = _only_kind(entries)
    if kind:
        return f"add `template: {kind}`: only a {kind} has `{field}`"
    types, used = types_with_the_names(entries, "", names, find)
    if not types:
        return None
    several = len(types) > 1
    has = "these types have" if several else "this type has"
    return f"add {either(f'template: {type_}' for type_ in types)}: {has} {listed(used)}"


def _only_kind(entries: Iterable[str]) -> tuple[str, str]:
    """The only kind of container that has the fields of a state which no other state has, with the
    first of these fields; empty without one."""
    rows = {key: row for key in entries if (row := schema.VARIABLES.get(key)) is not None}
    own = {key: row.owners & schema.CONTAINERS.keys() for key, row in rows.items()
           if row.owners and not row.owners & {"state", "base"}}  # fmt: skip
    kinds = set.intersection(*map(set, own.values())) if own else set()
    return (kinds.pop(), next(iter(own))) if len(kinds) == 1 else ("", "")


def missing_template(
    state: Word, calls: Sequence[Span], entries: Mapping[str, Entry], help: str | None
) -> Diagnostic:
    """SM005 for a state without a template. `calls` are those of sub-scripts that lead to it."""
    related = tuple(Related(span=call, message=CALLED_HERE) for call in calls)
    owner = Owner(state.text, f"`{state.text}`")
    place, help = state.span, f"{help or 'add `template: TYPE`'}; `smachac states` lists the types"
    edits: tuple[Edit, ...] = ()
    sure = guesser_of((*FIELDS_OF_STATES, "script")).unique_match
    for key, entry in entries.items():
        near = sure(key) if key not in schema.VARIABLES else None
        meant = "template" if key in TEMPLATE_WORDS else near
        if meant in ("template", "script"):
            place, help = entry.key.span, f"write `{meant}:` in place of `{entry.key.value}:`"
            edits = respelt(Word(str(entry.key.value), place), near)
            break
    return missing_variable(place, "template", owner, related, help=help, edits=edits)


def _has(type_: StateType, used: Iterable[str], ends: Iterable[str]) -> bool:
    """Whether a type declares these variables or keys, and these outcomes."""
    if type_.kind != "state" or type_.open or type_.any_variable:
        return False
    keys = {key.name for key in (*type_.input_keys, *type_.output_keys)}
    outcomes = {outcome.name for outcome in type_.outcomes} | {"error", "timeout"}
    return keys.union(type_.variables).issuperset(used) and outcomes.issuperset(ends)
