"""Calls of sub-scripts: what a sub-script holds, and what a call changes of it."""

from __future__ import annotations

from smachac import problems, shapes
from smachac.diagnostics import Report
from smachac.source import Span, Word
from smachac.syntax import Entry, Map, Scalar, Seq, Tree


def sub_script_state(
    tree: Tree, call: Word, report: Report
) -> tuple[Word, tuple[Entry, ...]] | None:
    """The name and the variables of the one state that a sub-script holds, as written (SM014)."""
    start = Span(tree.span.source, tree.span.start, tree.span.start + 1)
    if isinstance(tree, Map):
        message = "a sub-script is a list with one state; this is a mapping"
        report.append(problems.bad_sub_script(start, message, call.span))
        return None
    if not isinstance(tree, Seq) or len(tree.items) != 1:
        count = f"{len(tree.items)} states" if isinstance(tree, Seq) else shapes.kind_of(tree)
        message = f"a sub-script is a list with one state; this is {count}"
        report.append(problems.bad_sub_script(start, message, call.span))
        return None
    item = tree.items[0]
    if not isinstance(item, Map) or not item.entries:
        report.append(
            problems.bad_sub_script(start, "the sub-script's item is no state", call.span)
        )
        return None
    first, rest = item.entries[0], item.entries[1:]
    name = Word(str(first.key.value), first.key.span)
    if isinstance(first.value, Map) and not rest:
        return name, first.value.entries
    if isinstance(first.value, Scalar) and first.value.value is None and rest:
        return name, rest
    message = "a sub-script is a list with one state that has one key: its name"
    report.append(problems.bad_sub_script(first.key.span, message, call.span))
    return None


def overridden(inner: dict[str, Entry], call: dict[str, Entry]) -> dict[str, Entry]:
    """The variables of a sub-script under those of its call: mappings merge, the rest replaces."""
    merged = dict(inner)
    for key, entry in call.items():
        below = merged.get(key)
        if below is None or not isinstance(below.value, Map) or not isinstance(entry.value, Map):
            merged[key] = entry
            continue
        own = {item.key.value: item for item in entry.value.entries}
        entries = [own.pop(item.key.value, item) for item in below.value.entries]
        merged[key] = Entry(entry.key, Map((*entries, *own.values()), entry.value.span))
    return merged
