"""Entries and fields that are inserted into a script or removed from it, in the style around them.

All else stays as it is, character by character. The functions raise RefusedError where the place is
written in a way that they do not change.
"""

from __future__ import annotations

import json

from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import is_plain
from smachac.refactor.cst import Atom, Collection, Item
from smachac.refactor.editor import RefusedError, ScriptEditor, variable
from smachac.refactor.field_order import variables_of


def as_yaml(name: str) -> str:
    """A name as YAML text, in quotes where it needs them."""
    return name if is_plain(name) else json.dumps(name, ensure_ascii=False)


def fields_of(editor: ScriptEditor, span: Span) -> Collection:
    """The fields of the state whose name is at a span, or of the script."""
    place = editor.places.get(span.start)
    if place is None:
        return editor.text.root
    body = variables_of(place.item)
    if body is None or body.raw is not None:
        raise _unusual(span)
    return body


def set_entry(editor: ScriptEditor, span: Span, field: str, key: str, value: str) -> None:
    """Set the value of a key in a field of a state that is a mapping; add what is missing."""
    body = fields_of(editor, span)
    item = variable(body, field)
    if item is None:
        insert_field(editor, body, f"{field}: {{{as_yaml(key)}: {as_yaml(value)}}}")
        return
    group = _mapping(item, span)
    entry = _entry(group, key)
    if entry is None:
        _insert(editor, group, f"{as_yaml(key)}: {as_yaml(value)}")
    elif isinstance(entry.value, Atom) and entry.value.text[:1] not in ("*", "&", "!", "|", ">"):
        editor.replace(entry.value.start, entry.value.end, as_yaml(value))
    else:
        raise _unusual(span)


def remove_entry(editor: ScriptEditor, span: Span, field: str, key: str) -> bool:
    """Remove a key from a field of a state that is a mapping, and the field if it was the only one;
    whether there was such a key."""
    body = fields_of(editor, span)
    item = variable(body, field)
    if item is None:
        return False
    group = _mapping(item, span)
    entry = _entry(group, key)
    if entry is None:
        return False
    if len(group.items) == 1:
        _remove(editor, body, item, span)
    else:
        _remove(editor, group, entry, span)
    return True


def insert_field(editor: ScriptEditor, body: Collection, text: str) -> None:
    """Insert a field into a state or the script: before its states, or as its last one."""
    states = variable(body, "states")
    if states is not None and not body.flow and states.start >= 0:
        assert states.key is not None
        editor.insert(states.start, f"{' ' * _column(editor, states)}{text}\n")
        return
    _insert(editor, body, text)


def _insert(editor: ScriptEditor, group: Collection, text: str) -> None:
    """Insert an entry behind the others of a mapping."""
    if not group.items:
        editor.insert(group.end - 1, text)
        return
    last = group.items[-1]
    end = max(last.value.end, last.key.end if last.key is not None else 0)
    if group.flow:
        editor.insert(end, f", {text}")
        return
    stop = editor.source.text.find("\n", end)
    stop = len(editor.source.text) if stop < 0 else stop
    editor.insert(stop, f"\n{' ' * _column(editor, last)}{text}")


def _remove(editor: ScriptEditor, group: Collection, item: Item, span: Span) -> None:
    """Remove an entry of a mapping that has others. Its comments stay."""
    text = editor.source.text
    assert item.key is not None
    if not group.flow:
        begin = editor.source.line_starts[editor.source.position(item.key.start)[0] - 1]
        if text[begin : item.key.start].strip():
            raise _unusual(span)
        stop = text.find("\n", item.value.end)
        margin = text[begin : item.key.start]
        kept = "".join(f"{margin}{comment}\n" for comment in _comments(item))
        editor.replace(begin, len(text) if stop < 0 else stop + 1, kept)
        return
    number = group.items.index(item)
    if number:
        editor.replace(group.items[number - 1].value.end, item.value.end, "")
    else:
        after = group.items[1].key
        assert after is not None
        editor.replace(item.key.start, after.start, "")


def _comments(top: Item) -> list[str]:
    """The comments behind an entry and inside its value."""
    found = [top.trailing.strip()]
    todo = [top.value]
    while todo:
        group = todo.pop()
        if isinstance(group, Collection):
            for item in group.items:
                found += [*item.leading, item.trailing.strip()]
                todo.append(item.value)
            found += group.tail
    return [comment for comment in found if comment]


def _mapping(item: Item, span: Span) -> Collection:
    group = item.value
    if not isinstance(group, Collection) or not group.mapping or group.raw is not None:
        raise _unusual(span)
    return group


def _entry(group: Collection, key: str) -> Item | None:
    names = {key, as_yaml(key), f"'{key}'", f'"{key}"'}
    return next((item for item in group.items if item.key and item.key.text in names), None)


def _column(editor: ScriptEditor, item: Item) -> int:
    assert item.key is not None
    return editor.source.position(item.key.start)[1] - 1


def _unusual(span: Span) -> RefusedError:
    help = "write its fields out, or format the script: `smachac fmt`"
    return RefusedError(span, "this state is written in a way that cannot be edited", help)
