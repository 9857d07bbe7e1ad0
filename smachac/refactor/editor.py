"""A script to be changed: words here and there, and states that are written anew or elsewhere."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable
from dataclasses import dataclass

from smachac.diagnostics.source import Source, Span
from smachac.refactor.cst import Atom, Group, Item, take_apart
from smachac.refactor.field_order import long_name, variables_of
from smachac.refactor.formatter import item_lines


class RefusedError(Exception):
    """Something cannot be done; the words say what is in the way, and what helps."""

    def __init__(self, span: Span, message: str, help: str | None = None) -> None:
        super().__init__(message)
        self.span = span
        self.message = message
        self.help = help


@dataclass(slots=True)
class Place:
    """A state of a script: its item, and the list that it is an item of."""

    item: Item
    states: Group


class Sheet:
    """One text, and what is to become of it. States are known by where their name begins."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.text = take_apart(source)
        self.places: dict[int, Place] = {}
        self._words: dict[tuple[int, int], str] = {}
        self._anew: dict[int, tuple[Place, list[Item]]] = {}
        self._values: dict[int, Atom] = {}
        self._owners: dict[int, Group] = {}
        self._numbers: dict[int, int] = {}
        self._sorted: list[tuple[int, int]] = []
        self._find()

    def _find(self) -> None:
        root = self.text.root
        todo = [root] if not root.mapping else _lists(root)
        while todo:
            states = todo.pop()
            for item in states.items:
                name = _name(item)
                body = variables_of(item)
                if name is not None and body is not None:
                    self.places[name.start] = Place(item, states)
                    todo += _lists(body)

    def state(self, span: Span) -> Place:
        """The state whose name stands there. Raises RefusedError where it is in brackets."""
        place = self.places.get(span.start)
        if place is None or place.states.flow or place.item.start < 0:
            help = "lay the script out first: `smachac fmt`"
            raise RefusedError(span, "this state stands in brackets, or in an unusual place", help)
        return place

    def body_of(self, span: Span) -> Group | None:
        """The variables among whose outcomes or states a name stands."""
        if not self._owners:
            root = self.text.root
            bodies = [variables_of(place.item) for place in self.places.values()]
            for body in [root, *bodies] if root.mapping else bodies:
                for name in ("outcomes", "states") if body is not None else ():
                    item = variable(body, name) if body is not None else None
                    for inner in item.value.items if item and isinstance(item.value, Group) else ():
                        atom = inner.value if isinstance(inner.value, Atom) else _name(inner)
                        if atom is not None and body is not None:
                            self._owners[atom.start] = body
        return self._owners.get(span.start)

    def value_of(self, span: Span) -> Atom:
        """The scalar behind the key that stands there. Raises RefusedError."""
        if not self._values:
            todo = [Item(None, self.text.root)]
            while todo:
                item = todo.pop()
                if isinstance(item.value, Group):
                    todo += item.value.items
                elif item.key is not None:
                    self._values[item.key.start] = item.value
        if span.start not in self._values:
            raise RefusedError(span, "what stands here comes from elsewhere", "write it out first")
        return self._values[span.start]

    def spell(self, span: Span, text: str) -> None:
        """Let another word stand there; in quotes, if the one before does."""
        written = span.text
        if written[:1] in ("'", '"') and written[:1] == written[-1:]:
            text = f"{written[0]}{text}{written[0]}"
        self._words[span.start, span.end] = text

    def write_anew(self, place: Place, items: list[Item] | None = None) -> None:
        """Write a state as its parts have become; or other states, or none, in its stead."""
        self._anew[place.item.start] = (place, [place.item] if items is None else items)

    def result(self) -> str:
        """The new text."""
        text = self.source.text
        parts: list[str] = []
        at = 0
        words = sorted(self._words.items())
        self._sorted = sorted(self._words)
        stretches = [(*self._stretch(place), place, items) for place, items in self._anew.values()]
        todo = [(start, end, new) for (start, end), new in words]
        todo += [
            (begin, end, self._printed(place, items))
            for begin, end, place, items in _outermost(stretches)
        ]
        for begin, end, new in sorted(todo, key=lambda each: (each[0], -each[1])):
            if begin >= at:  # what stands in a stretch is in its print
                parts += [text[at:begin], new]
                at = end
        return "".join(parts) + text[at:]

    def _stretch(self, place: Place) -> tuple[int, int]:
        """The lines of a state, as far as the next one or the end of the list."""
        items = place.states.items
        if id(place.item) not in self._numbers:
            self._numbers |= {id(item): number for number, item in enumerate(items)}
        number = self._numbers[id(place.item)]
        if number + 1 < len(items):
            return place.item.start, items[number + 1].start
        end = self.source.text.find("\n", place.states.end)
        return place.item.start, len(self.source.text) if end < 0 else end + 1

    def _printed(self, place: Place, items: list[Item]) -> str:
        first = place.states.items[0] is place.item
        lines: list[str] = []
        for item in items:
            self.respell(item)
            lines += item_lines(item, place.states.column, first=first and not lines)
        return "".join(f"{line}\n" for line in lines)

    def respell(self, top: Item) -> None:
        """Bring the new words into the parts that are written anew."""
        if not self._words:
            return
        todo = [top]
        while todo:
            item = todo.pop()
            for node in (item.key, item.value):
                match node:
                    case Atom(start=start, end=end) if start >= 0:
                        node.text = self._changed(start, end) or node.text
                    case Group(raw=str()):
                        node.raw = self._changed(node.start, node.end) or node.raw
                    case Group():
                        todo += node.items

    def _changed(self, start: int, end: int) -> str | None:
        """The text between two places with its new words; None if there are none."""
        if len(self._sorted) != len(self._words):
            self._sorted = sorted(self._words)
        parts: list[str] = []
        at = start
        for begin, stop in self._sorted[bisect_left(self._sorted, (start, start)) :]:
            if stop > end:
                break
            parts += [self.source.text[at:begin], self._words[begin, stop]]
            at = stop
        return "".join(parts) + self.source.text[at:end] if parts else None


