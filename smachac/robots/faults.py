"""Faults of a simulated world as data: the kind, the target, the time, and the probability."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

from smachac.robots import fields as data
from smachac.robots.fields import DataError, Field, Fields, Place, Shape, Table, guess


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
    value: Shape[Any] | None = None


@data.shape({"type": "number", "minimum": 0})
def _amount(value: Any, place: Place) -> float:
    found = data.number(value, place)
    if found < 0.0:
        message = f"a number from 0 on is expected, not {found:g}"
        raise DataError(message, place, f"write `{-found:g}`")
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
of `grip_force` a force (N), of `weak_joint` a torque (N m) or force (N), of `sensor_noise` a
standard deviation (m)."""


@data.shape({"enum": [*KINDS]})
def _kind(content: Any, place: Place) -> str:
    name = data.text(content, place)
    if name not in KINDS:
        raise DataError(f"no fault kind `{name}`", place, guess(name, KINDS))
    return name


@data.shape({})
def _value(content: Any, place: Place) -> Any:
    return content


_FAULT: Table = {
    "kind": Field(_kind, "What happens (docs/robots.md, Faults)."),
    "target": Field(data.text, "The body, joint or arm; the only arm needs no name.", ""),
    "value": Field(_value, "The parameter of the kind: a pose, or a number in N, N m or m.", None),
    "at": Field(_amount, "The simulated time when it happens (s).", None),
    "state": Field(data.text, "It happens when a state begins: its path, or the end of it.", None),
    "probability": Field(data.probability, "The probability that it happens.", 1.0),
    "each_time": Field(data.truth, "It can happen at every visit of the state.", False),
}
"""The keys of a fault, which are the fields of Fault."""


def read(faults: Iterable[Fault | Mapping[str, Any]]) -> tuple[Fault, ...]:
    """Faults from values, or from mappings with the same keys. Raises DataError."""
    return tuple(
        other if isinstance(other, Fault) else fault(other, (k,)) for k, other in enumerate(faults)
    )


def _kind_schema(name: str, kind: Kind) -> data.Schema:
    """What the JSON Schema of a fault demands for a kind."""
    needed = [data.given("target")] if kind.target in ("body", "joint") else []
    needed += [{"not": data.given("target")}] if not kind.target else []
    if kind.value is None:
        needed.append({"not": data.given("value")})
    else:
        needed.append({"required": ["value"], "properties": {"value": kind.value.schema}})
    of_kind = {"required": ["kind"], "properties": {"kind": {"const": name}}}
    return {"if": of_kind, "then": {"allOf": needed}}


_EACH_TIME = {"required": ["each_time"], "properties": {"each_time": {"const": True}}}


@data.record(
    _FAULT,
    oneOf=[data.given("at"), data.given("state")],
    allOf=[
        *(_kind_schema(name, kind) for name, kind in KINDS.items()),
        {"if": _EACH_TIME, "then": data.given("state")},
    ],
)
def fault(given: Fields) -> Fault:
    """One fault."""
    name: str = given["kind"]
    place, kind = given.place, KINDS[name]
    if ("at" in given) == ("state" in given):
        both = "at" in given
        help = "remove one of the two" if both else "add `at: SECONDS` or `state: PATH`"
        raise DataError(f"fault `{name}` needs either `at` or `state`", place, help)
    if kind.target in ("body", "joint") and "target" not in given:
        message = f"fault `{name}` needs a `target`, the name of a {kind.target}"
        raise DataError(message, place, f"add `target: {kind.target.upper()}`")
    if not kind.target and "target" in given:
        raise DataError(f"fault `{name}` has no `target`", (*place, "target"), "remove `target`")
    if kind.value is None and "value" in given:
        raise DataError(f"fault `{name}` has no `value`", (*place, "value"), "remove `value`")
    if kind.value is not None and "value" not in given:
        raise DataError("the key `value` is missing", place, "add `value: ...`")
    if given["each_time"] and "state" not in given:
        help = "write `state: PATH` in place of `at`, or remove `each_time`"
        raise DataError("`each_time` needs `state`", (*place, "each_time"), help)
    value = None if kind.value is None else kind.value(given["value"], (*place, "value"))
    return Fault(
        kind=name,
        target=given["target"],
        value=value,
        at=given["at"],
        state=given["state"],
        probability=given["probability"],
        each_time=given["each_time"],
    )


_FILE: Table = {"faults": Field(data.each(fault), "The faults.")}


@data.record(_FILE)
def _file(given: Fields) -> tuple[Fault, ...]:
    found: tuple[Fault, ...] = given["faults"]
    return found


def read_file(content: Any) -> tuple[Fault, ...]:
    """The faults in the data of a YAML file: a list under `faults`. Raises DataError."""
    return _file(content, ())


SCHEMA = _file.schema
"""The JSON Schema of a file of faults."""
