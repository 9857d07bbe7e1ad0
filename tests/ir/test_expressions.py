from __future__ import annotations

import ast
import re
import warnings

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.ir.expressions import (
    Attribute,
    Binary,
    Call,
    Compare,
    Conditional,
    Constant,
    Expr,
    Lambda,
    Name,
    Unary,
    dotted,
    looks_like_expression,
    parse_expression,
    print_expression,
)
from tests.strategies.expressions import expressions
from tests.support.examples import examples

X, Y = Name("x"), Name("y")


@pytest.mark.parametrize(
    ("text", "tree"),
    [
        ("lambda ud: ud.n + 1", Lambda("ud", Binary("+", Attribute(Name("ud"), "n"), Constant(1)))),
        ("lambda: True", Lambda(None, Constant(True))),
        ("-x ** -2", Unary("-", Binary("**", X, Unary("-", Constant(2))))),
        ("not x < y", Unary("not", Compare(X, (("<", Y),)))),
        ("f(x, y=1,)", Call(Name("f"), (X,), (("y", Constant(1)),))),
        ("x if y else x if x else y", Conditional(Y, X, Conditional(X, X, Y))),
        ("x not  in\ty", Compare(X, (("not in", Y),))),
        ("  'it\\'s \\u00e9'  ", Constant("it's é")),
        ("(x +\n y)", Binary("+", X, Y)),
    ],
)
def test_a_portable_expression_is_read(text: str, tree: Expr) -> None:
    assert parse_expression(text) == tree


@pytest.mark.parametrize(
    ("text", "value"),
    [("0x1F", 31), ("1_000", 1000), ("0b101", 5), ("1.", 1.0), (".5e-1", 0.05), ("1e5", 1e5)],
)
def test_numbers_are_those_of_python(text: str, value: float) -> None:
    tree = parse_expression(text)
    assert isinstance(tree, Constant)
    assert (tree.value, type(tree.value)) == (value, type(value))


OUTSIDE = r"""
x is None | x[1:2] | f(*x) | [y for y in x] | x := 1 | x & y | 3j | 'a' 'b' | f'x' | r'x' | 01
lambda x, y: x | lambda x=1: x | f(y=1, x) | f(y=1, y=2) | x.1 | 1.real | 1if x else y | class
None.x = 1 | x; y | x, y | {x} | {**x} | await x | x not y | 'unclosed | '\d' | '\777' | # x
import os | x == | () () x | hello world | x ! y | yield | 1.e | 0xg | '''x''' | [,] | (,)
f(,) | 1__0 | a\b | ?
"""


@pytest.mark.parametrize("text", re.split(r"\s*[|\n]\s*", OUTSIDE))
def test_what_is_outside_the_subset_is_no_expression(text: str) -> None:
    assert parse_expression(text) is None


def test_a_name_that_python_would_change_is_refused() -> None:
    assert parse_expression("\N{LATIN SMALL LIGATURE FI}") is None


def test_a_line_may_end_only_inside_brackets() -> None:
    assert parse_expression("x +\ny") is None
    assert parse_expression("f(x\n,\r\ny)") == Call(Name("f"), (X, Y))


def test_size_and_depth_are_limited() -> None:
    assert parse_expression("'" + "a" * 9_998 + "'") is not None
    assert parse_expression("'" + "a" * 9_999 + "'") is None
    assert parse_expression("(" * 100 + "x" + ")" * 100) == X
    assert parse_expression("(" * 101 + "x" + ")" * 101) is None
    assert parse_expression("-" * 99 + "x") is not None
    assert parse_expression("-" * 100 + "x") is None
    assert parse_expression("-" * 9_999 + "x") is None
    assert parse_expression("9" * 5_000) is None


@given(expressions())
@settings(max_examples=examples(60))
def test_reading_what_is_printed_gives_the_same_tree(tree: Expr) -> None:
    text = print_expression(tree)
    again = parse_expression(text)
    assert repr(again) == repr(tree)
    assert again == tree


@given(expressions())
@settings(max_examples=examples(60))
def test_python_reads_what_is_printed(tree: Expr) -> None:
    assert python_tree(print_expression(tree))


SOME_TEXT = "x y 1 2.5 'a' + - * / // % ** < == in not and or if else lambda : ( ) [ ] , . f( x. ="
TOKENS = st.sampled_from(SOME_TEXT.split())


@given(st.lists(TOKENS, max_size=9).map(" ".join))
@settings(max_examples=examples(300))
def test_what_is_read_means_to_python_what_is_printed(text: str) -> None:
    tree = parse_expression(text)
    if tree is not None:
        assert python_tree(text) == python_tree(print_expression(tree))


@given(st.text(alphabet="xy1.'\"\\n()[]{}+-*/%<>=!:, \nlambda", max_size=40))
def test_no_text_raises(text: str) -> None:
    tree = parse_expression(text)
    if tree is not None:
        assert python_tree(text.strip()) == python_tree(print_expression(tree))


def python_tree(text: str) -> str:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", SyntaxWarning)
        return ast.dump(ast.parse(text, mode="eval"))


@pytest.mark.parametrize(
    "text",
    [
        "(x + y) * x",
        "x - (y - x)",
        "(-x) ** y",
        "(x, )",
        "(1).real",
        "(lambda: x)()",
        "(x or y) or x",
    ],
)
def test_brackets_stay_where_they_are_needed(text: str) -> None:
    tree = parse_expression(text)
    assert tree is not None
    assert print_expression(tree) == text.replace(", )", ",)")


def test_other_brackets_go() -> None:
    tree = parse_expression("((x) + (y * (2))) if (not (x < y)) else ([(x)])")
    assert tree is not None
    assert print_expression(tree) == "x + y * 2 if not x < y else [x]"


def test_dotted_is_the_text_of_names_alone() -> None:
    assert dotted(Attribute(Attribute(Name("a"), "b"), "c")) == "a.b.c"
    assert dotted(Attribute(Constant(1), "b")) is None


@pytest.mark.parametrize(
    "text",
    [
        "a.b.c",
        "math.pi",
        "f()",
        "rospkg.RosPack().get_path('x')",
        "2 * len(x) ",
        "lambda ud: f(ud)",
        "hi(x)",
    ],
)
def test_code_looks_like_code(text: str) -> None:
    assert looks_like_expression(text)


@pytest.mark.parametrize(
    "text",
    [
        "block.urdf",
        "a.b.yaml",
        "MODEL.SDF",
        "1.5",
        "v1.2",
        "word",
        "two words",
        "a.b c",
        "hi (x)",
        "",
        "(1)",
        "x.",
        "f(x) y",
        "/a/b.c",
    ],
)
def test_other_strings_do_not(text: str) -> None:
    assert not looks_like_expression(text)


def test_looking_is_linear() -> None:
    assert not looks_like_expression("a" * 1_000_000 + ")")
    assert not looks_like_expression("a." * 500_000 + ")")
