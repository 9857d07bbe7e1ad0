"""Syntax errors of YAML: from the exception of libyaml to a diagnostic in the words of scripts.

The parser has two places, `first`, where the faulty part begins, and `at`, where it stopped. The
fault is often at a third one, in the line above. `problem` and `context` are libyaml's own words;
the sign that it met is in the text.
"""

from __future__ import annotations

import re
from typing import Any, NamedTuple

from smachac.diagnostics.diagnostic import Diagnostic, Related
from smachac.diagnostics.source import Source, Span
from smachac.frontend.errors.script import yaml_syntax
from smachac.frontend.schema import LONG, VARIABLES


class _Stop(NamedTuple):
    """What the parser reports. `first` and `at` are indexes in the text, `before` is the line of
    `at` up to there, `first_column` the column of `first`, `sign` the sign of YAML at `at`: "" at
    the end, TEXT for any other."""

    text: str
    problem: str
    context: str
    first: int | None
    first_column: int
    at: int
    before: str
    sign: str = ""

    @property
    def is_block_end(self) -> bool:
        """Whether a mapping or a list on lines of its own cannot go on here."""
        return self.problem in (_NO_KEY, _NO_ITEM)

    @property
    def is_deeper_list(self) -> bool:
        """Whether a list begins here that is indented more than what is around it."""
        return self.sign == "-" and (self.first is None or len(self.before) > self.first_column)


TEXT = "text"
_NO_KEY, _NO_ITEM = "did not find expected key", "did not find expected '-' indicator"
_NO_NODE, _NO_DOCUMENT = (
    "did not find expected node content",
    "did not find expected <document start>",
)
_NO_ESCAPE = "found unknown escape character"
_NOT_A_START = "found character that cannot start any token"
_TABS = (
    "found a tab character that violates indentation",
    "found a tab character where an indentation space is expected",
)
_COLON_IN_TEXT = "found unexpected ':'"


class _Fault(NamedTuple):
    """A fault in the words of scripts, at the characters `start` to `end`, or at one character.

    `begins`: the index where the part begins that has the fault; `part` names it.
    """

    message: str
    help: str | None
    start: int
    end: int | None = None
    begins: int | None = None
    part: str = ""


def too_deep_at(error: Any) -> int | None:
    """The index at which libyaml, since version 0.2.6, reads no more because of the nesting."""
    if error.problem != "exceeded maximum nesting depth":
        return None
    found: int = error.problem_mark.index
    return found


_ANCHOR = re.compile(r"(?:!\S*\s+)?([&*])([^\s\[\]{},]+)")


def anchor_fault(source: Source, start: int) -> Diagnostic | None:
    """SM001 for an anchor or alias at an index whose name has characters that are not part of it
    for libyaml, which reads `&left:home 0.5` as the anchor `left` of the text `:home 0.5`."""
    found = _ANCHOR.match(source.text, start)
    fault = None if found is None else _anchor_name(found)
    return None if fault is None else _diagnostic(source, fault)


def _anchor_name(found: re.Match[str]) -> _Fault | None:
    sign, name = found.groups()
    if re.fullmatch(r"[\w-]+", name, re.ASCII) is not None:
        return None
    better = re.sub(r"[^\w-]+", "_", name, flags=re.ASCII).strip("_") or "name"
    message = f"the name of an anchor has only letters, digits, `-` and `_`, not `{name}`"
    help = f"write `{sign}{better}`"
    if name == f"{better}:":
        help = f"remove the `{sign}`, or write a space before the colon: `{sign}{better} :`"
    return _Fault(message, help, found.start(1), found.end())


def syntax_error(source: Source, error: Any) -> Diagnostic:
    """SM001 for an exception of the parser."""
    stop = _stop(source.text, error)
    faults = (reader(stop) for reader in (_READERS if _is_short(stop) else (_conflict,)))
    message = ", ".join(part for part in (stop.problem, stop.context) if part)
    unknown = _Fault(message or "this is not YAML", None, stop.at)
    return _diagnostic(source, next((fault for fault in faults if fault is not None), unknown))


def _diagnostic(source: Source, fault: _Fault) -> Diagnostic:
    here = source.text[fault.start : fault.start + 1]
    end = fault.start + (here not in ("", "\n")) if fault.end is None else fault.end
    related: tuple[Related, ...] = ()
    if fault.begins is not None:
        begin = Span(source, fault.begins, fault.begins + 1)
        related = (Related(span=begin, message=f"the {fault.part} begins here"),)
    return yaml_syntax(
        Span(source, fault.start, end),
        fault.message,
        fault.help,
        arguments=("syntax", here),
        related=related,
    )


