"""The policies and presets of the quality of service of ROS 2 topics, as data; no ROS is needed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

DEPTH = 10
"""The depth of the history where none is stated."""

POLICIES: Mapping[str, tuple[str, ...]] = {
    "reliability": ("reliable", "best_effort"),
    "durability": ("volatile", "transient_local"),
    "history": ("keep_last", "keep_all"),
}
"""The values of each policy. The key `depth`, a positive number, is known too."""

PRESETS: Mapping[str, Mapping[str, Any]] = {
    "default": {},
    "sensor_data": {"reliability": "best_effort", "depth": 5},
    "latched": {"durability": "transient_local", "depth": 1},
    "services_default": {},
    "parameters": {"depth": 1000},
}
"""Names for often used policies. All but `latched` are names of ROS 2."""


def policies(value: int | str | Mapping[str, Any] | None) -> dict[str, Any]:
    """All policies of a value without faults: None, a depth, a preset, or a mapping."""
    stated: Mapping[str, Any]
    if value is None:
        stated = {}
    elif isinstance(value, int):
        stated = {"depth": value}
    elif isinstance(value, str):
        stated = PRESETS[value]
    else:
        stated = {**PRESETS[value.get("preset", "default")], **value}
    default = {"reliability": "reliable", "durability": "volatile", "history": "keep_last"}
    merged = {**default, "depth": DEPTH, **stated}
    merged.pop("preset", None)
    return merged


class Fault(NamedTuple):
    """What is wrong with the policy `key` of a mapping; without a key, with the whole value.
    `known`: the values that are allowed."""

    text: str
    key: str = ""
    known: tuple[str, ...] = ()


def faults(value: object) -> list[Fault]:
    """What is wrong with a value; empty if it is a quality of service."""
    if value is None:
        return []
    if isinstance(value, str):
        known = ", ".join(PRESETS)
        fault = f"`qos` has no preset `{value}`; its presets are {known}"
        return [] if value in PRESETS else [Fault(fault, known=tuple(PRESETS))]
    if isinstance(value, Mapping):
        return [fault for key, item in value.items() for fault in _policy_faults(key, item)]
    return [fault._replace(key="") for fault in _policy_faults("depth", value)]


def _policy_faults(key: object, value: object) -> list[Fault]:
    """What is wrong with one policy."""
    if key == "depth":
        is_depth = isinstance(value, int) and not isinstance(value, bool) and value > 0
        text = f"the depth of `qos` must be a positive whole number, not `{value}`"
        return [] if is_depth else [Fault(text, "depth")]
    if key == "preset":
        return [fault._replace(key="preset") for fault in faults(str(value))]
    if key not in POLICIES:
        known = (*POLICIES, "depth", "preset")
        text = f"`qos` has no policy `{key}`; its policies are {', '.join(known)}"
        return [Fault(text, str(key), known)]
    values = POLICIES[str(key)]
    text = f"`{key}` of `qos` must be {' or '.join(values)}, not `{value}`"
    return [] if value in values else [Fault(text, str(key), values)]
