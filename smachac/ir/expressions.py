"""Portable expressions: syntax tree, parser and printer.

The portable subset of Python is defined by grammars/expression.lark; interpreter/evaluator.py
evaluates it. Sections: nodes of the tree, parser, tree builder of the parser, printer.
"""

from __future__ import annotations

import ast
import keyword
import re
import unicodedata
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, TypeAlias

from smachac.diagnostics.source import assert_never
from smachac.grammars import parser_of
from smachac.records import dataclass

if TYPE_CHECKING:
    pass


LONGEST = 10_000
"""Limit on the length of an expression, in characters."""

DEEPEST = 100
"""Limit on the depth of an expression, and on the depth of its brackets."""


# The nodes are matched by position, so they are not keyword-only.
@dataclass(frozen=True, slots=True)
class Constant:
    """A literal. Numbers are not negative: `-1` is a `Unary`."""

    value: bool | int | float | str | None


@dataclass(frozen=True, slots=True)
class Name:
    """A variable or a function."""

    name: str


@dataclass(frozen=True, slots=True)
class Attribute:
    """`value.name`."""

    value: Expr
    name: str


@dataclass(frozen=True, slots=True)
class Index:
    """`value[index]`."""

    value: Expr
    index: Expr


@dataclass(frozen=True, slots=True)
class Call:
    """`function(arguments, name=keyword)`."""

    function: Expr
    arguments: tuple[Expr, ...] = ()
    keywords: tuple[tuple[str, Expr], ...] = ()


@dataclass(frozen=True, slots=True)
class Unary:
    """`operator` is `+`, `-` or `not`."""

    operator: str
    operand: Expr


@dataclass(frozen=True, slots=True)
class Binary:
    """`operator` is one of `+ - * / // % **`."""

    operator: str
    left: Expr
    right: Expr


@dataclass(frozen=True, slots=True)
class Compare:
    """`first op operand op operand ...` with `< <= > >= == !=`, `in` and `not in`."""

    first: Expr
    rest: tuple[tuple[str, Expr], ...]


@dataclass(frozen=True, slots=True)
class Boolean:
    """Two or more operands; `operator` is `and` or `or`."""

    operator: str
    operands: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class Conditional:
    """`then if test else otherwise`."""

    test: Expr
    then: Expr
    otherwise: Expr


@dataclass(frozen=True, slots=True)
class Lambda:
    """A function with one parameter or none."""

    parameter: str | None
    body: Expr


@dataclass(frozen=True, slots=True)
class ListDisplay:
    """`[items]`."""

    items: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class TupleDisplay:
    """`(items)`."""

    items: tuple[Expr, ...]


@dataclass(frozen=True, slots=True)
class DictDisplay:
    """`{key: value}`."""

    entries: tuple[tuple[Expr, Expr], ...]


Operation: TypeAlias = Unary | Binary | Compare | Boolean
Display: TypeAlias = ListDisplay | TupleDisplay | DictDisplay
Expr: TypeAlias = (
    Constant | Name | Attribute | Index | Call | Conditional | Lambda | Display | Operation
)


def parts(expr: Expr) -> tuple[Expr, ...]:
    """The direct subexpressions of an expression, in the order of the text."""
    match expr:
        case Constant() | Name():
            return ()
        case Attribute(value, _):
            return (value,)
        case Index(value, index):
            return (value, index)
        case Call(function, arguments, keywords):
            return (function, *arguments, *(value for _, value in keywords))
        case Unary(_, operand):
            return (operand,)
        case Binary(_, left, right):
            return (left, right)
        case Compare(first, rest):
            return (first, *(operand for _, operand in rest))
        case Boolean(_, operands):
            return operands
        case Conditional(test, then, otherwise):
            return (then, test, otherwise)
        case Lambda(_, body):
            return (body,)
        case ListDisplay(items) | TupleDisplay(items):
            return items
        case DictDisplay(entries):
            return tuple(part for entry in entries for part in entry)
    return assert_never(expr)


def dotted(expr: Expr) -> str | None:
    """The text of a dotted name, `math.pi`; None for any other expression."""
    words: list[str] = []
    while isinstance(expr, Attribute):
        words.append(expr.name)
        expr = expr.value
    if not isinstance(expr, Name):
        return None
    return ".".join((expr.name, *reversed(words)))


# --- parser

# File extensions: a dotted word with one of them is a file name.
_FILE = re.compile(
    r"bag|csv|dae|gif|gz|html|ini|jpe?g|json|mesh|mp4|pcd|pdf|pkl|ply|png|py|sdf|smir|srdf|stl"
    r"|svg|txt|urdf|wav|xacro|xml|ya?ml|zip",
    re.IGNORECASE,
)
_DOTTED = re.compile(r"[^\W\d]\w*(?:\.[^\W\d]\w*)+")
_CALL = re.compile(r"(?<!\w)[^\W\d]\w*\(")