LONGEST_LINE = 2_000
"""In characters. A syntax error in a longer line is reported in the words of the parser: some
searches for a cause take quadratic time."""


def _is_short(stop: _Stop) -> bool:
    """Whether the lines of both places of a syntax error have at most LONGEST_LINE characters."""
    places = [stop.at] if stop.first is None else [stop.at, stop.first]
    starts = [stop.text.rfind("\n", 0, place) + 1 for place in places]
    return all(line_end(stop.text, start) - start <= LONGEST_LINE for start in starts)


def stopped_at(text: str, error: Any) -> list[int]:
    """Indexes of the lines in which the fault of an exception of the parser can be."""
    stop = _stop(text, error)
    above = [start for start, _ in _lines_above(stop, 1)]
    first = [] if stop.first is None else [stop.first]
    opened = _opened_above(stop)
    return list(dict.fromkeys([stop.at, *above, *first, *([] if opened is None else [opened])]))


def _opened_above(stop: _Stop) -> int | None:
    """The quote in a line above that a quote before this place closes; None without one."""
    quote = stop.before.rstrip()[-1:]
    if quote not in ("'", '"'):
        return None
    opened = stop.text.rfind(quote, 0, stop.at - len(stop.before))
    return opened if opened >= 0 else None


def _stop(text: str, error: Any) -> _Stop:
    first, mark = (getattr(error, name, None) for name in ("context_mark", "problem_mark"))
    problem, context = (_one_line(getattr(error, name, None)) for name in ("problem", "context"))
    mark = mark or first
    at = min(mark.index, len(text)) if mark is not None else 0
    if problem in (_NOT_A_START, *_TABS):
        first = None  # where a value began that has no fault
    if problem == _NO_ESCAPE:
        at += 1
    return _Stop(
        text=text,
        problem=problem,
        context=context,
        first=min(first.index, len(text)) if first is not None else None,
        first_column=first.column if first is not None else 0,
        at=at,
        before=text[text.rfind("\n", 0, at) + 1 : at],
        sign=_sign(text[at : at + 2]),
    )


def _sign(text: str) -> str:
    """The sign with which a text begins."""
    if text[:1] in ("-", "?") and text[1:].strip():
        return TEXT
    return text[:1] if text[:1] in ("", *"[]{},:-?&*!") else TEXT


def _one_line(text: object) -> str:
    return " ".join(str(text).split()) if text else ""


CONFLICT = re.compile(r"^(?:<{7}|={7}|>{7}|\|{7})(?=[ \n\r]|\Z)", re.M)
"""A line that git writes around two versions of a text."""


def _conflict(stop: _Stop) -> _Fault | None:
    """The marks of a merge conflict."""
    found = CONFLICT.search(stop.text)
    if found is None:
        return None
    message = f"`{found[0]}` is a mark of git: two versions of these lines are in the file"
    help = "keep one version, and remove the lines with `<<<<<<<`, `=======` and `>>>>>>>`"
    return _Fault(message, help, *found.span())


_BLOCK_TEXT = re.compile(r"([ \t]*(?:- +)*)[^\s#][^#]*: [|>][-+0-9]*[ \t]*$")


def lost_of_block_text(text: str, index: int) -> int | None:
    """The column that a line must have to be a part of the text below `|` or `>` above it; None for
    a line that has a key, and without such a text."""
    stop = _Stop(text, "", "", None, 0, index, text[text.rfind("\n", 0, index) + 1 : index])
    start = index - len(stop.before)
    line = text[start : line_end(text, index)].rstrip("\r")
    if not line.strip() or _KEY_AT_START.match(line) is not None:
        return None
    due: int | None = None
    for _, above in _lines_above(stop, _MOST_TEXT):
        found = _BLOCK_TEXT.match(above)
        if found is not None:
            return due or len(found[1]) + 2
        if _KEY_AT_START.match(above) is not None:
            return None
        due = min(_indent(above), due or 1_000)
    return None


_KEY_AT_START = re.compile(r"[ \t]*(?:- |[\w./-]+:(?:\s|$))")
_MOST_TEXT = 40


