"""Injected faults: which of them happen, when, and what each one does to the world.

Which faults happen is drawn from the seed of the world: the same seed gives the same faults.
"""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from smachac.robots.faults import Fault as Fault
from smachac.robots.faults import read as read
from smachac.sim import models
from smachac.sim.arm import Arm, arm_named
from smachac.sim.physics import UnknownNameError
from smachac.sim.scene import Scene
from smachac.sim.transforms import as_pose, shifted

Arms = Sequence[Arm]


class WorldCrash(RuntimeError):  # noqa: N818
    """The simulated world has crashed, as a fault demanded: every later skill raises this too."""


def _move_body(scene: Scene, arms: Arms, fault: Fault) -> None:
    body = scene.body(fault.target)
    pose = models.where(scene.engine, body)
    models.place(scene.engine, body, shifted(pose, as_pose(fault.value)))


def _remove_body(scene: Scene, arms: Arms, fault: Fault) -> None:
    scene.remove(fault.target)


def _gripper_dead(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm = arm_named(arms, fault.target)
    arm.stick(arm.fingers)


def _gripper_slips(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm = arm_named(arms, fault.target)
    arm.slips = True
    arm.squeeze()


def _grip_force(scene: Scene, arms: Arms, fault: Fault) -> None:
    # Lower friction would not drop a held block: PyBullet's contacts keep their first friction.
    arm = arm_named(arms, fault.target)
    arm.grip_force = float(fault.value)
    arm.squeeze()


def _lock_joint(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm, number = _joint(arms, fault.target)
    arm.stick([arm.indices[number]])


def _weak_joint(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm, number = _joint(arms, fault.target)
    efforts = list(arm.efforts)
    efforts[number] = float(fault.value)
    arm.efforts = tuple(efforts)


def _joint(arms: Arms, name: str) -> tuple[Arm, int]:
    for arm in arms:
        if name in arm.limb.joints:
            return arm, arm.limb.joints.index(name)
    raise UnknownNameError("joint", name, tuple(name for arm in arms for name in arm.limb.joints))


def _no_ik(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm_named(arms, fault.target).solves = False


def _sensor_noise(scene: Scene, arms: Arms, fault: Fault) -> None:
    scene.noise = float(fault.value)


def _never_returns(scene: Scene, arms: Arms, fault: Fault) -> None:
    arm_named(arms, fault.target).returns = False


def _crash(scene: Scene, arms: Arms, fault: Fault) -> None:
    scene.crashed = True


EFFECTS: Mapping[str, Callable[[Scene, Arms, Fault], None]] = {
    "move_body": _move_body,
    "remove_body": _remove_body,
    "gripper_dead": _gripper_dead,
    "gripper_slips": _gripper_slips,
    "grip_force": _grip_force,
    "lock_joint": _lock_joint,
    "weak_joint": _weak_joint,
    "no_ik": _no_ik,
    "sensor_noise": _sensor_noise,
    "never_returns": _never_returns,
    "crash": _crash,
}
"""The effect of each kind of robots.faults.KINDS."""

AT_ONCE = frozenset({"no_ik", "sensor_noise", "never_returns", "crash"})
"""The kinds that apply when their state begins: they do not touch the physics. The other kinds
apply before the next physics step."""


class FaultSchedule:
    """The faults of one world that are still to happen, drawn from its seed."""

    def __init__(self, faults: Iterable[Fault | Mapping[str, Any]], seed: int) -> None:
        # One draw for each fault from its own source: one more fault does not change the others.
        self._seed = seed
        self._visits: Counter[int] = Counter()
        self._pending = [
            (k, fault)
            for k, fault in enumerate(read(faults))
            if fault.each_time or self._happens(f"{seed}/{k}", fault)
        ]
        self._due: list[Fault] = []

    @staticmethod
    def _happens(source: str, fault: Fault) -> bool:
        return random.Random(source).random() < fault.probability

    def enter(self, scene: Scene, arms: Arms, began: Iterable[str]) -> None:
        """Make the faults due that wait for one of the states `began`, which begin now.

        Raises WorldCrash.
        """
        if not self._pending:
            return
        paths = tuple(f"/{path}" for path in began)
        found = [pair for pair in self._pending if _begins(pair[1], paths)]
        for number, fault in found:
            if fault.each_time:
                self._visits[number] += 1
                source = f"{self._seed}/{number}/{self._visits[number]}"
                if not self._happens(source, fault):
                    continue
            else:
                self._pending.remove((number, fault))
            if fault.kind in AT_ONCE:
                _apply(scene, arms, fault)
            else:
                self._due.append(fault)
        check_alive(scene)

    def apply(self, scene: Scene, arms: Arms) -> None:
        """Apply the faults that are due; to be called before each physics step.

        Each adds an Event. A fault whose target does not exist has no effect. Raises WorldCrash.
        """
        if self._pending or self._due:
            now = [pair for pair in self._pending if _is_due(pair[1], scene.time)]
            self._pending = [pair for pair in self._pending if pair not in now]
            due, self._due = [*self._due, *(fault for _, fault in now)], []
            for fault in due:
                _apply(scene, arms, fault)
        check_alive(scene)


def check_alive(scene: Scene) -> None:
    """Raises WorldCrash after the fault `crash`."""
    if scene.crashed:
        raise WorldCrash("the simulated world has crashed (injected fault)")


def _apply(scene: Scene, arms: Arms, fault: Fault) -> None:
    try:
        EFFECTS[fault.kind](scene, arms, fault)
    except KeyError as error:
        scene.note("fault", f"{fault.kind} did not happen: {error}")
    else:
        scene.note("fault", " ".join(filter(None, (fault.kind, fault.target))))


def _is_due(fault: Fault, time: float) -> bool:
    return fault.at is not None and fault.at <= time


def _begins(fault: Fault, paths: tuple[str, ...]) -> bool:
    return fault.state is not None and any(path.endswith(f"/{fault.state}") for path in paths)
