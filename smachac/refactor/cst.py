"""Concrete syntax tree of a YAML text: values as written, comments, blank lines, anchors.

The tree of frontend/text/yaml_tree.py has the meaning of a text only. Here everything is kept, and
each comment belongs to an item: `leading` above it, `trailing` behind it, `tail` below the last
item.
"""

from __future__ import annotations

import re
from itertools import accumulate
from typing import Any, TypeAlias

from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import events
from smachac.records import dataclass, field

_COMMENT = re.compile(r"(?:^|(?<=\s))#.*")
_BLOCK = re.compile(r"(?:[&!]\S*\s+)*[|>]")
_MARKS = re.compile(r"[|>](?P<marks>[-+0-9]*)")
_PROPERTIES = re.compile(r"(?:[&!][^\s\[\]{},]*\s*)+")
_DASH = re.compile(r"-(?=\s)")


class UnsupportedYamlError(Exception):
    """A text without a syntax tree here: it has YAML directives, or is no collection."""


@dataclass(slots=True)
class Atom:
    """A scalar or an alias with its anchor and tag, as written.

    `column` is the indentation of the collection around it; the indentation of a block scalar is
    relative to it.
    """

    text: str
    start: int
    end: int
    column: int = 0

    @property
    def is_block(self) -> bool:
        return _BLOCK.match(self.text) is not None


@dataclass(slots=True)
class Item:
    """An entry of a mapping, or an item of a list, which has no key.

    `leading` holds the lines above, comments or empty; `trailing` the comment behind, with its
    spaces. `start` is the offset of its first line or of the first line above it, -1 if it does not
    begin a line.
    """

    key: Atom | None
    value: Node
    leading: list[str] = field(default_factory=list)
    trailing: str = ""
    start: int = -1


@dataclass(slots=True)
class Collection:
    """A mapping or a list.

    `raw`: a flow collection with comments in it, kept as written. `properties`: anchor and tag.
    `tail`: the comments below the last item.
    """

    mapping: bool
    flow: bool
    start: int
    properties: str = ""
    end: int = 0
    column: int = 0
    items: list[Item] = field(default_factory=list)
    tail: list[str] = field(default_factory=list)
    raw: str | None = None
    is_state: bool = False
    flat: str = ""
    """The collection on one line, computed by formatter.py; `is_state` is computed by
    field_order.py."""


Node: TypeAlias = Atom | Collection


@dataclass(slots=True)
class Document:
    """A whole text: the comments above everything, and the collection."""

    head: list[str]
    root: Collection
    comments: tuple[str, ...]


def parse_cst(source: Source) -> Document:
    """The syntax tree of a text. Raises UnsupportedYamlError, also for a text that is no YAML, but
    that the checks read as repaired (frontend/text/yaml_recovery.py)."""
    if source.text.startswith("%"):
        raise UnsupportedYamlError("it begins with a YAML directive")
    from yaml import YAMLError

    try:
        return _CstBuilder(source).read()
    except YAMLError as error:
        raise UnsupportedYamlError("it is no valid YAML") from error


