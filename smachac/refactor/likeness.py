"""Whether two texts say the same: their trees, but for what a layout may change."""

from __future__ import annotations

from smachac import schema
from smachac.lookups import look_up_word
from smachac.syntax import Map, Scalar, Seq, Tree


def same_meaning(one: Tree, other: Tree) -> bool:
    """Whether two scripts are the same but for the order and short names of the variables of
    states, the spelling of look-ups, and whether a state's variables stand under its name."""
    todo = [(one, other, "root")]
    while todo:
        left, right, role = todo.pop()
        match left, right:
            case Scalar(), Scalar():
                if not _same_scalar(left, right):
                    return False
            case Seq(), Seq() if len(left.items) != len(right.items) or _look_ups(left, right):
                if not _look_ups(left, right):
                    return False
            case Seq(), Seq():
                inner = "item" if role in ("root", "states") else role
                todo += [(*pair, inner) for pair in zip(left.items, right.items, strict=True)]
            case Map(), Map():
                pairs = _paired(left, right, role)
                if pairs is None:
                    return False
                todo += pairs
            case _:
                return False
    return True


def _same_scalar(left: Scalar, right: Scalar) -> bool:
    same_type = type(left.value) is type(right.value) and left.plain == right.plain
    return same_type and (left.value == right.value or left.value != left.value)


def _look_ups(left: Seq, right: Seq) -> bool:
    """Whether both are the same look-up."""
    one, other = look_up_word(left), look_up_word(right)
    return one is not None and other is not None and one.text == other.text


def _paired(left: Map, right: Map, role: str) -> list[tuple[Tree, Tree, str]] | None:
    """The values of two mappings by key; None where the keys differ."""
    state = role == "state" or (role == "root" and _is_script(left))
    if role == "item":
        left, right = _nested(left), _nested(right)
    keys = [[_key(entry.key, state) for entry in each.entries] for each in (left, right)]
    orders = [list(range(len(each))) for each in keys]
    if state:
        orders = [sorted(order, key=lambda at, own=own: (*own[at], at))  # type: ignore[misc]
                  for order, own in zip(orders, keys, strict=True)]  # fmt: skip
    if [keys[0][at] for at in orders[0]] != [keys[1][at] for at in orders[1]]:
        return None
    found: list[tuple[Tree, Tree, str]] = []
    for here, there in zip(*orders, strict=True):
        inner = "state" if role == "item" else "value"
        if state and keys[0][here][1] == "states":
            inner = "states"
        found.append((left.entries[here].value, right.entries[there].value, inner))
    return found


def _is_script(tree: Map) -> bool:
    return any(entry.key.value in ("states", "s") for entry in tree.entries)


def _key(key: Scalar, state: bool) -> tuple[str, str, bool]:
    """A key, in a form that can be compared and sorted."""
    text = str(key.value)
    if state and isinstance(key.value, str):
        return "str", schema.LONG.get(text, text), True
    return type(key.value).__name__, text, key.plain


def _nested(item: Map) -> Map:
    """A state item with its variables under its name."""
    if len(item.entries) < 2:
        return item
    first, *rest = item.entries
    if not isinstance(first.value, Scalar) or first.value.value is not None:
        return item
    inner = Map(tuple(rest), item.span)
    return Map((type(first)(first.key, inner),), item.span)
