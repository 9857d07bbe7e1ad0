"""Durations as scripts and scenarios have them: a number and a unit."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

SECONDS: Mapping[str, float] = {"": 1.0, "ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
"""The units with their seconds."""

DURATION = re.compile(r"(\d+(?:\.\d+)?|\.\d+)\s*([a-z]*)")


def seconds(value: object) -> float | None:
    """The seconds of a duration: `20s`, `500ms`, `1.5 min`, `1h`, or a number of seconds. None for
    anything else."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return float(value) if 0 <= value < math.inf else None
    found = DURATION.fullmatch(value.strip()) if isinstance(value, str) else None
    return float(found[1]) * SECONDS[found[2]] if found and found[2] in SECONDS else None


def in_one_unit(duration: float) -> str | float:
    """A duration in seconds with the largest unit of which it is a short number: `1.5 min`. A
    number of seconds if it is none of any unit."""
    for unit in ("h", "min", "s", "ms"):
        text = f"{duration / SECONDS[unit]:g} {unit}"
        if len(text) <= len("99.99 min") and seconds(text) == duration:
            return text
    return duration
