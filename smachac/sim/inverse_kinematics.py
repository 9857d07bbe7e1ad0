"""Forward and inverse kinematics of the arms of a robot, from its URDF file alone.

Inverse kinematics is the Levenberg-Marquardt method on the geometric Jacobian of the tool frame
(Siciliano et al., Robotics: Modelling, Planning and Control, 3.7). A joint that follows another
(`<mimic>`) adds its column, times its multiplier, to that of the joint that it follows.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.sim.robots import SLIDE, Limb, RobotPart
from smachac.sim.transforms import (
    IDENTITY,
    Pose,
    Vector,
    add,
    angle_between,
    compose,
    conjugate,
    multiply,
    nearest_turn,
    rotate,
)

POSITION_TOLERANCE = 1e-4
"""Largest distance (m) of a solution from the goal along each axis."""
ANGLE_TOLERANCE = 1e-3
"""Largest angle (rad) between a solution and the goal."""
_ROUNDS = 50
"""Steps from each start posture."""
_TRIES = 10
"""Random start postures, after the given ones."""
_LARGEST_STEP = 1.0
"""Largest change (rad) of a joint in one step."""
_PRECISE = 0.01
"""Part of the tolerances at which the steps end: a solution is better than its tolerances."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Joint:
    """A joint between the base and the tip of a limb.

    `origin` is its frame in that of the moved joint before it. Its position is `multiplier` times
    that of the joint `leader`, plus `offset`; `index` is that of the leader among the joints of the
    limb, None for a joint that the limb does not move.
    """

    origin: Pose
    axis: Vector
    turns: bool
    leader: str
    multiplier: float
    offset: float
    index: int | None

    def motion(self, position: float) -> Pose:
        """The pose of the link that it moves, in the frame of the joint."""
        x, y, z = self.axis
        if not self.turns:
            return (x * position, y * position, z * position), IDENTITY[1]
        s = math.sin(position / 2)
        return IDENTITY[0], (x * s, y * s, z * s, math.cos(position / 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class _Chain:
    """The joints from the base to the tip of a limb, and the tool frame in the last of them."""

    joints: tuple[_Joint, ...]
    tool: Pose


class Kinematics:
    """The arms of one robot with its base at the origin; the joints of other arms at their home."""

    def __init__(self, robot: RobotPart) -> None:
        self._facts = robot.file.urdf.joints
        self._rest = robot.rest()
        self._chains = {limb.name: _chain(robot, limb) for limb in robot.limbs}

    def tip(
        self, limb: Limb, joints: Sequence[float], others: Mapping[str, float] | None = None
    ) -> Pose:
        """Forward kinematics: the tip's pose in the base frame.

        `others` are positions of joints that are not of the limb, by name.
        """
        return self._frames(limb, joints, others or {})[1]

    def solve(
        self,
        limb: Limb,
        pose: Pose,
        seed: Sequence[float] | None = None,
        others: Mapping[str, float] | None = None,
    ) -> tuple[float, ...] | None:
        """Joints (rad, or m if they slide) that bring the tip of `limb` to `pose` (base frame).

        None if there are none. Start postures: `seed` if given, then the limb's home, then random
        ones, which are the same at every call. So the result depends on the arguments alone.
        A continuous joint is less than half a turn from the start posture.
        """
        for start in self._seeds(limb, seed):
            joints = self._descend(limb, pose, start, others or {})
            if joints is not None:
                return joints
        return None

    def _seeds(self, limb: Limb, seed: Sequence[float] | None) -> Iterator[Sequence[float]]:
        if seed is not None:
            yield seed
        yield limb.home
        draw = random.Random(0)
        facts = [self._facts[name] for name in limb.joints]
        for _ in range(_TRIES):
            yield [
                draw.uniform(joint.lower, joint.upper)
                if joint.is_limited
                else draw.uniform(-math.pi, math.pi)
                for joint in facts
            ]

    def _descend(
        self, limb: Limb, pose: Pose, start: Sequence[float], others: Mapping[str, float]
    ) -> tuple[float, ...] | None:
        """The joints that a search from one start posture finds; None if it ends elsewhere."""
        joints, damping = tuple(start), 1e-4
        frames, tip = self._frames(limb, joints, others)
        error = _error(tip, pose)
        for _ in range(_ROUNDS):
            if _is_close(tip, pose, _PRECISE) or damping > 1e3:
                break
            step = _step(_jacobian(limb, self._chains[limb.name], frames, tip), error, damping)
            moved = self._moved(limb, joints, step)
            frames_there, there = self._frames(limb, moved, others)
            error_there = _error(there, pose)
            if math.hypot(*error_there) < math.hypot(*error):
                joints, frames, tip, error = moved, frames_there, there, error_there
                damping = max(damping / 5, 1e-9)
            else:
                damping = max(damping * 5, 1e-7)
        if not _is_close(tip, pose, 1.0):
            return None
        return tuple(
            position if self._facts[name].is_limited else nearest_turn(position, begun)
            for name, position, begun in zip(limb.joints, joints, start, strict=True)
        )

    def _moved(
        self, limb: Limb, joints: Sequence[float], step: Sequence[float]
    ) -> tuple[float, ...]:
        """The joints after a step, within their limits."""
        facts = [self._facts[name] for name in limb.joints]
        largest = max(map(abs, step), default=0.0)
        part = _LARGEST_STEP / largest if largest > _LARGEST_STEP else 1.0
        scales = [1.0 if joint.turns else SLIDE for joint in facts]
        return tuple(
            min(max(position + part * change * scale, joint.lower), joint.upper)
            for position, change, scale, joint in zip(joints, step, scales, facts, strict=True)
        )

    def _frames(
        self, limb: Limb, joints: Sequence[float], others: Mapping[str, float]
    ) -> tuple[list[Pose], Pose]:
        """The frames of the joints of a chain, and that of the tip (base frame)."""
        chain, place = self._chains[limb.name], IDENTITY
        frames = []
        for joint in chain.joints:
            if joint.index is not None:
                leader = joints[joint.index]
            else:
                leader = others.get(joint.leader, self._rest[joint.leader])
            frames.append(compose(place, joint.origin))
            place = compose(frames[-1], joint.motion(joint.multiplier * leader + joint.offset))
        return frames, compose(place, chain.tool)


def _chain(robot: RobotPart, limb: Limb) -> _Chain:
    """The chain of a limb; the origins of fixed joints are parts of those of moved ones."""
    origin, joints = IDENTITY, []
    frames = robot.file.frames()
    for fact in robot.file.urdf.chain(limb.tip):
        place, axis = frames[fact.name]
        origin = compose(origin, place)
        if not fact.is_moved:
            continue
        leader = robot.file.urdf.leader(fact.name)
        joints.append(
            _Joint(
                origin=origin,
                axis=axis,
                turns=fact.turns,
                leader=leader.joint,
                multiplier=leader.multiplier,
                offset=leader.offset,
                index=limb.joints.index(leader.joint) if leader.joint in limb.joints else None,
            )
        )
        origin = IDENTITY
    return _Chain(joints=tuple(joints), tool=compose(origin, limb.offset))


def _jacobian(limb: Limb, chain: _Chain, frames: Sequence[Pose], tip: Pose) -> list[list[float]]:
    """The geometric Jacobian of the tip: for each joint of the limb its column of six numbers.

    The column of a joint that slides is that of SLIDE metres.
    """
    columns = [[0.0] * 6 for _ in limb.joints]
    for joint, (place, rotation) in zip(chain.joints, frames, strict=True):
        if joint.index is None:
            continue
        x, y, z = rotate(rotation, joint.axis)
        if joint.turns:
            a, b, c = (t - p for t, p in zip(tip[0], place, strict=True))
            column = [y * c - z * b, z * a - x * c, x * b - y * a, x, y, z]
        else:
            column = [SLIDE * x, SLIDE * y, SLIDE * z, 0.0, 0.0, 0.0]
        total = columns[joint.index]
        for k in range(6):
            total[k] += joint.multiplier * column[k]
    return columns


def _step(columns: list[list[float]], error: Sequence[float], damping: float) -> list[float]:
    """The damped least-squares step: J^T (J J^T + damping I)^-1 error."""
    import numpy

    transposed: Any = numpy.array(columns)
    square = transposed.T @ transposed + damping * numpy.eye(6)
    step: list[float] = (transposed @ numpy.linalg.solve(square, error)).tolist()
    return step


def _error(tip: Pose, goal: Pose) -> list[float]:
    """The way from the tip to the goal: the translation (m), and the rotation vector (rad)."""
    x, y, z, w = multiply(goal[1], conjugate(tip[1]))
    if w < 0.0:
        x, y, z, w = -x, -y, -z, -w
    s = math.hypot(x, y, z)
    scale = 2.0 * math.atan2(s, w) / s if s > 1e-12 else 2.0
    way = add(goal[0], (-tip[0][0], -tip[0][1], -tip[0][2]))
    return [*way, scale * x, scale * y, scale * z]


def _is_close(tip: Pose, goal: Pose, part: float) -> bool:
    """Whether the tip is at the goal, within a part of the tolerances."""
    far = max(abs(a - b) for a, b in zip(tip[0], goal[0], strict=True))
    if far >= part * POSITION_TOLERANCE:
        return False
    return angle_between(tip[1], goal[1]) < part * ANGLE_TOLERANCE
