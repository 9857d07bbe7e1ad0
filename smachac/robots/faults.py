"""Faults of a simulated world as data: the kind, the target, the time, and the probability."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any, NamedTuple

from smachac.robots import fields as data
from smachac.robots.fields import DataError, Fields, Place, guess


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A fault that happens once, or with `each_time` at every visit of its state.

    `kind` is a key of KINDS; `target` names a body, a joint or a limb (empty: the only limb);
    `value` is the parameter of the kind. The fault happens at the simulated time `at` (s), or when
    a state begins whose path is or ends with `state`; with `probability`, which is drawn for each
    seed, with `each_time` for each visit.
    """

    kind: str
    target: str = ""
    value: Any = None
    at: float | None = None
    state: str | None = None
    probability: float = 1.0
    each_time: bool = False


class Kind(NamedTuple):
    """What a kind of fault needs: its target (`body`, `joint`, `limb` or nothing), its value.

    `value` reads the value; None for a kind without one.
    """

    target: str
    value: Callable[[Any, Place], object] | None = None


def _amount(value: Any, place: Place) -> float:
    found = data.number(value, place)
    if found < 0.0:
        raise DataError(f"a number from 0 on is expected, not {found:g}", place)
    return found


KINDS: Mapping[str, Kind] = {
    "move_body": Kind("body", data.pose),
    "remove_body": Kind("body"),
    "gripper_dead": Kind("limb"),
    "gripper_slips": Kind("limb"),
    "grip_force": Kind("limb", _amount),
    "lock_joint": Kind("joint"),
    "weak_joint": Kind("joint", _amount),
    "no_ik": Kind("limb"),
    "sensor_noise": Kind("", _amount),
    "never_returns": Kind("limb"),
    "crash": Kind(""),
}
"""The kinds by name. The value of `move_body` is the shift as a pose along the world's axes; that
of `grip_force` a force (N), of `weak_joint` a torque (N m), of `sensor_noise` a standard deviation
(m)."""

_KEYS = tuple(each.name for each in fields(Fault))


def read(faults: Iterable[Fault | Mapping[str, Any]]) -> tuple[Fault, ...]:
    """Faults from values, or from mappings with the same keys. Raises DataError."""
    return tuple(
        each if isinstance(each, Fault) else fault(each, (k,)) for k, each in enumerate(faults)
    )


def read_file(content: Any) -> tuple[Fault, ...]:
    """The faults in the data of a YAML file: a list under `faults`. Raises DataError."""
    given = Fields(content, (), ("faults",))
    rows = given.take("faults", data.items)
    return tuple(fault(each, ("faults", k)) for k, each in enumerate(rows))


def fault(content: Any, place: Place) -> Fault:
    """One fault. Raises DataError."""
    given = Fields(content, place, _KEYS)
    name = given.take("kind", data.text)
    if name not in KINDS:
        raise DataError(f"no fault kind `{name}`", (*place, "kind"), guess(name, KINDS))
    kind = KINDS[name]
    if ("at" in given) == ("state" in given):
        raise DataError(f"fault `{name}` needs either `at` or `state`", place)
    if kind.target in ("body", "joint") and "target" not in given:
        raise DataError(f"fault `{name}` needs a `target`, the name of a {kind.target}", place)
    if not kind.target and "target" in given:
        raise DataError(f"fault `{name}` has no `target`", (*place, "target"))
    if kind.value is None and "value" in given:
        raise DataError(f"fault `{name}` has no `value`", (*place, "value"))
    each_time = given.get("each_time", data.truth, False)
    if each_time and "state" not in given:
        raise DataError("`each_time` needs `state`", (*place, "each_time"))
    return Fault(
        kind=name,
        target=given.get("target", data.text, ""),
        value=None if kind.value is None else given.take("value", kind.value),
        at=given.get("at", _amount, None),
        state=given.get("state", data.text, None),
        probability=given.get("probability", data.probability, 1.0),
        each_time=each_time,
    )
