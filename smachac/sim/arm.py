"""An arm of the robot in a scene: its tip, inverse kinematics, and skills that block."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from smachac.sim import skills, transforms
from smachac.sim.clock import Skill
from smachac.sim.joint_control import JointControl
from smachac.sim.outcome import Preempted, Result
from smachac.sim.physics import UnknownNameError
from smachac.sim.robots import MountedLimb
from smachac.sim.scene import Scene
from smachac.sim.transforms import IDENTITY, Pose, as_pose


class Arm(JointControl):
    """One limb of the robot. Positions of joints and fingers in rad, or m if they slide.

    A skill returns when it has ended in simulated time. Physical failures (out of reach, not
    settled in time, an empty grasp) are a Result with the outcome `aborted` and a reason, and an
    Event of the world. Only a wrong call raises: ValueError for a pose that is not seven numbers,
    UnknownNameError for an unknown frame.

    `preempted`, where given, is called before each physics step; once it returns true the arm
    stays where it is and the outcome is `preempted`.

    Attributes:
        world: the scene that the arm stands in.
        body: PyBullet's number of its robot.
        base: the pose of its robot's base (world frame).
        kinematics: forward and inverse kinematics of its robot.
        solves: whether the next pose can be within reach; an injected fault unsets it.
        returns: whether the next skill returns; an injected fault unsets it.
    """

    def __init__(self, world: Scene, mounted: MountedLimb) -> None:
        super().__init__(world.engine, mounted)
        self.world = world
        self.solves = self.returns = True
        self.body, self.base = mounted.body, mounted.base
        self.kinematics = world.kinematics[mounted.body]

    @property
    def name(self) -> str:
        """The limb's name."""
        return self.limb.name

    def tip_pose(self, frame: str = "base") -> list[list[float]]:
        """The pose of the tip in `frame`. Raises UnknownNameError."""
        state = self.engine.getLinkState(self.body, self.tip, computeForwardKinematics=True)
        tip = transforms.compose((state[4], state[5]), self.limb.offset)
        return transforms.as_lists(self.world.seen_from(frame, tip))

    def forces(self) -> dict[str, float]:
        """The bodies that every finger presses, with the force of the weakest finger (N)."""
        return self.contact_forces(self.world.bodies)

    def solve_ik(self, pose: Any, offset: Any = None, frame: str = "base") -> list[float] | None:
        """Joints (rad or m) that bring the tip to `pose`, moved by `offset` along the frame's axes.

        None, and an Event, if the pose is out of reach. The search starts from the limb's home and
        not from the present joints, so the posture does not drift from cycle to cycle. Joints of
        other limbs that carry this one are where they are.
        """
        target = self._target(pose, offset, frame)
        joints = None
        if self.solves:
            joints = self.kinematics.solve(self.limb, target, others=self.carriers)
        self.solves = True
        if joints is None:
            place = ", ".join(f"{number:.3f}" for number in target[0])
            self.world.note("ik", f"{self.name}: ({place}) is out of reach")
            return None
        return list(joints)

    def grasp_pose(self, block_pose: Any) -> list[list[float]]:
        """The tool pose that grips a cube at `block_pose` with this hand."""
        return transforms.grasp_pose(block_pose, self.limb.grasp)

    # Skills

    def move_to_joints(
        self,
        positions: Sequence[float],
        speed: float = 1.0,
        preempted: Preempted = None,
    ) -> Result:
        """Move to `positions` (rad or m) in joint space.

        `speed` is that of the fastest joint (rad/s; of joints that slide times 0.2 m, m/s).
        A continuous joint turns the short way.
        """
        return self._run("move", skills.move(self, positions, speed, preempted), preempted)

    def move_along(
        self,
        pose: Any,
        offset: Any = None,
        speed: float = 1.0,
        preempted: Preempted = None,
        frame: str = "base",
    ) -> Result:
        """Move the tip on the straight line from its present pose to `pose` + `offset`."""
        target = self._target(pose, offset, frame)
        skill = skills.move_along(self, self.kinematics, target, speed, preempted)
        return self._run("move along", skill, preempted)

    def grip(self, command: str, preempted: Preempted = None) -> Result:
        """`open` or `close` the gripper; the value is its width (m).

        Aborted if it does not open, or closes on nothing. Raises ValueError for another command.
        """
        if command not in ("open", "close"):
            raise ValueError(f"no gripper command `{command}`; known: `open`, `close`")
        skill = skills.grip(self, self.world.bodies, command == "open", preempted)
        return self._run(f"grip {command}", skill, preempted)

    def check_grasp(self, name: str | None = None) -> Result:
        """Check that both fingers press one body (`name`, else any); the value is its name."""
        return self._run("check grasp", skills.check_grasp(self, self.world.bodies, name))

    def holds(self, name: str | None = None) -> bool:
        """The check of `check_grasp` as a bool, without an Event."""
        result = self.world.run(skills.check_grasp(self, self.world.bodies, name))
        return result.outcome == "succeeded"

    def _target(self, pose: Any, offset: Any, frame: str) -> Pose:
        """The pose, moved by `offset`, in the frame of the base of the arm's robot."""
        shift = IDENTITY if offset is None else as_pose(offset)
        moved = transforms.shifted(as_pose(pose), shift)
        place = transforms.compose(self.world.frame(frame), moved)
        return transforms.compose(transforms.inverse(self.base), place)

    def _run(self, name: str, skill: Skill[Result], preempted: Preempted = None) -> Result:
        """Run a skill to its end; an aborted one adds an Event with the reason."""
        if not self.returns:
            self.returns = True
            skill = skills.never_returns(preempted)
        result = self.world.run(skill)
        if result.outcome == "aborted":
            self.world.note(name, f"{self.name}: {result.reason}")
        return result


def arm_named(arms: Sequence[Arm], limb: str | None) -> Arm:
    """The arm of that name; the only arm if the name is empty. Raises UnknownNameError."""
    for arm in arms:
        if arm.name == limb or (not limb and len(arms) == 1):
            return arm
    raise UnknownNameError("limb", limb or "", tuple(arm.name for arm in arms))
