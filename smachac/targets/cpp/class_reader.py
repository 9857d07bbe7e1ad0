"""What a class of C++ says of itself: its outcomes, the fields of `In` and `Out`, its number.

This is no parser of C++: it knows classes as `smachac new state` begins them and people go on. What
looks otherwise (macros, fields with values, inherited parts) is not judged; the compiler does.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from smachac.diagnostics.source import Source, Span, Word
from smachac.frontend.loader import Library
from smachac.frontend.state_types import StateType
from smachac.ir.nodes import Key
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import class_code, field_type, interface_hash
from smachac.targets.interface_check import Declared, Words

LONGEST = 200_000
"""Characters of the longest header that is read."""

_NO_CODE = re.compile(
    r"""(?P<kept>\b\d[\w.']*)|//[^\n]*|/\*.*?(?:\*/|\Z)|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""",
    re.DOTALL,
)
_CLASS = r"(?<!enum )\b(?:class|struct)\s+(?:\w+\s+)?(?P<name>{})\b(?P<base>[^;(){{}}=]*)\{{"
_OUTCOME = r"\benum\s+(?:class|struct)\s+Outcome\b[^;{]*\{"
_STRUCT = r"\bstruct\s+{}\s*\{{"
_NUMBER = r"\bsmachac_interface\s*[={]\s*(0[xX][\da-fA-F']{1,20}|\d[\d']{0,20})[uUlL]*\s*\}?\s*;"
_ENUMERATOR = re.compile(r"\s*(?P<name>[A-Za-z_]\w*)\s*(?:=[^,]*)?")
_LAST_WORD = re.compile(r"\b[A-Za-z_]\w*$")
_ARGUMENTS = re.compile(r"<[^<>]*>")
_ODD = re.compile(r"[#(){}\[\]=]|\b(?:using|static|template|typedef|mutable)\b")
"""What fields of `In` and `Out` do not have."""

KNOWN = {"bool", "double", "float", "int", "std::int64_t", "std::string"}
"""Types that are surely others where they are spelt otherwise, beside those of `smachac::`."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Part:
    """A stretch of a header, without comments and texts; `start` is where it begins."""

    source: Source
    text: str
    start: int = 0

    def word(self, text: str, at: int, end: int) -> Word:
        return Word(text, Span(self.source, self.start + at, self.start + end))

    def only(self, pattern: str) -> re.Match[str] | None:
        """What fits a pattern, if there is just one."""
        found = list(re.finditer(pattern, self.text))
        return found[0] if len(found) == 1 else None

    def member(self, pattern: str) -> re.Match[str] | None:
        """The same outside braces."""
        found = self.only(pattern)
        before = self.text[: found.start()] if found is not None else ""
        return found if before.count("{") == before.count("}") else None

    def inside(self, head: re.Match[str] | None) -> _Part | None:
        """What stands between the brace that a head ends with and the one that closes it."""
        depth = 1
        for found in re.finditer(r"[{}]", self.text[head.end() :]) if head is not None else ():
            depth += 1 if found.group() == "{" else -1
            if depth == 0 and head is not None:
                text = self.text[head.end() : head.end() + found.start()]
                return _Part(source=self.source, text=text, start=self.start + head.end())
        return None

    def split(self, mark: str) -> Iterator[tuple[int, str]]:
        """The pieces between marks, each with its offset, but for those that are blank."""
        at = 0
        for piece in self.text.split(mark):
            if piece.strip():
                yield at, piece
            at += len(piece) + 1


@dataclass(frozen=True, slots=True, kw_only=True)
class _Field:
    """A field of `In` or `Out`: its name and the text of its type."""

    word: Word
    type: str


def declared(type_: StateType, library: Library) -> Declared | None:
    """What the class of a state type declares; None where that cannot be read."""
    code = class_code(type_)
    source = library.code(code.header) if code is not None else None
    if code is None or source is None or len(source.text) > LONGEST:
        return None
    whole = _Part(source=source, text=_NO_CODE.sub(_blank, source.text))
    head = whole.only(_CLASS.format(re.escape(code.name.rpartition("::")[2])))
    body = whole.inside(head)
    if head is None or body is None or "#" in body.text:
        return None
    derived = ":" in head["base"]
    inputs, outputs = (_fields(body, name, derived=derived) for name in ("In", "Out"))
    return Declared(
        name=code.name.removeprefix("::"),
        span=whole.word("", *head.span("name")).span,
        outcomes=_outcomes(body, [each.name for each in type_.outcomes]),
        inputs=_names(inputs, type_.input_keys),
        outputs=_names(outputs, type_.output_keys),
        others=(
            *_other_fields("In", inputs, type_.input_keys),
            *_other_fields("Out", outputs, type_.output_keys),
        ),
        stale=_stale(body, interface_hash(type_)),
    )


def _blank(found: re.Match[str]) -> str:
    return found["kept"] or re.sub(r"[^\n]", " ", found.group())


def _stale(body: _Part, wanted: str) -> Word | None:
    """The place of the number of another interface, and the number of the one there is."""
    found = body.member(_NUMBER)
    number = _number(found[1]) if found is not None else None
    if found is None or number is None or number == _number(wanted.rstrip("U")):
        return None
    return body.word(wanted, *found.span(1))


def _number(text: str) -> int | None:
    """A whole number as C++ reads it."""
    digits = text.lower().replace("'", "")
    base = 16 if digits.startswith("0x") else 8 if digits.startswith("0") else 10
    try:
        return int(digits, base)
    except ValueError:
        return None


def _outcomes(body: _Part, names: Iterable[str]) -> Words | None:
    part = body.inside(body.member(_OUTCOME))
    if part is None or re.search(r"[\[{(]", part.text):
        return None
    own = {identifier(name): name for name in names}
    words = []
    for at, piece in part.split(","):
        found = _ENUMERATOR.fullmatch(piece.rstrip())
        if found is None:
            return None
        name, (start, end) = found["name"], found.span("name")
        words.append(part.word(own.get(name, name), at + start, at + end))
    return tuple(words)


def _fields(body: _Part, name: str, *, derived: bool) -> list[_Field] | None:
    """The fields of a struct; none where nothing is called so, unless it may be inherited."""
    if not derived and not re.search(rf"\b{name}\b", body.text):
        return []
    part = body.inside(body.member(_STRUCT.format(name)))
    if part is None or _ODD.search(part.text):
        return None
    fields = []
    for at, piece in part.split(";"):
        text = piece.rstrip()
        found = _LAST_WORD.search(text)
        type_ = text[: found.start()].strip() if found is not None else ""
        if found is None or not type_ or "," in _without_arguments(type_):
            return None
        word = part.word(found.group(), at + found.start(), at + found.end())
        fields.append(_Field(word=word, type=type_))
    return fields


def _without_arguments(type_: str) -> str:
    """A type without what stands in angle brackets, as far as those are nested in types."""
    for _ in range(10):
        type_ = _ARGUMENTS.sub("", type_)
    return type_


def _names(fields: Sequence[_Field] | None, keys: Iterable[Key]) -> Words | None:
    """The fields in the words of the interface."""
    if fields is None:
        return None
    own = {identifier(key.name): key.name for key in keys}
    return tuple(
        each.word._replace(text=own.get(each.word.text, each.word.text)) for each in fields
    )


def _other_fields(
    part: str, fields: Sequence[_Field] | None, keys: Iterable[Key]
) -> Iterator[Word]:
    """Fields of another type than the interface says, or in another order."""
    if not fields:
        return
    wanted = {identifier(key.name): key for key in keys}
    for each in fields:
        name = each.word.text
        try:
            right = field_type(part, wanted[name].type) if name in wanted else ""
        except UnportableError:
            continue
        if right and _surely_other(each.type, right):
            yield Word(f"`{part}::{name}` must be `{right}`", each.word.span)
    have = [each.word.text for each in fields]
    if have != [*wanted] and sorted(have) == sorted(wanted):
        order = ", ".join(f"`{name}`" for name in wanted)
        yield Word(f"the fields of `{part}` must be in the order {order}", fields[0].word.span)


def _surely_other(text: str, wanted: str) -> bool:
    """Whether two spellings of types name two types, whatever `using` says."""
    one, other = _plain(text), _plain(wanted)
    return one != other and one in KNOWN and (other in KNOWN or other.startswith("smachac::"))


def _plain(text: str) -> str:
    """A type without `const`, reference and `Key`, its name in full where it is known."""
    text = re.sub(r"\bconst\b|[&\s]", " ", text).strip()
    key = re.fullmatch(r"(?:smachac ?:: ?)?Key ?<(.*)>", text)
    text = (key[1] if key else text).replace(" ", "")
    return f"std::{text}" if text in ("string", "int64_t") else text
