"""Values that a view shows: copies of limited size."""

from __future__ import annotations

import json

from smachac.runtime.tracing.values import (
    DEEPEST,
    LONGEST_TEXT,
    MOST_INNER,
    MOST_PARTS,
    shown_value,
)


class Message:
    """As a message of ROS 2: slots with an underscore."""

    __slots__ = ("_data", "_frame")

    def __init__(self) -> None:
        self._data, self._frame = list(range(10**6)), "arm"


class Hostile:
    def __init__(self) -> None:
        self.part = self

    def __getattr__(self, name: str) -> object:
        raise RuntimeError("no")


def test_values_are_cut() -> None:
    assert shown_value({"a": [1, 2.5, None, True, "x"]}) == {"a": [1, 2.5, None, True, "x"]}
    assert shown_value("x" * (LONGEST_TEXT + 3)) == "x" * LONGEST_TEXT + "… 3 more"
    many = shown_value(list(range(10**6)))
    assert isinstance(many, list)
    assert len(many) == MOST_PARTS
    assert many[-1] == f"… {10**6 - MOST_PARTS + 1} more"
    wide = shown_value({f"k{number}": number for number in range(10**5)})
    assert isinstance(wide, dict)
    assert wide["…"] == f"{10**5 - MOST_PARTS + 1} more"
    deep: object = 0
    for _ in range(100):
        deep = [deep]
    assert json.dumps(shown_value(deep)).count("[") == DEEPEST
    assert shown_value(b"abc") == "<3 bytes>"
    assert shown_value(float("nan")) == "nan"
    assert shown_value(2**60) == str(2**60)
    assert shown_value(10**5000) == "<int>"
    assert shown_value((1, (2,))) == [1, [2]]
    assert shown_value(Message) == "<type>"
    shown = shown_value(Message())
    assert isinstance(shown, dict)
    assert shown["frame"] == "arm"
    assert len(shown["data"]) == MOST_INNER + 1
    json.dumps(shown_value(Hostile()))
