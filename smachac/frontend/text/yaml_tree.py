"""The YAML parser: from a text to a tree in which every node has a span.

Events come from libyaml, the C parser in PyYAML. Scalars are resolved by the YAML 1.2 core schema:
`on` and `yes` are strings, `010` is ten. Duplicate keys stay in the tree.

Nobody changes a tree. Its nodes are not frozen dataclasses, which take two to four times as long to
make: a long script has hundreds of thousands.
"""

from __future__ import annotations

import gc
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import Piece, Source, Span, Word, new_tuple
from smachac.frontend.errors.script import duplicate_key, too_big, wrong_shape, yaml_syntax
from smachac.records import dataclass, field
from smachac.robots.core_schema import WORDS, value_of

MAX_CHARACTERS = 10_000_000
MAX_DEPTH = 900
MAX_ALIASED = 100_000
"""Limits of a script: its length, its nesting (libyaml 0.2.6 reads at most 1,000 levels), and the
nodes that its aliases add (more are allowed if the script has more characters)."""

MAX_NODES = 2_000_000
MAX_SMALL_NODES, CHARACTERS_OF_A_NODE = 250_000, 5
"""The most values, lists and mappings of a script: MAX_NODES, and no more than MAX_SMALL_NODES plus
one for each five characters. A build takes up to 440 bytes for one, so that a script takes less
than 110 MB and 90 times its text. 100,000 states have a million, of ten characters each."""

MAX_DUPLICATES = 10_000
"""The most duplicate keys, and keys without a space after the colon, that are reported."""


@dataclass(slots=True, unsafe_hash=True)
class Scalar:
    """A single value. `plain`: without quotes, so that it may be a look-up or code."""

    value: bool | int | float | str | None
    plain: bool
    piece: Piece = field(compare=False, repr=False)
    first: int = field(compare=False)
    last: int = field(compare=False)

    @property
    def span(self) -> Span:
        """The place of the value, made when it is needed: a long list has millions of values."""
        return new_tuple(Span, (self.piece, self.first, self.last))

    @property
    def source(self) -> Source:
        return self.piece.source

    @property
    def start(self) -> int:
        return self.piece.begin + self.first

    @property
    def end(self) -> int:
        return self.piece.begin + self.last


@dataclass(slots=True, unsafe_hash=True)
class Joined(Scalar):
    """The text of a string construct. `parts` are its texts, and its params with their values."""

    parts: tuple[str | Scalar, ...] = field(default=(), compare=False)


@dataclass(slots=True, unsafe_hash=True)
class Seq:
    """A list."""

    items: tuple[Tree, ...]
    span: Span = field(compare=False)


@dataclass(slots=True, unsafe_hash=True)
class Entry:
    """One key of a mapping with its value."""

    key: Scalar
    value: Tree


@dataclass(slots=True, unsafe_hash=True)
class Map:
    """A mapping in the order of the text. The first of duplicate keys counts."""

    entries: tuple[Entry, ...]
    span: Span = field(compare=False)

    def get(self, name: str) -> Entry | None:
        for entry in self.entries:
            if entry.key.value == name:
                return entry
        return None


Tree: TypeAlias = Scalar | Seq | Map


def known_wrong(span: Span) -> Scalar:
    """The scalar in place of a value that was reported, so that it is reported only once.

    No text parses to it: an empty plain scalar is None.
    """
    return Scalar("", True, *span)


def is_known_wrong(tree: Tree) -> bool:
    return isinstance(tree, Scalar) and tree.value == "" and tree.plain


class ParseAnomalies(NamedTuple):
    """The places of a text where something is probably missing or wrong, as indexes: `stops` are
    those that a syntax error names, at `places` the text is YAML with an unusual meaning because of
    a sign, at `steps` because of an indentation."""

    stops: list[int]
    places: list[int]
    steps: list[int]


class OffsetMap(NamedTuple):
    """A repaired text. `changes`: the index, the number of characters that are removed there, and
    of those written, each in the text with the changes before it."""

    text: str
    changes: tuple[tuple[int, int, int], ...]

    def back(self, index: int) -> int:
        """The index in the text as the user wrote it."""
        for at, removed, written in reversed(self.changes):
            if index >= at + written:
                index += removed - written
            elif index > at:
                index = at
        return index


