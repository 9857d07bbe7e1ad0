"""XML as a tree of elements with their places in the text: robot files (URDF, xacro) and imports.

The parser is expat. A document type is refused, because it can expand a small file to a huge one or
refer to other files; size, depth and number of elements are bounded.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import NamedTuple, TypeAlias
from xml.parsers import expat

MAX_CHARACTERS = 5_000_000
MAX_ELEMENTS = 100_000
MAX_DEPTH = 100

TextPlace: TypeAlias = tuple[int, int]
"""The start and the end of a part of a text, in characters."""

TOO_LARGE = "name a smaller URDF file: one robot, without its meshes in the text"
FIRST_TAG = "name a URDF file: its first tag is `<robot name=...>`"


class FormatHelp(NamedTuple):
    """The helps that name the format of a file: for a text that is empty, for one with something
    outside of all tags, and for one that is too large."""

    empty: str
    outside: str
    too_large: str


URDF = FormatHelp(FIRST_TAG, "the first tag of a URDF file is `<robot name=...>`", TOO_LARGE)


class XmlError(ValueError):
    """A mistake in a text: the message, its place, and a line of help."""

    def __init__(self, message: str, place: TextPlace, help: str) -> None:
        super().__init__(message)
        self.message, self.place, self.help = message, place, help


@dataclass(slots=True)
class Element:
    """An element: its tag, attributes and child elements; `start` is the index of its `<`, `end`
    that after the `>` of its start tag."""

    tag: str
    attributes: dict[str, str]
    start: int
    line: int
    end: int = 0
    children: list[Element] = field(default_factory=list)

    def all(self, tag: str) -> list[Element]:
        """The children with that tag."""
        return [child for child in self.children if child.tag == tag]

    def first(self, tag: str) -> Element | None:
        """The first child with that tag."""
        return next((child for child in self.children if child.tag == tag), None)

    def place(self, text: str, attribute: str = "", *, whole: bool = False) -> TextPlace:
        """The place of the value of an attribute, with its name if `whole`; that of the start tag
        without the attribute."""
        if attribute in self.attributes:
            pattern = rf"""\s{re.escape(attribute)}\s*=\s*(?:"([^"]*)"|'([^']*)')"""
            found = re.compile(pattern).search(text, self.start, self.end)
            if found is not None and whole:
                return found.start() + 1, found.end()
            if found is not None:
                return found.span(found.lastindex or 0)
        return self.start, self.end


def parse(text: str, format: FormatHelp = URDF) -> Element:
    """The outermost element of an XML text. Raises XmlError."""
    return _Reader(text, format).read()


_HELP = {
    expat.errors.codes[expat.errors.XML_ERROR_DUPLICATE_ATTRIBUTE]: (
        "remove one of the two attributes with one name in this tag"
    ),
    expat.errors.codes[expat.errors.XML_ERROR_UNDEFINED_ENTITY]: "write `&amp;` for the sign `&`",
    expat.errors.codes[expat.errors.XML_ERROR_MISPLACED_XML_PI]: (
        "`<?xml ...?>` may stand only at the start of the file: remove what is before it, also"
        " spaces and blank lines"
    ),
    expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_TOKEN]: (
        "add the end of what starts here: `>` of a tag, or `-->` of a comment"
    ),
    expat.errors.codes[expat.errors.XML_ERROR_UNCLOSED_CDATA_SECTION]: "add `]]>`",
    expat.errors.codes[expat.errors.XML_ERROR_JUNK_AFTER_DOC_ELEMENT]: (
        "a file has one outermost element: move what follows it into it, or remove it"
    ),
}
_TOKEN = 'write an attribute as `name="value"`, and `&lt;` and `&amp;` for `<` and `&` in a value'


