"""Code for Python 2, as that of ROS before Noetic is: read with the fixers of `fissix` that keep
lines. In lines that they change, the place of a node is searched.

`fissix` (PyPI, the extra `python2`) is lib2to3, which Python 3.13 no longer has.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from importlib.util import find_spec

from smachac.diagnostics.source import Source, Span
from smachac.ir.python_code import parse_module
from smachac.pysource.modules.source import PythonText, is_readable
from smachac.records import dataclass

FIXERS = ("print", "except", "raise", "repr", "ne", "numliterals", "exec")
"""The fixers that keep lines, of constructs that Python 3 cannot parse."""

INSTALL = "run `pip install 'smachac[python2]'`, which reads code for Python 2"

_PYTHON_2 = re.compile(
    r"^[ \t]*(?:print[ \t]+[\w\"'%]|exec[ \t]+[\w\"']|raise[ \t]+[\w.]+[ \t]*,"
    r"|except[ \t]+[\w.()]+[ \t]*,[ \t]*\w+[ \t]*:)",
    re.M,
)
_FOR_PYTHON_3 = re.compile(r"#!.*\bpython3")
_TABS = re.compile(r"^[ ]*\t[ \t]*", re.M)


class NotInstalledError(Exception):
    """The package `fissix` is not installed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConvertedText(PythonText):
    """A text whose tree is that of another one with the same lines, which are `lines`. Places in a
    line that was changed are those of the same code in it, or else the whole line."""

    lines: Sequence[str]

    def span(self, node: ast.stmt | ast.expr) -> Span:
        first, last = node.lineno, node.end_lineno or node.lineno
        if self._shift(first) is not None and self._shift(last) is not None:
            # (not `super()`, which a class with slots does not have)
            return PythonText.span(self, node)
        line = self.source.line(first)
        start, code = len(line) - len(line.lstrip()), line.strip()
        if first == last:
            whole = self.lines[first - 1].encode("utf-8", "surrogatepass")
            column, end = node.col_offset, node.end_col_offset or node.col_offset
            same = whole[column:end].decode("utf-8", "replace")
            places = [found.start() for found in re.finditer(re.escape(same), line)]
            if same and places:
                start = min(places, key=lambda place: abs(place - column))
                code = same
        start += self.source.line_starts[first - 1]
        return Span(self.source, start, start + max(len(code), 1))

    def offset(self, line: int, column: int) -> int:
        return PythonText.offset(self, line, max(column - (self._shift(line) or 0), 0))

    def _shift(self, number: int) -> int | None:
        """By how many columns a line of the tree is indented more than that of the text; None for a
        line that was changed."""
        line, own = self.lines[number - 1], self.source.line(number)
        if line.strip() != own.strip():
            return None
        return (len(line) - len(line.lstrip())) - (len(own) - len(own.lstrip()))


def is_installed() -> bool:
    """Whether the package `fissix` is installed."""
    return find_spec("fissix") is not None


def looks_like_python2(source: Source) -> bool:
    """Whether a text has a statement that only Python 2 can parse."""
    return _PYTHON_2.search(source.text) is not None


def python2_text(source: Source) -> PythonText | None:
    """A text for Python 2; None if it is not valid, or if its first line names Python 3. Raises
    NotInstalledError."""
    if not is_readable(source.text) or _FOR_PYTHON_3.match(source.text):
        return None
    text = converted = _TABS.sub(lambda found: found.group().expandtabs(8), source.text)
    try:
        tree = parse_module(text)
        if text == source.text:  # Python 3 refuses it, but not because of its tabs
            return None
    except SyntaxError:
        changed = _converted(text)
        if changed is None or changed.count("\n") != text.count("\n"):
            return None
        converted = changed
        try:
            tree = parse_module(converted)
        except (SyntaxError, RecursionError, MemoryError):
            return None
    except (RecursionError, MemoryError):
        return None
    return ConvertedText(source=source, tree=tree, lines=converted.split("\n"))


def python2_error(source: Source) -> Span | None:
    """The place of the first syntax error of a text for Python 2; None if there is none, or if
    `fissix` is not installed."""
    try:
        from fissix.pgen2.parse import ParseError
        from fissix.pgen2.tokenize import TokenError
        from fissix.refactor import RefactoringTool
    except ImportError:
        return None
    try:
        RefactoringTool([]).refactor_string(f"{source.text}\n", "<text>")
    except ParseError as error:
        _, (line, column) = error.context
    except TokenError as error:
        _, (line, column) = error.args
    except IndentationError as error:
        line, column = error.lineno or 1, 0
    except (RecursionError, ValueError):
        return None
    else:
        return None
    line = min(line, len(source.line_starts))
    start = source.line_starts[line - 1] + min(column, len(source.line(line)))
    return Span(source, start, min(start + 1, len(source.text)))


def _converted(text: str) -> str | None:
    """The text for Python 3; None if it is not valid Python 2."""
    try:
        from fissix.pgen2.parse import ParseError
        from fissix.pgen2.tokenize import TokenError
        from fissix.refactor import RefactoringTool
    except ImportError:
        raise NotInstalledError from None
    tool = RefactoringTool([f"fissix.fixes.fix_{name}" for name in FIXERS])
    whole = text if text.endswith("\n") else f"{text}\n"
    try:
        converted = str(tool.refactor_string(whole, "<text>"))
    except (ParseError, TokenError, RecursionError, IndentationError, ValueError):
        return None
    return converted if text.endswith("\n") else converted.removesuffix("\n")
