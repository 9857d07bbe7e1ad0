"""Code for Python 2, as that of ROS before Noetic is: read with the fixers of `fissix` that keep
lines. Places are those of lines, because columns can change.

`fissix` (PyPI, the extra `python2`) is lib2to3, which Python 3.13 no longer has.
"""

from __future__ import annotations

import ast
import re
from importlib.util import find_spec

from smachac.diagnostics.source import Source, Span
from smachac.ir.python_code import parse_module
from smachac.pysource.source import PythonText, is_readable
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
class LinesOfText(PythonText):
    """A text whose tree is that of another one with the same lines: places are whole lines."""

    def span(self, node: ast.stmt | ast.expr) -> Span:
        line = self.source.line(node.lineno)
        start = self.source.line_starts[node.lineno - 1] + len(line) - len(line.lstrip())
        return Span(self.source, start, start + max(len(line.strip()), 1))

    def offset(self, line: int, column: int) -> int:
        length = len(self.source.line(line))
        return self.source.line_starts[line - 1] + min(column, length)


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
    text = _TABS.sub(lambda found: found.group().expandtabs(8), source.text)
    try:
        tree = parse_module(text)
        if text == source.text:  # Python 3 refuses it, but not because of its tabs
            return None
    except SyntaxError:
        converted = _converted(text)
        if converted is None or converted.count("\n") != text.count("\n"):
            return None
        try:
            tree = parse_module(converted)
        except (SyntaxError, RecursionError, MemoryError):
            return None
    except (RecursionError, MemoryError):
        return None
    return LinesOfText(source=source, tree=tree)


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
