"""Script editor: words are replaced in place, states are rewritten, moved or removed."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterable

from smachac.diagnostics.source import Source, Span
from smachac.records import dataclass
from smachac.refactor.cst import Atom, Collection, Item, parse_cst
from smachac.refactor.field_order import long_name, variables_of
from smachac.refactor.formatter import item_lines


class RefusedError(Exception):
    """A refactoring is refused; message and help have the reason and what to do."""

    def __init__(self, span: Span, message: str, help: str | None = None) -> None:
        super().__init__(message)
        self.span = span
        self.message = message
        self.help = help


@dataclass(slots=True)
class StateItem:
    """A state of a script: its item in the syntax tree, and the list that contains it."""

    item: Item
    states: Collection


class ScriptEditor:
    """One text and its pending changes. States are identified by the offset of their name."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.text = parse_cst(source)
        self.places: dict[int, StateItem] = {}
        self._words: dict[tuple[int, int], str] = {}
        self._rewritten: dict[int, tuple[StateItem, list[Item]]] = {}
        self._values: dict[int, Atom] = {}
        self._owners: dict[int, Collection] = {}
        self._numbers: dict[int, int] = {}
        self._sorted: list[tuple[int, int]] = []
        self._find()

    def _find(self) -> None:
        """Find all states of the script."""
        root = self.text.root
        todo = [root] if not root.mapping else _lists(root)
        while todo:
            states = todo.pop()
            for item in states.items:
                name = _name(item)
                body = variables_of(item)
                if name is not None and body is not None:
                    self.places[name.start] = StateItem(item, states)
                    todo += _lists(body)

    def state(self, span: Span) -> StateItem:
        """The state whose name is at a span. Raises RefusedError if it is in a flow collection."""
        place = self.places.get(span.start)
        if place is None or place.states.flow or place.item.start < 0:
            help = "format the script first: `smachac fmt`"
            raise RefusedError(span, "this state is in brackets, or in an unusual position", help)
        return place

    def body_of(self, span: Span) -> Collection | None:
        """The fields of the state that lists the outcome or state at a span."""
        if not self._owners:
            root = self.text.root
            bodies = [variables_of(place.item) for place in self.places.values()]
            for body in [root, *bodies] if root.mapping else bodies:
                for name in ("outcomes", "states") if body is not None else ():
                    item = variable(body, name) if body is not None else None
                    for inner in (
                        item.value.items if item and isinstance(item.value, Collection) else ()
                    ):
                        atom = inner.value if isinstance(inner.value, Atom) else _name(inner)
                        if atom is not None and body is not None:
                            self._owners[atom.start] = body
        return self._owners.get(span.start)

    def value_of(self, span: Span) -> Atom:
        """The scalar value of the key at a span. Raises RefusedError."""
        if not self._values:
            todo = [Item(None, self.text.root)]
            while todo:
                item = todo.pop()
                if isinstance(item.value, Collection):
                    todo += item.value.items
                elif item.key is not None:
                    self._values[item.key.start] = item.value
        if span.start not in self._values:
            raise RefusedError(span, "this value is defined in another place", "write it out first")
        return self._values[span.start]

    def replace_word(self, span: Span, text: str) -> None:
        """Replace the word at a span; quotes are kept."""
        written = span.text
        if written[:1] in ("'", '"') and written[:1] == written[-1:]:
            text = f"{written[0]}{text}{written[0]}"
        self._words[span.start, span.end] = text

    def replace(self, start: int, end: int, text: str) -> None:
        """Replace a range of the text."""
        self._words[start, end] = text

    def insert(self, at: int, text: str) -> None:
        """Insert a text at an offset, behind what was inserted there before."""
        self._words[at, at] = self._words.get((at, at), "") + text

    def insert_lines(self, at: int, lines: Iterable[str]) -> None:
        """Insert lines at the beginning of a line, or at the end of the text."""
        text = "".join(f"{line}\n" for line in lines)
        ended = at == 0 or self.source.text[at - 1] == "\n"
        self.insert(at, text if ended else f"\n{text}")

    def end_of(self, place: StateItem) -> int:
        """The offset behind a state: that of the next one, or behind the end of the list."""
        return self._stretch(place)[1]

    @property
    def replaced(self) -> list[Span]:
        """The words that are replaced, in the order of the text."""
        return [Span(self.source, start, end) for start, end in sorted(self._words)]

    def rewrite_state(self, place: StateItem, items: list[Item] | None = None) -> None:
        """Print a state from its changed syntax tree, or replace it with other states or none."""
        self._rewritten[place.item.start] = (place, [place.item] if items is None else items)

    def result(self) -> str:
        """The new text."""
        text = self.source.text
        parts: list[str] = []
        at = 0
        words = sorted(self._words.items())
        self._sorted = sorted(self._words)
        stretches = [
            (*self._stretch(place), place, items) for place, items in self._rewritten.values()
        ]
        todo = [(start, end, new) for (start, end), new in words]
        todo += [
            (begin, end, self._printed(place, items))
            for begin, end, place, items in _outermost(stretches)
        ]
        for begin, end, new in sorted(todo, key=lambda row: (row[0], -row[1])):
            if begin >= at:  # what stands in a stretch is in its print
                parts += [text[at:begin], new]
                at = end
        return "".join(parts) + text[at:]

    def _stretch(self, place: StateItem) -> tuple[int, int]:
        """The range of a state: to the next state or the end of the list."""
        items = place.states.items
        if id(place.item) not in self._numbers:
            self._numbers |= {id(item): number for number, item in enumerate(items)}
        number = self._numbers[id(place.item)]
        if number + 1 < len(items):
            return place.item.start, items[number + 1].start
        end = self.source.text.find("\n", place.states.end)
        return place.item.start, len(self.source.text) if end < 0 else end + 1

    def _printed(self, place: StateItem, items: list[Item]) -> str:
        first = place.states.items[0] is place.item
        lines: list[str] = []
        for item in items:
            self.apply_words(item)
            lines += item_lines(item, place.states.column, first=first and not lines)
        return "".join(f"{line}\n" for line in lines)

    def apply_words(self, top: Item) -> None:
        """Apply the replaced words to a part of the syntax tree that is printed anew."""
        if not self._words:
            return
        todo = [top]
        while todo:
            item = todo.pop()
            for node in (item.key, item.value):
                match node:
                    case Atom(start=start, end=end) if start >= 0:
                        node.text = self._changed(start, end) or node.text
                    case Collection(raw=str()):
                        node.raw = self._changed(node.start, node.end) or node.raw
                    case Collection():
                        todo += node.items

    def _changed(self, start: int, end: int) -> str | None:
        """The text of a range with its replaced words; None if it has none."""
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
    stretches: list[tuple[int, int, StateItem, list[Item]]],
) -> Iterable[tuple[int, int, StateItem, list[Item]]]:
    """The ranges that are not inside another one."""
    inside = 0
    for stretch in sorted(stretches, key=lambda row: (row[0], -row[1])):
        if stretch[0] >= inside:
            inside = stretch[1]
            yield stretch


