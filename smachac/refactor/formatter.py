"""The one layout of a script: `smachac fmt`.

Mappings are indented by two, lists under their key by two; collections in brackets stay so, on one
line where that has room; variables stand in the order of order.py. Scalars, comments and anchors
stay as they are written, and what was block or flow stays so. That the new text says the same is
proven before it is handed out: the trees are equal but for the order of variables.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from smachac.diagnostics.source import Source
from smachac.frontend import schema
from smachac.frontend.params import look_up_word
from smachac.frontend.yaml_tree import Map, Scalar, Seq, Tree, parse
from smachac.ir.recursion import deep_recursion
from smachac.refactor.cst import Atom, Group, Item, Text, UnusualError, take_apart
from smachac.refactor.field_order import Spelling, put_in_order

WIDTH = 100
"""The length of a line that collections in brackets are broken at, in characters."""


def laid_out(source: Source, spelling: Spelling = "kept") -> str | None:
    """A script in its layout, or None where it cannot be laid out without a change of meaning.

    The text has to be one that `parse` makes a tree of. Ends of lines are kept: CRLF where the
    first line ends so. Laid out twice is laid out once.
    """
    crlf = "\r\n" in source.text[: source.text.find("\n") + 1]
    plain = Source(source.name, source.text.replace("\r\n", "\n").replace("\r", "\n"))
    with deep_recursion():
        for ordered in (True, False):  # an alias must not come to stand before its anchor
            found = _laid_out(plain, spelling, ordered)
            if found is not None:
                return found.replace("\n", "\r\n") if crlf else found
    return None


def _laid_out(source: Source, spelling: Spelling, ordered: bool) -> str | None:
    before = parse(source, [])
    if before is None:
        return None
    try:
        text = take_apart(source)
    except UnusualError:
        return None
    made = Source(source.name, _printed(text, spelling, ordered))
    after = parse(made, [])
    if after is None or not same_meaning(before, after):
        return None
    try:
        again = take_apart(made)
    except UnusualError:
        return None
    if Counter(again.comments) != Counter(text.comments):
        return None
    # A comment beside an empty item has no place that is found again.
    return made.text if _printed(again, spelling, ordered) == made.text else None


def _printed(text: Text, spelling: Spelling, ordered: bool) -> str:
    put_in_order(text.root, spelling, ordered=ordered)
    printer = _Printer()
    printer.lines += printer.trivia(text.head, "", first=True)
    printer.root(text.root)
    return "\n".join(printer.lines).rstrip("\n") + "\n"


def item_lines(item: Item, column: int, *, first: bool) -> list[str]:
    """The lines of one item of a list whose dashes stand in a column."""
    printer = _Printer()
    margin = " " * column
    printer.lines += printer.trivia(item.lead, margin, first=first)
    printer.item(item, f"{margin}- ", column)
    return printer.lines


def list_text(item: Item, tail: list[str]) -> str:
    """A text that is a list with one item."""
    return "".join(f"{line}\n" for line in [*item_lines(item, 0, first=True), *tail])


class _Printer:
    """Prints parts as lines."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    @staticmethod
    def trivia(lines: list[str], margin: str, *, first: bool = False) -> Iterator[str]:
        """Comments at a margin, with at most one empty line in a row, none where a block begins."""
        blank = first
        for line in lines:
            if line or not blank:
                yield f"{margin}{line}" if line else ""
            blank = not line

    def root(self, group: Group) -> None:
        if group.properties and not group.flow:
            self.lines.append(group.properties)
        if group.flow and group.is_state and group.raw is None:
            _to_block(group)
        if group.flow:
            self.lines += [*self.flow_lines(group, "", "  "), *group.tail]
            return
        self.block(group, 0)

    def block(self, group: Group, indent: int, prefix: str | None = None) -> None:
        """A block collection; `prefix` is what its first line begins with, after a dash."""
        margin = " " * indent
        for number, item in enumerate(group.items):
            begin = prefix if prefix is not None and number == 0 else margin
            above = begin[: len(begin) - len(begin.lstrip(" "))]
            self.lines += self.trivia(item.lead, above, first=number == 0)
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
        if isinstance(value, Group) and value.flow and _wants_block(value, head):
            _to_block(value)
        if isinstance(value, Group) and not value.flow:
            words = f" {value.properties}" if value.properties else ""
            self.lines.append(f"{head}{words}{item.aside}")
            self.block(value, indent + 2)
            return
        self.value(item, head, indent)

    def item(self, item: Item, begin: str, indent: int) -> None:
        value = item.value
        if isinstance(value, Group) and not value.flow:
            if value.properties or item.aside:
                self.lines.append(f"{begin}{value.properties}".rstrip() + item.aside)
                self.block(value, indent + 2)
            else:
                self.block(value, indent + 2, begin)
            return
        self.value(item, begin.rstrip(" "), indent)

    def value(self, item: Item, head: str, indent: int) -> None:
        """A scalar or flow collection behind its key or dash."""
        value = item.value
        if isinstance(value, Group):
            margin = " " * (indent + 2)
            lines = list(self.flow_lines(value, f"{head} ", margin, item.aside))
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
        lines[-1] += item.aside
        self.lines += lines

    def flow_lines(self, group: Group, head: str, margin: str, aside: str = "") -> Iterator[str]:
        """A collection in brackets: on one line or, where that is too long, item by item."""
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


def _flat(group: Group) -> str:
    """A flow collection on one line."""
    if not group.flat:
        opening, closing = ("{", "}") if group.mapping else ("[", "]")
        words = f"{group.properties} " if group.properties else ""
        inside = ", ".join(map(_flat_item, group.items))
        group.flat = f"{words}{opening}{inside}{closing}"
    return group.flat


def _flat_item(item: Item) -> str:
    value = _flat(item.value) if isinstance(item.value, Group) else item.value.text
    if item.key is None:
        return value
    colon = " :" if item.key.text.startswith("*") else ":"
    return f"{item.key.text}{colon} {value}"


def _wants_block(group: Group, head: str) -> bool:
    """Whether a flow mapping is a state that has no room on its line, or holds states."""
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


def _to_block(group: Group) -> None:
    """Write a state, and the states in it, in lines instead of brackets."""
    group.flow = not group.items
    for item in group.items:
        if _is_states(item) and isinstance(item.value, Group) and item.value.items:
            item.value.flow = False
            for state in item.value.items:
                if isinstance(state.value, Group) and state.value.items:
                    state.value.flow = False


def _block_lines(atom: Atom, indent: int) -> Iterator[str]:
    """A block scalar with its lines two columns further in than its key or dash."""
    first, *lines = atom.text.split("\n")
    yield first.rstrip()
    digits = next((char for char in first.split("#")[0] if char.isdigit()), "")
    full = [len(line) - len(line.lstrip(" ")) for line in lines if line.strip(" ")]
    least = atom.column + int(digits) if digits else full[0] if full else 0
    margin = " " * (indent + int(digits or 2))
    for line in lines:
        yield margin + line[least:] if line[least:] else ""


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
