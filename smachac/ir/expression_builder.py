"""What the rules of grammars/expression.lark make of their parts."""

from __future__ import annotations

import ast
import keyword
import re
import unicodedata
from typing import Any

from smachac.ir.expressions import (
    Attribute,
    Binary,
    Boolean,
    Call,
    Compare,
    Conditional,
    Constant,
    DictDisplay,
    Expr,
    Index,
    Lambda,
    ListDisplay,
    Name,
    TupleDisplay,
    Unary,
)

LONGEST_INTEGER = 1000
"""Characters of the longest whole number; Python itself prints no more than 4300 digits."""


def word_of(token: str) -> str:
    """A token as a name. Raises ValueError where Python would read it otherwise."""
    if keyword.iskeyword(token) or not token.isidentifier():
        raise ValueError(f"{token} is no name")
    if unicodedata.normalize("NFKC", token) != token:
        raise ValueError(f"Python reads {token} as another name")
    return str(token)


_ESCAPE = re.compile(r"\\([0-7]{1,3}|.)", re.DOTALL)
_GOOD_ESCAPE = re.compile(r"[0-3]?[0-7]{1,2}|[\\'\"abfnrtvxuUN\n]")
"""Escapes in a string literal; Python warns of others, and says it will refuse them."""


class Builder:
    """What each rule of the grammar makes of its parts."""

    def conditional(self, found: list[Any]) -> Expr:
        then, test, otherwise = found
        return Conditional(test, then, otherwise)

    def function(self, found: list[Any]) -> Expr:
        return Lambda(word_of(found[0]) if len(found) > 1 else None, found[-1])

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
        return Attribute(found[0], word_of(found[1]))

    def call(self, found: list[Any]) -> Expr:
        function, (positional, keywords) = found
        return Call(function, positional, keywords)

    def index(self, found: list[Any]) -> Expr:
        return Index(found[0], found[1])

    def arguments(self, found: list[Any]) -> tuple[tuple[Expr, ...], tuple[tuple[str, Expr], ...]]:
        positional = tuple(each for each in found if not isinstance(each, tuple))
        keywords = tuple(each for each in found if isinstance(each, tuple))
        if found[: len(positional)] != list(positional):
            raise ValueError("an argument by place follows one by name")
        if len({name for name, _ in keywords}) < len(keywords):
            raise ValueError("an argument is given twice")
        return positional, keywords

    def keyword(self, found: list[Any]) -> tuple[str, Expr]:
        return word_of(found[0]), found[1]

    def tuple_display(self, found: list[Any]) -> Expr:
        return TupleDisplay(tuple(found))

    def list_display(self, found: list[Any]) -> Expr:
        return ListDisplay(tuple(found))

    def dict_display(self, found: list[Any]) -> Expr:
        return DictDisplay(tuple(found))

    def entry(self, found: list[Any]) -> tuple[Expr, Expr]:
        return found[0], found[1]

    def name(self, found: list[Any]) -> Expr:
        return Name(word_of(found[0]))

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
