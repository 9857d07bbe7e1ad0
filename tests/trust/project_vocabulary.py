"""The state types, keys and literals of random projects."""

from __future__ import annotations

import random
from typing import Any

from tests.trust.project_text import Quoted

LITERALS: dict[str, list[Any]] = {
    "int": [0, 3, 12],
    "float": [0.5, 2, -1.25],
    "float<m>": [0.05, 0.8],
    "float<rad>": [1.5, -0.5],
    "str": ["left_arm", Quoted("a b: c"), Quoted("params")],
    "bool": [True, False],
    "Pose": [[[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]], [[0, 0, 1], [0.0, 1.0, 0.0, 0.0]]],
    "float<rad>[3]": [[0.0, -0.5, 1.0]],
    "list[int]": [[1, 2, 3], [7]],
    "one_of[open, close]": ["open", "close"],
}
"""Types with literals of theirs."""

CONDITIONS = {
    "int": "lambda ud: ud.{} < 3",
    "float": "lambda ud: ud.{} > 0.25",
    "float<m>": "lambda ud: ud.{} < 1.0",
    "bool": "lambda ud: ud.{}",
    "str": "lambda ud: ud.{} == 'left_arm'",
    "list[int]": "lambda ud: len(ud.{}) > 1",
}
"""Functions of a key of a type, that say yes or no."""

CHANGES = {
    "int": "lambda ud: ud.{} + 1",
    "float": "lambda ud: ud.{} * 0.5",
    "bool": "lambda ud: not ud.{}",
    "list[int]": "lambda ud: ud.{} + [4]",
}
"""Functions of a key of a type to one of the same type."""


def literal(draw: random.Random, type_: str) -> Any:
    return draw.choice(LITERALS[type_])


def long_type(type_: str) -> str | Quoted:
    """A type as a script writes it: in quotes where YAML needs them."""
    return Quoted(type_) if any(sign in type_ for sign in "[]<>,") else type_