def looks_like_expression(text: str) -> bool:
    """Whether an unmarked string can be code: a dotted name that is no file name, or a call at its
    end.

    A fast test before `parse_expression`.
    """
    text = text.strip()
    if text.endswith(")"):
        return _CALL.search(text) is not None
    if _DOTTED.fullmatch(text) is None:
        return False
    return _FILE.fullmatch(text.rpartition(".")[2]) is None


def parse_expression(text: str) -> Expr | None:
    """The tree of a portable expression; None if the text is not one, is too long or too deep."""
    text = text.strip()
    if len(text) > LONGEST or not _brackets_fit(text):
        return None
    from smachac.grammars.standalone.lalr import LarkError

    try:
        expr: Any = parser_of("expression", _TreeBuilder).parse(text)
    except (LarkError, ValueError, SyntaxError):
        return None
    return expr if _depth_fits(expr) else None


_BRACKETS = re.compile(
    r"'(?:[^'\\\n]|\\.)*'|\"(?:[^\"\\\n]|\\.)*\"|(?P<open>[(\[{])|(?P<close>[)\]}])|(?P<end>[\n\r])"
)


def _brackets_fit(text: str) -> bool:
    """Whether the brackets are not too deep, and line ends occur only inside brackets, as in
    Python."""
    depth = 0
    for found in _BRACKETS.finditer(text):
        kind = found.lastgroup
        depth += (kind == "open") - (kind == "close")
        if depth > DEEPEST or (kind == "end" and depth <= 0):
            return False
    return True


def _depth_fits(expr: Expr) -> bool:
    """Whether a tree has at most DEEPEST levels."""
    level: Iterable[Expr] = (expr,)
    for _ in range(DEEPEST):
        level = [part for item in level for part in parts(item)]
        if not level:
            return True
    return False


# --- tree builder of the parser

LONGEST_INTEGER = 1000
"""Limit on the length of an integer literal; Python prints at most 4300 digits."""


def _name_of(token: str) -> str:
    """A token as a name. Raises ValueError if Python reads the token as another name."""
    if keyword.iskeyword(token) or not token.isidentifier():
        raise ValueError(f"{token} is no name")
    if unicodedata.normalize("NFKC", token) != token:
        raise ValueError(f"Python reads {token} as another name")
    return str(token)


_ESCAPE = re.compile(r"\\([0-7]{1,3}|.)", re.DOTALL)
_GOOD_ESCAPE = re.compile(r"[0-3]?[0-7]{1,2}|[\\'\"abfnrtvxuUN\n]")
"""Valid escapes in a string literal; Python warns of others and will reject them."""


class _TreeBuilder:
    """The tree of each grammar rule, made from the trees of its parts."""

    def conditional(self, found: list[Any]) -> Expr:
        then, test, otherwise = found
        return Conditional(test, then, otherwise)

    def function(self, found: list[Any]) -> Expr:
        return Lambda(_name_of(found[0]) if len(found) > 1 else None, found[-1])

    def or_test(self, found: list[Any]) -> Expr:
        return Boolean("or", tuple(found))

    def and_test(self, found: list[Any]) -> Expr:
        return Boolean("and", tuple(found))

    def negation(self, found: list[Any]) -> Expr:
        return Unary("not", found[0])

    def comparison(self, found: list[Any]) -> Expr:
        return Compare(found[0], tuple(zip(found[1::2], found[2::2], strict=True)))

    def comparator(self, found: list[Any]) -> str:
        return " ".join(found)

    def binary(self, found: list[Any]) -> Expr:
        left, operator, right = found
        return Binary(str(operator), left, right)

    def unary(self, found: list[Any]) -> Expr:
        return Unary(str(found[0]), found[1])

    def attribute(self, found: list[Any]) -> Expr:
        return Attribute(found[0], _name_of(found[1]))

    def call(self, found: list[Any]) -> Expr:
        function, (positional, keywords) = found
        return Call(function, positional, keywords)

    def index(self, found: list[Any]) -> Expr:
        return Index(found[0], found[1])

    def arguments(self, found: list[Any]) -> tuple[tuple[Expr, ...], tuple[tuple[str, Expr], ...]]:
        positional = tuple(item for item in found if not isinstance(item, tuple))
        keywords = tuple(row for row in found if isinstance(row, tuple))
        if found[: len(positional)] != list(positional):
            raise ValueError("an argument by place follows one by name")
        if len({name for name, _ in keywords}) < len(keywords):
            raise ValueError("an argument is given twice")
        return positional, keywords

    def keyword(self, found: list[Any]) -> tuple[str, Expr]:
        return _name_of(found[0]), found[1]

    def tuple_display(self, found: list[Any]) -> Expr:
        return TupleDisplay(tuple(found))

    def list_display(self, found: list[Any]) -> Expr:
        return ListDisplay(tuple(found))

    def dict_display(self, found: list[Any]) -> Expr:
        return DictDisplay(tuple(found))

    def entry(self, found: list[Any]) -> tuple[Expr, Expr]:
        return found[0], found[1]

    def name(self, found: list[Any]) -> Expr:
        return Name(_name_of(found[0]))

    def integer(self, found: list[Any]) -> Expr:
        if len(found[0]) > LONGEST_INTEGER:
            raise ValueError("more digits than Python prints")
        return Constant(int(found[0], 0))

    def float(self, found: list[Any]) -> Expr:
        return Constant(float(found[0]))

    def string(self, found: list[Any]) -> Expr:
        for escape in _ESCAPE.findall(found[0]):
            if not _GOOD_ESCAPE.fullmatch(escape):
                raise ValueError("an escape that newer Pythons refuse")
        return Constant(ast.literal_eval(found[0]))

    def none(self, found: list[Any]) -> Expr:
        return Constant(None)

    def true(self, found: list[Any]) -> Expr:
        return Constant(True)

    def false(self, found: list[Any]) -> Expr:
        return Constant(False)


