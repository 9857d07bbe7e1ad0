"""Python that is printed: code of the script in it, however it is written."""

from __future__ import annotations

import ast

import pytest

from smachac.targets.python.formatter import expression, flat

CODES = {
    "lambda a, b: a # the first": "lambda a, b: a",
    "lambda a, b: '#' # a hash": "lambda a, b: '#'",
    "lambda a, b: (a,\n  b)": "lambda a, b: (a, b)",
    "lambda a, b:\n  a  # one\n  + b # two": "lambda a, b: a + b",
    "lambda a, b: a": "lambda a, b: a",
}


@pytest.mark.parametrize("code", CODES)
def test_code_that_is_not_portable_stands_on_one_line_without_comments(code: str) -> None:
    assert flat(expression(code)) == CODES[code]
    assert ast.parse(f"f({flat(expression(code))}, 1)", mode="eval")
