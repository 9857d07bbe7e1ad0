"""Python as it stands in files of the user, parsed with `ast` and never run.

In a template, what Jinja fills in is a name of the same length here, so that places stay what they
are, and nothing is said of what it touches. Code that cannot be read is not judged.
"""

from __future__ import annotations

import ast
import re
import warnings
from dataclasses import dataclass

from smachac.source import Source, Span

LONGEST = 200_000
"""Characters of the longest text that is read."""

_JINJA = re.compile(r"\{#.*?#\}|\{%.*?%\}|\{\{.*?\}\}", re.DOTALL)
_RAW = re.compile(r"\{%[-+]?\s*raw\b")
_NOT_PORTABLE_LINES = re.compile(r"\r(?!\n)|[\f\v]")


@dataclass(frozen=True, slots=True, kw_only=True)
class PythonText:
    """A text with its tree; `filled` are the stretches that Jinja fills in."""

    source: Source
    tree: ast.Module
    filled: tuple[tuple[int, int], ...] = ()

    def span(self, node: ast.stmt | ast.expr) -> Span:
        start = self.offset(node.lineno, node.col_offset)
        end = self.offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
        return Span(self.source, start, end)

    def offset(self, line: int, column: int) -> int:
        """The offset in characters of a column in bytes of UTF-8, as `ast` counts them."""
        before = self.source.line(line).encode("utf-8", "surrogatepass")[:column]
        return self.source.line_starts[line - 1] + len(before.decode("utf-8", "surrogatepass"))

    def is_filled(self, span: Span) -> bool:
        return bool(self.fillings(span))

    def fillings(self, span: Span) -> list[str]:
        """The pieces of Jinja that touch a stretch."""
        return [
            self.source.text[start:end]
            for start, end in self.filled
            if start < span.end and end > span.start
        ]


def python_text(source: Source, *, template: bool) -> PythonText | None:
    """A text of Python, or None where it cannot be read. Raises RecursionError and MemoryError
    for what is nested too deeply."""
    text = source.text
    if len(text) > LONGEST or _NOT_PORTABLE_LINES.search(text):
        return None
    filled: tuple[tuple[int, int], ...] = ()
    if template:
        if _RAW.search(text):
            return None
        filled = tuple(found.span() for found in _JINJA.finditer(text))
        text = _JINJA.sub(_stand_in, text)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            return PythonText(source=source, tree=ast.parse(text), filled=filled)
    except (SyntaxError, ValueError):
        return None


def _stand_in(found: re.Match[str]) -> str:
    """A name for a value, space for the rest; of the same length and number of lines."""
    text = found.group()
    return re.sub(r"[^\n]", "_" if text.startswith("{{") else " ", text)
