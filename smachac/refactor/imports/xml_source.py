"""XML files with machines: elements with their places, and what a reader makes of them."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from html import unescape
from typing import TypeAlias

from smachac.diagnostics.source import Source, Span
from smachac.ir.nodes import Data, Leaf, Outcome, Remap, StateMachine, Struct, Transition
from smachac.pysource.machines.constructions import Argument, Construction, Names
from smachac.records import dataclass, field
from smachac.refactor.imports.scripts import Lost
from smachac.robots.xml_tree import Element

Edges: TypeAlias = Mapping[str, tuple[str, Span, Span]]
"""Transitions by outcome: the target, and the places of the outcome and the target."""


Loader: TypeAlias = "Callable[[str, str], tuple[Source, Element] | None]"
"""Returns another file, by the name of the file that includes it and its own; None without one."""


@dataclass(slots=True, kw_only=True)
class XmlMachine:
    """A machine that was read: how its states are made and the values of its userdata, by the path
    of names, and what was not taken over. `one_rule`: see Constructions."""

    root: StateMachine
    one_rule: bool = False
    states: dict[Names, Construction] = field(default_factory=dict)
    userdata: dict[Names, tuple[Argument, ...]] = field(default_factory=dict)
    lost: list[Lost] = field(default_factory=list)


class UnreadableMachineError(Exception):
    """A fault for which nothing of the file can be imported: its place, and what to do."""

    def __init__(self, message: str, span: Span, help: str) -> None:
        super().__init__(message)
        self.span, self.help = span, help


class XmlText:
    """The elements of a file. `lost` is what was not taken over."""

    def __init__(self, source: Source, lost: list[Lost]) -> None:
        self.source = source
        self.lost = lost

    def span(self, element: Element, attribute: str = "") -> Span:
        """The place of the value of an attribute, or of the start tag."""
        return Span(self.source, *element.place(self.source.text, attribute))

    def content(self, element: Element) -> str:
        """The text at the start of an element."""
        end = self.source.text.find("<", element.end)
        return unescape(self.source.text[element.end : end]).strip() if end >= 0 else ""

    def lose(self, span: Span, text: str, help: str) -> None:
        self.lost.append(Lost(span=span, text=text, help=help))


def local(tag: str) -> str:
    """The name of a tag without the prefix of its namespace."""
    return tag.rpartition(":")[2]


def inside(element: Element) -> Iterator[Element]:
    """An element and all elements in it, in the order of the text."""
    todo = [element]
    while todo:
        here = todo.pop()
        yield here
        todo += reversed(here.children)


def transitions(edges: Edges) -> tuple[Transition, ...]:
    return tuple(
        Transition(outcome=outcome, target=target, span=span, target_span=target_span)
        for outcome, (target, span, target_span) in edges.items()
    )


def leaf(
    name: str, type: str, edges: Edges, span: Span, *, remaps: tuple[Remap, ...] = (),
    is_open: bool = False,
) -> Leaf:  # fmt: skip
    """A state whose outcomes are those that its transitions name."""
    outcomes = tuple(Outcome(name=outcome, span=place) for outcome, (_, place, _) in edges.items())
    return Leaf(name=name, type=type, outcomes=outcomes, transitions=transitions(edges),
                remaps=remaps, open=is_open, span=span)  # fmt: skip


def type_name(text: str, default: str) -> str:
    """A name for a state type: the last part of a path, an address or a dotted name."""
    word = re.split(r"[/#:.]", text.rstrip("/"))[-1]
    word = re.sub(r"\W+", "_", word).strip("_")
    return word if word.isidentifier() else default


def as_data(value: object) -> Data:
    """A value of JSON as data of a script."""
    if isinstance(value, dict):
        return Struct(entries=tuple((str(key), as_data(part)) for key, part in value.items()))
    if isinstance(value, list):
        return tuple(map(as_data, value))
    assert value is None or isinstance(value, bool | int | float | str)
    return value


_JS = re.compile(
    r"""\s*(?:(?P<text>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')"""
    r"""|(?P<number>-?(?:0|[1-9]\d*)(?:\.\d+)?(?:[eE][-+]?\d+)?)(?![\w.])"""
    r"""|(?P<word>[A-Za-z_$][\w$]*)|(?P<sign>[\[\]{}(),:]))"""
)
_ESCAPE = re.compile(r"\\(?:u([0-9a-fA-F]{4})|(.))")
_PLAIN = {"n": "\n", "t": "\t", "r": "\r", "b": "\b", "f": "\f", "'": "'", '"': '"', "\\": "\\",
          "/": "/"}  # fmt: skip
_WORDS = frozenset(["true", "false", "null"])

LONGEST = 100_000
"""The longest value that is read, in characters."""


class NoLiteralError(ValueError):
    """An expression that is no plain value."""


def literal(code: str) -> Data:
    """The value of a literal of ECMAScript: as JSON, and names without quotes as keys, texts in
    single quotes, brackets around all. Raises NoLiteralError for other code."""
    if len(code) > LONGEST:
        raise NoLiteralError
    parts: list[str] = []
    at, text = 0, code.strip()
    while text.startswith("(") and text.endswith(")"):
        text = text[1:-1].strip()
    while at < len(text):
        found = _JS.match(text, at)
        if found is None:
            raise NoLiteralError
        at = found.end()
        word, is_key = found["word"], re.match(r"\s*:", text[at:]) is not None
        if found["text"] is not None:
            parts.append(json.dumps(_unescaped(found["text"][1:-1])))
        elif word is not None and is_key:
            parts.append(json.dumps(word))
        elif word is not None and word not in _WORDS:
            raise NoLiteralError
        else:
            parts.append(found[0].strip())
    try:
        return as_data(
            json.loads(" ".join(parts), object_pairs_hook=_unlike, parse_constant=_refuse)
        )
    except (ValueError, RecursionError):
        raise NoLiteralError from None


def _unlike(pairs: Iterable[tuple[str, object]]) -> dict[str, object]:
    """A mapping without two of one key."""
    found: dict[str, object] = {}
    for key, value in pairs:
        if key in found:
            raise ValueError(key)
        found[key] = value
    return found


def _refuse(_: str) -> object:
    raise ValueError


def _unescaped(text: str) -> str:
    def one(found: re.Match[str]) -> str:
        if found[1] is not None:
            return chr(int(found[1], 16))
        if found[2] not in _PLAIN:
            raise NoLiteralError
        return _PLAIN[found[2]]

    return _ESCAPE.sub(one, text)