def parse(
    source: Source,
    report: Report,
    anomalies: ParseAnomalies | None = None,
    offsets: OffsetMap | None = None,
) -> Tree | None:
    """The tree of a source; None if the text is empty or not YAML.

    Reported are syntax errors (SM001), duplicate keys (SM002), keys that are no scalars (SM004) and
    limits that are exceeded (SM006). With `offsets`, the tree is that of the repaired text, with
    places in the source.
    """
    if not fits_limits(source, report):
        return None
    builder = _Builder(source, source.pieces[0], report)
    if offsets is None:
        return _build(builder, events(source.text), anomalies)
    return _build(builder, _moved_back(events(offsets.text), offsets), anomalies)


def parse_piece(
    source: Source, piece: Piece, text: str, report: Report, anomalies: ParseAnomalies
) -> Tree | None:
    """The tree of a piece of a source, which has this text, with places in the piece."""
    builder = _Builder(source, piece, report)
    builder.most_levels -= 1  # the mapping around the list of states
    return _build(builder, events(text), anomalies)


def fits_limits(source: Source, report: Report) -> bool:
    """Whether a text is not too long, and has only characters of YAML; if not, that is reported."""
    if len(source.text) >= MAX_CHARACTERS:
        span = Span(source, 0, 0)
        report.append(
            too_big(
                span,
                f"the script has {len(source.text):,} characters;"
                f" the limit is {MAX_CHARACTERS - 1:,}",
                "split it into sub-scripts",
                arguments=("characters",),
            )
        )
        return False
    bad = _unprintable(source.text)
    if bad is not None:
        span = Span(source, bad.start(), bad.end())
        report.append(
            yaml_syntax(
                span,
                f"the character {bad.group()!a} is not allowed in YAML",
                "remove it, and check that the file is a text file",
                arguments=("character", f"U+{ord(bad.group()):04X}"),
            )
        )
    return bad is None


def _unprintable(text: str) -> re.Match[str] | None:
    """The first character that is not printable: YAML 1.2.2, section 5.1."""
    if text.replace("\n", "").isprintable():  # quicker; fewer characters are printable for Python
        return None
    # Compiled here, because that takes 5 ms, and few texts have such characters.
    unprintable = "[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"
    return re.search(unprintable, text)


def events(text: str) -> Iterator[Any]:
    """The events of a text. Raises yaml.MarkedYAMLError."""
    from yaml._yaml import CParser

    return iter(CParser(text).get_event, None)


_CORE = "tag:yaml.org,2002:"

_SCALAR_TAGS: Mapping[str, type] = {
    "int": int, "float": float, "bool": bool, "null": type(None)
}  # fmt: skip
"""The tags of scalars in the core schema of YAML 1.2, beside text, with their types."""

_WITHOUT_END = (
    "while parsing a flow",
    "while scanning a simple key",
    "while scanning a quoted scalar",
)
"""What the parser was reading where the line of its beginning has the error."""


def syntax_error_line(text: str) -> int | None:
    """The line, counted from 0, of the first syntax error; None if the text is YAML.

    It is the line of the part that has no end, if the parser names it, else that at which the
    parser stops, else the last one.
    """
    from yaml import MarkedYAMLError

    last = text.count("\n")
    bad = _unprintable(text)
    if bad is not None:
        return text.count("\n", 0, bad.start())
    try:
        for _ in events(text):
            pass
    except MarkedYAMLError as error:
        named = (error.context or "").startswith(_WITHOUT_END)
        mark = error.context_mark if named else error.problem_mark
        return last if mark is None else min(int(mark.line), last)
    return None


@dataclass(slots=True)
class _Mark:
    """A place in the text as the user wrote it."""

    index: int


def _moved_back(events: Iterator[Any], offsets: OffsetMap) -> Iterator[Any]:
    """The events of a repaired text with the places of the text before."""
    for event in events:
        event.start_mark = _Mark(offsets.back(event.start_mark.index))
        event.end_mark = _Mark(offsets.back(event.end_mark.index))
        yield event


