"""Elements of an SCXML document, their text, and the identifiers of states and data."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from importlib import resources

from smachac.records import dataclass, field
from smachac.targets.scxml.expressions import RESERVED

_ODD = re.compile("[^A-Za-z0-9_-]")
_INVALID = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")

EVENTS = ("done", "elapsed", "error", "fault", "preempt", "stop")
"""The first words of events. No state has one of these names: its own events start with it."""

OWN_DATA = ("inputs", "inside", "preempted", "previous", "ready", "requested", "running",
            "state", "stopped", "stopping")  # fmt: skip
"""The data of every document."""

GLOBALS = ("Array", "In", "Infinity", "JSON", "Math", "NaN", "Number", "Object", "Proxy", "String",
           "console", "getDelayInMs", "it", "log", "name", "undefined")  # fmt: skip
"""Names that data would hide."""


@dataclass(frozen=True, slots=True)
class Element:
    """An element with its attributes and content; text is a line of its own, a Comment a comment.
    Attributes that are None are left out."""

    tag: str
    attributes: Mapping[str, str | None] = field(default_factory=dict)
    content: tuple[Element | Comment | Code | str, ...] = ()


@dataclass(frozen=True, slots=True)
class Comment:
    """A comment of one line."""

    text: str


@dataclass(frozen=True, slots=True)
class Code:
    """The text of a script of several lines."""

    text: str


def element(
    tag: str, *content: Element | Comment | Code | str | None, **attributes: str | None
) -> Element:
    """An element; content that is None is left out."""
    return Element(tag, attributes, tuple(value for value in content if value is not None))


def script(code: str) -> Element:
    return Element("script", {}, (code,))


def escaped(text: str) -> str:
    """A text in an attribute or element; characters that XML cannot represent are replaced."""
    text = _INVALID.sub("\ufffd", text)
    for sign, name in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(sign, name)
    return text.replace("\n", "&#10;").replace("\r", "&#13;").replace("\t", "&#9;")


def lines_of(root: Element) -> Iterator[str]:
    """The lines of a document, indented by two spaces. Iterative: nesting is not limited."""
    stack: list[tuple[int, Element | Comment | Code | str]] = [(0, root)]
    while stack:
        depth, node = stack.pop()
        indent = "  " * depth
        if isinstance(node, Comment):
            yield f"{indent}<!-- {_comment(node.text)} -->"
            continue
        if isinstance(node, str | Code):
            yield f"{indent}{node}"
            continue
        given = "".join(
            f' {name}="{escaped(value)}"'
            for name, value in node.attributes.items()
            if value is not None
        )
        match node.content:
            case ():
                yield f"{indent}<{node.tag}{given}/>"
            case (str() as only,):
                text = escaped(only).replace("&quot;", '"')
                yield f"{indent}<{node.tag}{given}>{text}</{node.tag}>"
            case (Code() as only,):  # SCION drops the text if a space is beside the CDATA
                yield f"{indent}<{node.tag}{given}><![CDATA["
                yield from (f"{indent}{line}".rstrip() for line in only.text.splitlines())
                yield f"{indent}]]></{node.tag}>"
            case _:
                yield f"{indent}<{node.tag}{given}>"
                stack.append((depth, f"</{node.tag}>"))
                stack.extend((depth + 1, value) for value in reversed(node.content))


def _comment(text: str) -> str:
    return _INVALID.sub("\ufffd", text).replace("--", "- -").rstrip("-")


class Identifiers:
    """Unique identifiers: of states and events (xs:ID without `.`), or of data (JavaScript)."""

    def __init__(self, taken: Iterable[str], *, joiner: str = "-") -> None:
        self._taken = set(taken)
        self._numbers: dict[str, int] = {}
        self._joiner = joiner

    def new(self, name: str, around: str = "", *, avoided: Collection[str] = ()) -> str:
        """An identifier for a name: the name itself, that with its container, or one with a
        number; none of `avoided`."""
        word = _ODD.sub("_", name)
        word = word.replace("-", "_") if self._joiner == "_" else word
        word = f"_{word}" if not word[:1].isalpha() else word
        found = word
        if (found in self._taken or found in avoided) and around:
            word = found = f"{around}{self._joiner}{word}"
        while found in self._taken or found in avoided:
            number = self._numbers[word] = self._numbers.get(word, 1) + 1
            found = f"{word}_{number}"
        self._taken.add(found)
        return found


_CALLED = re.compile(r"\b(\w+)(?=\()|(?<=\()(\w+)(?=[),])")


def functions() -> dict[str, str]:
    """The functions of functions.js with their comments, by name."""
    text = resources.files("smachac.targets.scxml").joinpath("functions.js").read_text("utf-8")
    found = {}
    for block in text.split("\n\n"):
        name = re.search(r"^function (\w+)", block, re.MULTILINE)
        if name is not None:
            found[name[1]] = block.strip()
    return found


def functions_in(texts: Iterable[str]) -> list[str]:
    """The functions that a document with these texts needs, in the order of functions.js."""
    known = functions()
    needed: dict[str, None] = {}
    todo = [*texts]
    while todo:
        for name in (word for pair in _CALLED.findall(todo.pop()) for word in pair):
            if name in known and name not in needed:
                needed[name] = None
                todo.append(known[name])
    return [block for name, block in known.items() if name in needed]


def taken_data() -> list[str]:
    """The names that data of containers cannot have."""
    return [*RESERVED, *GLOBALS, *OWN_DATA, *functions()]
