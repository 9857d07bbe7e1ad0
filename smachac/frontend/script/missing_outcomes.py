"""The outcomes of a container that does not declare its outcomes: those that the script uses.

The container has them after the fault is reported (SM005), so that no use of them is reported too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend import schema
from smachac.frontend.text.fields import name_of, pairs_of
from smachac.frontend.text.yaml_tree import Entry, Map, Seq, Tree
from smachac.ir.nodes import Outcome


def outcomes_used(entries: Mapping[str, Entry]) -> tuple[Outcome, ...]:
    """The outcomes that the fields of a container use, each once, in the order of the script.

    They are those of its transitions, its default outcome, the results of its outcome map, and the
    targets of its states that are no states.
    """
    words = [*_keys(entries.get("transitions")), *_keys(entries.get("outcome_map"))]
    if "default_outcome" in entries and (name := name_of(entries["default_outcome"].value)):
        words.append(name)
    if "states" in entries:
        words += _exits(entries["states"].value)
    found: dict[str, Word] = {}
    for word in words:
        found.setdefault(word.text, word)
    return tuple(Outcome(name=word.text, span=word.span) for word in found.values() if word.text)


def _keys(entry: Entry | None) -> Iterator[Word]:
    """The keys of a mapping, or of the mappings in a list, that are names."""
    value = entry.value if entry is not None else None
    for part in value.items if isinstance(value, Seq) else (value,):
        words = (name_of(item.key) for item in part.entries) if isinstance(part, Map) else ()
        yield from (word for word in words if word is not None)


def _exits(states: Tree) -> Iterator[Word]:
    """The targets in a list of states that are not the names of states, nor misspelt ones."""
    names: list[str] = []
    targets: list[Word] = []
    for item in states.items if isinstance(states, Seq) else ():
        if not isinstance(item, Map) or not item.entries:
            continue
        first, rest = item.entries[0], item.entries[1:]
        names.append(str(first.key.value))
        for field in first.value.entries if isinstance(first.value, Map) else rest:
            key = str(field.key.value)
            if schema.LONG.get(key, key) == "transitions":
                targets += [target for _, target in pairs_of(field.value)]
    guess = guesser(names)
    yield from (
        target
        for target in targets
        if target.text not in names and not guess.unique_match(target.text)
    )
