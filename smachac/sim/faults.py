"""Injected faults as data: the kind, the target, the time, and the probability.

Which faults happen is drawn from the seed of the world: the same seed gives the same faults.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.sim import models
from smachac.sim.arm import Arm, arm_named
from smachac.sim.physics import UnknownNameError
from smachac.sim.scene import Scene
from smachac.sim.transforms import as_pose, shifted


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A fault that happens at most once.

    `kind` is one of KINDS; `target` names a body, a joint or a limb (empty: the only limb);
    `value` is the parameter of the kind. The fault happens at the simulated time `at` (s), or when
    a state begins whose path is or ends with `state`; in the share `probability` of all seeds.
    """

    kind: str
    target: str = ""
    value: Any = None
    at: float | None = None
    state: str | None = None
    probability: float = 1.0


Arms = Sequence[Arm]


def _move_body(scene: Scene, arms: Arms, fault: Fault) -> None:
    body = scene.body(fault.target)
    pose = models.where(scene.engine, body)
    models.place(scene.engine, body, shifted(pose, as_pose(fault.value)))


def _remove_body(scene: Scene, arms: Arms, fault: Fault) -> None:
    scene.remove(fault.target)


def _gripper_dead(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm = arm_named(arms, fault.target)
    arm.stick(arm.fingers)


def _grip_force(scene: Scene, arms: Arms, fault: Fault) -> None:
    # Lower friction would not drop a held block: PyBullet's contacts keep their first friction.
    arm = arm_named(arms, fault.target)
    arm.grip_force = float(fault.value)
    arm.squeeze()


def _lock_joint(scene: Scene, arms: Arms, fault: Fault) -> None:
    for arm in arms:
        if fault.target in arm.limb.joints:
            arm.stick([arm.indices[arm.limb.joints.index(fault.target)]])
            return
    known = tuple(name for arm in arms for name in arm.limb.joints)
    raise UnknownNameError("joint", fault.target, known)


KINDS: dict[str, Callable[[Scene, Arms, Fault], None]] = {
    "move_body": _move_body,
    "remove_body": _remove_body,
    "gripper_dead": _gripper_dead,
    "grip_force": _grip_force,
    "lock_joint": _lock_joint,
}
"""The effect of each kind. The value of `move_body` is the shift as a pose along the world's axes,
the value of `grip_force` a force in N; the other kinds have none."""


def read(faults: Iterable[Fault | Mapping[str, Any]]) -> tuple[Fault, ...]:
    """Faults from values or from mappings with the same keys.

    Raises ValueError for an unknown kind or key, and unless just one of `at` and `state` is given.
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


class FaultSchedule:
    """The faults of one world that are still to happen, drawn from its seed."""

    def __init__(self, faults: Iterable[Fault | Mapping[str, Any]], seed: int) -> None:
        # One draw for each fault from its own source: one more fault does not change the others.
        self._pending = [
            fault
            for k, fault in enumerate(read(faults))
            if random.Random(f"{seed}/{k}").random() < fault.probability
        ]
        self._due: list[Fault] = []

    def enter(self, paths: Iterable[str]) -> None:
        """Make the faults due that wait for one of these active states."""
        active = tuple(f"/{path}" for path in paths)
        self._make_due(lambda fault: _begins(fault, active))

    def apply(self, scene: Scene, arms: Arms) -> None:
        """Apply the faults that are due; to be called before each physics step.

        Each adds an Event. A fault whose target does not exist has no effect.
        """
        if not self._pending and not self._due:
            return
        self._make_due(lambda fault: fault.at is not None and fault.at <= scene.time)
        due, self._due = self._due, []
        for fault in due:
            try:
                KINDS[fault.kind](scene, arms, fault)
            except KeyError as error:
                scene.note("fault", f"{fault.kind} did not happen: {error}")
            else:
                scene.note("fault", " ".join(filter(None, (fault.kind, fault.target))))

    def _make_due(self, condition: Callable[[Fault], bool]) -> None:
        self._due += [fault for fault in self._pending if condition(fault)]
        self._pending = [fault for fault in self._pending if not condition(fault)]


def _begins(fault: Fault, active: tuple[str, ...]) -> bool:
    state = fault.state
    return state is not None and any(path.endswith(f"/{state}") for path in active)
