"""Code of the user in Python, parsed with Python's own parser and never run; its depth is bounded.

Everything that reads such code can follow its tree by recursion. All code that is parsed passes
through this module: a bound that each reader keeps for itself would be forgotten by one of them.
"""

from __future__ import annotations

import ast
import math
import re
import warnings

DEEPEST = 200
"""The most levels of the syntax tree of an expression."""

DEEPEST_MODULE = 500
"""The most levels of the syntax tree of a module, which can be a program with such expressions."""

MOST_OPERATIONS = 2_000
"""The most operators, calls and names that can be in one another: Python's parser reads
`a.b.b ...` without a limit of its own."""

_TEXT = (
    r"(?:'''(?:[^\\]|\\.)*?'''|'(?:[^'\\\n]|\\.)*'"
    r'|"""(?:[^\\]|\\.)*?"""|"(?:[^"\\\n]|\\.)*")'
)
_TOKEN = re.compile(
    rf"(?P<skipped>\#[^\n]*|\\\n|\d[\w.]*|[rRbBuU]{{0,2}}{_TEXT})|(?P<format>[fFrR]{{1,2}}{_TEXT})"
    r"|(?P<open>[(\[{])|(?P<close>[)\]}])|(?P<end>[,;\n])|(?P<part>\w+|[^\w\s])",
    re.DOTALL,
)
_LONG_TOKEN = re.compile(
    rf"(?P<skipped>\#[^\n]*|\\\n)|(?P<text>{_TEXT})|(?P<open>[(\[{{])|(?P<close>[)\]}}])"
    r"|(?P<end>[,;\n])|(?P<part>[^()\[\]{},;\n#'\"\\]+|['\"\\])",
    re.DOTALL,
)
"""As _TOKEN, but a part is as long as possible."""
_PART = re.compile(r"\w+|[^\w\s]")
_PREFIXES = frozenset("fFrR")
"""The letters before a text that is an f-string, or can be one."""


class TooDeepError(SyntaxError):
    """Code is nested deeper than its limit; the message has the limit."""


def parse_module(text: str) -> ast.Module:
    """The syntax tree of a module. Raises SyntaxError, also for code that is nested deeper than
    DEEPEST_MODULE levels or has characters that Python does not read."""
    tree = _parsed(text, "exec", DEEPEST_MODULE)
    assert isinstance(tree, ast.Module)
    return tree


def parse_code(text: str) -> ast.expr:
    """The syntax tree of an expression. Raises SyntaxError, also for code that is nested deeper
    than DEEPEST levels or has characters that Python does not read."""
    tree = _parsed(text, "eval", DEEPEST)
    assert isinstance(tree, ast.Expression)
    return tree.body


def _parsed(text: str, mode: str, deepest: int) -> ast.AST:
    too_deep = TooDeepError(f"it is nested deeper than {deepest} levels")
    is_long = len(text) > deepest  # each level takes a character or more
    if is_long and _may_have_too_many_operations(text) and _has_too_many_operations(text):
        raise too_deep
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)
            tree = ast.parse(text, mode=mode)
    except (RecursionError, MemoryError):
        raise too_deep from None
    except ValueError as error:  # NUL, a lone surrogate, `None` in full-width letters
        raise SyntaxError("it has a character that Python does not allow") from error
    if is_long and _is_deeper(tree, deepest):
        raise too_deep
    return tree


def _may_have_too_many_operations(text: str) -> bool:
    """As `_has_too_many_operations`, in a third of the time: each character counts as one."""
    around: list[int] = []
    here = inside = 0
    for found in _LONG_TOKEN.finditer(text):
        kind = found.lastgroup
        if kind == "part":
            here += found.end() - found.start()
        elif kind == "end":
            if not around or found[0] == ",":
                here = 0
        elif kind == "open":
            around.append(here)
            inside, here = inside + here, 0
        elif kind == "close" and around:
            here = around.pop()
            inside, here = inside - here, here + 1
        elif kind == "text" and text[found.start() - 1 : found.start()] in _PREFIXES:
            here += found.end() - found.start()  # code can be inside
        if inside + here > MOST_OPERATIONS:
            return True
    return False


def _has_too_many_operations(text: str) -> bool:
    """Whether more than MOST_OPERATIONS operators, calls and names can be in one another: those
    since the last comma, of a bracket and of all brackets around it."""
    around: list[int] = []
    here = inside = 0
    for found in _TOKEN.finditer(text):
        match found.lastgroup:
            case "part":
                here += 1
            case "format":  # code can be inside
                here += len(_PART.findall(found[0]))
            case "open":
                around.append(here)
                inside, here = inside + here, 0
            case "close" if around:
                here = around.pop()
                inside, here = inside - here, here + 1
            case "end" if found[0] == "," or not around:
                here = 0
        if inside + here > MOST_OPERATIONS:
            return True
    return False


def _characters(node: ast.AST) -> float:
    """The length of code that is in one line; infinite for other code."""
    if not isinstance(node, ast.stmt | ast.expr) or node.lineno != node.end_lineno:
        return math.inf
    return (node.end_col_offset or 0) - node.col_offset


def _is_deeper(tree: ast.AST, deepest: int) -> bool:
    """Whether a tree has more levels. The tree of code in one line has fewer levels than twice its
    characters and ten, so that most of it need not be searched."""
    level = [tree]
    for at in range(deepest):
        inside: list[ast.AST] = []
        shortest = (deepest - at - 10) // 2
        for node in level:
            if _characters(node) < shortest:
                continue
            for name in node._fields:  # pyflakes writes other attributes, which lead to other trees
                part = getattr(node, name, None)
                if isinstance(part, list):
                    inside += [item for item in part if isinstance(item, ast.AST)]
                elif isinstance(part, ast.AST):
                    inside.append(part)
        if not inside:
            return False
        level = inside
    return True