def _block_text(stop: _Stop) -> _Fault | None:
    """A line of a text below `|` that is indented too little."""
    for index in (stop.at, *(() if stop.first in (None, stop.at) else (stop.first,))):
        due = lost_of_block_text(stop.text, index)
        start = stop.text.rfind("\n", 0, index) + 1
        line = stop.text[start : line_end(stop.text, index)].rstrip()
        if due is None or _indent(line) >= due:
            continue
        begin = start + _indent(line)
        message = "this line is indented too little for the text that begins at `|` or `>` above it"
        return _Fault(message, f"indent it by {of_spaces(due)}", begin, start + len(line))
    return None


_SPACES = re.compile(r"[ \t-]*([^\S\x00-\x7f]|[\u200b-\u200d\u2060\ufeff])[^\S\n]*")
"""The beginning of a line with a character that looks like a space, and is none for YAML."""

_SPACE_NAMES = {
    0xA0: "a no-break space",
    0xFEFF: "a byte order mark",
    0x200B: "a space of no width",
}


def _space(stop: _Stop) -> _Fault | None:
    """A character in the indentation of the line, or of one of those above it, that is no space for
    YAML, as copied text contains it."""
    here = stop.at - len(stop.before)
    for start in (here, *(start for start, _ in _lines_above(stop, 2))):
        found = _SPACES.match(stop.text, start)
        if found is not None:
            code = ord(found[1])
            name = _SPACE_NAMES.get(code, "a character that looks like a space")
            message = f"there is {name} (U+{code:04X}) in the indentation"
            return _Fault(message, "replace it with spaces", found.start(1), found.end(1))
    return None


_UNCLOSED = re.compile(r"did not find expected ',' or '([]}])'")
_VALUES_BESIDE = re.compile(r": [^\s,:{}\[\]]+ ([^\W\d]\w*)$")
"""A value and a key in one line of a mapping in braces, without a comma between them."""

_LAMBDA = re.compile(r"lambda\b[^:{}]{0,100}$")
"""The beginning of a function without quotes, up to its colon."""

_TYPE = re.compile(r"(?:(\w+): )?(list|dict|one_of|float|int)$")
"""The beginning of a type with brackets that is not in quotes, with the key before it."""

_TYPE_REST = re.compile(r"[^\n,{}]{0,100}?\](?=[\s,}?\]]|$)\??")


def _quoted_type(found: re.Match[str], stop: _Stop) -> str:
    """The help for a type in a mapping in braces, in which its brackets are those of a list."""
    rest = _TYPE_REST.match(stop.text, stop.at)
    whole = f'"{found[2]}{rest[0] if rest is not None else "[...]"}"'
    key = f"{found[1]}: " if found[1] else ""
    return f"put the type in quotes: `{key}{whole}`"


_OPENING = {"]": "[", "}": "{"}


def _unclosed_or_unopened(stop: _Stop) -> _Fault | None:
    """A bracket or a quote without its counterpart."""
    unclosed = _UNCLOSED.fullmatch(stop.problem)
    if unclosed is not None and stop.first is not None:
        end = unclosed[1]
        kind = "list" if end == "]" else "mapping"
        help = f"close the {kind} with `{end}`, or put text that contains `:` in quotes"
        if not stop.sign:
            message = f"this {kind} is not closed: there is no `{end}` up to the end of the text"
            return _Fault(message, help, stop.first)
        beside = _VALUES_BESIDE.search(stop.before)
        if beside is not None and stop.sign == ":":
            help = f"write a `,` before `{beside[1]}`, or put text that contains `:` in quotes"
        code = _LAMBDA.search(stop.before)
        if code is not None and stop.sign == ":":
            help = f"put the code in quotes: `'{code[0]}: ...'`"
        type_ = _TYPE.search(stop.before)
        if type_ is not None and stop.sign == "[":
            help = _quoted_type(type_, stop)
        if stop.sign == TEXT:
            help = f"write a `,` between two values, or close the {kind} with `{end}`"
        closing = _line_to_close(stop)
        if closing:
            message = f"this {kind} is not closed before the next key"
            return _Fault(message, f"write `{end}` at the end of line {closing}", stop.first)
        found = stop.sign if stop.sign == TEXT else f"`{stop.sign}`"
        message = f"expected `,` or `{end}`, found {found}"
        return _Fault(message, help, stop.at, begins=stop.first, part=kind)
    if stop.sign in _OPENING and (stop.is_block_end or stop.problem == _NO_NODE):
        opening = _OPENING[stop.sign]
        help = f"remove it, or write the `{opening}`"
        return _Fault(f"`{stop.sign}` closes no `{opening}`", help, stop.at)
    in_quotes = stop.context == "while scanning a quoted scalar"
    if in_quotes and stop.problem == "found unexpected end of stream" and stop.first is not None:
        help = "write the same quote at the end of the text"
        return _Fault("this quote is not closed", help, stop.first)
    return None


