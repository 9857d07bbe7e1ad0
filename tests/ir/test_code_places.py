"""Places in code: the spans of the parts of an expression in the text of a script."""

from __future__ import annotations

import ast

import pytest

from smachac.diagnostics.source import Source, Span
from smachac.ir.code_places import key_place, node_place
from smachac.ir.nodes import Expression
from smachac.ir.script_code import script_code


def code(written: str, text: str) -> Expression:
    """The expression `text`, which a script contains as `written` behind other text."""
    source = Source("main.yml", f"key: {written}\n")
    return Expression(text=text, span=Span(source, 5, 5 + len(written)))


@pytest.mark.parametrize(
    ("written", "text"),
    [
        ("ud.x + bad", "ud.x + bad"),
        ("'ud.x + bad'", "ud.x + bad"),
        ("'` ud.x + bad `'", "ud.x + bad"),
        ('"ud[\\"x\\"] + bad"', 'ud["x"] + bad'),
        ("'ud[''x''] + bad'", "ud['x'] + bad"),
        ("'ud.x\n    + bad'", "ud.x + bad"),
        ('"\\"ä\\" + bad"', '"ä" + bad'),
        ("'ärger + bad'", "ärger + bad"),
        ("|\n  (ud.x +\n  bad)", "(ud.x +\nbad)"),
    ],
)
def test_a_part_of_code_is_found_in_the_script(written: str, text: str) -> None:
    expression = code(written, text)
    tree = script_code(text).tree
    assert isinstance(tree, ast.BinOp)
    place = node_place(expression, tree.right)
    expected = "bad" if "|" not in written else written  # lines of a block are not followed
    assert place.text == expected


def test_text_from_params_has_one_place() -> None:
    expression = code("['open_', [params, n], '(1)']", "open_2(1)")
    tree = script_code("open_2(1)").tree
    assert isinstance(tree, ast.Call)
    assert node_place(expression, tree.func) == expression.span


@pytest.mark.parametrize("text", ["ud.key + 1", "ud['key'] + 1"])
def test_the_place_of_a_key_is_its_name(text: str) -> None:
    assert key_place(code(f'"{text}"', text), "key").text.strip("'") == "key"
    assert key_place(code(f'"{text}"', text), "other").text == f'"{text}"'
