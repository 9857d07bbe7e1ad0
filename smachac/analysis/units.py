"""Units of numbers, and the factors between them."""

from __future__ import annotations

import math

_IN_BASE_UNIT = {
    "s": ("s", 1.0),
    "ms": ("s", 0.001),
    "us": ("s", 1e-6),
    "min": ("s", 60.0),
    "h": ("s", 3600.0),
    "m": ("m", 1.0),
    "cm": ("m", 0.01),
    "mm": ("m", 0.001),
    "km": ("m", 1000.0),
    "rad": ("rad", 1.0),
    "deg": ("rad", math.pi / 180),
    "°": ("rad", math.pi / 180),
    "m/s": ("m/s", 1.0),
    "mm/s": ("m/s", 0.001),
    "cm/s": ("m/s", 0.01),
    "km/h": ("m/s", 1 / 3.6),
    "rad/s": ("rad/s", 1.0),
    "deg/s": ("rad/s", math.pi / 180),
    "rpm": ("rad/s", math.pi / 30),
    "kg": ("kg", 1.0),
    "g": ("kg", 0.001),
    "t": ("kg", 1000.0),
    "N": ("N", 1.0),
    "kN": ("N", 1000.0),
    "mN": ("N", 0.001),
    "Hz": ("Hz", 1.0),
    "kHz": ("Hz", 1000.0),
    "Pa": ("Pa", 1.0),
    "kPa": ("Pa", 1000.0),
    "mbar": ("Pa", 100.0),
    "bar": ("Pa", 100_000.0),
    "V": ("V", 1.0),
    "mV": ("V", 0.001),
    "A": ("A", 1.0),
    "mA": ("A", 0.001),
    "W": ("W", 1.0),
    "kW": ("W", 1000.0),
}
"""The base unit of each unit, and the value of one unit in it (SI Brochure, 9th edition)."""


FULL_TURN = 2 * math.pi
"""The largest angle in radians that a whole number can be."""


def conversion(given: str, wanted: str) -> float | None:
    """The factor from one unit to another; None if they do not measure the same, or are not
    known."""
    one, other = _IN_BASE_UNIT.get(given), _IN_BASE_UNIT.get(wanted)
    if one is None or other is None or one[0] != other[0]:
        return None
    return one[1] / other[1]


def other_units(unit: str) -> tuple[str, ...]:
    """The other units that measure the same as a unit, those of the table above, in its order."""
    found = _IN_BASE_UNIT.get(unit)
    return tuple(
        name
        for name, (base, _) in _IN_BASE_UNIT.items()
        if found is not None and base == found[0] and name != unit
    )
