"""Texts of the user in Python: parsed with `ast`, never run.

In a template, each expression of Jinja is replaced by a name of the same length, so that positions
stay the same; code that contains one is not analysed, nor is code that cannot be parsed.
"""

from __future__ import annotations

import ast
import re
import warnings

from smachac.diagnostics.source import Source, Span, Word
from smachac.ir.python_code import TooDeepError, parse_module
from smachac.pysource.modules.jinja_tags import meta_block, replaced, tags
from smachac.records import dataclass

ASSIGNED = "Maybe you meant '==' instead of '='?"
"""The end of the message of Python for `=` in a comparison."""

LONGEST = 1_000_000
"""The longest text that is read, in characters."""

_RAW = re.compile(r"\{%[-+]?\s*raw\b")
_NOT_PORTABLE_LINES = re.compile(r"\r(?!\n)")


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonText:
    """A text with its tree; `filled` are the ranges that Jinja replaces."""

    source: Source
    tree: ast.Module
    filled: tuple[tuple[int, int], ...] = ()

    def span(self, node: ast.stmt | ast.expr) -> Span:
        start = self.offset(node.lineno, node.col_offset)
        end = self.offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
        return Span(self.source, start, end)

    def offset(self, line: int, column: int) -> int:
        """The offset in characters of a column in bytes of UTF-8, as `ast` counts them."""
        start, text = self.source.line_starts[line - 1], self.source.line(line)
        if text.isascii():
            return start + min(column, len(text))
        before = text.encode("utf-8", "surrogatepass")[:column]
        return start + len(before.decode("utf-8", "surrogatepass"))

    def is_filled(self, span: Span) -> bool:
        return bool(self.fillings(span))

    def fillings(self, span: Span) -> list[str]:
        """The ranges of Jinja that overlap a range."""
        return [
            self.source.text[start:end]
            for start, end in self.filled
            if start < span.end and end > span.start
        ]


def is_readable(text: str) -> bool:
    """Whether a text is short enough, and its lines are the same for Python and for `Source`."""
    return len(text) <= LONGEST and not _NOT_PORTABLE_LINES.search(text)


def python_text(source: Source, *, template: bool, compiled: bool = True) -> PythonText | None:
    """A text of Python; None if it is not valid, or nested too deeply. `compiled`: nor if it has
    `await` outside `async` or `return` outside a function."""
    text = source.text
    if not is_readable(text):
        return None
    filled: tuple[tuple[int, int], ...] = ()
    if template:
        if _RAW.search(text):
            return None
        filled = tuple(tags(text))
        text = _without_meta(text)
        text = replaced(text, iter(filled), {"{{": "_"})  # a name in place of an expression
        text = _with_statements(text, source.text, filled)
    try:
        tree = parse_module(text)
        if compiled and not template:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", SyntaxWarning)
                compile(tree, "", "exec", dont_inherit=True)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    return PythonText(source=source, tree=tree, filled=filled)


def _without_meta(template: str) -> str:
    """A template in which the text of its meta block, which is YAML, is blank."""
    found = meta_block(template)
    if found is None:
        return template
    blank = re.sub(r"[^\n]", " ", template[found[1] : found[2]])
    return template[: found[1]] + blank + template[found[2] :]


def _with_statements(text: str, template: str, filled: tuple[tuple[int, int], ...]) -> str:
    """The Python of a template in which each tag that begins a line with code is a statement, so
    that the code behind it is not indented: `{% block body %}{{ add("Say") }}`."""
    parts, done, before = [], 0, 0
    for start, end in filled:
        begins = not before or "\n" in text[before:start]
        before = end
        if not begins or not template.startswith("{%", start):
            continue
        first, last = text.rfind("\n", 0, start) + 1, text.find("\n", end)
        rest = text[end : last if last >= 0 else None]
        inside = rest.lstrip().startswith((",", ")", "]", "}"))  # code between brackets
        if rest.strip() and not inside and not text[first:start].strip():
            parts += [text[done:start], "_;"]
            done = start + 2
    return "".join([*parts, text[done:]])


def is_too_deep(text: str) -> bool:
    """Whether code can be valid Python, but is nested too deeply to be read."""
    if not is_readable(text):
        return False
    try:
        parse_module(text)
    except TooDeepError:
        return True
    except SyntaxError:
        return False
    return False


def syntax_error(source: Source) -> Word | None:
    """The first syntax error of a text, with the message of the parser; None if there is none."""
    text = source.text
    if not is_readable(text):
        return None
    try:
        parse_module(text)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            compile(text, "", "exec", dont_inherit=True)
    except SyntaxError as error:
        line = min(max(error.lineno or 1, 1), len(source.line_starts))
        length = len(source.line(line))
        column = min(max((error.offset or 1) - 1, 0), length)
        end = min(column + 1, length)
        if error.end_lineno == line and error.end_offset is not None:
            end = max(end, min(error.end_offset - 1, length))
        sign = source.line(line).find("=", end)
        if error.msg.endswith(ASSIGNED) and sign >= 0:
            column, end = sign, sign + 1
        start = source.line_starts[line - 1]
        span = Span(source, start + column, min(start + end, len(text)))
        return Word(error.msg, span)
    except (RecursionError, MemoryError):
        return None
    return None


def name_span(text: PythonText, node: ast.ClassDef | ast.FunctionDef) -> Span:
    """The place of the name in a definition."""
    span = text.span(node)
    at = max(span.source.text.find(node.name, span.start), span.start)
    return Span(span.source, at, at + len(node.name))