_KEY_IN_BLOCK = re.compile(r"[ \t]*(?:-[ \t]+)*[^\W\d][\w.-]*[ \t]*")
"""The line of a key outside of brackets, up to its colon."""


def _line_to_close(stop: _Stop) -> int:
    """The number of the line whose end lacks a closing bracket: the line after it has a key and is
    indented no more than the line of the opening bracket. 0 if there is none."""
    first = stop.first or 0
    start = stop.text.rfind("\n", 0, first) + 1
    opening = stop.text[start:first]
    here = stop.at - len(stop.before)
    is_key = stop.text.startswith(":", stop.at) and _KEY_IN_BLOCK.fullmatch(stop.before)
    above = _lines_above(stop, 1)
    if here <= start or not is_key or not above:
        return 0
    if _indent(stop.before) > _indent(opening):
        return 0
    return stop.text.count("\n", 0, above[0][0]) + 1


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" \t"))


_NO_SPACE = re.compile(r"[^\s:]*:[\[{'\"]")
JOINED = re.compile(r"[^\W\d][\w.-]*:[^\s:/]\S*")
_WORD = re.compile(r"[^\W\d][\w./-]*")
_VALUED = re.compile(r"([^\W\d][\w./-]*):[ \t]+[^\s\[{'\"|>#&*].*")
SPACE_MISSING = "a space is missing after the colon"
"""The message for a text of the form JOINED where a key and its value are probably meant."""


def _colon(stop: _Stop) -> _Fault | None:
    """A colon that is missing, has no space after it, or is one too many."""
    if stop.context == "while scanning a simple key" and stop.first is not None:
        joined = JOINED.match(stop.text, stop.first)
        if joined is not None:
            return _Fault(SPACE_MISSING, spaced(joined[0]), *joined.span())
        word = _WORD.match(stop.text, stop.first)
        help = "write `key: value`, with a space after `:`"
        if word is not None and stop.text[word.end() : word.end() + 1] in ("", "\n", "\r"):
            return _Fault("a `:` is missing after this key", f"write `{word[0]}:`", *word.span())
        return _Fault("a `:` is missing after this key", help, stop.first)
    if stop.problem == _COLON_IN_TEXT:
        help = "write a space after the colon, or put the text in quotes"
        return _Fault(SPACE_MISSING, help, stop.at)
    if not stop.problem.startswith("mapping values are not allowed"):
        return None
    message = "a colon is not allowed here"
    no_space = _NO_SPACE.search(stop.before)
    if no_space is not None:
        help = f"write a space after the colon in `{no_space.group()}`"
        return _Fault(message, help, stop.at)
    fault = _colon_above(stop) if ": " not in stop.before else None
    entry = _ENTRIES.fullmatch(_line_of(stop))
    if entry is not None and fault is None:
        help = f"put the inner mapping in braces: `{entry[1]}: {{{entry[2]}}}`"
        if LONG.get(entry[1], entry[1]) not in _MAPPINGS:
            help = f"put the text with the colon in quotes: `{entry[1]}: '{entry[2]}'`"
        return _Fault(message, help, stop.at)
    help = "put the text with the colon in quotes, or write an inner mapping on lines of its own"
    return fault or _Fault(message, help, stop.at)


_MAPPINGS = frozenset(
    name for name, row in VARIABLES.items() if row.shape in ("pairs", "map", "keys", "userdata")
) | {"retry", "for_each", "outcomes"}
"""The fields whose values are mappings."""

_ENTRIES = re.compile(
    r"[ -]*([\w.-]+): ([^\s\[{'\"&*|>#][^\[\]{}'\"#]{0,100}:(?: [^\[\]{}'\"#]{1,100})?)"
)
"""A line with a key, and another one in the place of its value."""


def _line_of(stop: _Stop) -> str:
    start = stop.at - len(stop.before)
    return stop.text[start : line_end(stop.text, start)].rstrip()


