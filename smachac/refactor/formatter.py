"""Script formatter: the layout of `smachac fmt`.

Mappings and lists are indented by two; flow collections stay on one line if there is room; the
fields of a state are ordered (field_order.py). Scalars, comments and anchors are kept as written,
and block or flow style is kept. The result is checked before it is returned: both syntax trees are
equal except for the order of fields.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from smachac.diagnostics.source import Source
from smachac.frontend import schema
from smachac.frontend.files import with_line_feeds
from smachac.frontend.script.params import look_up_word
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse
from smachac.ir.recursion import deep_recursion
from smachac.refactor.cst import Atom, Collection, Document, Item, UnsupportedYamlError, parse_cst
from smachac.refactor.field_order import Spelling, order_fields
from smachac.refactor.line_ends import with_line_ends

WIDTH = 100
"""The line length, in characters, at which flow collections are broken."""


def format_script(source: Source, spelling: Spelling = "kept") -> str | None:
    """A script in the standard layout; None if the layout would change its meaning.

    The text must be one that `parse` accepts. Each line keeps its line end. Formatting is
    idempotent.
    """
    plain = Source(source.name, with_line_feeds(source.text))
    with deep_recursion():
        for ordered in (True, False):  # an alias must not come to stand before its anchor
            found = _format_script(plain, spelling, ordered)
            if found is not None:
                return with_line_ends(found, source.text)
    return None


def _format_script(source: Source, spelling: Spelling, ordered: bool) -> str | None:
    before = parse(source, [])
    if before is None:
        return None
    try:
        text = parse_cst(source)
    except UnsupportedYamlError:
        return None
    made = Source(source.name, _printed(text, spelling, ordered))
    after = parse(made, [])
    if after is None or not same_meaning(before, after):
        return None
    try:
        again = parse_cst(made)
    except UnsupportedYamlError:
        return None
    if Counter(again.comments) != Counter(text.comments):
        return None
    # A comment beside an empty item has no place that is found again.
    return made.text if _printed(again, spelling, ordered) == made.text else None


def _printed(text: Document, spelling: Spelling, ordered: bool) -> str:
    order_fields(text.root, spelling, ordered=ordered)
    printer = _Printer()
    printer.lines += printer.trivia(text.head, "", first=True)
    printer.root(text.root)
    return "\n".join(printer.lines).rstrip("\n") + "\n"


def item_lines(item: Item, column: int, *, first: bool) -> list[str]:
    """The lines of a list item whose dash is at a column."""
    printer = _Printer()
    margin = " " * column
    printer.lines += printer.trivia(item.leading, margin, first=first)
    printer.item(item, f"{margin}- ", column)
    return printer.lines


def list_text(item: Item, tail: list[str]) -> str:
    """A text that consists of a list with one item."""
    return "".join(f"{line}\n" for line in [*item_lines(item, 0, first=True), *tail])


class _Printer:
    """Prints syntax trees as lines."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    @staticmethod
    def trivia(lines: list[str], margin: str, *, first: bool = False) -> Iterator[str]:
        """Comments with an indentation; consecutive empty lines become one, none at the start of a
        block."""
        blank = first
        for line in lines:
            if line or not blank:
                yield f"{margin}{line}" if line else ""
            blank = not line

    def root(self, group: Collection) -> None:
        if group.properties and not group.flow:
            self.lines.append(group.properties)
        if group.flow and group.is_state and group.raw is None:
            _to_block(group)
        if group.flow:
            self.lines += [*self.flow_lines(group, "", "  "), *group.tail]
            return
        self.block(group, 0)

    def block(self, group: Collection, indent: int, prefix: str | None = None) -> None:
        """A block collection. `prefix` begins the first line, after a dash."""
        margin = " " * indent
        for number, item in enumerate(group.items):
            begin = prefix if prefix is not None and number == 0 else margin
            above = begin[: len(begin) - len(begin.lstrip(" "))]
            self.lines += self.trivia(item.leading, above, first=number == 0)
            if group.mapping:
                self.entry(item, begin, indent)
            else:
                self.item(item, begin + "- ", indent)
        self.lines += self.trivia(group.tail, margin)

    def entry(self, item: Item, begin: str, indent: int) -> None:
        assert item.key is not None
        colon = " :" if item.key.text.startswith("*") else ":"
        head = f"{begin}{item.key.text}{colon}"
        value = item.value
        if isinstance(value, Collection) and value.flow and _wants_block(value, head):
            _to_block(value)
        if isinstance(value, Collection) and not value.flow:
            words = f" {value.properties}" if value.properties else ""
            self.lines.append(f"{head}{words}{item.trailing}")
            self.block(value, indent + 2)
            return
        self.value(item, head, indent)

    def item(self, item: Item, begin: str, indent: int) -> None:
        value = item.value
        if isinstance(value, Collection) and not value.flow:
            if value.properties or item.trailing:
                self.lines.append(f"{begin}{value.properties}".rstrip() + item.trailing)
                self.block(value, indent + 2)
            else:
                self.block(value, indent + 2, begin)
            return
        self.value(item, begin.rstrip(" "), indent)

    def value(self, item: Item, head: str, indent: int) -> None:
        """A scalar or flow collection behind its key or dash."""
        value = item.value
        if isinstance(value, Collection):
            margin = " " * (indent + 2)
            lines = list(self.flow_lines(value, f"{head} ", margin, item.trailing))
        elif not value.text:
            lines = [head]
        elif value.is_block:
            lines = [f"{head} {line}" if not number else line
                     for number, line in enumerate(_block_lines(value, indent))]  # fmt: skip
        else:
            first, *others = value.text.split("\n")
            margin = " " * (indent + 2)
            lines = [f"{head} {first}"]
            lines += [f"{margin}{line.lstrip()}" if line.strip() else "" for line in others]
        lines[-1] += item.trailing
        self.lines += lines

    def flow_lines(
        self, group: Collection, head: str, margin: str, aside: str = ""
    ) -> Iterator[str]:
        """A flow collection: on one line or, if that is too long, broken between items."""
        if group.raw is not None:
            first, *others = group.raw.split("\n")
            yield f"{head}{first.rstrip()}" if others else f"{head}{first}"
            least = min((len(line) - len(line.lstrip()) for line in others if line.strip()),
                        default=0)  # fmt: skip
            yield from (f"{margin}{line[least:]}".rstrip() if line.strip() else ""
                        for line in others)  # fmt: skip
            return
        flat = _flat(group)
        if len(head) + len(flat) <= WIDTH or "smachac:" in aside or len(group.items) < 2:
            yield f"{head}{flat}"
            return
        opening, closing = ("{", "}") if group.mapping else ("[", "]")
        words = f"{group.properties} " if group.properties else ""
        line = f"{head}{words}{opening}"
        for number, item in enumerate(group.items):
            end = closing if number == len(group.items) - 1 else ","
            text = _flat_item(item) + end
            if number and len(line) + len(text) + 1 > WIDTH:
                yield line
                line = margin + text
            else:
                line += f" {text}" if number else text
        yield line


