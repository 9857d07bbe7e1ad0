"""A text that is parsed in pieces has the tree of the whole text, also after edits."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from smachac.diagnostics.source import Source, Span
from smachac.frontend.text.pieces import PieceTree, parse_in_pieces
from smachac.frontend.text.recovering_parser import parse_with_recovery
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree

ROOT = Path(__file__).parents[2]

SCRIPT = """\
name: sm
template: Base
outcomes: [done]
states:
# the first one
- A: {template: SleepState, time: 1.0, transitions: {succeeded: B, preempted: done}}
- B:
    template: SleepState
    time: |
      1.0

    transitions:
      succeeded: C
      preempted: done

- C:
    template: SleepState
    doc: "a text
      on two lines"
    time: 1.0
    transitions: {succeeded: done,
      preempted: done}  # the last one
"""


def flat(tree: Tree) -> list[tuple[object, ...]]:
    """All values, lists and mappings of a tree with their places in the text."""
    place = tree.span.start, tree.span.end
    match tree:
        case Scalar():
            return [(tree.value, tree.plain, *place)]
        case Seq():
            return [("list", *place), *(row for item in tree.items for row in flat(item))]
    rows = [row for entry in tree.entries for row in (*flat(entry.key), *flat(entry.value))]
    return [("mapping", *place), *rows]


def whole(text: str) -> list[tuple[object, ...]]:
    tree = parse_with_recovery(Source("main.yml", text), [])
    assert tree is not None
    return flat(tree)


def in_pieces(
    text: str, before: tuple[PieceTree, ...] = ()
) -> tuple[Map, tuple[PieceTree, ...]] | None:
    return parse_in_pieces(Source("main.yml", text), before)


@pytest.mark.parametrize(
    "path", sorted(ROOT.glob("examples/**/main.yml")) + sorted(ROOT.glob("tests/cases/*/main.yml"))
)
def test_the_tree_is_that_of_the_whole_text(path: Path) -> None:
    text = path.read_bytes().decode("utf-8", "replace")
    found = in_pieces(text)
    if found is not None:
        assert flat(found[0]) == whole(text)


def test_most_examples_are_cut() -> None:
    texts = [path.read_text("utf-8") for path in ROOT.glob("examples/**/main.yml")]
    assert sum(in_pieces(text) is not None for text in texts) > len(texts) / 2


def test_random_edits_have_the_tree_of_the_whole_text() -> None:
    chance = random.Random(1)
    text, cut = SCRIPT, 0
    pieces: tuple[PieceTree, ...] = ()
    for _ in range(400):
        at = chance.randrange(len(text))
        size = chance.choice([0, 0, 1, 7])
        sign = chance.choice(["", "x", " ", "\n", "- ", "\n- D: {}", ":", "{", '"', "#", "\n#"])
        new = text[:at] + sign + text[at + size :]
        found = in_pieces(new, pieces)
        if found is not None:
            assert flat(found[0]) == whole(new)
            text, pieces, cut = new, found[1], cut + 1
    assert cut > 100


def test_a_state_that_did_not_change_moves_with_its_tree() -> None:
    found = in_pieces(SCRIPT)
    assert found is not None
    before = found[0].entries[-1].value
    assert isinstance(before, Seq)
    old = before.items[2].span
    start, text = old.start, old.text
    edited = SCRIPT.replace("- B:\n", "- B_LONGER:\n")
    source = Source("main.yml", edited)
    again = parse_in_pieces(source, found[1])
    assert again is not None
    after = again[0].entries[-1].value
    assert isinstance(after, Seq)
    assert after.items[0] is before.items[0]
    assert after.items[1] is not before.items[1]
    assert after.items[2] is before.items[2]
    assert (old.source, old.start, old.text) == (source, start + len("_LONGER"), text)
    assert old == Span(source, old.start, old.end)


@pytest.mark.parametrize(
    "text",
    [
        SCRIPT.replace("name: sm", "name: &n sm"),
        SCRIPT.replace("states:", "states: []\nmore:"),
        SCRIPT + "properties: []\n",
        SCRIPT.replace('on two lines"', "on two lines"),
        SCRIPT.replace("- C:", "- A: 1\n  B: 2\n- C:").replace("A: 1", "A: {x: 1, x: 2}"),
        SCRIPT.replace("- A:", "-\n  A:").replace("\n", "\r\n"),
        "%YAML 1.2\n---\n" + SCRIPT,
        SCRIPT + "...\n",
        SCRIPT + "---\n",
        SCRIPT.replace("states:\n", ""),
        "",
    ],
)
def test_other_texts_are_parsed_as_a_whole(text: str) -> None:
    source = Source("main.yml", text)
    assert parse_in_pieces(source, ()) is None
    assert [piece.begin for piece in source.pieces] == [0]
