"""Entries of mappings whose name and value have changed places: `rows: in` in place of `in: rows`.

They are reported once (SM003) and then count as they are meant, so that nothing else follows.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Span, Word
from smachac.frontend.errors.script import Owner, unknown_variable, wrong_shape
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Tree
from smachac.ir.types import parse_type, unknown_words


def turned(entry: Entry) -> Entry | None:
    """The entry with its name and its value exchanged; None for a value that is no plain word."""
    value = entry.value
    if not isinstance(value, Scalar) or not value.plain or not isinstance(value.value, str):
        return None
    return Entry(value, entry.key) if value.value else None


def turned_help(entry: Entry) -> str:
    """The text to write in place of an entry that is turned round."""
    return f"write `{entry.value.span.text}: {entry.key.span.text}`: the name comes first"


def with_turned(tree: Tree, known: Collection[str], owner: Owner, report: Report) -> Tree:
    """A mapping with the fields `known`, in which the entries are turned back whose value is the
    name of a field that it does not have otherwise."""
    if not isinstance(tree, Map) or all(each.key.value in known for each in tree.entries):
        return tree
    given = {str(entry.key.value) for entry in tree.entries}

    def is_turned(entry: Entry, back: Entry) -> bool:
        name = str(back.key.value)
        return str(entry.key.value) not in known and name in known and name not in given

    return _turned_back(tree, is_turned, owner, report)


def with_turned_types(tree: Tree, owner: Owner, report: Report) -> Tree:
    """A mapping of names to types, in which the entries are turned back whose name is a type and
    whose value is none."""
    if not isinstance(tree, Map):
        return tree
    given = {str(entry.key.value) for entry in tree.entries}

    def is_turned(entry: Entry, back: Entry) -> bool:
        name = str(back.key.value)
        return (
            name.isidentifier()
            and name not in given
            and _is_type(str(entry.key.value))
            and not _is_type(name)
        )

    return _turned_back(tree, is_turned, owner, report)


def _is_type(text: str) -> bool:
    type_ = parse_type(text)
    return type_ is not None and not unknown_words(type_)


def _turned_back(
    tree: Map, is_turned: Callable[[Entry, Entry], bool], owner: Owner, report: Report
) -> Tree:
    entries: list[Entry] = []
    for entry in tree.entries:
        back = turned(entry)
        if back is not None and is_turned(entry, back):
            _report(entry, owner, report)
            entry = back
        entries.append(entry)
    if all(new is old for new, old in zip(entries, tree.entries, strict=True)):
        return tree
    return Map(tuple(entries), tree.span)


def _report(entry: Entry, owner: Owner, report: Report) -> None:
    word = Word(entry.key.span.text, entry.key.span)
    report.append(unknown_variable(word, owner, (), certain=turned_help(entry)))


def with_turned_fields(
    entries: Mapping[str, Entry],
    known: Collection[str],
    variables: Collection[str],
    owner: Owner,
    report: Report,
) -> dict[str, Entry]:
    """The fields of a state by long name, in which those are turned back whose name is none of
    `known` and whose value is one of `variables`, which the state does not have otherwise."""
    found: dict[str, Entry] = {}
    wrong: set[Span] = set()
    for key, entry in entries.items():
        back = turned(entry) if key not in known else None
        name = "" if back is None else str(back.key.value)
        if back is None or name not in variables or name in entries or name in found:
            found[key] = entry
            continue
        found[name] = back
        wrong.add(entry.key.span)
        _report(entry, owner, report)
    if wrong:  # `true` is no name either
        report[:] = [
            item for item in report if not (item.kind is wrong_shape.code and item.span in wrong)
        ]
    return found
