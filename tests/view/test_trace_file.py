"""A trace that is read in pieces, with lines that are too long."""

from __future__ import annotations

import json

import pytest

from smachac.runtime.tracing.writer import LONGEST_LINE
from smachac.view.feed import Feed
from smachac.view.trace_file import TraceText

PIECE = 1_000_000


@pytest.mark.parametrize("length", [LONGEST_LINE + 1, 3 * LONGEST_LINE, 3 * LONGEST_LINE + PIECE])
def test_a_line_that_is_too_long_is_left_out(length: int) -> None:
    text = TraceText(Feed())
    start = json.dumps({"event": "start", "path": "sm"})
    long = json.dumps({"event": "enter", "path": "sm/A", "value": "x" * length})
    end = json.dumps({"event": "enter", "path": "sm/B"})
    data = f"{start}\n{long}\n{end}\n".encode()
    for at in range(0, len(data), PIECE):
        text.add(data[at : at + PIECE])
    assert text.wrong == 1
    assert [*text.places] == ["sm", "sm/B"]


def test_a_name_that_is_too_long_is_left_out() -> None:
    text = TraceText(Feed())
    text.add(json.dumps({"event": "enter", "path": "a" * 20_000}).encode() + b"\n")
    assert (text.wrong, text.places) == (1, {})
