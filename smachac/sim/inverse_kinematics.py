"""Forward and inverse kinematics of a robot, on a physics client that holds only the robot.

PyBullet's solver makes damped least-squares steps and may stop far from the goal. So it is
repeated, and each result is checked by forward kinematics against the tolerances below.
"""

import random
import threading
from collections.abc import Iterator, Sequence

from smachac.sim.physics import Engine, quiet
from smachac.sim.robots import Limb, RobotPart
from smachac.sim.transforms import IDENTITY, Pose, angle_between, compose, inverse

POSITION_TOLERANCE = 1e-4
"""Largest distance (m) of a solution from the goal along each axis."""
ANGLE_TOLERANCE = 1e-3
"""Largest angle (rad) between a solution and the goal."""
_ROUNDS = 50
"""Solver calls for each start posture."""
_TRIES = 10
"""Random start postures, after the given ones."""


class Kinematics:
    """The robot in an empty world with its base at the origin. Any thread may call it.

    Raises SimUnavailable without PyBullet. To be closed, which frees the physics client.
    """

    def __init__(self, robot: RobotPart) -> None:
        self._engine = Engine()
        self._lock = threading.Lock()
        flags = self._engine.URDF_IGNORE_VISUAL_SHAPES | self._engine.URDF_IGNORE_COLLISION_SHAPES
        with quiet():
            self._body = self._engine.loadURDF(str(robot.path), useFixedBase=True, flags=flags)
        self._joints: dict[str, int] = {}
        self._links: dict[str, int] = {}
        self._limits: dict[str, tuple[float, float]] = {}
        self._movable: list[str] = []
        for index in range(self._engine.getNumJoints(self._body)):
            known = self._engine.getJointInfo(self._body, index)
            name = known[1].decode()
            self._joints[name], self._links[known[12].decode()] = index, index
            self._limits[name] = (known[8], known[9])
            if known[2] != self._engine.JOINT_FIXED:
                self._movable.append(name)
        self._start = {
            name: position
            for limb in robot.limbs
            for name, position in zip(limb.joints, limb.home, strict=True)
        }

    def close(self) -> None:
        """Free the physics client."""
        self._engine.close()

    def tip(self, limb: Limb, joints: Sequence[float]) -> Pose:
        """Forward kinematics: the tip's pose in the base frame."""
        with self._lock:
            return self._tip(limb, joints)

    def solve(
        self, limb: Limb, pose: Pose, seed: Sequence[float] | None = None
    ) -> tuple[float, ...] | None:
        """Joints (rad) that bring the tip of `limb` to `pose` (base frame), or None.

        Start postures: `seed` if given, then the limb's home, then random ones, which are the same
        at every call. So the result depends on the arguments alone.
        """
        with self._lock:
            for start in self._seeds(limb, seed):
                joints = self._descend(limb, pose, start)
                if joints is not None:
                    return joints
        return None

    def _seeds(self, limb: Limb, seed: Sequence[float] | None) -> Iterator[Sequence[float]]:
        if seed is not None:
            yield seed
        yield limb.home
        draw = random.Random(0)
        for _ in range(_TRIES):
            yield [draw.uniform(*self._limits[name]) for name in limb.joints]

    def _descend(self, limb: Limb, pose: Pose, start: Sequence[float]) -> tuple[float, ...] | None:
        joints = tuple(start)
        self._tip(limb, joints)
        link = pose if limb.offset == IDENTITY else compose(pose, inverse(limb.offset))
        for _ in range(_ROUNDS):
            answer = self._engine.calculateInverseKinematics(
                self._body,
                self._links[limb.tip],
                link[0],
                link[1],
                maxNumIterations=20,
                residualThreshold=1e-6,
            )
            found = dict(zip(self._movable, answer, strict=True))
            joints = tuple(self._clip(name, found[name]) for name in limb.joints)
            reached = self._tip(limb, joints)
            if (
                max(abs(a - b) for a, b in zip(reached[0], pose[0], strict=True))
                < POSITION_TOLERANCE
                and angle_between(reached[1], pose[1]) < ANGLE_TOLERANCE
            ):
                return joints
        return None

    def _clip(self, joint: str, position: float) -> float:
        low, high = self._limits[joint]
        return min(max(position, low), high)

    def _tip(self, limb: Limb, joints: Sequence[float]) -> Pose:
        posture = {**self._start, **dict(zip(limb.joints, joints, strict=True))}
        for name in self._movable:
            self._engine.resetJointState(self._body, self._joints[name], posture.get(name, 0.0))
        state = self._engine.getLinkState(
            self._body, self._links[limb.tip], computeForwardKinematics=True
        )
        link = state[4], state[5]
        return link if limb.offset == IDENTITY else compose(link, limb.offset)
