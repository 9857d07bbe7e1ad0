"""Repairs of half-typed texts, and positions of the protocol: the laws that all answers need."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import Map, parse
from smachac.lsp.positions import Encoding, Positions
from smachac.lsp.repair import MARK, repaired, with_mark

TEXTS = st.text(st.sampled_from("ab:-[]{},'\"# \n\r\t\u00e9\U0001f916&*|>?!"), max_size=60)


@given(TEXTS)
def test_a_repaired_text_is_yaml_of_the_same_length(text: str) -> None:
    found = repaired(text)
    if found is not None:
        assert len(found) == len(text)
        assert found.count("\n") == text.count("\n")
        report: Report = []
        parse(Source("x", found), report)
        assert "SM001" not in [item.code for item in report]


@pytest.mark.parametrize(
    ("text", "kept"),
    [
        ("a: 1\nb: [1, 2\nc: 3\n", "a: 1"),
        ("a: 1\nb\nc: 3\n", "c: 3"),
        ("a: {b: 1\nc: 3\n", "c: 3"),
        ("a: 'x\nb: 2\n", "b: 2"),
    ],
)
def test_the_lines_without_errors_stay(text: str, kept: str) -> None:
    found = repaired(text)
    assert found is not None
    assert kept in found


@given(TEXTS, st.integers(0, 60))
def test_the_mark_is_where_the_word_was(text: str, at: int) -> None:
    at = min(at, len(text))
    found = with_mark(text, at, at, "x")
    if found is not None:
        source, _, offset = found
        assert source.text[offset : offset + len(MARK)] == MARK


def test_the_mark_of_a_half_typed_mapping() -> None:
    text = "a: {b: 1, "
    found = with_mark(text, len(text), len(text), "x")
    assert found is not None
    assert isinstance(found[1], Map)


@given(st.text(max_size=40), st.sampled_from(["utf-8", "utf-16", "utf-32"]))
def test_each_position_leads_back(text: str, encoding: Encoding) -> None:
    positions = Positions(text, encoding)
    for offset in range(len(text) + 1):
        if text[offset - 1 : offset + 1] != "\r\n":
            assert positions.offset(*positions.at(offset)) == offset


@pytest.mark.parametrize(("encoding", "column"), [("utf-8", 8), ("utf-16", 5), ("utf-32", 4)])
def test_columns_have_the_units_of_the_encoding(encoding: Encoding, column: int) -> None:
    text = "a\n\u00e9\U0001f916b: c"
    assert Positions(text, encoding).at(text.index(":") + 1) == (1, column)
