"""Slips in code that Python rejects: words and signs of other languages, and missing signs."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import NamedTuple

from smachac.diagnostics.spelling import guesser_of
from smachac.ir.python_code import TooDeepError, parse_code
from smachac.ir.script_code import script_code


class Slip(NamedTuple):
    """The characters `start` to `end` of code are no Python. `what` is the fault and `help` the
    cure, as in messages; `cure` is the text that replaces them, None if it is not certain."""

    start: int
    end: int
    what: str
    help: str = "write a value, or a function such as `lambda ud: ud.n + 1`"
    cure: str | None = None


CONSTANTS: Mapping[str, str] = {
    **dict.fromkeys(("true", "TRUE"), "True"),
    **dict.fromkeys(("false", "FALSE"), "False"),
    **dict.fromkeys(("null", "none", "nil", "undefined", "nullptr", "NULL"), "None"),
}
"""Constants of other languages, with those of Python."""

_TOKEN = re.compile(
    r"""(?P<text>'(?:[^'\\\n]|\\.)*'|"(?:[^"\\\n]|\\.)*")|(?P<name>[^\W\d]\w*)|(?P<number>\d[\w.]*)
    |(?P<sign>&&|\|\||===|!==|=>|->|\+\+|--|<>|(?://|\*\*|>>|<<)=|[-+*/%&|^@=!<>:]=|//|\*\*|\S)""",
    re.VERBOSE | re.DOTALL,
)

_SIGNS: Mapping[str, tuple[str, str]] = {
    "&&": ("and", "Python writes `and`"),
    "||": ("or", "Python writes `or`"),
    "!": ("not", "Python writes `not`"),
    "===": ("==", "Python writes `==`"),
    "!==": ("!=", "Python writes `!=`"),
    "<>": ("!=", "Python writes `!=`"),
}
"""Signs of other languages: what Python has instead, and the message."""

_ASSIGNMENTS = ("+=", "-=", "*=", "/=", "%=", "//=", "**=", "&=", "|=", "^=", ":=")
_STATEMENTS = ("return", "def", "if", "for", "while", "del", "import", "pass", "raise")
_PAIRS: Mapping[str, str] = {"(": ")", "[": "]", "{": "}"}
_OPEN = {close: opening for opening, close in _PAIRS.items()}
_WORDS = ("and", "or", "not", "in", "is", "if", "else")
_OPERATORS = frozenset([*"+-*/%<>.,", "//", "**", "<=", ">=", "==", "!=", *_WORDS])
_BETWEEN = frozenset([*_WORDS, "for", "lambda", "await", "async"])


class _Token(NamedTuple):
    kind: str
    text: str
    start: int
    end: int


def slips(text: str, *, compares: bool = False) -> list[Slip]:
    """The slips in code that Python rejects, in the order of the text; at least one. `compares`:
    the code is a condition, so that `=` can only be a comparison."""
    error = _error(text)
    if isinstance(error, TooDeepError):
        return [Slip(0, len(text), str(error))]
    tokens = [
        _Token(found.lastgroup or "", found[0], *found.span()) for found in _TOKEN.finditer(text)
    ]
    found = sorted([*_misspelt_lambdas(tokens), *_signs(tokens, compares)])
    found = found or [*_statements(tokens)] or [*_brackets(tokens)] or [*_gaps(tokens)]
    reason = error.msg.lower() if error is not None else ""
    return found or [Slip(0, len(text), reason or "invalid syntax")]


def corrected(text: str, found: list[Slip]) -> str | None:
    """The code without its slips, if all of them have a certain cure and Python accepts it."""
    for slip in reversed(found):
        if slip.cure is None:
            return None
        text = text[: slip.start] + slip.cure + text[slip.end :]
    return text if script_code(text).tree is not None else None


def _spaced(tokens: list[_Token], at: int, word: str) -> str:
    """A word instead of a token, with spaces where other words touch it."""
    here = tokens[at]
    left = at > 0 and tokens[at - 1].end == here.start and _ends(tokens[at - 1])
    right = at + 1 < len(tokens) and tokens[at + 1].start == here.end
    return f"{' ' * left}{word}{' ' * right}"


def _signs(tokens: list[_Token], compares: bool) -> Iterator[Slip]:
    """Signs that Python does not have, or not in an expression."""
    depth = 0
    for at, (_, text, start, end) in enumerate(tokens):
        depth += (text in _PAIRS) - (text in _OPEN)
        if text in _SIGNS:
            word, what = _SIGNS[text]
            cure = _spaced(tokens, at, word) if word.isalpha() else word
            yield Slip(start, end, what, f"write `{word}` instead of `{text}`", cure)
        elif text == "=" and not _names_an_argument(tokens, at):
            what = "`=` assigns, which is not allowed here"
            help = "return the new value: its key receives it; `==` compares"
            if compares:
                help = "compare with `==`"
            yield Slip(start, end, what, help, "==" if compares else None)
        elif text in _ASSIGNMENTS and not (text == ":=" and depth):
            operation = text[:-1] if text != ":=" else "+"
            what = f"`{text}` assigns, which is not allowed here"
            help = f"return the new value, as in `lambda ud: ud.n {operation} 1`"
            yield Slip(start, end, what, help)
        elif text in ("++", "--") and (at + 1 == len(tokens) or at == 0):
            yield Slip(start, end, f"Python has no `{text}`", f"write `{text[0]} 1`")
        elif text == "?":
            help = "write `a if condition else b` for `condition ? a : b`"
            yield Slip(start, end, "Python has no `? :`", help)
        elif text in ("->", "=>"):
            yield _arrow(tokens, at)
        elif text == ";":
            yield Slip(start, end, "`;` separates statements", "write one expression")


def _names_an_argument(tokens: list[_Token], at: int) -> bool:
    """Whether `=` stands between the name of an argument and its value."""
    if at < 2 or tokens[at - 1].kind != "name":
        return False
    return tokens[at - 2].text in ("(", ",", "lambda", "*")


def _arrow(tokens: list[_Token], at: int) -> Slip:
    """`->` or `=>`: of a function, or of an attribute in C++."""
    _, text, start, end = tokens[at]
    if tokens[0].text == "lambda" and not any(token.text == ":" for token in tokens[:at]):
        what = f"the arguments of a lambda end with `:`, not with `{text}`"
        return Slip(start, end, what, "write `lambda ud: ...`")
    if text == "->":
        return Slip(start, end, "Python writes `.` for an attribute", "write `.`", ".")
    what, help = "Python writes a function with `lambda`", "write `lambda ud: ...`"
    return Slip(start, end, what, help)


def _statements(tokens: list[_Token]) -> Iterator[Slip]:
    """A statement where an expression is required."""
    for at, (_, text, start, end) in enumerate(tokens):
        if text in _STATEMENTS and (at == 0 or tokens[at - 1].text == ":"):
            what = f"`{text}` begins a statement, and code in a script is an expression"
            help, cure = "write the value only, as in `lambda ud: ud.n + 1`", None
            if text == "return" and at + 1 < len(tokens):
                cure, end = "", tokens[at + 1].start
            elif text == "if":
                help = "write `a if condition else b`"
            elif text == "def":
                help = "write a lambda, or define the function in a template and write its name"
            yield Slip(start, end, what, help, cure)
            return


def _misspelt_lambdas(tokens: list[_Token]) -> Iterator[Slip]:
    """Names that are nearly `lambda`, each where a value begins and before an argument."""
    for at, (token, after) in enumerate(pairwise(tokens)):
        starts = at == 0 or not _ends(tokens[at - 1])
        has_argument = after.kind == "name" or (after.text == ":" and at == 0)
        if token.kind != "name" or token.text == "lambda" or not (starts and has_argument):
            continue
        if guesser_of(("lambda",)).unique_match(token.text) is not None:
            what = f"Python has no `{token.text}`"
            yield Slip(token.start, token.end, what, "did you mean `lambda`?", "lambda")


def _brackets(tokens: list[_Token]) -> Iterator[Slip]:
    """The first quote or bracket without its counterpart."""
    opened: list[_Token] = []
    for token in tokens:
        text, start, end = token.text, token.start, token.end
        if text in ("'", '"'):
            yield Slip(start, end, "this quote is not closed", f"write {text} at the end as well")
            return
        if text in _PAIRS:
            opened.append(token)
        elif text in _OPEN:
            if not opened:
                what = f"`{text}` closes no `{_OPEN[text]}`"
                yield Slip(start, end, what, f"remove it, or write the `{_OPEN[text]}`")
                return
            due = _PAIRS[opened[-1].text]
            if text != due:
                what = f"`{text}` cannot close `{opened[-1].text}`"
                outer = any(_PAIRS[token.text] == text for token in opened)
                help = f"write `{due}` before this `{text}`" if outer else f"write `{due}`"
                yield Slip(start, end, what, help)
                return
            opened.pop()
    for _, text, start, end in opened[-1:]:
        help = f"write the `{_PAIRS[text]}`"
        yield Slip(start, end, f"`{text}` is not closed", help)


def _gaps(tokens: list[_Token]) -> Iterator[Slip]:
    """A place where an operand, an operator or a colon is missing."""
    if tokens and tokens[-1].text in _OPERATORS:
        _, text, start, end = tokens[-1]
        help = f"write the value after `{text}`, or remove `{text}`"
        yield Slip(start, end, f"nothing follows `{text}`", help)
        return
    if tokens and tokens[0].text == "lambda" and not any(token.text == ":" for token in tokens):
        what, help = (
            "the `:` after the arguments of the lambda is missing",
            "write `lambda ud: ...`",
        )
        yield Slip(tokens[0].start, tokens[0].end, what, help)
        return
    for before, after in pairwise(tokens):
        if _ends(before) and _begins(after):
            what = f"there is no operator between `{before.text}` and `{after.text}`"
            help = "write an operator, such as `+`, `and` or `==`, or remove one of them"
            if before.kind == "number" and after.kind == "name":
                help = f"remove `{after.text}`: a number in code has no unit"
            yield Slip(after.start, after.end, what, help)
            return


def _ends(token: _Token) -> bool:
    """Whether a value ends with a token."""
    if token.kind == "name":
        return token.text not in _BETWEEN
    return token.kind in ("number", "text") or token.text in _OPEN


def _begins(token: _Token) -> bool:
    """Whether a value can only begin with a token."""
    return token.kind in ("name", "number", "text") and token.text not in _BETWEEN


def _error(text: str) -> SyntaxError | None:
    """The reason of Python."""
    try:
        parse_code(text)
    except SyntaxError as error:
        return error
    return None


def texts_of(node: ast.expr) -> tuple[str, ...]:
    """The texts that an expression can be, if it is a text or a choice of texts; none of any
    other."""
    match node:
        case ast.Constant(value=str(text)):
            return (text,)
        case ast.IfExp(body=one, orelse=other):
            left, right = texts_of(one), texts_of(other)
            return (*left, *right) if left and right else ()
    return ()
