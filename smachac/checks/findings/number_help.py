"""Help for texts that were meant as numbers: decimal commas, units, clock times, quotes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable

from smachac.analysis.type_lattice import POINT, QUATERNION, inside, length_of, present, unit_of
from smachac.analysis.units import conversion
from smachac.ir.nodes import Data, is_number
from smachac.ir.types import Type

LONGEST = 1000
"""In characters. A longer list is no list of a few numbers."""

_NUMBER = r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?"
_WITH_UNIT = re.compile(rf"({_NUMBER})\s*([^\W\d]\S*|°)?")
_COMMA = re.compile(r"([-+]?\d+),(\d+)")
_CLOCK = re.compile(r"(\d+):([0-5]?\d)(?::([0-5]?\d))?")
_GROUP = re.compile(r"\[([^\[\]]*)\]")


def suggested_number(text: str, wanted: Type) -> str | None:
    """The help for a text where a number is due; None if the text looks like no number."""
    unit, text = unit_of(wanted), text.strip()
    value, hash_sign, comment = text.partition("#")
    if hash_sign and re.fullmatch(_NUMBER, value):
        return f"a comment needs a space before its `#`: `{value} #{comment}`"
    found = _COMMA.fullmatch(text)
    if found is not None:
        return f"a decimal comma? write `{found[1]}.{found[2]}`"
    found = _CLOCK.fullmatch(text)
    if found is not None and unit in ("", "s"):
        parts = [int(part) for part in found.groups() if part is not None]
        seconds = sum(part * 60**power for power, part in enumerate(reversed(parts)))
        return f"write the seconds: `{seconds}`"
    found = _WITH_UNIT.fullmatch(text)
    if found is None:
        return None
    given = found[2] or ""
    if not given:
        return f"write the number without quotes: `{found[1]}`"
    if given == unit or not unit:
        return f"write the number without its unit: `{found[1]}`"
    factor = conversion(given, unit)
    if factor is None:
        return f"write the number in `{unit}`, without the unit"
    return f"write the number in `{unit}`, without the unit: `{float(found[1]) * factor:.6g}`"


def suggested_list(text: str) -> str | None:
    """The help for a text of several numbers where a list is due; None for any other text."""
    parts = re.split(r"[\s;]+|,\s*", text.strip(" []()")[:LONGEST])
    if len(parts) < 2 or not all(re.fullmatch(_NUMBER, part) for part in parts):
        return None
    return f"write a list without quotes: `[{', '.join(parts)}]`"


def suggested_rotation(angles: Data) -> str | None:
    """The help for a rotation of three numbers: the quaternion of these angles about the fixed axes
    x, y and z (roll, pitch and yaw in rad, as `euler` "sxyz" of tf.transformations); None for
    other values. Formula: the product of the quaternions of the three rotations, yaw first."""
    if not isinstance(angles, tuple) or len(angles) != 3:
        return None
    halves = [angle / 2 for angle in angles if is_number(angle) and math.isfinite(angle)]
    if len(halves) != 3:
        return None
    (sr, sp, sy), (cr, cp, cy) = (tuple(map(wave, halves)) for wave in (math.sin, math.cos))
    rotation = (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
    text = ", ".join(str(round(number, 4) + 0.0) for number in rotation)
    which = "for no rotation" if not any(halves) else "for these 3 angles (roll, pitch, yaw in rad)"
    return f"write a quaternion, `[qx, qy, qz, qw]`: `[{text}]` {which}"


def decimal_commas(text: str, sizes: Iterable[int]) -> str | None:
    """The help for a list whose decimal commas separate items, as in `[0,5, 0,0, 0,1]`: with points
    it has one of these sizes."""
    for group in _GROUP.finditer(text[:LONGEST]):
        items = [item.strip() for item in re.split(r",\s", group[1])]
        joined = [_COMMA.fullmatch(item) for item in items]
        plain = [re.fullmatch(_NUMBER, item) for item in items]
        fits = all(one or other for one, other in zip(joined, plain, strict=True))
        if len(items) in sizes and fits and any(joined):
            first = next(found for found in joined if found)
            return f"decimal commas? write `{first[1]}.{first[2]}` in place of `{first[0]}`"
    return None


def sizes_of(wanted: Type) -> tuple[int, ...]:
    """The sizes of the lists of numbers in a literal of a type."""
    wanted = present(wanted)
    if wanted.name in ("Pose", "Transform"):
        return 3, 4
    if wanted in (POINT, QUATERNION):
        return (3,) if wanted == POINT else (4,)
    size = length_of(wanted)
    return (size,) if size is not None else sizes_of(inside(wanted)) if wanted.args else ()