def _flat(group: Collection) -> str:
    """A flow collection on one line."""
    if not group.flat:
        opening, closing = ("{", "}") if group.mapping else ("[", "]")
        words = f"{group.properties} " if group.properties else ""
        inside = ", ".join(map(_flat_item, group.items))
        group.flat = f"{words}{opening}{inside}{closing}"
    return group.flat


def _flat_item(item: Item) -> str:
    value = _flat(item.value) if isinstance(item.value, Collection) else item.value.text
    if item.key is None:
        return value
    colon = " :" if item.key.text.startswith("*") else ":"
    return f"{item.key.text}{colon} {value}"


def _wants_block(group: Collection, head: str) -> bool:
    """Whether a flow mapping is a state that is too long for its line, or contains states."""
    return (
        group.is_state
        and group.raw is None
        and (
            len(head) + 1 + len(_flat(group)) > WIDTH
            or any(_is_states(item) for item in group.items)
        )
    )


def _is_states(item: Item) -> bool:
    return item.key is not None and item.key.text in ("states", "s")


def _to_block(group: Collection) -> None:
    """Change a state, and the states in it, from flow to block style."""
    group.flow = not group.items
    for item in group.items:
        if _is_states(item) and isinstance(item.value, Collection) and item.value.items:
            item.value.flow = False
            for state in item.value.items:
                if isinstance(state.value, Collection) and state.value.items:
                    state.value.flow = False


def _block_lines(atom: Atom, indent: int) -> Iterator[str]:
    """The lines of a block scalar, indented by two relative to its key or dash."""
    first, *lines = atom.text.split("\n")
    yield first.rstrip()
    digits = next((char for char in first.split("#")[0] if char.isdigit()), "")
    full = [len(line) - len(line.lstrip(" ")) for line in lines if line.strip(" ")]
    least = atom.column + int(digits) if digits else full[0] if full else 0
    margin = " " * (indent + int(digits or 2))
    for line in lines:
        yield margin + line[least:] if line[least:] else ""


def same_meaning(one: Tree, other: Tree) -> bool:
    """Whether two scripts are equal except for the order and spelling of fields, the spelling of
    look-ups, and fields beside or under the name of a state."""
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
    """The values of two mappings by key; None if the keys differ."""
    state = role == "state" or (role == "root" and _is_script(left))
    if role == "item":
        left, right = _nested(left), _nested(right)
    keys = [[_key(entry.key, state) for entry in map_.entries] for map_ in (left, right)]
    orders = [list(range(len(key))) for key in keys]
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
    """A key in a form that can be compared and sorted."""
    text = str(key.value)
    if state and isinstance(key.value, str):
        return "str", schema.LONG.get(text, text), True
    return type(key.value).__name__, text, key.plain


def _nested(item: Map) -> Map:
    """A state item with its fields under its name."""
    if len(item.entries) < 2:
        return item
    first, *rest = item.entries
    if not isinstance(first.value, Scalar) or first.value.value is not None:
        return item
    inner = Map(tuple(rest), item.span)
    return Map((type(first)(first.key, inner),), item.span)