def spaced(joined: str) -> str:
    """The help for a text of the form JOINED."""
    key, _, value = joined.partition(":")
    return f"write a space after the colon in `{joined}`: `{key}: {value}`"


def _colon_above(stop: _Stop) -> _Fault | None:
    """The fault of a key that the parser read as a part of the text in the line above."""
    lines = _lines_above(stop, 2)
    if not lines:
        return None
    start, above = lines[0]
    dashes = re.match(r"(?:-[ \t]+)*", above.lstrip())
    assert dashes is not None
    column = len(above) - len(above.lstrip()) + dashes.end()
    written = above[column:].partition(" #")[0].rstrip()
    if JOINED.fullmatch(written) is not None:
        begin = start + column
        return _Fault(SPACE_MISSING, spaced(written), begin, begin + len(written))
    begins = dashes.end() or len(lines) < 2 or lines[1][1].rstrip().endswith(":")
    if _WORD.fullmatch(written) is not None and begins:
        begin = start + column
        help = f"write `{dashes[0]}{written}:`"
        return _Fault("a `:` is missing after this key", help, begin, begin + len(written))
    valued, key = _VALUED.fullmatch(written), stop.before.lstrip()
    if valued is not None and len(stop.before) - len(key) > column and not key.startswith("- "):
        message = f"this key is indented more than `{valued[1]}` above it, which has a value"
        spaces = of_spaces(column)
        help = f"indent it by {spaces}, like `{valued[1]}`, or remove the value of `{valued[1]}`"
        return _Fault(message, help, stop.at - len(key), stop.at)
    return None


def _lines_above(stop: _Stop, most: int) -> list[tuple[int, str]]:
    """The nearest lines above that are not empty and no comment, each with its start."""
    found: list[tuple[int, str]] = []
    end = stop.at - len(stop.before) - 1
    while end >= 0 and len(found) < most:
        start = stop.text.rfind("\n", 0, end) + 1
        line = stop.text[start:end].rstrip("\r")
        if line.strip() and not line.lstrip().startswith("#"):
            found.append((start, line))
        end = start - 1
    return found


_ITEM = re.compile(r"([ ]*)- +([^\W\d][\w.-]*):")
"""The line of an item with a name, such as a state."""


class _Item(NamedTuple):
    """An item of a list that is open: its column, name and index in the text."""

    column: int
    name: str
    start: int


def _open_items(stop: _Stop) -> list[_Item]:
    """The last item of each list that is open above a line, the innermost first."""
    found: list[_Item] = []
    least: int | None = None
    for start, line in _lines_above(stop, len(stop.text)):
        indent = _indent(line)
        if least is not None and indent >= least:
            continue
        least = indent
        item = _ITEM.match(line)
        if item is not None:
            found.append(_Item(indent, item[2], start + indent))
    return found


def _column_below(stop: _Stop, column: int) -> int | None:
    """The column of the next item below one at `column` that is not inside it."""
    for line in stop.text[line_end(stop.text, stop.at) :].split("\n"):
        if line.strip() and _indent(line) <= column:
            return _indent(line) if line.lstrip().startswith("- ") else None
    return None


def line_end(text: str, index: int) -> int:
    end = text.find("\n", index)
    return len(text) if end < 0 else end


def _misindented(stop: _Stop) -> _Fault | None:
    """The fault of an item with a name that is not indented like those of an open list."""
    here = _ITEM.match(stop.text, stop.at - len(stop.before))
    opened = _open_items(stop)
    if here is None or stop.before.strip() or not opened:
        return None
    column, name = len(here[1]), here[2]
    columns = [item.column for item in opened]
    if column in columns:
        return None
    below = _column_below(stop, column)
    first = opened[0]
    if first.column != column == below and _is_alone(stop, first):
        message = f"`- {first.name}:` is indented by {of_spaces(first.column)}, the items after it"
        end = first.start + len(first.name) + 3
        return _Fault(f"{message} by {column}", _shift(column, name), first.start, end)
    due = min(
        opened, key=lambda item: (abs(item.column - column), item.column != below, -item.column)
    )
    around = next((item.name for item in opened if item.column < due.column), "")
    owner = f"of `{around}`" if around else "of the script"
    message = f"`- {name}:` is indented by {of_spaces(column)}, the items {owner} by {due.column}"
    return _Fault(message, _shift(due.column, due.name), stop.at, stop.at + len(name) + 3)


