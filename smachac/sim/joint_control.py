"""Position control of one limb: measured joints and fingers, and the targets of their motors."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from smachac.sim.physics import Engine
from smachac.sim.robots import SLIDE, MountedLimb
from smachac.sim.transforms import nearest_turn

GRIP_TIME = 0.4
"""Time (s) in which a finger moves from open to closed: 0.1 m/s for a stroke of 0.04 m."""
_FOLLOW_FORCE = 50.0
"""Force (N) or torque (N m) with which joints of a gripper follow its first one."""
_LOCK_FORCE = 1000.0
"""Force (N) or torque (N m) that holds a locked joint."""


class JointControl:
    """The joints and the gripper of one limb, without waiting: every method returns at once.

    Positions of joints and fingers are in rad, or m if they slide. A target applies from the next
    physics step until the next target.

    Attributes:
        limb: the limb as the robot describes it.
        indices: PyBullet's joint numbers, from the base to the hand.
        fingers: PyBullet's joint numbers of the fingers.
        facts: the joints as the URDF file describes them.
        scales: 1 for each joint that turns, SLIDE for each that slides.
        efforts: the largest torque (N m) or force (N) of each joint.
        finger_joints: the fingers of the gripper as described; none without a gripper.
        grip_force: force of each finger (N, or N m if it turns).
        slips: whether the fingers press with no force, until the gripper opens.
        stuck: joint number -> position at which that joint is locked.
    """

    def __init__(self, engine: Engine, mounted: MountedLimb) -> None:
        self.engine = engine
        self.limb = mounted.limb
        self.tip = mounted.tip
        self.indices = mounted.joints
        self.fingers = mounted.fingers
        self.facts = mounted.facts
        self.scales = tuple(1.0 if joint.turns else SLIDE for joint in mounted.facts)
        self.efforts = mounted.efforts
        gripper = mounted.gripper
        self.finger_joints = gripper.fingers if gripper is not None else ()
        # 1 to 40 N hold a block of 0.1 kg, 100 N press it out.
        self.grip_force = gripper.force if gripper is not None else 0.0
        self.closed_width, self.open_width = gripper.width if gripper is not None else (0.0, 0.0)
        self.slips = False
        self.stuck: dict[int, float] = {}
        self._body = mounted.body
        self._pads = mounted.pads
        self._followers = mounted.followers
        self._carriers = mounted.carriers
        self._finger_targets = tuple(joint.opened for joint in self.finger_joints)

    # Measurements

    @property
    def joints(self) -> tuple[float, ...]:
        """Joint positions (rad or m); a continuous joint may have made several turns."""
        states = self.engine.getJointStates(self._body, self.indices)
        return tuple(state[0] for state in states)

    @property
    def velocities(self) -> tuple[float, ...]:
        """Joint velocities (rad/s or m/s)."""
        states = self.engine.getJointStates(self._body, self.indices)
        return tuple(state[1] for state in states)

    @property
    def carriers(self) -> dict[str, float]:
        """The positions (rad or m) of the joints of other limbs that carry this one, by name."""
        if not self._carriers:
            return {}
        states = self.engine.getJointStates(self._body, [*self._carriers.values()])
        return {name: state[0] for name, state in zip(self._carriers, states, strict=True)}

    def unwound(self, positions: Sequence[float], begun: Sequence[float]) -> tuple[float, ...]:
        """`positions`, those of continuous joints in the turn that is nearest to `begun`."""
        return tuple(
            position if joint.is_limited else nearest_turn(position, start)
            for joint, position, start in zip(self.facts, positions, begun, strict=True)
        )

    @property
    def opening(self) -> tuple[float, ...]:
        """How far each finger is open: 0 closed, 1 open."""
        if not self.fingers:
            return ()
        states = self.engine.getJointStates(self._body, self.fingers)
        return tuple(
            abs(state[0] - finger.closed) / abs(finger.opened - finger.closed)
            for state, finger in zip(states, self.finger_joints, strict=True)
        )

    @property
    def width(self) -> float:
        """The distance between the fingers (m), computed from the mean opening of all fingers."""
        opening = self.opening
        part = sum(opening) / len(opening) if opening else 0.0
        return self.closed_width + part * (self.open_width - self.closed_width)

    def contact_forces(self, bodies: Mapping[str, int]) -> dict[str, float]:
        """The bodies that every finger presses, with the force of the weakest finger (N)."""
        pressed = {}
        for name, other in bodies.items():
            each = [
                sum(point[9] for point in self.engine.getContactPoints(self._body, other, finger))
                for finger in self._pads
            ]
            if each and min(each) > 0.0:
                pressed[name] = min(each)
        return pressed

    # Targets

    def reset(self, joints: Sequence[float]) -> None:
        """Place the joints at `joints` with the gripper open, at rest; for the start of a world."""
        for index, position in zip(self.indices, joints, strict=True):
            self.engine.resetJointState(self._body, index, position)
        for follower in self._followers:
            position = follower.multiplier * joints[follower.leader] + follower.offset
            self.engine.resetJointState(self._body, follower.joint, position)
        for index, finger in zip(self.fingers, self.finger_joints, strict=True):
            self.engine.resetJointState(self._body, index, finger.opened)
        self.hold()
        self.squeeze(self._finger_targets)

    def command(self, positions: Sequence[float], velocities: Sequence[float]) -> None:
        """Track these joint positions (rad or m) and velocities (rad/s or m/s).

        The joints that follow others track the positions that these have.
        """
        followers = self._followers
        count = len(self.indices) + len(followers)
        self.engine.setJointMotorControlArray(
            self._body,
            [*self.indices, *(follower.joint for follower in followers)],
            self.engine.POSITION_CONTROL,
            targetPositions=[
                *positions,
                *(
                    follower.multiplier * positions[follower.leader] + follower.offset
                    for follower in followers
                ),
            ],
            targetVelocities=[
                *velocities,
                *(follower.multiplier * velocities[follower.leader] for follower in followers),
            ],
            positionGains=[0.3] * count,
            velocityGains=[1.0] * count,
            forces=[*self.efforts, *(follower.effort for follower in followers)],
        )
        self._hold_stuck_joints()

    def hold(self) -> None:
        """Stay at the present joint positions."""
        self.command(self.joints, [0.0] * len(self.indices))

    def squeeze(self, positions: Sequence[float] | None = None) -> None:
        """Drive the fingers to `positions` (m, or rad if they turn) with the grip force.

        None keeps the last target.
        """
        if positions is not None:
            self._finger_targets = tuple(positions)
        rows = zip(self.fingers, self.finger_joints, self._finger_targets, strict=True)
        for index, finger, position in rows:
            self.engine.setJointMotorControl2(
                self._body,
                index,
                self.engine.POSITION_CONTROL,
                targetPosition=position,
                force=0.0 if self.slips else self.grip_force,
                maxVelocity=abs(finger.opened - finger.closed) / GRIP_TIME,
            )
        self.follow()

    def follow(self) -> None:
        """Bring the other joints of a gripper of more than two to the opening of the first."""
        if len(self.fingers) > 2:
            part = self.opening[0]
            for index, finger in zip(self.fingers[1:], self.finger_joints[1:], strict=True):
                self.engine.setJointMotorControl2(
                    self._body,
                    index,
                    self.engine.POSITION_CONTROL,
                    targetPosition=finger.closed + part * (finger.opened - finger.closed),
                    force=_FOLLOW_FORCE,
                )
        self._hold_stuck_joints()

    def stick(self, indices: Sequence[int]) -> None:
        """Lock these joints, and those that follow them, for the rest of the run."""
        locked = [*indices]
        locked += [
            follower.joint
            for follower in self._followers
            if self.indices[follower.leader] in indices
        ]
        states = self.engine.getJointStates(self._body, locked)
        self.stuck.update(zip(locked, (state[0] for state in states), strict=True))
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
