"""Units of numbers, and the factors between them."""

from __future__ import annotations

import math

_IN_BASE_UNIT = {
    "s": ("s", 1.0),
    "ms": ("s", 0.001),
    "min": ("s", 60.0),
    "h": ("s", 3600.0),
    "m": ("m", 1.0),
    "cm": ("m", 0.01),
    "mm": ("m", 0.001),
    "rad": ("rad", 1.0),
    "deg": ("rad", math.pi / 180),
    "°": ("rad", math.pi / 180),
}
"""The base unit of each unit, and the value of one unit in it (SI Brochure, 9th edition)."""


def conversion(given: str, wanted: str) -> float | None:
    """The factor from one unit to another; None if they do not measure the same, or are not
    known."""
    one, other = _IN_BASE_UNIT.get(given), _IN_BASE_UNIT.get(wanted)
    if one is None or other is None or one[0] != other[0]:
        return None
    return one[1] / other[1]