def _shift(column: int, like: str) -> str:
    """The help for an item at a wrong column. `like` is the name of an item at the right one."""
    if not column:
        return f"write it and the lines below it without indentation, like `- {like}:`"
    return f"indent it and the lines below it by {of_spaces(column)}, like `- {like}:`"


def of_spaces(number: int) -> str:
    return f"{number} space{'s' * (number != 1)}"


def _is_alone(stop: _Stop, item: _Item) -> bool:
    """Whether an item is the first of its list."""
    above = stop._replace(at=item.start, before=" " * item.column)
    lines = _lines_above(above, 1)
    return bool(lines) and _indent(lines[0][1]) < item.column and lines[0][1].rstrip().endswith(":")


def _key_above(stop: _Stop) -> tuple[int, str] | None:
    """The column and the name of the open key above a line with the nearest column."""
    column, found = len(stop.before), []
    least: int | None = None
    for _, line in _lines_above(stop, len(stop.text)):
        dashes = re.match(r"[ ]*(?:-[ ]+)*", line)
        assert dashes is not None
        word = _WORD.match(line, dashes.end())
        if least is None or _indent(line) < least:
            least = _indent(line)
            if word is not None:
                found.append((dashes.end(), word[0]))
    return min(found, key=lambda key: (abs(key[0] - column), -key[0])) if found else None


_EQUALLY = "indent the items of one list equally, below the key of the list"


def _indentation(stop: _Stop) -> _Fault | None:
    """A line whose indentation is that of no other."""
    entries = stop.problem.startswith("block sequence entries are not allowed")
    if stop.is_block_end or entries:
        first = _first_dash(stop) if stop.text.startswith("- ", stop.at) else None
        if first is not None:
            return first
        misindented = _misindented(stop)
        if misindented is not None:
            return misindented
    if stop.is_block_end and stop.sign == "-" and not stop.is_deeper_list:
        return _Fault("a list item cannot follow the keys of a mapping", _EQUALLY, stop.at)
    if stop.is_block_end and stop.sign == ":":
        return _Fault("a name is missing before this `:`", _NAME_BEFORE, stop.at)
    if entries:
        help = "write each item on a line of its own, below the key of the list"
        return _Fault("a list item is not allowed here", help, stop.at)
    outermost = stop.problem == _NO_DOCUMENT
    if not outermost and not stop.is_block_end:
        return None
    indented = stop.text.lstrip("\n").startswith(" ")
    if stop.before.strip() or (outermost and not indented):
        help = "put the whole value in quotes, or remove the text"
        return _Fault("there is text after the end of the value", help, stop.at)
    if stop.is_deeper_list:
        return _item(stop)
    if stop.text.startswith("-", stop.at):
        word = _WORD.match(stop.text, stop.at + 1)
        name = f"`- {word[0]}`" if word is not None else "`- ...`"
        name = f"`- {word[0]}:`" if _STATE.match(stop.text, stop.at) is not None and word else name
        return _Fault("a space is missing after this `-`", f"write {name}", stop.at)
    state = _lost_dash(stop)
    if state is not None:
        return state
    if stop.problem == _NO_ITEM and len(stop.before) == stop.first_column:
        help = "indent it like the key of the list, or begin it with `- ` as an item"
        return _Fault("a key cannot follow the items of a list", help, stop.at)
    message = "the indentation of this line is that of no mapping or list above it"
    like = _key_above(stop)
    help = "indent the keys of one mapping equally"
    if like is not None and _WORD.match(stop.text, stop.at) is not None:
        help = f"indent it by {of_spaces(like[0])}, like `{like[1]}`"
    return _Fault(message, help, stop.at)


_STATE = re.compile(r"(-?)([A-Z][\w.-]*):[ \t]*(?:\{.*)?")


def _lost_dash(stop: _Stop) -> _Fault | None:
    """A state that follows the items of a list and has no `- `."""
    start = stop.at - len(stop.before)
    line = stop.text[start : line_end(stop.text, start)].rstrip()
    found = _STATE.fullmatch(line.strip())
    if found is None or found[1] or found[2] in VARIABLES:
        return None
    like = next((item for item in _open_items(stop) if item.column == _indent(line)), None)
    if like is None:
        return None
    begin = start + _indent(line)
    message = f"a `- ` is missing before `{found[2]}:`"
    help = f"write `- {found[2]}:`, like `- {like.name}:`"
    return _Fault(message, help, begin, begin + len(found[2]) + 1)


