"""The types in a script: aliases of `types:` are replaced, and errors are reported (SM017)."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Word
from smachac.frontend.errors.script import bad_type
from smachac.frontend.fields import as_pairs, is_long_form
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Tree, is_known_wrong
from smachac.ir.types import WORDS, Type, parse_type, unknown_words

Aliases = Mapping[str, str]
"""The type of each alias, itself without aliases."""

TYPED = ("input_keys", "output_keys", "userdata")
"""The fields that have types."""

_WORD = re.compile(r"[A-Za-z_]\w*")


def read_aliases(tree: Tree, report: Report) -> Aliases:
    """The `types:` of a script; an alias may use earlier ones."""
    found: dict[str, str] = {}
    for key, value in as_pairs(tree, report):
        text = _filled(value.text, found)
        if read_type(text, value, report) is not None:
            found[key.text] = text
    return found


def read_type(text: str, place: Word, report: Report) -> Type | None:
    """The type that a text names; SM017 at `place` if it names none."""
    type_ = parse_type(text)
    if type_ is None:
        report.append(bad_type(place, WORDS))
        return None
    unknown = unknown_words(type_)
    if unknown:
        report.append(bad_type(place, WORDS, unknown[0]))
    return type_


def typed(key: str, entry: Entry, aliases: Aliases, report: Report) -> Entry:
    """A field with the aliases in its types replaced; any other field as it is."""
    value = entry.value
    if key not in TYPED or not isinstance(value, Map):
        return entry
    items = tuple(
        Entry(
            item.key,
            _long_form(item.value, aliases, report)
            if key == "userdata"
            else _type(item.value, aliases, report),
        )
        for item in value.entries
    )
    return Entry(entry.key, Map(items, value.span))


def type_words(key: str, tree: Tree) -> Iterator[str]:
    """The words in the types of a field."""
    if key not in TYPED or not isinstance(tree, Map):
        return
    for item in tree.entries:
        value = item.value
        if key == "userdata":
            entry = value.get("type") if isinstance(value, Map) and is_long_form(value) else None
            if entry is None:
                continue
            value = entry.value
        yield from words_of(value)


def words_of(tree: Tree) -> list[str]:
    """The words of a type, as written."""
    if isinstance(tree, Scalar) and isinstance(tree.value, str):
        return _WORD.findall(tree.value)
    return []


def _long_form(tree: Tree, aliases: Aliases, report: Report) -> Tree:
    if not isinstance(tree, Map) or not is_long_form(tree):
        return tree
    items = tuple(
        Entry(item.key, _type(item.value, aliases, report)) if item.key.value == "type" else item
        for item in tree.entries
    )
    return Map(items, tree.span)


def _type(tree: Tree, aliases: Aliases, report: Report) -> Tree:
    if not isinstance(tree, Scalar) or not isinstance(tree.value, str) or is_known_wrong(tree):
        return tree
    text = _filled(tree.value, aliases)
    read_type(text, Word(tree.value, tree.span), report)
    return Scalar(text, tree.plain, *tree.span)


def _filled(text: str, aliases: Aliases) -> str:
    return _WORD.sub(lambda found: aliases.get(found.group(), found.group()), text)
