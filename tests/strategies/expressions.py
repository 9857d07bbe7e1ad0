"""Hypothesis strategies for portable expressions."""

from __future__ import annotations

import keyword
import unicodedata
from collections.abc import Callable, Sequence
from typing import TypeAlias, TypeVar

from hypothesis import strategies as st

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

T = TypeVar("T")


def _is_python_name(text: str) -> bool:
    plain = unicodedata.normalize("NFKC", text) == text
    return plain and text.isidentifier() and not keyword.iskeyword(text)


# A strategy that is made anew for each draw costs more than the draw.
PYTHON_NAMES = st.sampled_from(
    ["ud", "x", "y", "größe", "_hidden", "match", "andy", "lambda_"]
) | st.from_regex(r"[^\W\d]\w{0,4}", fullmatch=True).filter(_is_python_name)
OPTIONAL_NAMES = st.none() | PYTHON_NAMES
KEYWORDS = st.lists(PYTHON_NAMES, max_size=2, unique=True)
SIGN = st.sampled_from(["+", "-", "not"])
OPERATOR = st.sampled_from(["+", "-", "*", "/", "//", "%", "**"])
COMPARISON = st.sampled_from(["<", "<=", ">", ">=", "==", "!=", "in", "not in"])
JUNCTION = st.sampled_from(["and", "or"])


def constants() -> st.SearchStrategy[Expr]:
    """Literals of every kind; numbers are not negative, as in the text."""
    numbers = st.integers(min_value=0) | st.floats(min_value=0.0, allow_nan=False).map(abs)
    return st.builds(Constant, st.none() | st.booleans() | st.text(max_size=6) | numbers)


Make: TypeAlias = Callable[[st.DrawFn, Callable[[], Expr]], Expr]

FORMS: Sequence[Make] = (
    lambda draw, part: Unary(draw(SIGN), part()),
    lambda draw, part: Binary(draw(OPERATOR), part(), part()),
    lambda draw, part: Compare(part(), _several(draw, 1, 2, lambda: (draw(COMPARISON), part()))),
    lambda draw, part: Boolean(draw(JUNCTION), _several(draw, 2, 3, part)),
    lambda draw, part: Conditional(part(), part(), part()),
    lambda draw, part: ListDisplay(_several(draw, 0, 3, part)),
    lambda draw, part: TupleDisplay(_several(draw, 0, 3, part)),
    lambda draw, part: DictDisplay(_several(draw, 0, 2, lambda: (part(), part()))),
    lambda draw, part: Index(part(), part()),
)
"""The forms that have a value for some parts."""

OTHER_FORMS: Sequence[Make] = (
    lambda draw, part: Attribute(part(), draw(PYTHON_NAMES)),
    lambda draw, part: Call(part(), _several(draw, 0, 2, part), _keywords(draw, part)),
    lambda draw, part: Lambda(draw(OPTIONAL_NAMES), part()),
)


def _several(draw: st.DrawFn, least: int, most: int, make: Callable[[], T]) -> tuple[T, ...]:
    return tuple(make() for _ in range(draw(st.integers(least, most))))


def _keywords(draw: st.DrawFn, part: Callable[[], Expr]) -> tuple[tuple[str, Expr], ...]:
    names = draw(KEYWORDS)
    return tuple((name, part()) for name in names)


@st.composite
def trees(
    draw: st.DrawFn, leaves: st.SearchStrategy[Expr], forms: Sequence[Make], depth: int
) -> Expr:
    """Expressions of the given forms, at most `depth` levels over the leaves."""

    def grow(left: int) -> Expr:
        form = draw(st.integers(0, len(forms)))
        if left == 0 or form == 0:
            return draw(leaves)
        return forms[form - 1](draw, lambda: grow(left - 1))

    return grow(depth)


def expressions(depth: int = 3) -> st.SearchStrategy[Expr]:
    """Any tree of the portable subset, whether or not it has a value."""
    leaves = constants() | st.builds(Name, PYTHON_NAMES)
    return trees(leaves, (*FORMS, *OTHER_FORMS), depth)


NAMES_OF_VALUES = ("x", "y", "z")
NUMERIC = ("abs", "sum", "round", "int", "float", "range")
FUNCTION_NAMES = (*NUMERIC, "bool", "dict", "len", "list", "max", "min", "sorted", "str", "tuple")
FUNCTION_NAME = st.sampled_from(FUNCTION_NAMES)
VALUES = st.one_of(
    st.integers(-9, 9),
    st.sampled_from([0.0, -0.0, 0.5, -2.5, 1e300, float("inf")]),
    st.text(alphabet="ab1", max_size=3),
    st.lists(st.integers(-3, 3), max_size=3),
)
"""What the names of `computations` may stand for."""

COMPUTING_FORMS: Sequence[Make] = (
    *FORMS,
    lambda draw, part: Call(Name(draw(FUNCTION_NAME)), _several(draw, 0, 2, part)),
    lambda draw, part: Call(
        Name("sorted"), (part(),), (("key", Lambda("x", part())), ("reverse", Constant(True)))
    ),
)


def computations(depth: int = 3) -> st.SearchStrategy[Expr]:
    """Expressions over `x`, `y` and `z` whose value Python can be asked for."""
    numbers = st.integers(0, 9) | st.sampled_from([0.0, 0.5, 2.5, 1e300])
    literals = st.builds(Constant, numbers | st.text(alphabet="ab1", max_size=3) | st.booleans())
    names = st.builds(Name, st.sampled_from(NAMES_OF_VALUES))
    return trees(literals | names, COMPUTING_FORMS, depth)
