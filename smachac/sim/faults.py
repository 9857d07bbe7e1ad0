"""Faults as data: what goes wrong, to what, when, how likely. Same seed, same misfortune."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from smachac.sim import models
from smachac.sim.transforms import as_pose, shifted

if TYPE_CHECKING:
    from smachac.sim.world import World


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """One thing that goes wrong once.

    `kind` is one of KINDS; `target` names a body, a joint or a limb (empty: the only limb);
    `value` is what the kind needs. It happens at `at` (s, simulated), or when the state whose path
    is or ends with `state` begins, in `probability` of all seeds.
    """

    kind: str
    target: str = ""
    value: Any = None
    at: float | None = None
    state: str | None = None
    probability: float = 1.0


def _move_body(world: World, fault: Fault) -> None:
    body = world.body(fault.target)
    pose = models.where(world.engine, body)
    models.place(world.engine, body, shifted(pose, as_pose(fault.value)))


def _remove_body(world: World, fault: Fault) -> None:
    world.remove(fault.target)


def _gripper_dead(world: World, fault: Fault) -> None:
    arm = world.arm(fault.target or None)
    arm.stick(arm.fingers)


def _grip_force(world: World, fault: Fault) -> None:
    # Friction is no way to lose a block: the contacts of a held one keep what they began with.
    arm = world.arm(fault.target or None)
    arm.grip_force = float(fault.value)
    arm.squeeze()


def _lock_joint(world: World, fault: Fault) -> None:
    for arm in world.arms:
        if fault.target in arm.limb.joints:
            arm.stick([arm.indices[arm.limb.joints.index(fault.target)]])
            return
    known = tuple(name for arm in world.arms for name in arm.limb.joints)
    raise world.unknown("joint", fault.target, known)


KINDS: dict[str, Callable[[World, Fault], None]] = {
    "move_body": _move_body,
    "remove_body": _remove_body,
    "gripper_dead": _gripper_dead,
    "grip_force": _grip_force,
    "lock_joint": _lock_joint,
}
"""What each kind does. `move_body`: value is the shift as a pose, along the world's axes;
`grip_force`: value in N; the others need none."""


def read(faults: Iterable[Fault | Mapping[str, Any]]) -> tuple[Fault, ...]:
    """Faults from values or from mappings with the same keys.

    Raises ValueError for an unknown kind or key, or where the time is not given in just one way.
    """
    found = []
    for each in faults:
        try:
            fault = each if isinstance(each, Fault) else Fault(**each)
        except TypeError as error:
            raise ValueError(f"not a fault: {each!r}: {error}") from None
        if fault.kind not in KINDS:
            raise ValueError(f"no fault kind `{fault.kind}`; known: {', '.join(KINDS)}")
        if (fault.at is None) == (fault.state is None):
            raise ValueError(f"fault `{fault.kind}` needs either `at` or `state`")
        found.append(fault)
    return tuple(found)


class Misfortune:
    """The faults that will happen to one world, drawn from its seed, and those still to come."""

    def __init__(self, faults: Iterable[Fault | Mapping[str, Any]], seed: int) -> None:
        # One draw each, from a source of its own: adding a fault leaves the others as they were.
        self._left = [
            fault
            for k, fault in enumerate(read(faults))
            if random.Random(f"{seed}/{k}").random() < fault.probability
        ]
        self._due: list[Fault] = []

    def enter(self, paths: Iterable[str]) -> None:
        """These states are active now."""
        active = tuple(f"/{path}" for path in paths)
        self._call(lambda fault: _begins(fault, active))

    def strike(self, world: World) -> None:
        """Let happen what is due, before a physics step."""
        if not self._left and not self._due:
            return
        self._call(lambda fault: fault.at is not None and fault.at <= world.time)
        due, self._due = self._due, []
        for fault in due:
            try:
                KINDS[fault.kind](world, fault)
            except KeyError as error:
                world.note("fault", f"{fault.kind} did not happen: {error}")
            else:
                world.note("fault", " ".join(filter(None, (fault.kind, fault.target))))

    def _call(self, now: Callable[[Fault], bool]) -> None:
        self._due += [fault for fault in self._left if now(fault)]
        self._left = [fault for fault in self._left if not now(fault)]


def _begins(fault: Fault, active: tuple[str, ...]) -> bool:
    state = fault.state
    return state is not None and any(path.endswith(f"/{state}") for path in active)
