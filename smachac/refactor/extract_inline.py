"""Extract and inline: a container becomes a sub-script, a sub-script becomes a container."""

from __future__ import annotations

from smachac.diagnostics.source import Span
from smachac.refactor.cst import Collection, Item
from smachac.refactor.editor import RefusedError, ScriptEditor, new_atom, variable
from smachac.refactor.field_order import long_name, sort_variables, variables_of
from smachac.refactor.formatter import list_text

CALL_FIELDS = ("params", "userdata", "remapping", "transitions")
"""Fields that stay at the call of a sub-script, as in SMACHA: other calls may have other values."""


def extract(editor: ScriptEditor, span: Span, script: str) -> str:
    """Replace the container whose name is at `span` by a call; return the text of the sub-script.

    Raises RefusedError.
    """
    place = editor.state(span)
    body = variables_of(place.item)
    assert body is not None
    if variable(body, "script") is not None:
        help = "`smachac inline` replaces the call by its content"
        raise RefusedError(span, f"`{span.text}` is already a sub-script", help)
    if variable(body, "states") is None:
        help = "put it into a container first: `smachac contain`"
        raise RefusedError(span, f"`{span.text}` is not a container", help)
    state = place.item.value
    assert isinstance(state, Collection)
    entry = state.items[0]
    kept = [item for item in body.items if long_name(item) in CALL_FIELDS]
    moved = [item for item in body.items if long_name(item) not in CALL_FIELDS]
    inner = Collection(True, False, -1, items=moved, tail=body.tail, is_state=True)
    named = Collection(True, False, -1, items=[Item(entry.key, inner)], tail=state.tail)
    editor.apply_words(Item(None, named))
    text = list_text(Item(None, named), [])
    call = [Item(new_atom("script"), new_atom(script)), *kept]
    entry.value = Collection(True, body.flow, -1, body.properties, items=call, is_state=True)
    state.tail = []
    editor.rewrite_state(place)
    return text


def inline(editor: ScriptEditor, span: Span, sub: ScriptEditor) -> None:
    """Replace the call of a sub-script by its content. Raises RefusedError."""
    place = editor.state(span)
    call = variables_of(place.item)
    found = sub.text.root
    first = found.items[0] if found.items and not found.mapping else None
    inner = variables_of(first) if first is not None else None
    assert call is not None
    if first is None or inner is None:
        raise RefusedError(span, "its sub-script has an unusual form")
    state, below = place.item.value, first.value
    assert isinstance(state, Collection)
    assert isinstance(below, Collection)
    entry = state.items[0]
    script = variable(call, "script")
    above = [*script.leading, script.trailing.strip()] if script is not None else []
    named = below.items[0]
    above += [*first.leading, *named.leading, named.trailing.strip() if entry.trailing else ""]
    entry.trailing = entry.trailing or named.trailing
    place.item.leading += [line for line in above if line]
    own = [item for item in call.items if item is not script]
    body = Collection(True, False, -1, call.properties or inner.properties, is_state=True)
    body.items = _merged(inner.items, own)
    body.tail = [*inner.tail, *below.tail, *found.tail, *call.tail]
    sort_variables(body)
    entry.value = body
    editor.rewrite_state(place)


def _merged(below: list[Item], own: list[Item]) -> list[Item]:
    """The fields of a sub-script, overridden by those of its call (as frontend/script/resolve.py
    merges them)."""
    over = {long_name(item): item for item in own}
    merged = []
    for item in below:
        above = over.pop(long_name(item), None)
        if above is None:
            merged.append(item)
            continue
        merged.append(_with_comments(above, item))
        if _is_mapping(item) and _is_mapping(above):
            assert isinstance(item.value, Collection)
            assert isinstance(above.value, Collection)
            entries = {_key(entry): entry for entry in above.value.items}
            mine = [
                _with_comments(entries.pop(_key(entry)), entry) if _key(entry) in entries else entry
                for entry in item.value.items
            ]
            flow = item.value.flow and above.value.flow
            whole = Collection(True, flow, -1, items=[*mine, *entries.values()])
            whole.tail = [*item.value.tail, *above.value.tail]
            above.value = whole
    return [*merged, *over.values()]


def _with_comments(item: Item, below: Item) -> Item:
    """An item with the comments of the item that it replaces."""
    item.leading = [*below.leading, *item.leading]
    item.trailing = item.trailing or below.trailing
    return item


def _is_mapping(item: Item) -> bool:
    return isinstance(item.value, Collection) and item.value.mapping and item.value.raw is None


def _key(item: Item) -> str:
    return item.key.text.strip("'\"") if item.key is not None else ""
