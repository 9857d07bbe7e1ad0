"""Words of the same meaning for the choices of a variable and in names: `shut` means `close`, and
`velocity` means `speed`."""

from __future__ import annotations

from collections.abc import Sequence

from smachac.diagnostics.negation import words_in

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
    frozenset(["front", "ahead", "forward", "forwards"]),
    frozenset(["rear", "back", "behind", "backward", "backwards"]),
    frozenset(["top", "up", "upper", "above"]),
    frozenset(["bottom", "down", "lower", "below", "under"]),
    frozenset(["inside", "inner", "interior"]),
    frozenset(["outside", "outer", "exterior"]),
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


QUANTITIES = (
    frozenset(["error", "failure", "exception", "fault"]),
    frozenset(["velocity", "speed", "vel"]),
    frozenset(["acceleration", "accel", "acc"]),
    frozenset(["time", "duration", "timeout", "delay", "seconds", "secs"]),
    frozenset(["rate", "frequency", "freq", "hz"]),
    frozenset(["count", "number", "num", "n", "amount"]),
    frozenset(["max", "maximum", "limit", "most"]),
    frozenset(["min", "minimum", "least"]),
    frozenset(["goal", "target", "destination"]),
    frozenset(["pose", "position", "location", "place", "spot"]),
    frozenset(["distance", "range", "dist"]),
    frozenset(["percentage", "percent", "level", "fraction", "soc"]),
    frozenset(["gripper", "hand"]),
    frozenset(["force", "effort"]),
    frozenset(["temperature", "temp"]),
    frozenset(["orientation", "rotation", "attitude"]),
    frozenset(["latitude", "lat"]),
    frozenset(["longitude", "lon", "lng"]),
    frozenset(["altitude", "height", "alt"]),
    frozenset(["confidence", "score", "probability"]),
    frozenset(["id", "identifier"]),
    frozenset(["tolerance", "precision", "accuracy"]),
)
"""Groups of words in names of variables, fields and keys, each with one meaning."""

GENERAL = frozenset(["cb", "data", "key", "keys", "list", "name", "state", "type", "value"])
"""Words that many names have: they say nothing about what is meant."""

SHORTEST_STEM = 4
"""A longer word that begins with a shorter one than this need not be of its meaning."""


def by_words(word: str, names: Sequence[str]) -> str | None:
    """The only name that has most words of the meaning of the words of another name, and the fewest
    others: `percentage` for `charge_percent`. The last word of a name counts most. None without
    one."""
    wanted = words_in(word)
    found: dict[tuple[bool, int, int], list[str]] = {}
    for name in names:
        own = words_in(name)
        alike = [
            text not in GENERAL and any(_are_alike(text, other) for other in own) for text in wanted
        ]
        if any(alike):
            rank = (alike[-1], sum(alike), -len(own))
            found.setdefault(rank, []).append(name)
    best = found[max(found)] if found else []
    if len(best) != 1 or best[0] == word or _differ(wanted, words_in(best[0])):
        return None
    return best[0]


def _differ(words: Sequence[str], others: Sequence[str]) -> bool:
    """Whether two names have known words of other meanings each: `left_width`, `right_width`."""
    left = [one for one in words if not any(_are_alike(one, other) for other in others)]
    right = [other for other in others if not any(_are_alike(one, other) for one in words)]
    return _has_known(left) and _has_known(right)


def _has_known(words: Sequence[str]) -> bool:
    return any(word in group for word in words for group in (*MEANINGS, *QUANTITIES))


def _are_alike(one: str, other: str) -> bool:
    """Whether two words are of one meaning, or one is the beginning of the other."""
    if one == other or any(one in group and other in group for group in (*MEANINGS, *QUANTITIES)):
        return True
    shorter, longer = sorted((one, other), key=len)
    return len(shorter) >= SHORTEST_STEM and longer.startswith(shorter)
