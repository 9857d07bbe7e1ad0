"""Position control of one limb: measured joints and fingers, and the targets of their motors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from smachac.sim.physics import Engine
from smachac.sim.robots import MountedLimb

GRIP_FORCE = 20.0
"""Force of each finger (N): 1 to 40 N hold a block of 0.1 kg, 100 N press it out."""
GRIP_SPEED = 0.1
"""Speed of each finger (m/s)."""
TOP_SPEED = 1.0
"""Joint speed (rad/s) of a move with speed 1; the limit in the URDF applies where it is lower."""
_LOCK_FORCE = 1000.0
"""Force (N) or torque (N m) that holds a locked joint."""


class JointControl:
    """The joints and the gripper of one limb, without waiting: every method returns at once.

    Joint positions are in rad, finger positions in m. A target applies from the next physics step
    until the next target.

    Attributes:
        limb: the limb as the robot describes it.
        indices: PyBullet's joint numbers, from the base to the hand.
        fingers: PyBullet's joint numbers of the fingers.
        limits: (lowest, highest) position of each joint (rad).
        efforts: the largest torque of each joint (N m).
        speeds: the speed of each joint (rad/s) in a move with speed 1.
        grip_force: force of each finger (N).
        stuck: joint number -> position at which that joint is locked.
    """

    def __init__(self, engine: Engine, body: int, mounted: MountedLimb) -> None:
        self.engine = engine
        self.limb = mounted.limb
        self.tip = mounted.tip
        self.indices = mounted.joints
        self.fingers = mounted.fingers
        self.limits = mounted.limits
        self.efforts = mounted.efforts
        self.speeds = tuple(min(TOP_SPEED, each or TOP_SPEED) for each in mounted.speeds)
        self.grip_force = GRIP_FORCE
        self.stuck: dict[int, float] = {}
        self._body = body
        self._finger_targets = tuple(each.opened for each in self.limb.fingers)

    # Measurements

    @property
    def joints(self) -> tuple[float, ...]:
        """Joint positions (rad)."""
        states = self.engine.getJointStates(self._body, self.indices)
        return tuple(each[0] for each in states)

    @property
    def velocities(self) -> tuple[float, ...]:
        """Joint velocities (rad/s)."""
        states = self.engine.getJointStates(self._body, self.indices)
        return tuple(each[1] for each in states)

    @property
    def opening(self) -> tuple[float, ...]:
        """The distance of each finger from its closed position (m)."""
        states = self.engine.getJointStates(self._body, self.fingers)
        pairs = zip(states, self.limb.fingers, strict=True)
        return tuple(abs(state[0] - finger.closed) for state, finger in pairs)

    @property
    def width(self) -> float:
        """The opening of the gripper (m): the sum over its fingers."""
        return sum(self.opening)

    def contact_forces(self, bodies: Mapping[str, int]) -> dict[str, float]:
        """The bodies that every finger presses, with the force of the weakest finger (N)."""
        pressed = {}
        for name, other in bodies.items():
            each = [
                sum(point[9] for point in self.engine.getContactPoints(self._body, other, finger))
                for finger in self.fingers
            ]
            if each and min(each) > 0.0:
                pressed[name] = min(each)
        return pressed

    # Targets

    def reset(self, joints: Sequence[float]) -> None:
        """Place the joints at `joints` with the gripper open, at rest; for the start of a world."""
        for index, position in zip(self.indices, joints, strict=True):
            self.engine.resetJointState(self._body, index, position)
        for index, finger in zip(self.fingers, self.limb.fingers, strict=True):
            self.engine.resetJointState(self._body, index, finger.opened)
        self.hold()
        self.squeeze(self._finger_targets)

    def command(self, positions: Sequence[float], velocities: Sequence[float]) -> None:
        """Track these joint positions (rad) and velocities (rad/s)."""
        self.engine.setJointMotorControlArray(
            self._body,
            self.indices,
            self.engine.POSITION_CONTROL,
            targetPositions=positions,
            targetVelocities=velocities,
            positionGains=[0.3] * len(self.indices),
            velocityGains=[1.0] * len(self.indices),
            forces=self.efforts,
        )
        self._hold_stuck_joints()

    def hold(self) -> None:
        """Stay at the present joint positions."""
        self.command(self.joints, [0.0] * len(self.indices))

    def squeeze(self, positions: Sequence[float] | None = None) -> None:
        """Drive the fingers to `positions` (m) with the grip force; None keeps the last target."""
        if positions is not None:
            self._finger_targets = tuple(positions)
        for index, position in zip(self.fingers, self._finger_targets, strict=True):
            self.engine.setJointMotorControl2(
                self._body,
                index,
                self.engine.POSITION_CONTROL,
                targetPosition=position,
                force=self.grip_force,
                maxVelocity=GRIP_SPEED,
            )
        self._hold_stuck_joints()

    def stick(self, indices: Sequence[int]) -> None:
        """Lock these joints where they are, for the rest of the run."""
        states = self.engine.getJointStates(self._body, indices)
        self.stuck.update(zip(indices, (each[0] for each in states), strict=True))
        self._hold_stuck_joints()

    def _hold_stuck_joints(self) -> None:
        # A fixed target: explicit joint damping, the other way to lock, makes the solver diverge.
        for index, position in self.stuck.items():
            self.engine.setJointMotorControl2(
                self._body,
                index,
                self.engine.POSITION_CONTROL,
                targetPosition=position,
                force=_LOCK_FORCE,
            )
