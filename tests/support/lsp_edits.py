"""Random edits of a text: insert, delete, paste of another file, undo."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from hypothesis import strategies as st

PIECES = (
    *(" ", "\n", "  ", ":", ": ", "- ", "{", "}", "[", "]", ",", "'", '"', "#", "&a ", "*a", "\t"),
    *("x", "A", "succeeded", "template: ", "transitions: {", "states:\n", "- NEW:\n", "[[x]]"),
    *("\r\n", "\u00e9", "\U0001f916", "lambda ud: ud.x", "outcomes: [a, b]\n", "---\n", "\u2028"),
    *("<<: ", "!!str ", "| ", "> ", "? ", "script: main\n", "timeout: 3s\n", "\x00"),
)
"""What is inserted."""

PASTED = tuple(
    path.read_text("utf-8")
    for path in sorted((Path(__file__).parents[2] / "examples").rglob("*.yml"))
)
"""What is pasted: a part of it, or all of it."""


class Edit(NamedTuple):
    """An edit at a place, both as fractions of the text. `size` is the length of what is deleted or
    pasted; `piece` selects what is inserted or pasted."""

    kind: str
    place: float
    size: int
    piece: int


def edits() -> st.SearchStrategy[Edit]:
    fraction = st.floats(0, 1)
    kinds = st.sampled_from(["insert", "insert", "delete", "delete", "paste", "undo"])
    return st.builds(Edit, kinds, fraction, st.integers(1, 200), st.integers(0, 10_000))


def edited(history: list[str], edit: Edit) -> tuple[str, int]:
    """The text after an edit, which is added to the history, and the place of the edit."""
    text = history[-1]
    at = int(edit.place * len(text))
    match edit.kind:
        case "undo" if len(history) > 1:
            history.pop()
            return history[-1], min(at, len(history[-1]))
        case "delete":
            size = edit.size if edit.size > 100 else edit.size % 12
            text = text[:at] + text[at + size :]
        case "paste":
            source = PASTED[edit.piece % len(PASTED)]
            start = 0 if edit.size > 150 else edit.piece % len(source)
            part = source[start:] if edit.size > 150 else source[start : start + edit.size]
            text = text[:at] + part + text[at:]
            at += len(part)
        case _:
            piece = PIECES[edit.piece % len(PIECES)]
            text = text[:at] + piece + text[at:]
            at += len(piece)
    history.append(text)
    return text, min(at, len(text))
