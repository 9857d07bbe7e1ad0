"""Names of a script as identifiers of C++."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.targets.cpp.identifiers import KEYWORDS, OURS, clashes, identifier


@pytest.mark.parametrize(
    ("name", "spelt"),
    [
        ("GRASP", "GRASP"),
        ("my outcome", "my_outcome"),
        ("class", "class_"),
        ("2nd", "n2nd"),
        ("größe", "grosse"),
        ("Überwachung", "Uberwachung"),
        ("naïve café", "naive_cafe"),
        ("抓取", "u6293u53d6"),
        ("↺", "_"),
    ],
)
def test_names_stay_as_near_as_they_can(name: str, spelt: str) -> None:
    assert identifier(name) == spelt


@given(st.text())
def test_every_name_becomes_an_identifier(name: str) -> None:
    word = identifier(name)
    assert re.fullmatch(r"[A-Za-z][0-9A-Za-z_]*|_", word)
    assert "__" not in word
    assert word not in KEYWORDS | OURS


def test_two_names_that_become_one_are_told() -> None:
    assert clashes(["größe", "grösse", "grosse", "MOVE"]) == [
        ("grösse", "größe"),
        ("grosse", "größe"),
    ]
