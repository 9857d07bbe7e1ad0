"""An arm of a robot in the world: its joints, its tip, its gripper, and its skills."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from smachac.sim import skills, transforms
from smachac.sim.clock import Skill
from smachac.sim.physics import Engine
from smachac.sim.robots import Parts
from smachac.sim.skills import Result
from smachac.sim.transforms import IDENTITY, Pose, as_pose

if TYPE_CHECKING:
    from smachac.sim.world import World

GRIP_FORCE = 20.0
"""N, each finger; 1 to 40 N hold a block of 0.1 kg, 100 N press it out."""
GRIP_SPEED = 0.1
"""m/s."""
TOP_SPEED = 1.0
"""rad/s, for speed 1; a joint's own limit may be lower."""


class Arm:
    """One limb of the robot. Positions in rad (fingers m), poses of the tip.

    The skills block until done in simulated time. They return a Result for whatever the physical
    world refuses, and raise only for a wrong call (a pose without seven numbers, an unknown frame).
    `preempted`, where given, is asked between two physics steps; when true the arm stays where it
    is and the outcome is `preempted`.
    """

    def __init__(self, world: World, parts: Parts) -> None:
        self.world = world
        self.limb = parts.limb
        self.tip = parts.tip
        self.indices = parts.joints
        self.fingers = parts.fingers
        self.limits = parts.limits
        self.efforts = parts.efforts
        self.speeds = tuple(min(TOP_SPEED, each or TOP_SPEED) for each in parts.speeds)
        self.grip_force = GRIP_FORCE
        self.stuck: dict[int, float] = {}
        self._grip = tuple(each.opened for each in self.limb.fingers)

    @property
    def name(self) -> str:
        """The limb's name."""
        return self.limb.name

    @property
    def engine(self) -> Engine:
        """The physics client."""
        return self.world.engine

    # What is

    @property
    def joints(self) -> tuple[float, ...]:
        """Joint positions (rad)."""
        states = self.engine.getJointStates(self.world.robot_body, self.indices)
        return tuple(each[0] for each in states)

    @property
    def velocities(self) -> tuple[float, ...]:
        """Joint velocities (rad/s)."""
        states = self.engine.getJointStates(self.world.robot_body, self.indices)
        return tuple(each[1] for each in states)

    @property
    def opening(self) -> tuple[float, ...]:
        """How far each finger stands from closed (m)."""
        states = self.engine.getJointStates(self.world.robot_body, self.fingers)
        pairs = zip(states, self.limb.fingers, strict=True)
        return tuple(abs(state[0] - finger.closed) for state, finger in pairs)

    @property
    def width(self) -> float:
        """The gripper's opening (m)."""
        return sum(self.opening)

    def tip_pose(self, frame: str = "base") -> list[list[float]]:
        """Where the tip is."""
        state = self.engine.getLinkState(
            self.world.robot_body, self.tip, computeForwardKinematics=True
        )
        return transforms.as_lists(self.world.seen_from(frame, (state[4], state[5])))

    def forces(self) -> dict[str, float]:
        """The bodies that the fingers press, with the weaker finger's force (N)."""
        body, pressed = self.world.robot_body, {}
        for name, other in self.world.bodies.items():
            each = [
                sum(point[9] for point in self.engine.getContactPoints(body, other, finger))
                for finger in self.fingers
            ]
            if each and min(each) > 0.0:
                pressed[name] = min(each)
        return pressed

    # What is to be

    def reset(self, joints: Sequence[float]) -> None:
        """Be at `joints`, gripper open, without motion; for the start of a world."""
        for index, position in zip(self.indices, joints, strict=True):
            self.engine.resetJointState(self.world.robot_body, index, position)
        for index, finger in zip(self.fingers, self.limb.fingers, strict=True):
            self.engine.resetJointState(self.world.robot_body, index, finger.opened)
        self.hold()
        self.squeeze(self._grip)

    def command(self, positions: Sequence[float], velocities: Sequence[float]) -> None:
        """Track these joints (rad, rad/s) from the next physics step on."""
        self.engine.setJointMotorControlArray(
            self.world.robot_body,
            self.indices,
            self.engine.POSITION_CONTROL,
            targetPositions=positions,
            targetVelocities=velocities,
            positionGains=[0.3] * len(self.indices),
            velocityGains=[1.0] * len(self.indices),
            forces=self.efforts,
        )
        self._stick()

    def hold(self) -> None:
        """Stay at the present joints."""
        self.command(self.joints, [0.0] * len(self.indices))

    def squeeze(self, positions: Sequence[float] | None = None) -> None:
        """Drive the fingers to `positions` (m) with the grip force; None repeats the last ones."""
        self._grip = self._grip if positions is None else tuple(positions)
        for index, position in zip(self.fingers, self._grip, strict=True):
            self.engine.setJointMotorControl2(
                self.world.robot_body,
                index,
                self.engine.POSITION_CONTROL,
                targetPosition=position,
                force=self.grip_force,
                maxVelocity=GRIP_SPEED,
            )
        self._stick()

    def stick(self, indices: Sequence[int]) -> None:
        """Seize these joints where they are, for good."""
        states = self.engine.getJointStates(self.world.robot_body, indices)
        self.stuck.update(zip(indices, (each[0] for each in states), strict=True))
        self._stick()

    def _stick(self) -> None:
        # A frozen target: explicit joint damping, the other way to lock, blows the solver up.
        for index, position in self.stuck.items():
            self.engine.setJointMotorControl2(
                self.world.robot_body,
                index,
                self.engine.POSITION_CONTROL,
                targetPosition=position,
                force=1000.0,
            )

    # Skills

    def move_to_joints(
        self,
        positions: Sequence[float],
        speed: float = 1.0,
        preempted: Callable[[], bool] | None = None,
    ) -> Result:
        """Move to `positions` (rad) in joint space; `speed` multiplies 1 rad/s."""
        return self._do("move", skills.move(self, positions, speed, preempted))

    def move_along(
        self,
        pose: Any,
        offset: Any = None,
        speed: float = 1.0,
        preempted: Callable[[], bool] | None = None,
        frame: str = "base",
    ) -> Result:
        """Move the tip on the straight line from where it is to `pose` + `offset`."""
        target = self._target(pose, offset, frame)
        return self._do("move along", skills.move_along(self, target, speed, preempted))

    def grip(self, command: str, preempted: Callable[[], bool] | None = None) -> Result:
        """`open` or `close` the gripper; the value is its width (m).

        Aborted when it does not open, or closes on nothing. Raises ValueError for another command.
        """
        if command not in ("open", "close"):
            raise ValueError(f"no gripper command `{command}`; known: `open`, `close`")
        return self._do(f"grip {command}", skills.grip(self, command == "open", preempted))

    def check_grasp(self, name: str | None = None) -> Result:
        """Whether both fingers press one body (`name`, else any); the value is its name."""
        return self._do("check grasp", skills.check_grasp(self, name))

    def holds(self, name: str | None = None) -> bool:
        """The same as a plain truth."""
        return self.world.run(skills.check_grasp(self, name)).outcome == "succeeded"

    def solve_ik(self, pose: Any, offset: Any = None, frame: str = "base") -> list[float] | None:
        """Joints (rad) that bring the tip to `pose`, moved by `offset` along the frame's axes.

        None when out of reach. Solved from the limb's home, never from where the arm is, lest the
        posture drifts from cycle to cycle.
        """
        target = self._target(pose, offset, frame)
        joints = self.world.shadow.solve(self.limb, target)
        if joints is None:
            place = ", ".join(f"{each:.3f}" for each in target[0])
            self.world.note("ik", f"{self.name}: ({place}) is out of reach")
            return None
        return list(joints)

    def grasp_pose(self, block_pose: Any) -> list[list[float]]:
        """The tool pose that grips a cube at `block_pose` with this hand, tool straight down."""
        return transforms.grasp_pose(block_pose, self.limb.turn)

    def _target(self, pose: Any, offset: Any, frame: str) -> Pose:
        shift = IDENTITY if offset is None else as_pose(offset)
        moved = transforms.shifted(as_pose(pose), shift)
        return self.world.seen_from("base", transforms.compose(self.world.frame(frame), moved))

    def _do(self, name: str, skill: Skill[Result]) -> Result:
        result = self.world.run(skill)
        if result.outcome == "aborted":
            self.world.note(name, f"{self.name}: {result.reason}")
        return result
