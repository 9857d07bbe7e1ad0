"""Containers that become sub-scripts, and sub-scripts that become containers again."""

from __future__ import annotations

from smachac.diagnostics.source import Span
from smachac.refactor.cst import Group, Item
from smachac.refactor.editor import RefusedError, Sheet, variable, word
from smachac.refactor.field_order import long_name, sort_variables, variables_of
from smachac.refactor.formatter import list_text

AT_THE_CALL = ("params", "userdata", "remapping", "transitions")
"""What stays with the call of a sub-script, as SMACHA had it: other calls may have others."""


def extract(sheet: Sheet, span: Span, script: str) -> str:
    """Make a call of the container whose name stands at `span`; the text of the sub-script that it
    calls. Raises RefusedError."""
    place = sheet.state(span)
    body = variables_of(place.item)
    assert body is not None
    if variable(body, "script") is not None:
        help = "`smachac inline` puts it in the place of its call"
        raise RefusedError(span, f"`{span.text}` is a sub-script already", help)
    if variable(body, "states") is None:
        help = "put it into a container first: `smachac contain`"
        raise RefusedError(span, f"`{span.text}` is no container", help)
    state = place.item.value
    assert isinstance(state, Group)
    entry = state.items[0]
    kept = [item for item in body.items if long_name(item) in AT_THE_CALL]
    moved = [item for item in body.items if long_name(item) not in AT_THE_CALL]
    inner = Group(True, False, -1, items=moved, tail=body.tail, is_state=True)
    named = Group(True, False, -1, items=[Item(entry.key, inner)], tail=state.tail)
    sheet.respell(Item(None, named))
    text = list_text(Item(None, named), [])
    call = [Item(word("script"), word(script)), *kept]
    entry.value = Group(True, body.flow, -1, body.properties, items=call, is_state=True)
    state.tail = []
    sheet.write_anew(place)
    return text


def inline(sheet: Sheet, span: Span, sub: Sheet) -> None:
    """Put what a sub-script holds in the place of its call. Raises RefusedError."""
    place = sheet.state(span)
    call = variables_of(place.item)
    found = sub.text.root
    first = found.items[0] if found.items and not found.mapping else None
    inner = variables_of(first) if first is not None else None
    assert call is not None
    if first is None or inner is None:
        raise RefusedError(span, "its sub-script stands in an unusual form")
    state, below = place.item.value, first.value
    assert isinstance(state, Group)
    assert isinstance(below, Group)
    entry = state.items[0]
    script = variable(call, "script")
    above = [*script.lead, script.aside.strip()] if script is not None else []
    named = below.items[0]
    above += [*first.lead, *named.lead, named.aside.strip() if entry.aside else ""]
    entry.aside = entry.aside or named.aside
    place.item.lead += [line for line in above if line]
    own = [item for item in call.items if item is not script]
    body = Group(True, False, -1, call.properties or inner.properties, is_state=True)
    body.items = _merged(inner.items, own)
    body.tail = [*inner.tail, *below.tail, *found.tail, *call.tail]
    sort_variables(body)
    entry.value = body
    sheet.write_anew(place)


def _merged(below: list[Item], own: list[Item]) -> list[Item]:
    """Variables of a sub-script under those of its call, as calls.py has it."""
    over = {long_name(item): item for item in own}
    merged = []
    for item in below:
        above = over.pop(long_name(item), None)
        if above is None:
            merged.append(item)
            continue
        merged.append(_with_comments(above, item))
        if _is_mapping(item) and _is_mapping(above):
            assert isinstance(item.value, Group)
            assert isinstance(above.value, Group)
            entries = {_key(each): each for each in above.value.items}
            mine = [
                _with_comments(entries.pop(_key(each)), each) if _key(each) in entries else each
                for each in item.value.items
            ]
            flow = item.value.flow and above.value.flow
            whole = Group(True, flow, -1, items=[*mine, *entries.values()])
            whole.tail = [*item.value.tail, *above.value.tail]
            above.value = whole
    return [*merged, *over.values()]


def _with_comments(item: Item, below: Item) -> Item:
    """An item with the comments of the one that it replaces."""
    item.lead = [*below.lead, *item.lead]
    item.aside = item.aside or below.aside
    return item


def _is_mapping(item: Item) -> bool:
    return isinstance(item.value, Group) and item.value.mapping and item.value.raw is None


def _key(item: Item) -> str:
    return item.key.text.strip("'\"") if item.key is not None else ""