def _outermost(
    stretches: list[tuple[int, int, Place, list[Item]]],
) -> Iterable[tuple[int, int, Place, list[Item]]]:
    """The stretches that stand in no other one."""
    inside = 0
    for each in sorted(stretches, key=lambda each: (each[0], -each[1])):
        if each[0] >= inside:
            inside = each[1]
            yield each


def _lists(body: Group) -> list[Group]:
    """The list of states among the variables of a state."""
    values = (item.value for item in body.items if long_name(item) == "states")
    return [value for value in values if isinstance(value, Group) and not value.mapping]


def _name(item: Item) -> Atom | None:
    state = item.value
    return (
        state.items[0].key if isinstance(state, Group) and state.mapping and state.items else None
    )


def variable(body: Group, name: str) -> Item | None:
    """A variable of a state by its long name."""
    return next((item for item in body.items if long_name(item) == name), None)


def word(text: str) -> Atom:
    """A scalar that no text holds yet."""
    return Atom(text, -1, -1)


def pairs(entries: Iterable[tuple[str, str]]) -> Group:
    """A mapping in brackets."""
    return Group(True, True, -1, items=[Item(word(key), word(value)) for key, value in entries])


def put(body: Group, name: str, key: str, value: str) -> None:
    """Add an entry to a variable that is a mapping, or the variable."""
    item = variable(body, name)
    if item is None or not isinstance(item.value, Group):
        item = Item(word(name), pairs(()))
        assert isinstance(item.value, Group)
        states = variable(body, "states")
        at = len(body.items) if states is None else body.items.index(states)
        body.items.insert(at, item)
    assert isinstance(item.value, Group)
    item.value.flat = ""
    item.value.items.append(Item(word(key), word(value)))
