"""Slips in code: words and signs of other languages, and missing signs."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.ir.code_slips import corrected, slips
from smachac.ir.script_code import script_code


@pytest.mark.parametrize(
    ("text", "token", "cure"),
    [
        ("lambda ud: ud.a && ud.b", "&&", "lambda ud: ud.a and ud.b"),
        ("lambda ud: ud.a&&ud.b", "&&", "lambda ud: ud.a and ud.b"),
        ("lambda ud: ud.a || !ud.b", "||", "lambda ud: ud.a or not ud.b"),
        ("lambda ud: f(!ud.a)", "!", "lambda ud: f(not ud.a)"),
        ("lambda ud: ud.a === 1", "===", "lambda ud: ud.a == 1"),
        ("lambda ud: ud.a !== 1", "!==", "lambda ud: ud.a != 1"),
        ("lambda ud: ud.a <> 1", "<>", "lambda ud: ud.a != 1"),
        ("lambda ud: ud->a", "->", "lambda ud: ud.a"),
        ("lambda ud: return ud.a", "return ", "lambda ud: ud.a"),
        ("lambda ud: ud.a = 1", "=", None),
        ("lambda ud: f(x=1, y=2) = 1", "=", None),
        ("lambda ud: ud.a += 1", "+=", None),
        ("lambda ud: ud.a++", "++", None),
        ("lambda ud: ud.a ? 1 : 2", "?", None),
        ("lambda ud -> ud.a", "->", None),
        ("ud => ud.a", "=>", None),
        ("lambda ud: if ud.a: 1", "if", None),
        ("def f(ud): return 1", "def", None),
        ("lambda ud: f(ud.a", "(", None),
        ("lambda ud: f(ud.a))", ")", None),
        ("lambda ud: f(ud.a]", "]", None),
        ("lambda ud: 'a", "'", None),
        ("lambda ud: ud.a +", "+", None),
        ("lambda ud ud.a", "lambda", None),
        ("lambda ud: ud.a ud.b", "ud", None),
        ("lambda ud: '&&' ! 'x'", "!", None),
        ("lamda ud: ud.n > 1", "lamda", "lambda ud: ud.n > 1"),
        ("lambada ud: ud.n > 1", "lambada", "lambda ud: ud.n > 1"),
        ("Lambda ud: ud.n > 1", "Lambda", "lambda ud: ud.n > 1"),
        ("f(lamda x: x && 1)", "lamda", "f(lambda x: x and 1)"),
        ("lamda: 3", "lamda", "lambda: 3"),
        ("gamma ud: ud.n", "ud", None),
    ],
)
def test_the_slip_is_marked_and_cured_where_that_is_certain(
    text: str, token: str, cure: str | None
) -> None:
    assert script_code(text).tree is None
    found = slips(text)
    assert text[found[0].start : found[0].end] == token
    assert corrected(text, found) == cure


def test_a_misspelt_lambda_is_named() -> None:
    (slip,) = slips("lamda ud: ud.n > 1")
    assert slip.what == "Python has no `lamda`"
    assert slip.help == "did you mean `lambda`?"


def test_an_assignment_in_a_condition_is_a_comparison() -> None:
    text = "lambda ud: ud.a = 1"
    assert corrected(text, slips(text, compares=True)) == "lambda ud: ud.a == 1"


@given(st.text(alphabet="ab(){}[]'\"=!&|?:-+>. lambdaudreturn", max_size=60))
def test_every_text_that_python_rejects_has_a_slip(text: str) -> None:
    if script_code(text).tree is not None:
        return
    found = slips(text)
    assert all(0 <= slip.start <= slip.end <= len(text) and slip.what for slip in found)
    assert found
    cured = corrected(text, found)
    assert cured is None or script_code(cured).tree is not None
