"""Syntax errors in long lines: the words of the parser, without a search for the cause."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_errors import LONGEST_LINE
from smachac.frontend.text.yaml_tree import parse

USUAL = "check the brackets, quotes and indentation before this place"
"""The help without a cause."""


def finding(text: str) -> tuple[str, str, str | None]:
    """The code, the message and the help of the only finding."""
    report: Report = []
    parse(Source("main.yml", text), report)
    (found,) = report
    return found.code, found.finding.message, found.finding.help


@pytest.mark.parametrize(
    "line",
    [
        "a: {b: %s: 1}",
        "- %s: a: 1",
        "{a: [%s}",
        "a: 'b' %s",
    ],
)
def test_a_long_line_has_a_finding_in_the_words_of_the_parser(line: str) -> None:
    code, message, help = finding(line % ("x" * (LONGEST_LINE + 1)) + "\n")
    assert code == "SM001"
    assert message
    assert len(message) < 500
    assert help == USUAL


def test_a_line_of_the_limit_is_explained() -> None:
    line = "{a: [%s}"
    text = line % ("x" * (LONGEST_LINE - len(line) + 2)) + "\n"
    assert finding(text)[2] != USUAL