def _build(
    builder: _Builder, found: Iterable[Any], anomalies: ParseAnomalies | None
) -> Tree | None:
    """The tree of the events of a text."""
    from yaml import MarkedYAMLError

    source, report = builder.source, builder.report
    collecting = gc.isenabled()
    gc.disable()  # or it runs many times over the growing tree
    try:
        builder.drive(found)
    except MarkedYAMLError as error:
        from smachac.frontend.text.yaml_errors import stopped_at, syntax_error, too_deep_at

        builder.items = []
        deep = too_deep_at(error)
        if deep is not None:
            report.append(_too_deep(source, deep))
        else:
            report.append(syntax_error(source, error))
            if anomalies is not None:
                anomalies.stops.extend(stopped_at(source.text, error))
    except _BeyondLimitError:
        builder.items = []
    finally:
        if collecting:
            gc.enable()
    if anomalies is not None:
        anomalies.places.extend(builder.anomalous)
        anomalies.steps.extend(builder.misplaced)
    return next(iter(builder.items), None)


def _too_deep(source: Source, at: int) -> Diagnostic:
    message = f"the nesting is deeper than {MAX_DEPTH:,} levels"
    help = "split the script into sub-scripts"
    return too_big(Span(source, at, at + 1), message, help, arguments=("depth",))


MOST_NAMES_SHOWN = 6
"""The most names of a key that a help shows."""


def _jinja_look_up(items: list[Tree], span: Span, report: Report) -> Seq | None:
    """The look-up that is meant by `{{ name }}` or `{{ params.name }}`, a mapping in a mapping,
    which is reported."""
    if len(items) != 2 or not isinstance(items[0], Map) or items[1].span.text:
        return None
    entries = items[0].entries
    if len(entries) != 1 or entries[0].value.span.text:
        return None
    key = entries[0].key
    name = str(key.value).removeprefix("params.")
    if not key.plain or not name.isidentifier():
        return None
    word = Scalar(name, True, *Span(key.source, key.end - len(name), key.end))
    message, written = "`{{ }}` is for templates, not for scripts", word.span.text
    help = f"a param is looked up with `[params, {written}]`"
    report.append(wrong_shape(span, message, help, arguments=("braces", written)))
    return Seq((Scalar("params", True, *span), word), span)


_Open: TypeAlias = tuple[list[Tree], int, bool, int, str | None]
"""A collection that is being built: the items of the collection around it, the number of nodes
before it, whether it is in brackets or braces, its start and its anchor. A plain tuple, because
there is one for each list and mapping."""


def _identity(key: Scalar) -> str | tuple[type, object]:
    """What duplicate keys have in common. 1, 1.0 and true differ, though Python equates them."""
    value = key.value
    return value if isinstance(value, str) else (type(value), value)


class _BeyondLimitError(Exception):
    """A limit is exceeded and reported; parsing ends."""


_LAST_SIGNS = frozenset("]}\"'")
_TWO_WORDS = re.compile(r"[\w.-]+ [\w.-]+")
_NO_KEY = re.compile(r"[\[{= \"']")
"""A character that no usual key has."""


def _is_torn(text: str) -> bool:
    """Whether the bracket or quote at the end of a text without quotes has no counterpart in it. A
    text with spaces can end with an apostrophe, a number with the sign of inches."""
    last, before = text[-1], text[-2:-1]
    if last in "]}":
        opening = "[" if last == "]" else "{"
        return text.count(opening) < text.count(last) and (before.isalnum() or before in "_)]}\"'")
    return text.count(last) % 2 == 1 and " " not in text and not before.isdigit()


def _is_empty(tree: Tree) -> bool:
    return isinstance(tree, Scalar) and tree.value is None


