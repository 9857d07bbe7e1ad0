"""The place of a word in a script: the states around it, and the field in which it stands."""

from __future__ import annotations

from collections.abc import Mapping

from smachac.frontend import schema
from smachac.frontend.schema import CONTAINERS, FieldOwner
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree
from smachac.records import dataclass


@dataclass(frozen=True, kw_only=True)
class Body:
    """A state of the text, or the script itself: its name and its fields by long name."""

    name: Scalar | None
    fields: Mapping[str, Entry]
    start: int
    end: int

    @property
    def template(self) -> str:
        """The template as written; that of a script is `Base` if it has none."""
        return self.text("template") or ("" if self.name is not None else "Base")

    @property
    def owner(self) -> FieldOwner:
        """The owner of its fields in the schema, as far as the text shows it."""
        if self.name is None:
            return "base"
        kind = CONTAINERS.get(self.template)
        return kind or ("StateMachine" if "states" in self.fields else "state")

    def text(self, name: str) -> str:
        """The text of a field that is a single value."""
        entry = self.fields.get(name)
        value = entry.value if entry is not None else None
        return str(value.value) if isinstance(value, Scalar) and value.value is not None else ""

    def names(self, name: str) -> list[str]:
        """The names in a field that is a list, or a mapping with names as keys."""
        entry = self.fields.get(name)
        return names_in(entry.value) if entry is not None else []

    def pairs(self, name: str) -> dict[str, str]:
        """The names in a field that maps names to names."""
        entry = self.fields.get(name)
        if entry is None or not isinstance(entry.value, Map):
            return {}
        return {
            str(item.key.value): str(item.value.value)
            for item in entry.value.entries
            if isinstance(item.value, Scalar) and item.value.value is not None
        }

    @property
    def states(self) -> list[Body]:
        """The states in it."""
        entry = self.fields.get("states")
        items = entry.value.items if entry is not None and isinstance(entry.value, Seq) else ()
        return [body for item in items if (body := state_body(item)) is not None]


@dataclass(frozen=True, kw_only=True)
class Place:
    """A word and what is around it.

    `bodies`: the script and the states around the word, outermost first; the last one has it.
    `field`: the long name of its field, empty for a name of a field or state. `inner`: the keys
    from the field down to the word, its own key included if it is a value. `role`: what it is.
    """

    word: Scalar
    bodies: tuple[Body, ...]
    role: str
    field: str = ""
    inner: tuple[str, ...] = ()
    siblings: tuple[str, ...] = ()

    @property
    def body(self) -> Body:
        return self.bodies[-1]

    @property
    def around(self) -> Body | None:
        """The container of the state that has the word."""
        return self.bodies[-2] if len(self.bodies) > 1 else None

    @property
    def path(self) -> tuple[str, ...]:
        """The names of the states around it; the script itself has none."""
        return tuple(str(body.name.value) for body in self.bodies if body.name is not None)


FIELD, STATE, KEY, VALUE, ITEM = "field", "state", "key", "value", "item"
"""The roles of words: the name of a field, the name of a state; inside a field a key of a mapping,
a value, an item of a list."""


def names_in(tree: Tree) -> list[str]:
    """The names that a list or a mapping has."""
    match tree:
        case Seq(items=items):
            return [str(item.value) for item in items if isinstance(item, Scalar)]
        case Map(entries=entries):
            return [str(entry.key.value) for entry in entries]
    return []


def long_names(entries: tuple[Entry, ...]) -> dict[str, Entry]:
    """Fields by long name; the first of equal ones counts."""
    found: dict[str, Entry] = {}
    for entry in entries:
        word = str(entry.key.value)
        found.setdefault(schema.LONG.get(word, word), entry)
    return found


def state_body(item: Tree) -> Body | None:
    """The state of an item of a list of states; None if it has no name."""
    if not isinstance(item, Map) or not item.entries:
        return None
    first, rest = item.entries[0], item.entries[1:]
    inside = first.value
    entries = inside.entries if isinstance(inside, Map) else rest
    end = _end(item)
    return Body(name=first.key, fields=long_names(entries), start=first.key.start, end=end)


def _end(tree: Tree) -> int:
    """The offset behind the last word of a tree."""
    while not isinstance(tree, Scalar):
        below = tree.entries if isinstance(tree, Map) else tree.items
        if not below:
            return tree.span.end
        closed = tree.span.source.text[tree.span.end - 1 : tree.span.end]
        if closed in ("]", "}"):
            return tree.span.end
        last = below[-1]
        tree = last.value if isinstance(last, Entry) else last
    return tree.end


def top_bodies(tree: Tree | None) -> list[Body]:
    """The script, or the state of a sub-script."""
    if isinstance(tree, Map):
        fields = long_names(tree.entries)
        return [Body(name=None, fields=fields, start=tree.span.start, end=_end(tree))]
    if isinstance(tree, Seq):
        return [body for item in tree.items if (body := state_body(item)) is not None]
    return []


def place_at(tree: Tree | None, offset: int) -> Place | None:
    """The place of the word at an offset; None if there is no word."""
    bodies = [body for body in top_bodies(tree) if body.start <= offset]
    return _in_body(bodies[-1], (), offset) if bodies else None


def _in_body(body: Body, around: tuple[Body, ...], offset: int) -> Place | None:
    bodies = (*around, body)
    present = tuple(body.fields)
    if body.name is not None and _has(body.name, offset):
        return Place(word=body.name, bodies=bodies, role=STATE)
    for name, entry in reversed([*body.fields.items()]):
        if offset < entry.key.start:
            continue
        if _has(entry.key, offset):
            return Place(word=entry.key, bodies=bodies, role=FIELD, siblings=present)
        if name != "states" or not isinstance(entry.value, Seq):
            return _in_value(entry.value, Place(word=entry.key, bodies=bodies, role=VALUE,
                                                field=name), offset)  # fmt: skip
        for item in reversed(entry.value.items):
            inner = state_body(item)
            if inner is not None and inner.start <= offset:
                return _in_body(inner, bodies, offset)
            if isinstance(item, Scalar) and _has(item, offset):
                return Place(word=item, bodies=bodies, role=STATE)
        return None
    return None


def _in_value(tree: Tree, place: Place, offset: int) -> Place | None:
    """The place of a word in the value of a field; `place` is that of the value."""

    def at(word: Scalar, role: str, *keys: str, siblings: tuple[str, ...] = ()) -> Place:
        inner = (*place.inner, *keys)
        return Place(word=word, bodies=place.bodies, role=role, field=place.field, inner=inner,
                     siblings=siblings)  # fmt: skip

    match tree:
        case Scalar():
            return at(tree, place.role) if _has(tree, offset) else None
        case Seq(items=items):
            known = tuple(names_in(tree))
            for item in items:
                inside = at(place.word, ITEM)
                found = _in_value(item, inside, offset)
                if found is not None:
                    return found if found.siblings else at_siblings(found, known)
        case Map(entries=entries):
            known = tuple(str(entry.key.value) for entry in entries)
            for entry in entries:
                if _has(entry.key, offset):
                    return at(entry.key, KEY, siblings=known)
                found = _in_value(entry.value, at(place.word, VALUE, str(entry.key.value)), offset)
                if found is not None:
                    return found
    return None


def at_siblings(place: Place, siblings: tuple[str, ...]) -> Place:
    """The same place with the words beside it."""
    return Place(word=place.word, bodies=place.bodies, role=place.role, field=place.field,
                 inner=place.inner, siblings=siblings)  # fmt: skip


def _has(word: Scalar, offset: int) -> bool:
    return word.start <= offset <= word.end
