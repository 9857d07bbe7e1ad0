"""The data of YAML texts: the core schema of YAML 1.2, as the checks read them."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.data_files import plain as checked_data
from smachac.frontend.text.yaml_tree import parse
from smachac.robots.fields import DataError
from smachac.robots.files import plain


@pytest.mark.parametrize(
    ("text", "data"),
    [
        ("", None),
        ("a: [on, yes, 010, 0o7, 0x1F, 1e3, .5, ~, 'true', true]\n",
         {"a": ["on", "yes", 10, 7, 31, 1000.0, 0.5, None, "true", True]}),
        ("a: 2026-01-01\nb: 12:30:00\nc: 1_000\n",
         {"a": "2026-01-01", "b": "12:30:00", "c": "1_000"}),
        ("a: !!str 5\nb: &x [1]\nc: [*x, *x]\n", {"a": "5", "b": [1], "c": [[1], [1]]}),
        ("a: &a {x: 1, y: 2}\nb: {<<: *a, y: 3}\n", {"a": {"x": 1, "y": 2}, "b": {"y": 3, "x": 1}}),
        ("a: &a {x: 1}\nb: &b {x: 2, z: 3}\nc: {<<: [*a, *b]}\n",
         {"a": {"x": 1}, "b": {"x": 2, "z": 3}, "c": {"x": 1, "z": 3}}),
        ("[" * 80 + "]" * 80, None),
    ],
)  # fmt: skip
def test_a_text_has_the_data_that_the_checks_read(text: str, data: object) -> None:
    found = plain(text)
    tree = parse(Source("x.yml", text), [])
    assert found == (data if data is not None or not text else found)
    assert tree is None or checked_data(tree) == found


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: 1\na: 2\n", "the key a is there twice"),
        ("a: *b\n", "not YAML"),
        ("a: &a [*a]\n", "not YAML"),
        ("? [1]\n: 2\n", "not YAML"),
        ("a: {<<: 3}\n", "not YAML"),
        ("a: [1\n", "not YAML: while parsing a flow sequence"),
        ("a: 1\n---\nb: 2\n", "more than one YAML document"),
    ],
)
def test_other_texts_are_data_errors(text: str, words: str) -> None:
    with pytest.raises(DataError) as caught:
        plain(text)
    assert words in str(caught.value)
    report: Report = []
    parse(Source("x.yml", text), report)
    assert report  # `check` finds it too