def _lists(body: Collection) -> list[Collection]:
    """The list of states among the fields of a state."""
    values = (item.value for item in body.items if long_name(item) == "states")
    return [value for value in values if isinstance(value, Collection) and not value.mapping]


def _name(item: Item) -> Atom | None:
    """The name of a state item."""
    state = item.value
    return (
        state.items[0].key
        if isinstance(state, Collection) and state.mapping and state.items
        else None
    )


def variable(body: Collection, name: str) -> Item | None:
    """A field of a state by its long name."""
    return next((item for item in body.items if long_name(item) == name), None)


def new_atom(text: str) -> Atom:
    """A scalar that is not in the text yet."""
    return Atom(text, -1, -1)


def flow_mapping(entries: Iterable[tuple[str, str]]) -> Collection:
    """A mapping in braces."""
    return Collection(
        True, True, -1, items=[Item(new_atom(key), new_atom(value)) for key, value in entries]
    )


def add_entry(body: Collection, name: str, key: str, value: str) -> None:
    """Add an entry to a field that is a mapping; add the field if it is missing."""
    item = variable(body, name)
    if item is None or not isinstance(item.value, Collection):
        item = Item(new_atom(name), flow_mapping(()))
        assert isinstance(item.value, Collection)
        states = variable(body, "states")
        at = len(body.items) if states is None else body.items.index(states)
        body.items.insert(at, item)
    assert isinstance(item.value, Collection)
    item.value.flat = ""
    item.value.items.append(Item(new_atom(key), new_atom(value)))
