"""Each line of a rewritten script keeps its line end: CRLF, LF or a lone CR."""

from __future__ import annotations

import random
import re
from collections import Counter
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.frontend.files import with_line_feeds
from smachac.refactor.formatter import format_script
from smachac.refactor.line_ends import with_line_ends
from tests.refactor.test_formatter import SCRIPTS

ENDS = ["\n", "\r\n", "\r"]


def lines_of(text: str) -> list[tuple[str, str]]:
    """The lines of a text without the spaces around them, with their ends."""
    return [(m[1].strip(), m[2]) for m in re.finditer(r"([^\r\n]*)(\r\n|\r|\n)", text)]


def mixed(text: str, seed: int) -> str:
    draw = random.Random(seed)
    found = ""
    for line in text.splitlines(keepends=True):
        ends = ENDS[1:] if line == "\n" and found.endswith("\r") else ENDS  # CR LF is one line end
        found += line.replace("\n", draw.choice(ends))
    return found


def expect_same_ends(before: str, after: str) -> int:
    """Compare the ends of all lines that are once in both texts; their number."""
    old, new = lines_of(before), lines_of(after)
    times = Counter(line for line, _ in old), Counter(line for line, _ in new)
    ends = dict(old)
    same = [(line, end) for line, end in new if times[0][line] == times[1][line] == 1]
    assert [(line, end) for line, end in same if ends[line] != end] == []
    return len(same)


@given(st.data(), st.lists(st.sampled_from(ENDS), min_size=1, max_size=12))
def test_lines_that_move_take_their_ends_along(data: st.DataObject, ends: list[str]) -> None:
    old = [f"line {number}" for number in range(len(ends))]
    new = data.draw(st.permutations([*old, "new 1", "new 2"]))
    new = new[: data.draw(st.integers(0, len(new)))]
    before = "".join(map("".join, zip(old, ends, strict=True)))
    text = "".join(f"  {line}\n" for line in new)
    made = with_line_ends(text, before)
    assert with_line_feeds(made) == text
    expect_same_ends(before, made)


@given(st.text("ab \r\n"))
def test_a_text_that_is_unchanged_keeps_every_end(text: str) -> None:
    assert with_line_ends(with_line_feeds(text), text) == text


@given(st.sampled_from(SCRIPTS), st.integers(0, 1000))
def test_formatting(text: str, seed: int) -> None:
    before = mixed(text, seed)
    after = format_script(Source("x.yml", before))
    plain = format_script(Source("x.yml", text))
    assert (after is None) == (plain is None)
    if after is None or plain is None:
        return
    assert with_line_feeds(after) == plain
    expect_same_ends(before, after)
    assert format_script(Source("x.yml", after)) == after


SCRIPT = """\
# A mission.
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
# The first state.
- FIRST:
    template: ScriptedState
    outcomes: [done, lost]
    transitions:
      done: SECOND
      lost: aborted

# The second one.
- SECOND:
    template: ScriptedState
    outcomes: [well]
    transitions:
      well: succeeded  # the end
"""


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    "words",
    [
        ["rename", "SECOND", "LAST"],
        ["contain", "BOTH", "StateMachine", "FIRST", "SECOND"],
        ["fmt", "--shorthand"],
        ["check", "--fix"],
    ],
    ids=lambda words: words[0],
)
def test_commands(tmp_path: Path, words: list[str], seed: int) -> None:
    path = tmp_path / "main.yml"
    before = mixed(SCRIPT, seed)
    if words[0] == "check":
        before = before.replace("done: SECOND", "done: SECNOD")
    path.write_bytes(before.encode())
    assert main([words[0], str(path), *words[1:]]) == 0
    after = path.read_bytes().decode()
    assert after != before
    assert expect_same_ends(before, after) > 6
    if words[0] == "check":
        assert after == before.replace("SECNOD", "SECOND")


def test_extracted_lines_keep_their_ends(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    before = mixed(SCRIPT, 3)
    path.write_bytes(before.encode())
    assert main(["contain", str(path), "BOTH", "StateMachine", "FIRST", "SECOND"]) == 0
    assert main(["extract", str(path), "BOTH"]) == 0
    (made,) = (item for item in tmp_path.glob("*.yml") if item != path)
    assert expect_same_ends(before, made.read_bytes().decode()) > 6
