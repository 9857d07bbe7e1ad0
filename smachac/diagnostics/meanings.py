"""Words of the same meaning for the choices of a variable: `shut` means `close`."""

from __future__ import annotations

from collections.abc import Sequence

MEANINGS = (
    frozenset(
        ["open", "opened", "opening", "release", "released", "ungrasp", "ungrip", "unclamp", "drop"]
    ),
    frozenset(["close", "closed", "closing", "shut", "clamp", "grab", "grasp", "grip", "hold"]),
    frozenset(["add", "append", "attach", "insert"]),
    frozenset(["remove", "delete", "detach", "erase"]),
    frozenset(["start", "begin", "on", "enable"]),
    frozenset(["stop", "end", "halt", "off", "disable"]),
    frozenset(["left", "l"]),
    frozenset(["right", "r"]),
    frozenset(["rotation", "orientation", "rotate"]),
    frozenset(["translation", "position", "translate"]),
)
"""Groups of words, each with one meaning."""


def of_same_meaning(word: str, choices: Sequence[str]) -> str | None:
    """The only choice with the meaning of a word; None without one."""
    for group in MEANINGS:
        if word.casefold() in group:
            found = [choice for choice in choices if choice.casefold() in group]
            return found[0] if len(found) == 1 else None
    return None