def _first_dash(stop: _Stop) -> _Fault | None:
    """The first state of a list, which has no `- ` or no space after it, above a state that has."""
    for start, line in _lines_above(stop, _MOST_TEXT):
        found = _STATE.fullmatch(line.strip())
        indent, column = _indent(line), len(stop.before)
        if indent < column:
            return None
        if found is None or indent not in (column, column + 2):
            continue
        begin = start + indent
        message = f"a `- ` is missing before `{found[2]}:`"
        if found[1]:
            message = "a space is missing after this `-`"
        like = _ITEM.match(stop.text, stop.at - len(stop.before))
        beside = f", like `- {like[2]}:`" if like is not None else ""
        help = f"write `- {found[2]}:`{beside}"
        return _Fault(message, help, begin, begin + len(found[0]))
    return None


def _item(stop: _Stop) -> _Fault:
    """The fault of a list item that is indented more or less than the items above it."""
    column = len(stop.before)
    if stop.context == "while parsing a block collection":
        more = "more"
        due: int | None = stop.first_column
    else:
        more, due = "less", _closed_list(stop, column)
    if due is None:
        return _Fault("a list item is not allowed here", _EQUALLY, stop.at)
    message = f"this item is indented {more} than the items above it"
    spaces = f"{due} space{'s' * (due != 1)}"
    help = f"indent it by {spaces} like them" if due else "write it without indentation like them"
    return _Fault(message, help, stop.at)


def _closed_list(stop: _Stop, column: int) -> int | None:
    """The column of the list that ends above an item at `column`, which is to the left of it."""
    nearest: int | None = None
    for _, line in _lines_above(stop, len(stop.text)):
        indent = len(line) - len(line.lstrip())
        if indent <= column:
            break
        if line.lstrip().startswith("- "):
            nearest = indent if nearest is None else min(nearest, indent)
    return nearest


def _spaces(stop: _Stop) -> str:
    """The help for a tab: the spaces to write in its place."""
    above = next((line for _, line in _lines_above(stop, 1)), "")
    due = len(above) - len(above.lstrip()) + 2 * above.rstrip().endswith(":")
    word = _WORD.search(above)
    beside = f", below `{word[0]}`" if word is not None else ""
    if not due:
        return f"remove the tab: begin the line in the first column{beside}"
    return f"{_NO_TAB} {due} spaces{beside}"


_NO_TAB = "write spaces in place of the tab: begin the line with"


_NAME_BEFORE = "write the name before the `:`, or put text that begins with `:` in quotes"
_QUOTED = "put the value in quotes"


def _in_quotes(stop: _Stop, start: int) -> str:
    """The help for a value that needs quotes, with the value up to the end of its line."""
    line = stop.text[start : line_end(stop.text, start)].partition(" #")[0].rstrip()
    item = re.fullmatch(r"[*+@] *([A-Z]\w*):", line)
    if item is not None:
        return f"write `- {item[1]}:`: an item of a list begins with `- `"
    plain = len(line) <= _LONGEST_VALUE and not set(line) & set("'\"[]{},")
    return f"put the value in quotes: `'{line}'`" if plain else _QUOTED


_LONGEST_VALUE = 60
_TEXT_BESIDE = "did not find expected comment or line break"