class _Reader:
    """Receives the elements from expat."""

    def __init__(self, text: str, format: FormatHelp) -> None:
        self.text = text
        self.format = format
        self.lines = [0, *(found.end() for found in re.finditer(r"\r\n|\r|\n", text))]
        self.root: Element | None = None
        self.open: list[Element] = []
        self.last: Element | None = None
        self.count = 0
        self.parser = expat.ParserCreate("utf-8")

    def read(self) -> Element:
        if len(self.text) > MAX_CHARACTERS:
            message = f"the file has {len(self.text):,} characters, more than {MAX_CHARACTERS:,}"
            raise XmlError(message, (0, 0), self.format.too_large)
        if not self.text.strip():
            raise XmlError("the file is empty", (0, 0), self.format.empty)
        parser = self.parser
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.StartDoctypeDeclHandler = self.refuse
        parser.EntityDeclHandler = self.refuse
        try:
            parser.Parse(self.text.encode("utf-8", "replace"), True)
        except expat.ExpatError as error:
            raise self.fault(error) from None
        assert self.root is not None  # else expat finds no element
        return self.root

    def index(self, line: int, column: int) -> int:
        return min(self.lines[min(line, len(self.lines)) - 1] + column, len(self.text))

    def here(self) -> TextPlace:
        start = self.index(self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber)
        return start, min(start + 1, len(self.text))

    def refuse(self, *_: object) -> None:
        message = "it has a document type, which can expand to a huge text"
        raise XmlError(message, self.here(), "remove the lines with `<!DOCTYPE` and `<!ENTITY`")

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if self.count > MAX_ELEMENTS or len(self.open) > MAX_DEPTH:
            message = f"it has more than {MAX_ELEMENTS:,} elements, or more than {MAX_DEPTH} levels"
            raise XmlError(message, self.here(), self.format.too_large)
        element = Element(tag, attributes, self.here()[0], self.parser.CurrentLineNumber)
        element.end = _tag_end(self.text, element.start)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)
        self.last = element

    def end(self, _: str) -> None:
        self.open.pop()

    def fault(self, error: expat.ExpatError) -> XmlError:
        """The error for a text that is not XML."""
        index = self.index(error.lineno, error.offset)
        place = index, min(index + 1, len(self.text))
        codes, errors = expat.errors.codes, expat.errors
        if self.open and error.code == codes[errors.XML_ERROR_TAG_MISMATCH]:
            return self.mismatch(index)
        if self.open and error.code == codes[errors.XML_ERROR_NO_ELEMENTS]:
            return self.not_closed()
        start, dashes = _bad_comment(self.text, self.last.end if self.last is not None else 0)
        if 0 <= start <= index:
            if dashes >= 0:
                help = "write one `-`, or another sign: `--` may only end a comment, as `-->`"
                return XmlError("a comment contains `--`", (dashes, dashes + 2), help)
            help = "write `-->` at the end of the comment"
            return XmlError("a comment is not closed", (start, start + 4), help)
        message = f"the file is not valid XML: {expat.ErrorString(error.code)}"
        help = _HELP.get(error.code, _TOKEN)
        if error.code == codes[errors.XML_ERROR_SYNTAX]:
            help = f"remove the text outside of all tags; {self.format.outside}"
        return XmlError(message, place, help)

    def mismatch(self, start: int) -> XmlError:
        """The error for an end tag whose name is at `start`, and not that of the innermost open
        element. Where an element around it has this name, the innermost one is not closed."""
        found = re.compile(r"[^\s<>]+").match(self.text, start)
        name = found.group() if found is not None else ""
        if not name or any(element.tag == name for element in self.open):
            return self.not_closed()
        last = self.open[-1]
        message = f"`</{name}>` ends no element: `<{last.tag}>` in line {last.line} is open"
        help = f"write `</{last.tag}>`, or remove `</{name}>`"
        return XmlError(message, (start, start + len(name)), help)

    def not_closed(self) -> XmlError:
        """The error that the innermost open element has no end tag."""
        last = self.open[-1]
        help = f"write `/>` at the end of this tag, or add `</{last.tag}>` after its content"
        return XmlError(f"`<{last.tag}>` is not closed", (last.start, last.end), help)


def _bad_comment(text: str, index: int) -> tuple[int, int]:
    """The start of the first comment from `index` that contains `--` or is not closed, and the
    place of its `--`; -1 for what is not there."""
    while (start := text.find("<!--", index)) >= 0:
        dashes = text.find("--", start + 4)
        if text[dashes : dashes + 3] != "-->":
            return start, dashes
        index = dashes + 3
    return -1, -1


_TAG = re.compile(r"""<(?:[^"'>]|"[^"]*"|'[^']*')*>""")


def _tag_end(text: str, start: int) -> int:
    found = _TAG.match(text, start)
    return found.end() if found is not None else start + 1