# --- printer

# Precedence of the forms: a part with a lower precedence than its place requires needs brackets.
_TEST, _OR, _AND, _NOT, _COMPARE, _SUM, _PRODUCT, _SIGNED, _POWER, _ITEM = range(10)
_BINDING = {"+": _SUM, "-": _SUM, "*": _PRODUCT, "/": _PRODUCT, "//": _PRODUCT, "%": _PRODUCT}


def print_expression(expr: Expr) -> str:
    """The Python text of an expression with as few brackets as possible; `parse_expression`
    reverses it."""
    return _print(expr)[0]


def _at(binding: int, expr: Expr) -> str:
    """The text of a subexpression, in brackets if its precedence is lower than `binding`."""
    text, own = _print(expr)
    return text if own >= binding else f"({text})"


def _comma(items: Iterable[Expr]) -> str:
    """Expressions, separated by commas."""
    return ", ".join(_at(_TEST, item) for item in items)


def _print(expr: Expr) -> tuple[str, int]:
    """The text of an expression and its precedence."""
    match expr:
        case Constant(value):
            return "1e999" if value == float("inf") else repr(value), _ITEM
        case Name(name):
            return name, _ITEM
        case Attribute(Constant(int() as value), name):
            # `1.real` is no valid Python.
            return f"({value!r}).{name}", _ITEM
        case Attribute(value, name):
            return f"{_at(_ITEM, value)}.{name}", _ITEM
        case Index(value, index):
            return f"{_at(_ITEM, value)}[{_at(_TEST, index)}]", _ITEM
        case Call(function, arguments, keywords):
            named = [f"{key}={_at(_TEST, value)}" for key, value in keywords]
            given = ", ".join([*map(print_expression, arguments), *named])
            return f"{_at(_ITEM, function)}({given})", _ITEM
        case Lambda(parameter, body):
            return f"lambda{f' {parameter}' if parameter else ''}: {_at(_TEST, body)}", _TEST
        case Conditional(test, then, otherwise):
            return f"{_at(_OR, then)} if {_at(_OR, test)} else {_at(_TEST, otherwise)}", _TEST
        case ListDisplay(items):
            return f"[{_comma(items)}]", _ITEM
        case TupleDisplay(items):
            return f"({_comma(items)}{',' if len(items) == 1 else ''})", _ITEM
        case DictDisplay(entries):
            pairs = (f"{_at(_TEST, key)}: {_at(_TEST, value)}" for key, value in entries)
            return f"{{{', '.join(pairs)}}}", _ITEM
    return _print_operation(expr)


def _print_operation(expr: Operation) -> tuple[str, int]:
    """The text of an operation and its precedence."""
    match expr:
        case Unary("not", operand):
            return f"not {_at(_NOT, operand)}", _NOT
        case Unary(sign, operand):
            return f"{sign}{_at(_SIGNED, operand)}", _SIGNED
        case Binary("**", left, right):
            return f"{_at(_ITEM, left)} ** {_at(_SIGNED, right)}", _POWER
        case Binary(operator, left, right):
            own = _BINDING[operator]
            return f"{_at(own, left)} {operator} {_at(own + 1, right)}", own
        case Compare(first, rest):
            tail = "".join(f" {word} {_at(_SUM, operand)}" for word, operand in rest)
            return _at(_SUM, first) + tail, _COMPARE
        case Boolean(operator, operands):
            own = _OR if operator == "or" else _AND
            return f" {operator} ".join(_at(own + 1, operand) for operand in operands), own
    return assert_never(expr)
