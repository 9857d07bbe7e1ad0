"""What a script's variables are called, and in which order they stand: as the examples write them.

Works on the parts of a text (concrete.py), for it is about how a script is written alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from smachac.frontend import schema
from smachac.refactor.cst import Atom, Group, Item

Spelling = Literal["kept", "short", "long"]
"""Of the variables' names and of look-ups."""

FIRST = (
    *("<<", "name", "script", "template", "doc", "node_name", "function_name", "manifest"),
    *("types", "outcomes", "input_keys", "output_keys", "params"),
)
"""What a state begins with; outcomes and keys are in the order of SMACH's own signature. What is
neither here nor below stands between, as it is written: it belongs to the state type."""

LAST = (
    *("userdata", "remapping", "claims", "timeout", "retry", "for_each", "forever"),
    *("transitions", "on_error", "initial", "states"),
)
"""What a state ends with: first its keys, then where it leads, then what is in it."""

_RANKS = {name: number for number, name in enumerate(FIRST)}
_RANKS |= {name: len(FIRST) + 1 + number for number, name in enumerate(LAST)}
_SHORT = {long: short for short, long in schema.LONG.items()}


def put_in_order(root: Group, spelling: Spelling, *, ordered: bool = True) -> None:
    """Give every state of a script the order and the spelling, and the layout with one key.

    A mapping that has no states is no script: it stays as it is.
    """
    todo: list[Group] = []
    if not root.mapping:
        todo += _states(root)
    elif any(long_name(item) == "states" for item in root.items):
        todo.append(root)
    while todo:
        state = todo.pop()
        state.is_state = True
        for item in state.items:
            name = long_name(item)
            if name == "states" and isinstance(item.value, Group):
                todo += _states(item.value)
            _spell(item, name, spelling)
        if ordered:
            sort_variables(state)


def sort_variables(state: Group) -> None:
    """Put the variables of one state in order."""
    state.items.sort(key=lambda item: _RANKS.get(long_name(item), len(FIRST)))


def long_name(item: Item) -> str:
    text = item.key.text if item.key is not None else ""
    if text[:1] in ("'", '"') and text[:1] == text[-1:]:
        text = text[1:-1]
    return schema.LONG.get(text, text)


def _states(states: Group) -> Iterator[Group]:
    """The variables of each state of a list; those beside its name are put under it."""
    for item in states.items if not states.mapping else ():
        body = variables_of(item)
        if body is not None:
            yield body


def variables_of(item: Item) -> Group | None:
    """The variables of a state item, put under its name if they stand beside it."""
    state = item.value
    if not isinstance(state, Group) or not state.mapping or not state.items:
        return None
    first, rest = state.items[0], state.items[1:]
    if rest and isinstance(first.value, Atom) and first.value.text in ("", "~", "null"):
        column = rest[0].key.column if rest[0].key is not None else state.column
        inner = Group(True, state.flow, state.start, column=column, items=rest)
        inner.end = state.end
        inner.tail, state.tail = state.tail, []
        first.value, state.items = inner, [first]
    body = first.value
    return body if isinstance(body, Group) and body.mapping else None


def _spell(item: Item, name: str, spelling: Spelling) -> None:
    if spelling == "kept" or item.key is None:
        return
    if name in schema.VARIABLES:
        item.key.text = name if spelling == "long" else _SHORT.get(name, item.key.text)
    if name not in ("states", "types"):
        _spell_look_ups(item, spelling)


def _spell_look_ups(top: Item, spelling: Spelling) -> None:
    """`[params, x]` and `[[x]]` are the same wherever they stand in a value."""
    todo = [top]
    while todo:
        item = todo.pop()
        group = item.value
        if not isinstance(group, Group):
            continue
        match [inner.value for inner in group.items if inner.key is None and group.raw is None]:
            case [Atom(text="params"), Atom() as word] if group.flow and _is_plain(word):
                if spelling == "short":
                    inner = Group(False, True, group.start, items=[Item(None, word)])
                    group.items = [Item(None, inner)]
            case [Group(mapping=False, properties="", items=[Item(value=Atom() as word)])] if (
                group.flow and _is_plain(word)
            ):
                if spelling == "long":
                    params = Atom("params", word.start, word.end)
                    group.items = [Item(None, params), Item(None, word)]
            case _:
                todo += group.items


def _is_plain(atom: Atom) -> bool:
    return atom.text[:1] not in ("'", '"', "&", "*", "!", "")
