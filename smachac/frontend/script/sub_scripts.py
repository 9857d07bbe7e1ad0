"""Sub-scripts: the one state of a file, the fields that a call overrides, the params it gives."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Span, Word
from smachac.frontend.errors.references import (
    bad_sub_script,
)
from smachac.frontend.text.fields import kind_of
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree

SUB_SCRIPT_HELP = "write one state: `- NAME: {template: ...}`"
"""The help for a file that is no sub-script."""


def _state_name(item: Tree) -> Word | None:
    """The name of a state in the list of a sub-script."""
    if not isinstance(item, Map) or not item.entries:
        return None
    key = item.entries[0].key
    return Word(str(key.value), key.span)


def sub_script_state(
    tree: Tree, call: Word, report: Report
) -> tuple[Word, tuple[Entry, ...]] | None:
    """The name and the fields of the one state of a sub-script; SM014 if it is not one state."""

    def refuse(at: Span, fault: str, message: str, help: str = SUB_SCRIPT_HELP) -> None:
        """SM014; `fault` is the word for the fault among the arguments."""
        report.append(bad_sub_script(at, message, call.span, help, arguments=(fault,)))

    start = Span(tree.span.source, tree.span.start, tree.span.start + 1)
    if isinstance(tree, Map) and tree.get("states") is not None:
        own = tree.get("name")
        word = own.value.span.text.upper() if own is not None else "NAME"
        help = f"write `- {word}:` first, and indented below it `template: StateMachine`"
        message = "a sub-script must be a list with one state; this is a machine"
        refuse(start, "shape", message, f"{help} and the rest without `name:`")
        return None
    if not isinstance(tree, Seq):
        help = SUB_SCRIPT_HELP
        first = tree.entries[0] if isinstance(tree, Map) and tree.entries else None
        if first is not None and isinstance(first.value, Map):
            help = f"write `- {first.key.value}:`, the state as the item of a list"
        message = f"a sub-script must be a list with one state, not {kind_of(tree)}"
        refuse(start, "shape", message, help)
        return None
    if len(tree.items) != 1:
        message = f"a sub-script must have one state; this one has {len(tree.items)}"
        names = [name for name in map(_state_name, tree.items) if name is not None]
        place = names[1].span if len(names) > 1 else start
        inside = ", ".join(f"`{name.text}`" for name in names)
        help = f"remove all but one, or put {inside} into one container: `- NAME: {{template:"
        help += " StateMachine, outcomes: [...], states: [...]}`"
        refuse(place, "states", message, help if names else SUB_SCRIPT_HELP)
        return None
    item = tree.items[0]
    if not isinstance(item, Map) or not item.entries:
        refuse(start, "item", "the item of a sub-script must be a state")
        return None
    first, rest = item.entries[0], item.entries[1:]
    name = Word(str(first.key.value), first.key.span)
    if isinstance(first.value, Map) and not rest:
        return name, first.value.entries
    if isinstance(first.value, Scalar) and first.value.value is None and rest:
        return name, rest
    refuse(first.key.span, "key", "the state of a sub-script must have one key: its name")
    return None


def overridden(inner: dict[str, Entry], call: dict[str, Entry]) -> dict[str, Entry]:
    """The fields of a sub-script and its call: mappings are merged, other fields replaced."""
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
