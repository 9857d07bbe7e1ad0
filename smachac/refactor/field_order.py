"""Order and spelling of the fields of states, as in the examples.

Works on syntax trees (cst.py), because only the form of a script changes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from smachac.frontend import schema
from smachac.refactor.cst import Atom, Collection, Item

Spelling = Literal["kept", "short", "long"]
"""The spelling of field names and look-ups."""

FIRST = (
    *("<<", "name", "script", "template", "doc", "node_name", "function_name", "manifest"),
    *("types", "outcomes", "input_keys", "output_keys", "params", "properties"),
)
"""The first fields of a state; outcomes and keys are in the order of SMACH's constructor. Fields in
neither list belong to the state type; they stay in their order, between the two."""

LAST = (
    *("userdata", "remapping", "claims", "tags", "timeout", "retry", "for_each", "forever"),
    *("transitions", "on_error", "initial", "states"),
)
"""The last fields of a state: its keys, its transitions, its children."""

_RANKS = {name: number for number, name in enumerate(FIRST)}
_RANKS |= {name: len(FIRST) + 1 + number for number, name in enumerate(LAST)}
_SHORT = {long: short for short, long in schema.LONG.items()}


def order_fields(root: Collection, spelling: Spelling, *, ordered: bool = True) -> None:
    """Order and spell the fields of every state of a script, and move fields beside a state's name
    under it.

    A mapping without states is no script; it is not changed.
    """
    todo: list[Collection] = []
    if not root.mapping:
        todo += _states(root)
    elif any(long_name(item) == "states" for item in root.items):
        todo.append(root)
    while todo:
        state = todo.pop()
        state.is_state = True
        for item in state.items:
            name = long_name(item)
            if name == "states" and isinstance(item.value, Collection):
                todo += _states(item.value)
            _spell(item, name, spelling)
        if ordered:
            sort_variables(state)


def sort_variables(state: Collection) -> None:
    """Sort the fields of one state."""
    state.items.sort(key=lambda item: _RANKS.get(long_name(item), len(FIRST)))


def long_name(item: Item) -> str:
    """The long name of the field of an item."""
    text = item.key.text if item.key is not None else ""
    if text[:1] in ("'", '"') and text[:1] == text[-1:]:
        text = text[1:-1]
    return schema.LONG.get(text, text)


def _states(states: Collection) -> Iterator[Collection]:
    """The fields of each state of a list."""
    for item in states.items if not states.mapping else ():
        body = variables_of(item)
        if body is not None:
            yield body


def variables_of(item: Item) -> Collection | None:
    """The fields of a state item; if they are beside its name they are moved under it."""
    state = item.value
    if not isinstance(state, Collection) or not state.mapping or not state.items:
        return None
    first, rest = state.items[0], state.items[1:]
    if rest and isinstance(first.value, Atom) and first.value.text in ("", "~", "null"):
        column = rest[0].key.column if rest[0].key is not None else state.column
        inner = Collection(True, state.flow, state.start, column=column, items=rest)
        inner.end = state.end
        inner.tail, state.tail = state.tail, []
        first.value, state.items = inner, [first]
    body = first.value
    return body if isinstance(body, Collection) and body.mapping else None


def _spell(item: Item, name: str, spelling: Spelling) -> None:
    """Spell a field name and its look-ups."""
    if spelling == "kept" or item.key is None:
        return
    if name in schema.VARIABLES:
        item.key.text = name if spelling == "long" else _SHORT.get(name, item.key.text)
    if name not in ("states", "types"):
        _spell_look_ups(item, spelling)


def _spell_look_ups(top: Item, spelling: Spelling) -> None:
    """Spell look-ups: `[params, x]` and `[[x]]` are equal everywhere in a value."""
    todo = [top]
    while todo:
        item = todo.pop()
        group = item.value
        if not isinstance(group, Collection):
            continue
        match [inner.value for inner in group.items if inner.key is None and group.raw is None]:
            case [Atom(text="params"), Atom() as word] if group.flow and _is_plain(word):
                if spelling == "short":
                    inner = Collection(False, True, group.start, items=[Item(None, word)])
                    group.items = [Item(None, inner)]
            case [Collection(mapping=False, properties="", items=[Item(value=Atom() as word)])] if (
                group.flow and _is_plain(word)
            ):
                if spelling == "long":
                    params = Atom("params", word.start, word.end)
                    group.items = [Item(None, params), Item(None, word)]
            case _:
                todo += group.items


def _is_plain(atom: Atom) -> bool:
    return atom.text[:1] not in ("'", '"', "&", "*", "!", "")