class _CstBuilder:
    """Builds the tree from the YAML events and the text between them."""

    def __init__(self, source: Source) -> None:
        self.source = source
        self.text = source.text
        self.stack: list[Collection] = []
        self.root: Collection | None = None
        self.end = 0
        self.here: Item | None = None
        self.opening: Item | None = None
        self.closed: list[Collection] = []
        self.key: Atom | None = None
        self.head: list[str] = []
        self.comments: list[str] = []

    def read(self) -> Document:
        for event in events(self.text):
            match type(event).__name__:
                case "ScalarEvent" | "AliasEvent":
                    self.atom(event)
                case "MappingStartEvent" | "SequenceStartEvent":
                    self.begin(event)
                case "MappingEndEvent" | "SequenceEndEvent":
                    self.finish(event)
        if self.root is None:
            raise UnsupportedYamlError("it is a single value")
        self.opening = None
        self.closed = self.closed or [self.root]
        self.gap(len(self.text), last=True)
        first = self.root.items[0] if self.root.items and self.root.mapping else None
        head = first.leading if first is not None else self.head
        if first is not None:
            first.leading = []
        return Document(head=head, root=self.root, comments=tuple(self.comments))

    def column(self, at: int) -> int:
        return self.source.position(at)[1] - 1

    def atom(self, event: Any) -> None:
        start, end = event.start_mark.index, event.end_mark.index
        around = self.stack[-1] if self.stack else None
        if around is None:
            raise UnsupportedYamlError("it is a single value")
        if start == end:
            start = end = self.end
        atom = Atom(self.text[start:end], start, end)
        is_key = around.mapping and self.key is None
        if not is_key:
            atom.column = around.column
            self.put(atom)
        elif not around.items:
            around.column = around.column if around.flow else self.column(start)
        if atom.is_block and not around.flow:
            self.end_of_block(atom)
        if is_key:
            self.key = atom
            item = Item(atom, atom)
            around.items.append(item)
            self.opening = self.opening or item
        self.gap(start)
        self.here = around.items[-1]
        self.end = atom.end
        flow = around.flow and "\n" in atom.text
        if flow and (atom.text[0] in "'\"" or "\n\n" in atom.text.replace(" ", "")):
            self.keep_as_written()
        elif flow:
            atom.text = " ".join(atom.text.split())

    def end_of_block(self, atom: Atom) -> None:
        """Find the end of a block scalar: YAML parsers differ on the lines behind it."""
        at = self.text.find("\n", atom.start)
        at = len(self.text) if at < 0 else at
        marks = _MARKS.search(self.text, atom.start, at)
        assert marks is not None
        digits = re.sub(r"\D", "", marks["marks"])
        least = atom.column + int(digits) if digits else 0
        end = at
        while at < len(self.text):
            stop = self.text.find("\n", at + 1)
            stop = len(self.text) if stop < 0 else stop
            line = self.text[at + 1 : stop]
            margin = len(line) - len(line.lstrip(" "))
            if line.strip(" "):
                least = least or max(margin, atom.column + 1)
                if margin < least:
                    break
                end = stop
            elif "+" in marks["marks"]:
                end = stop
            at = stop
        atom.end = end
        atom.text = self.text[atom.start : end]

    def put(self, node: Node) -> None:
        """Add a value to the current key, or as a new item to the current list."""
        if not self.stack:
            assert isinstance(node, Collection)
            self.root = node
            return
        around = self.stack[-1]
        if around.mapping:
            if self.key is None:
                raise UnsupportedYamlError("one of its keys is a collection")
            around.items[-1].value = node
            self.key = None
            return
        item = Item(None, node)
        around.items.append(item)
        self.opening = self.opening or item

    def begin(self, event: Any) -> None:
        start = event.start_mark.index
        group = Collection(
            type(event).__name__.startswith("Mapping"), bool(event.flow_style), start
        )
        group.column = self.column(start)
        inside = start
        if event.anchor is not None or event.tag is not None:
            found = _PROPERTIES.match(self.text, start)
            assert found is not None
            group.properties = " ".join(found[0].split())
            inside = found.end()
            if not group.flow:
                group.column = self.stack[-1].column + 1 if self.stack else 0
        self.put(group)
        if group.flow:
            self.gap(start)
            self.end = inside + 1
        elif group.properties and self.stack and not self.stack[-1].mapping:
            self.gap(start)
            self.here = self.stack[-1].items[-1]
            self.end = inside
        self.stack.append(group)
        self.key = None

    def finish(self, event: Any) -> None:
        group = self.stack[-1]
        if group.flow:
            self.gap(event.start_mark.index)
            self.end = max(self.end, event.end_mark.index)
        self.stack.pop()
        group.end = self.end
        if group.flow and group.raw is not None:
            group.raw = self.text[group.start : group.end]
        if not group.flow:
            self.closed.append(group)
        if group.flow and self.stack:
            self.here = self.stack[-1].items[-1]
        self.key = None

    def keep_as_written(self) -> None:
        """Mark the outermost open flow collection as raw."""
        next(group for group in self.stack if group.flow).raw = ""

    def gap(self, to: int, *, last: bool = False) -> None:
        """Attach the comments and blank lines between the last value and an offset to their
        items."""
        text = self.text[self.end : to]
        opening, closed = self.opening, self.closed
        self.opening, self.closed = None, []
        if opening is not None:
            opening.start = self.source.line_starts[self.source.position(to)[0] - 1]
        if "#" not in text and text.count("\n") < 2:
            return
        lines = text.split("\n")
        inside = bool(self.stack) and self.stack[-1].flow
        found = [(line, _COMMENT.search(line)) for line in lines]
        self.comments += [comment[0].rstrip() for _, comment in found if comment]
        if inside:
            if any(comment for _, comment in found):
                self.keep_as_written()
            return
        if self.here is not None:
            line, comment = found.pop(0)
            if comment is not None:
                self.put_aside(line, comment, opening)
        target = opening.leading if opening else self.here.leading if self.here else self.head
        blanks = target if opening or self.here is None else []
        own = -1 if last else self.margin_of(opening, to)
        floating = True
        begin = 0
        ends = list(accumulate((len(line) + 1 for line in lines), initial=self.end))[-len(found) :]
        for number, (line, comment) in enumerate(found):
            if comment is None and (line.strip() or number == len(found) - 1):
                floating = floating and not _DASH.match(line.strip() + " ")
                continue
            deep = comment.start() if comment else own
            floating = floating and (comment is None or deep > own)
            group = _holder(closed, deep) if floating else None
            words = comment[0].rstrip() if comment else ""
            if group is not None and comment is not None:
                group.tail += [*_blanks(blanks), words]
                begin = 0
                for collection in closed[closed.index(group) :]:
                    collection.end = ends[number] - 1
            else:
                (target if words else blanks).append(words)
                begin = begin or ends[number] - len(line) - 1
        if opening is not None and begin:
            opening.start = begin

    def margin_of(self, opening: Item | None, to: int) -> int:
        """The column of the item that begins at an offset."""
        if opening is None or opening.key is not None:
            return self.column(to)
        start = self.source.line_starts[self.source.position(to)[0] - 1]
        dash = _DASH.search(self.text, start, to)
        return dash.start() - start if dash else self.column(to)

    def put_aside(self, line: str, comment: re.Match[str], opening: Item | None) -> None:
        """Attach a comment at the end of a line."""
        assert self.here is not None
        spaces = max(2, comment.start() - len(line[: comment.start()].rstrip()))
        if self.here.trailing:
            (opening or self.here).leading.append(comment[0].rstrip())
        else:
            self.here.trailing = " " * spaces + comment[0].rstrip()


def _holder(closed: list[Collection], column: int) -> Collection | None:
    """The innermost of the collections ended before a comment that can contain it."""
    fits = (group for group in closed if group.column <= column)
    return next(fits, closed[-1] if closed else None)


def _blanks(lines: list[str]) -> list[str]:
    """Remove the empty lines at the end of `lines`; at most one of them."""
    taken = []
    while lines and not lines[-1]:
        taken.append(lines.pop())
    return taken[:1]