def _value(stop: _Stop) -> _Fault | None:
    """A value that does not begin, or has a part, as YAML requires."""
    here = stop.text[stop.at : stop.at + 1]
    if stop.problem in (_NOT_A_START, *_TABS):
        if here == "\t":
            due = lost_of_block_text(stop.text, stop.at)
            help = f"{_NO_TAB} {of_spaces(due)}" if due is not None else _spaces(stop)
            return _Fault("YAML does not allow a tab in the indentation", help, stop.at)
        message = f"a value cannot begin with `{here}`"
        return _Fault(message, _in_quotes(stop, stop.at), stop.at)
    in_brackets = stop.context == "while parsing a flow node"
    if in_brackets and stop.sign == ",":
        return _Fault(
            "a value is missing before this `,`", "write the value, or remove the `,`", stop.at
        )
    if in_brackets and stop.sign == ":":
        return _Fault("a name is missing before this `:`", _NAME_BEFORE, stop.at)
    if in_brackets and not stop.sign:
        help = "close each `[` with `]`, and each `{` with `}`"
        return _Fault("the text ends inside brackets", help, stop.at)
    if in_brackets and stop.sign == "-":
        help = "write `[a, b]`, or write each item on a line of its own without the brackets"
        return _Fault("a list in brackets has no `-`", help, stop.at)
    if stop.problem == _NO_NODE and stop.sign == ",":
        return _Fault("a value cannot begin with `,`", _QUOTED, stop.at)
    if stop.context in ("while scanning an alias", "while scanning an anchor"):
        start = stop.at if stop.first is None else stop.first
        message = f"a value cannot begin with `{stop.text[start]}`"
        return _Fault(message, _in_quotes(stop, start), start)
    if stop.problem.startswith("mapping keys are not allowed") or (in_brackets and here == "?"):
        return _Fault("`?` is not allowed here", "put text that begins with `?` in quotes", stop.at)
    if stop.problem == _NO_NODE:
        return _Fault("a value is missing here", "write the value, or put it in quotes", stop.at)
    if stop.problem == _NO_ESCAPE:
        help = f"write `\\\\{here}`, or put the text in single quotes"
        return _Fault(f"unknown escape character `{here}`", help, stop.at)
    if stop.context == "while scanning a block scalar" and stop.problem == _TEXT_BESIDE:
        message = "the text cannot begin in the line of its `|` or `>`"
        return _Fault(message, "begin the text in the next line, indented", stop.at)
    return None


_NAME_BEFORE_SIGN = re.compile(r"(?:^|[\s\[{,])([&*])([\w-]+)$", re.ASCII)


def _anchor(stop: _Stop) -> _Fault | None:
    """A character in the name of an anchor or an alias at which its name ends for libyaml."""
    before = _NAME_BEFORE_SIGN.search(stop.before)
    whole = None if before is None else _ANCHOR.match(stop.text, stop.at - len(before[2]) - 1)
    if whole is None or whole.end() <= stop.at + (stop.sign == ":"):
        return None
    return _anchor_name(whole)


_ESCAPE = re.compile(r"\\[xuU][0-9A-Fa-f]{0,8}")
_SURROGATES = re.compile(r"\\u([dD][89abAB][0-9a-fA-F]{2})\\u([dD][c-fC-F][0-9a-fA-F]{2})")
"""The two escapes with which JSON writes one character beyond U+FFFF."""

_NO_CHARACTER = (
    "found invalid Unicode character escape code",
    "did not find expected hexdecimal number",
)


def _other_parts(stop: _Stop) -> _Fault | None:
    """Parts of YAML that scripts seldom have: directives, tags, escapes, ends of documents."""
    start = stop.at if stop.first is None else stop.first
    escape = _ESCAPE.match(stop.text, max(0, stop.at - 2))
    pair = _SURROGATES.match(stop.text, max(0, stop.at - 2))
    if pair is not None:
        high, low = (int(digits, 16) for digits in pair.groups())
        code = 0x10000 + ((high - 0xD800) << 10) + (low - 0xDC00)
        message = f"`{pair[0]}` is one character in JSON, and no character in YAML"
        return _Fault(message, f"write `\\U{code:08X}`, or the character itself", *pair.span())
    if stop.problem in _NO_CHARACTER and escape is not None:
        last = escape[0].startswith("\\U") and not escape[0].startswith(("\\U000", "\\U0010"))
        message = f"`{escape[0]}` is no character" + ": the last one is \\U0010FFFF" * last
        return _Fault(message, "correct the number", *escape.span())
    if stop.problem == "found an indentation indicator equal to 0":
        return _Fault("the number after `|` or `>` is 1 to 9", "remove the number", stop.at)
    if stop.problem == "found unexpected document indicator":
        message = "this quote is not closed before the line that ends the document"
        return _Fault(message, "write the same quote at the end of the text", start)
    if stop.text.startswith("%", start):
        message = "a line that begins with `%` is a directive of YAML"
        return _Fault(message, "remove the line: a script needs no directive", start)
    if stop.text.startswith("!", start):
        return _Fault("a value cannot begin with `!`", _in_quotes(stop, start), start)
    return None


_READERS = (
    *(_conflict, _space, _block_text, _anchor, _unclosed_or_unopened),
    *(_colon, _indentation, _value, _other_parts),
)
"""The searches for the cause of a syntax error; the first one that finds it decides."""
