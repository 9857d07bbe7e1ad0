"""Varied values of a sweep: start userdata, params and poses of a scene, drawn from the seed.

A varied value of the script takes the place of the value in the text, so that the script is
compiled and checked with it. `smachac run --set` gives one such value.
"""

from __future__ import annotations

import json
import math
import random
from collections.abc import Iterable, Mapping
from typing import TypeAlias

from smachac.diagnostics.diagnostic import did_you_mean
from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree
from smachac.records import dataclass
from smachac.robots.scene import AXES

Number: TypeAlias = "int | float"
Single: TypeAlias = "bool | int | float | str"

DIGITS = 6
"""The significant digits of a drawn number, so that command lines that repeat a run are short."""


class VariationError(Exception):
    """A varied value is wrong; the message has the reason and help."""


@dataclass(frozen=True, slots=True)
class Variation:
    """A name with its possible values: `choices`, or all numbers from `low` to `high`; whole
    numbers if both are."""

    name: str
    choices: tuple[Single, ...] = ()
    low: Number = 0
    high: Number = 0

    def drawn(self, seed: int) -> Single:
        """The value for a seed. It does not depend on other variations."""
        source = random.Random(f"{seed}/{self.name}")
        if self.choices:
            return source.choice(self.choices)
        if isinstance(self.low, int) and isinstance(self.high, int):
            return source.randint(self.low, self.high)
        value = float(f"{source.uniform(self.low, self.high):.{DIGITS}g}")
        return min(max(value, float(self.low)), float(self.high))


def read_variation(text: str) -> Variation:
    """The variation `NAME=LOW..HIGH` or `NAME=A,B,...`. Raises VariationError."""
    name, equals, given = (part.strip() for part in text.partition("="))
    if not equals or not name or not given:
        raise VariationError(f"`{text}` is not `NAME=LOW..HIGH` or `NAME=A,B,...`")
    first, dots, last = given.partition("..")
    if not dots:
        return Variation(name, tuple(_single(part.strip()) for part in given.split(",")))
    low, high = _single(first.strip()), _single(last.strip())
    for value in (low, high):
        if isinstance(value, bool | str) or not math.isfinite(value):
            raise VariationError(f"`{name}`: `{value}` is not a number; a range is `0.1..0.5`")
    assert not isinstance(low, str)
    assert not isinstance(high, str)
    if low > high:
        raise VariationError(
            f"`{name}`: the range begins with {low}, and ends with {high} below it"
        )
    return Variation(name, (), low, high)


def value_text(value: Single) -> str:
    """A value as an option has it, and as YAML."""
    return value if isinstance(value, str) else json.dumps(value)


def _single(text: str) -> Single:
    try:
        value = json.loads(text)
    except ValueError:
        return text
    return value if isinstance(value, bool | int | float | str) else text


NOTHING_VARIES = "it has no values in `userdata` or `params` that can vary"


def check_values(variations: Iterable[Variation], tree: Tree | None, bodies: Iterable[str]) -> None:
    """Raises VariationError for a name that the script or the scene does not have, for a name that
    is given twice, and for a value of another kind than the one in the script."""
    names = [*names_of(tree), *(f"scene.{body}.{axis}" for body in bodies for axis in AXES)]
    seen: set[str] = set()
    for variation in variations:
        if variation.name in seen:
            raise VariationError(f"`{variation.name}` is varied twice")
        seen.add(variation.name)
        if variation.name not in names:
            known = f"values that can vary: {', '.join(names)}" if names else NOTHING_VARIES
            near = did_you_mean(variation.name, names) or known
            raise VariationError(f"the script has no value `{variation.name}`\n{near}")
        given = variation.choices or (variation.low, variation.high)
        place = _found(variation.name, tree)
        before = place.value if place is not None else 0.0
        for value in given:
            if kind(value) != kind(before):
                raise VariationError(
                    f"`{variation.name}` is {kind(before)} in the script,"
                    f" `{value_text(value)}` is not"
                )


def fixed(given: Iterable[str], tree: Tree | None, bodies: Iterable[str]) -> dict[str, Single]:
    """The values of `NAME=VALUE`. Raises VariationError as `check_values` does."""
    found = []
    for text in given:
        name, equals, value = (part.strip() for part in text.partition("="))
        if not equals or not name:
            raise VariationError(f"`{text}` is not `NAME=VALUE`")
        found.append(Variation(name, (_single(value),)))
    check_values(found, tree, bodies)
    return {variation.name: variation.choices[0] for variation in found}


def kind(value: object) -> str:
    """The kind of a value in words."""
    if isinstance(value, bool):
        return "true or false"
    return "a text" if isinstance(value, str) else "a number"


def names_of(tree: Tree | None) -> list[str]:
    """The names of all values of a script that can vary: numbers, truth values and texts in the
    start userdata and in the params of the outermost container."""
    found: list[str] = []
    for part in ("userdata", "params"):
        entry = tree.get(part) if isinstance(tree, Map) else None
        if entry is not None and isinstance(entry.value, Map):
            _collect(part, entry.value, found)
    return found


def _collect(name: str, tree: Tree, found: list[str]) -> None:
    if isinstance(tree, Scalar):
        if tree.value is not None:
            found.append(name)
    elif isinstance(tree, Map):
        for entry in tree.entries:
            _collect(f"{name}.{entry.key.value}", entry.value, found)
    else:
        for number, item in enumerate(tree.items):
            _collect(f"{name}.{number}", item, found)


def edited(source: Source, tree: Tree | None, values: Mapping[str, Single]) -> Source:
    """The script with other values at the places of names that are not of a scene."""
    edits = []
    for name, value in values.items():
        place = _found(name, tree)
        if place is not None:
            of_float = isinstance(place.value, float) and not isinstance(value, bool | str)
            edits.append((place.start, place.end, json.dumps(float(value) if of_float else value)))
    text = source.text
    for start, end, new in sorted(edits, reverse=True):
        text = text[:start] + new + text[end:]
    return Source(source.name, text)


def poses(values: Mapping[str, Single]) -> dict[str, dict[str, float]]:
    """The values of a scene: body to axis to value."""
    found: dict[str, dict[str, float]] = {}
    for name, value in values.items():
        part, _, rest = name.partition(".")
        if part == "scene":
            body, _, axis = rest.rpartition(".")
            found.setdefault(body, {})[axis] = float(value)
    return found


def _found(name: str, tree: Tree | None) -> Scalar | None:
    """The value with a name in the tree of a script."""
    if name.partition(".")[0] not in ("userdata", "params"):
        return None
    return _below(name, tree)


def _below(name: str, tree: Tree | None) -> Scalar | None:
    if isinstance(tree, Scalar):
        return tree if not name else None
    if isinstance(tree, Map):
        for entry in tree.entries:  # a key may have a dot in it
            key = str(entry.key.value)
            if name == key or name.startswith(f"{key}."):
                found = _below(name[len(key) + 1 :], entry.value)
                if found is not None:
                    return found
    if isinstance(tree, Seq):
        number, _, rest = name.partition(".")
        if number.isdecimal() and int(number) < len(tree.items):
            return _below(rest, tree.items[int(number)])
    return None