class _Builder:
    """Builds one tree from events, with a stack in place of recursion."""

    def __init__(self, source: Source, piece: Piece, report: Report) -> None:
        self.source = source
        self.piece = piece
        self.report = report
        self.most_levels = MAX_DEPTH
        self.stack: list[_Open] = []
        self.items: list[Tree] = []
        self.anchors: dict[str, tuple[Tree, int]] = {}
        self.anomalous: list[int] = []
        self.misplaced: list[int] = []
        self.aliased = 0
        self.most = min(MAX_NODES, MAX_SMALL_NODES + len(source.text) // CHARACTERS_OF_A_NODE)

    def drive(self, events: Iterable[Any]) -> None:
        """Builds the tree, in one loop: a long script has hundreds of thousands of events."""
        from yaml import events as kinds

        scalar, alias = kinds.ScalarEvent, kinds.AliasEvent
        mapping_start, mapping_end = kinds.MappingStartEvent, kinds.MappingEndEvent
        list_start, list_end = kinds.SequenceStartEvent, kinds.SequenceEndEvent
        piece, stack, most = self.piece, self.stack, self.most
        items = self.items
        known: dict[str, str] = {}  # most texts are there many times: fields, templates, outcomes
        nodes = last = 0  # the number of nodes, and the end of the last one
        for event in events:
            kind = event.__class__
            if kind is scalar:
                text: str = event.value
                text = known.setdefault(text, text)
                start, end = event.start_mark.index, event.end_mark.index
                plain = not event.style
                value: bool | int | float | str | None = text
                if event.tag is not None:
                    value = self._tagged(event)
                elif plain and (not text.isidentifier() or text in WORDS):  # most are names
                    value = value_of(text)
                    if " " in text or text[-1:] in _LAST_SIGNS:
                        self._note_anomaly(text, start)
                if start == end and plain:  # positions of nothing differ between parsers
                    start = end = last
                last = end
                node: Tree = Scalar(value, plain, piece, start, end)
                nodes += 1
                items.append(node)
                if nodes > most:
                    self._too_many(start)
                if event.anchor is not None:
                    self._check_anchor(event)
                    self.anchors[event.anchor] = (node, 1)
            elif kind is mapping_end or kind is list_end:
                inside = items
                items, before, flow, start, anchor = stack.pop()
                if flow:
                    last = event.end_mark.index
                span = new_tuple(Span, (piece, start, last))
                if kind is list_end:
                    node = Seq(tuple(inside), span)
                else:
                    node = self._mapping(inside, span, flow)
                items.append(node)
                if anchor is not None:
                    self.anchors[anchor] = (node, nodes - before)
            elif kind is mapping_start or kind is list_start:
                start, last = event.start_mark.index, event.end_mark.index
                self._check_opening(event)
                stack.append((items, nodes, event.flow_style, start, event.anchor))
                items = []
                nodes += 1
                if nodes > most:
                    self._too_many(start)
            elif kind is alias:
                last = event.end_mark.index
                node, size = self._recovered(event)
                items.append(node)
                nodes += size
                if nodes > most:
                    self._too_many(event.start_mark.index)
            elif items and kind is kinds.DocumentStartEvent:
                self._refuse_second(event)
                items = []  # what the rest of the text defines would be reported as missing
                break
        self.items = items

    def _refuse_second(self, event: Any) -> None:
        """Reports a second document."""
        span = Span(self.source, event.start_mark.index, event.end_mark.index)
        message = "a second YAML document begins here"
        help = "remove the `---`: a script is one document"
        self.report.append(wrong_shape(span, message, help, arguments=("document",)))

    def _note_anomaly(self, text: str, start: int) -> None:
        """Notes a text without quotes that is probably two, or a part of one: `done READY`."""
        if text[-1] in _LAST_SIGNS:
            if _is_torn(text):
                self.anomalous.append(start)
        elif " = " in text or (self._is_flow() and _TWO_WORDS.fullmatch(text) is not None):
            self.anomalous.append(start)

    def _check_anchor(self, event: Any) -> None:
        """Reports an anchor of which libyaml reads a part as the value, `&left:home 0.5`."""
        from smachac.frontend.text.yaml_errors import anchor_fault

        fault = anchor_fault(self.source, event.start_mark.index)
        if fault is not None:
            self.report.append(fault)
            raise _BeyondLimitError

    def _is_flow(self) -> bool:
        """Whether the innermost open collection is in brackets or braces."""
        return bool(self.stack) and self.stack[-1][2]

    def _tagged(self, event: Any) -> bool | int | float | str | None:
        """The value of a scalar with a tag of the core schema of YAML 1.2; another tag, or one that
        the text does not fit, is reported."""
        text: str = event.value
        tag = str(event.tag).removeprefix(_CORE)
        if tag in ("str", "!"):
            return text
        value = value_of(text)
        if tag == "float" and type(value) is int:
            return float(value)
        if tag not in _SCALAR_TAGS:
            self._unknown_tag(event)
        elif type(value) is not _SCALAR_TAGS[tag]:
            span = Span(self.source, event.start_mark.index, event.end_mark.index)
            message = f"`{text}` is not a value of the type `!!{tag}`"
            help = "correct the value, or write it without a tag"
            self.report.append(wrong_shape(span, message, help, arguments=("tag", tag, text)))
        return value

    def _check_tag(self, event: Any) -> None:
        """Reports a tag of a list or a mapping that is not its own."""
        from yaml import events as kinds

        own = "map" if type(event) is kinds.MappingStartEvent else "seq"
        if str(event.tag) not in (f"{_CORE}{own}", "!"):
            self._unknown_tag(event)

    def _unknown_tag(self, event: Any) -> None:
        span = Span(self.source, event.start_mark.index, event.end_mark.index)
        self.report.append(
            wrong_shape(
                span,
                "only the YAML tags `!!str`, `!!int`, `!!float`, `!!bool`, `!!null`, `!!seq` and"
                " `!!map` are supported",
                "write the value without a tag",
                arguments=("tag", str(event.tag)),
            )
        )

    def _check_opening(self, event: Any) -> None:
        """Reports what is wrong with the tag, the depth or the anchor of a list or a mapping."""
        if event.tag is not None:
            self._check_tag(event)
        if len(self.stack) >= self.most_levels:
            self.report.append(_too_deep(self.source, event.start_mark.index))
            raise _BeyondLimitError
        if event.anchor is not None:
            self._check_anchor(event)

    def _mapping(self, items: list[Tree], span: Span, flow: bool) -> Seq | Map:
        """The mapping of keys and values in turn; a look-up in the form of Jinja is a list."""
        if flow and items and items[0].__class__ is Map:
            look_up = _jinja_look_up(items, span, self.report)
            if look_up is not None:
                return look_up
        return Map(self._entries(items, flow), span)

    def _recovered(self, event: Any) -> tuple[Tree, int]:
        """The node with the anchor of an alias, and the number of nodes in it."""
        self._check_anchor(event)
        span = Span(self.source, event.start_mark.index, event.end_mark.index)
        known = self.anchors.get(event.anchor)
        if known is None:
            name = event.anchor
            message = f"the alias `*{name}` has no anchor"
            help = f"put the anchor `&{name}` before this alias"
            self.report.append(yaml_syntax(span, message, help, arguments=("alias", name)))
            raise _BeyondLimitError
        node, size = known
        self.aliased += size
        limit = max(MAX_ALIASED, len(self.source.text))
        if self.aliased > limit:
            message = f"the aliases of this script add more than {limit:,} values"
            self._stop(
                span.start, message, "use fewer aliases, or aliases of shorter lists", "aliases"
            )
        return node, size

    def _too_many(self, at: int) -> None:
        self._stop(
            at,
            f"the script has more than {self.most:,} values",
            "put large data into a file that a state reads when the program runs",
            "nodes",
        )

    def _stop(self, at: int, message: str, help: str, limit: str) -> None:
        span = Span(self.source, at, at + 1)
        self.report.append(too_big(span, message, help, arguments=(limit,)))
        raise _BeyondLimitError

    def _entries(self, items: list[Tree], flow: bool) -> tuple[Entry, ...]:
        entries: list[Entry] = []
        merged: list[Entry] = []
        first: dict[str | tuple[type, object], Scalar] = {}
        pairs = iter(items)
        for key, value in zip(pairs, pairs, strict=True):
            if not isinstance(key, Scalar):
                entries += self._wrong_key(key, value)
                continue
            text = key.value
            if not isinstance(text, str) or not text.isidentifier():  # few keys
                if text == "<<" and key.plain:
                    merged.extend(self._merge(value))
                    continue
                if key.plain and isinstance(text, str) and _NO_KEY.search(text) is not None:
                    self.anomalous.append(key.start)
            if flow and isinstance(value, Scalar) and value.value is None:
                if entries and value.start == value.end and not _is_empty(entries[-1].value):
                    self.anomalous.append(key.start)
                key, value = self._separated(key, value)
                text = key.value
            known = first.setdefault(text if isinstance(text, str) else _identity(key), key)
            if known is not key:
                self.report.append(duplicate_key(Word(str(key.value), key.span), known.span))
                if len(self.report) > MAX_DUPLICATES:
                    message = f"more than {MAX_DUPLICATES:,} keys are duplicates"
                    self._stop(key.span.start, message, "use each key once", "duplicates")
            entries.append(Entry(key, value))
        if not flow and (len(entries) > 1 or "states" in first):
            self._note_steps(entries, first)
        for entry in merged:
            if _identity(entry.key) not in first:
                first[_identity(entry.key)] = entry.key
                entries.append(entry)
        return tuple(entries)

    def _note_steps(
        self, entries: list[Entry], names: dict[str | tuple[type, object], Scalar]
    ) -> None:
        """Notes a mapping on lines of its own that has keys of a state beside its name, or states
        without a template."""
        if "states" in names:
            if "template" not in names and "name" not in names and "T" not in names:
                self.misplaced.append(names["states"].start)
            elif "it" in names:
                self._note_iterator(entries)
        elif entries[0].value.__class__ is Map:
            start = entries[0].key.start
            if self.source.text[start - 2 : start] == "- ":
                self.misplaced.append(entries[1].key.start)

    def _note_iterator(self, entries: list[Entry]) -> None:
        """Notes the second state of an Iterator, which has one."""
        states = next(entry.value for entry in entries if entry.key.value == "states")
        if isinstance(states, Seq) and len(states.items) > 1:
            self.misplaced.append(states.items[1].span.start)

    def _wrong_key(self, key: Tree, value: Tree) -> Iterator[Entry]:
        """SM004 for a key that is a list or a mapping; the entries that a list of names stands
        for, each with the value."""
        names = key.items if isinstance(key, Seq) else ()
        meant = [name for name in names if isinstance(name, Scalar) and isinstance(name.value, str)]
        help = "write a name before the colon"
        if meant and len(meant) == len(names) <= MOST_NAMES_SHOWN:
            text = value.span.text if isinstance(value, Scalar) and value.span.text else "..."
            rows = ", ".join(f"{name.span.text}: {text}" for name in meant)
            help = f"write an entry for each name: `{rows}`"
        message = "a key must be a name, not a list or a mapping"
        self.report.append(wrong_shape(key.span, message, help, arguments=("key",)))
        for name in meant:
            yield Entry(name, value)

    def _separated(self, key: Scalar, value: Scalar) -> tuple[Scalar, Scalar]:
        """The key and the value that are meant by `{key:value}`, which YAML reads as a key without
        a value."""
        text = key.value
        if value.start != value.end or not key.plain or not isinstance(text, str):
            return key, value
        from smachac.frontend.text.yaml_errors import JOINED, SPACE_MISSING, spaced

        if JOINED.fullmatch(text) is None or key.end - key.start != len(text):
            return key, value
        colon = key.start + text.index(":")
        if len(self.report) < MAX_DUPLICATES:
            edits = (Edit(span=Span(self.source, colon + 1, colon + 1), text=" "),)
            wrong = wrong_shape(
                key.span, SPACE_MISSING, spaced(text), arguments=("space", text), edits=edits
            )
            self.report.append(wrong)
        name, _, rest = text.partition(":")
        return (
            Scalar(value_of(name), True, *Span(self.source, key.start, colon)),
            Scalar(value_of(rest), True, *Span(self.source, colon + 1, key.end)),
        )

    def _merge(self, value: Tree) -> Iterator[Entry]:
        """The entries that `<<` adds: those of a mapping, or of each mapping in a list."""
        for item in value.items if isinstance(value, Seq) else (value,):
            if isinstance(item, Map):
                yield from item.entries
            else:
                message = "the value of `<<` must be a mapping"
                help = "write the alias of a mapping: `<<: *defaults`"
                self.report.append(wrong_shape(item.span, message, help, arguments=("merge",)))
