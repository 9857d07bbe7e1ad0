"""Joints of all types in the simulation: limits, units, ways, and joints that follow others."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from smachac import sim
from smachac.sim import transforms
from smachac.sim.clock import TIME_STEP
from smachac.sim.inverse_kinematics import Kinematics
from smachac.sim.robots import SLIDE
from tests.support.urdf_texts import LIMIT, joint, link, one_joint, robot

pytest.importorskip("pybullet")

SCARA = str(Path(__file__).parent / "scara" / "scara.yml")
TABLE = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
HOVER = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]

# Joints without limits, and limits that are left out


@pytest.mark.parametrize(
    "limit",
    [
        "",
        '<limit effort="10" velocity="1"/>',
        '<limit lower="0" upper="0" effort="10" velocity="1"/>',
        '<limit lower="-1" upper="1" effort="10" velocity="0"/>',
    ],
)
def test_a_continuous_joint_has_no_limits(tmp_path: Path, limit: str) -> None:
    with sim.World(robot=one_joint(tmp_path, "continuous", limit)) as world:
        arm = world.arm()
        for goal in (0.4, -2.9, 3.0):
            result = arm.move_to_joints([goal])
            assert result.outcome == "succeeded", result.reason
            assert math.remainder(arm.joints[0] - goal, math.tau) == pytest.approx(0.0, abs=0.003)


def test_a_continuous_joint_turns_the_short_way(tmp_path: Path) -> None:
    with sim.World(robot=one_joint(tmp_path, "continuous")) as world:
        arm = world.arm()
        arm.move_to_joints([3.1])
        begun, start = world.time, arm.joints[0]
        assert arm.move_to_joints([-3.1]).outcome == "succeeded"
        assert arm.joints[0] - start == pytest.approx(math.tau - 6.2, abs=0.004)
        assert world.time - begun < 0.6


@pytest.mark.parametrize("turns", [-3, -1, 1, 12])
def test_whole_turns_are_no_way(tmp_path: Path, turns: int) -> None:
    with sim.World(robot=one_joint(tmp_path, "continuous")) as world:
        arm = world.arm()
        assert arm.move_to_joints([turns * math.tau]).outcome == "succeeded"
        assert arm.joints[0] == pytest.approx(0.0, abs=0.003)


@pytest.mark.parametrize("goal", [math.inf, -math.inf, math.nan])
def test_a_continuous_joint_needs_a_number(tmp_path: Path, goal: float) -> None:
    with sim.World(robot=one_joint(tmp_path, "continuous")) as world:
        assert world.arm().move_to_joints([goal]).outcome == "aborted"
        assert world.steps == 0


def test_a_revolute_joint_does_not_wrap(tmp_path: Path) -> None:
    limit = '<limit lower="-3.2" upper="3.2" effort="100" velocity="1"/>'
    with sim.World(robot=one_joint(tmp_path, "revolute", limit)) as world:
        arm = world.arm()
        arm.move_to_joints([3.1])
        assert arm.move_to_joints([-3.1]).outcome == "succeeded"
        assert arm.joints[0] == pytest.approx(-3.1, abs=0.003)
        refused = arm.move_to_joints([3.3])
        assert refused.reason == "j: 3.300 is not in -3.200..3.200 rad"


@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
@pytest.mark.parametrize(
    ("limit", "inside", "outside"),
    [
        ('lower="-0.5"', -0.4, 0.1),
        ('upper="0.5"', 0.4, -0.1),
        ('lower="-0.5" upper="0.5"', 0.4, 0.6),
    ],
)
def test_a_limit_that_is_left_out_is_0(
    tmp_path: Path, kind: str, limit: str, inside: float, outside: float
) -> None:
    given = f'<limit {limit} effort="100" velocity="1"/>'
    with sim.World(robot=one_joint(tmp_path, kind, given)) as world:
        arm = world.arm()
        unit = "rad" if kind == "revolute" else "m"
        assert arm.move_to_joints([inside]).outcome == "succeeded"
        assert arm.joints[0] == pytest.approx(inside, abs=0.003)
        assert arm.move_to_joints([outside]).reason.endswith(f" {unit}")


@pytest.mark.parametrize(("kind", "unit"), [("revolute", "rad"), ("prismatic", "m")])
def test_the_reasons_have_the_unit_of_the_joint(tmp_path: Path, kind: str, unit: str) -> None:
    # The joint has no stiffness against a fault: it is locked before the move settles.
    with sim.World(robot=one_joint(tmp_path, kind)) as world:
        arm = world.arm()
        arm.stick(arm.indices)
        result = arm.move_to_joints([0.04 if unit == "rad" else 0.04 * SLIDE])
        assert result.outcome == "aborted"
        assert result.reason.startswith("not settled in time: j is 0.0")
        assert result.reason.endswith(f" {unit} off")


@pytest.mark.parametrize(
    ("kind", "velocity", "speed", "fastest"),
    [
        ("revolute", 10.0, 1.0, 1.0),
        ("revolute", 10.0, 2.0, 2.0),
        ("revolute", 0.5, 2.0, 0.5),
        ("prismatic", 10.0, 1.0, SLIDE),
        ("prismatic", 0.1, 1.0, 0.1),
        ("prismatic", 0.1, 4.0, 0.1),
        ("continuous", 0.7, 1.0, 0.7),
        ("continuous", 0.0, 1.0, 1.0),  # no largest speed is known
    ],
)
def test_the_speed_of_a_joint(
    tmp_path: Path, kind: str, velocity: float, speed: float, fastest: float
) -> None:
    limit = f'<limit lower="-2" upper="2" effort="500" velocity="{velocity}"/>'
    with sim.World(robot=one_joint(tmp_path, kind, limit)) as world:
        arm, seen = world.arm(), [0.0]

        def watch() -> bool:
            seen.append(abs(arm.velocities[0]))
            return False

        assert arm.move_to_joints([1.5], speed, watch).outcome == "succeeded"
        assert max(seen) == pytest.approx(fastest, rel=0.02)


def test_a_move_that_takes_too_long_is_refused(tmp_path: Path) -> None:
    limit = '<limit lower="-2" upper="2" effort="100" velocity="1e-308"/>'
    with sim.World(robot=one_joint(tmp_path, "revolute", limit)) as world:
        result = world.arm().move_to_joints([1.0])
        assert result.reason == "the move takes longer than 600 s at the speed of the joints"
        assert world.steps == 0


def test_the_effort_of_a_joint_without_limit_element_is_not_limited(tmp_path: Path) -> None:
    parts = (
        link("base"),
        link("beam"),
        link("end", mass=5.0),
        joint("j", "continuous", "base", "beam", "", axis="0 1 0"),
        joint("weld", "fixed", "beam", "end", "", xyz="0.5 0 0"),
    )
    limb = sim.robots.Limb(name="arm", joints=("j",), tip="end", home=(0.0,))
    with sim.World(robot=sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))) as world:
        assert world.arm().move_to_joints([-1.0]).outcome == "succeeded"


# Joints that are not of an arm


def test_a_joint_of_no_arm_stays_within_its_limits(tmp_path: Path) -> None:
    limit = '<limit lower="0.2" upper="0.5" effort="99" velocity="1"/>'
    parts = (
        link("base"),
        link("body"),
        link("hand"),
        joint("height", "prismatic", "base", "body", limit),
        joint("j", "revolute", "body", "hand", xyz="0.1 0 0"),
    )
    limb = sim.robots.Limb(name="arm", joints=("j",), tip="hand", home=(0.0,))
    with sim.World(robot=sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))) as world:
        world.sleep(0.5)
        arm = world.arm()
        assert arm.tip_pose()[0] == pytest.approx([0.1, 0.0, 0.3], abs=1e-3)
        assert arm.kinematics.tip(arm.limb, [0.0])[0] == pytest.approx((0.1, 0.0, 0.3))
        assert arm.solve_ik([[0.1, 0.0, 0.3], transforms.about_z(1.0)]) == pytest.approx([1.0])


@pytest.mark.parametrize("kind", ["planar", "floating"])
def test_planar_and_floating_joints_are_fixed(tmp_path: Path, kind: str) -> None:
    parts = (
        link("base"),
        link("cart"),
        link("hand"),
        link("toy"),
        joint("wheels", kind, "base", "cart", ""),
        joint("j", "revolute", "cart", "hand"),
        joint("string", kind, "cart", "toy", "", xyz="1 0 0"),
    )
    limb = sim.robots.Limb(name="arm", joints=("j",), tip="hand", home=(0.0,))
    with sim.World(robot=sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))) as world:
        arm = world.arm()
        joints = arm.solve_ik([[0.0, 0.0, 0.2], transforms.about_z(0.5)])
        assert joints == pytest.approx([0.5])
        assert arm.move_to_joints(joints or []).outcome == "succeeded"
        assert arm.tip_pose()[0] == pytest.approx([0.0, 0.0, 0.2], abs=1e-4)


# Joints that follow others


MIMIC = '<mimic joint="{leader}" multiplier="{multiplier}" offset="{offset}"/>'


def telescope(folder: Path, multiplier: float, offset: float) -> sim.robots.Robot:
    """A column of two tubes, the second of which follows the first, with a continuous hand."""
    follows = MIMIC.format(leader="lower", multiplier=multiplier, offset=offset)
    limit = '<limit lower="0" upper="0.4" effort="500" velocity="1"/>'
    wide = '<limit lower="-1" upper="1" effort="500" velocity="1"/>'
    parts = (
        link("base"),
        link("tube_1"),
        link("tube_2"),
        link("hand"),
        joint("lower", "prismatic", "base", "tube_1", limit),
        joint("upper", "prismatic", "tube_1", "tube_2", wide + follows),
        joint("wrist", "continuous", "tube_2", "hand", xyz="0.2 0 0.1"),
    )
    limb = sim.robots.Limb(name="arm", joints=("lower", "wrist"), tip="hand", home=(0.1, 0.0))
    return sim.robots.from_urdf(robot(folder, *parts), limbs=(limb,))


@pytest.mark.parametrize(("multiplier", "offset"), [(1.0, 0.0), (0.5, 0.03), (-2.0, 0.1)])
def test_a_joint_of_an_arm_that_follows_another(
    tmp_path: Path, multiplier: float, offset: float
) -> None:
    def height(lower: float) -> float:
        return 0.3 + lower + multiplier * lower + offset

    with sim.World(robot=telescope(tmp_path, multiplier, offset)) as world:
        arm = world.arm()
        assert arm.tip_pose()[0][2] == pytest.approx(height(0.1), abs=1e-6)
        goal = [[0.2, 0.0, height(0.3)], list(transforms.about_z(2.0))]
        joints = arm.solve_ik(goal)
        assert joints == pytest.approx([0.3, 2.0], abs=2e-4)
        assert arm.move_to_joints(joints or []).outcome == "succeeded"
        assert arm.tip_pose()[0] == pytest.approx(goal[0], abs=1e-3)
        assert arm.move_along([[0.2, 0.0, height(0.2)], goal[1]]).outcome == "succeeded"
        assert arm.tip_pose()[0][2] == pytest.approx(height(0.2), abs=1e-3)


def test_a_locked_joint_locks_the_joints_that_follow_it(tmp_path: Path) -> None:
    with sim.World(robot=telescope(tmp_path, 1.0, 0.0)) as world:
        arm = world.arm()
        before = arm.tip_pose()[0]
        arm.stick(arm.indices[:1])
        assert arm.move_to_joints([0.3, 0.0]).reason == "lower does not follow"
        assert arm.tip_pose()[0] == pytest.approx(before, abs=2e-3)


@pytest.mark.parametrize("middle", [True, False])
def test_a_joint_follows_over_several_joints(tmp_path: Path, middle: bool) -> None:
    first = MIMIC.format(leader="a", multiplier=2.0, offset=0.1)
    second = MIMIC.format(leader="b", multiplier=-1.0, offset=0.2)
    if not middle:
        second = MIMIC.format(leader="a", multiplier=-2.0, offset=0.1)
    parts = (
        link("base"),
        *(link(name) for name in ("hand", "left", "right")),
        joint("a", "revolute", "base", "hand"),
        joint("b", "revolute", "base", "left", LIMIT + first, xyz="0 1 0"),
        joint("c", "revolute", "base", "right", LIMIT + second, xyz="0 2 0"),
    )
    limb = sim.robots.Limb(name="arm", joints=("a",), tip="hand", home=(0.3,))
    made = sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))
    with sim.World(robot=made) as world:
        arm = world.arm()

        def others() -> list[float]:
            return [world.engine.getJointState(arm.body, number)[0] for number in (1, 2)]

        assert others() == pytest.approx([0.7, -0.5])
        assert arm.move_to_joints([0.5]).outcome == "succeeded"
        assert others() == pytest.approx([1.1, -0.9], abs=0.003)


@pytest.mark.parametrize(
    ("mimic", "limits"),
    [
        ('<mimic joint="left"/>', (0.0, 0.04)),
        ('<mimic joint="left" multiplier="-1"/>', (-0.04, 0.0)),
        ('<mimic joint="left" multiplier="0.5" offset="0.01"/>', (0.01, 0.03)),
    ],
)
def test_fingers_that_follow(tmp_path: Path, mimic: str, limits: tuple[float, float]) -> None:
    box = '<collision><geometry><box size="0.02 0.01 0.1"/></geometry></collision>'
    low, high = limits
    right = f'<limit lower="{low}" upper="{high}" effort="20" velocity="0.1"/>{mimic}'
    left = '<limit lower="0" upper="0.04" effort="20" velocity="0.1"/>'
    parts = (
        link("base"),
        link("hand"),
        link("finger_1", box),
        link("finger_2", box),
        joint("turn", "revolute", "base", "hand"),
        joint("left", "prismatic", "hand", "finger_1", left, axis="0 1 0"),
        joint("right", "prismatic", "hand", "finger_2", right, axis="0 -1 0", xyz="0 -0.1 0.1"),
    )
    gripper = sim.robots.Gripper(
        fingers=(sim.robots.Finger(joint="left", opened=0.04),), width=(0.0, 0.08)
    )
    limb = sim.robots.Limb(name="arm", joints=("turn",), tip="hand", home=(0.0,), gripper=gripper)
    made = sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))
    ends = (high, low) if "-1" not in mimic else (low, high)
    with sim.World(robot=made) as world:
        arm = world.arm()
        follower = world.engine.getJointState(arm.body, 2)[0]
        assert follower == pytest.approx(ends[0], abs=1e-6)
        assert arm.grip("close").reason.startswith("the grasp is empty")
        assert arm.opening == pytest.approx((0.0, 0.0), abs=5e-3)
        assert world.engine.getJointState(arm.body, 2)[0] == pytest.approx(ends[1], abs=2e-4)
        assert arm.grip("open").outcome == "succeeded"
        assert arm.opening == pytest.approx((1.0, 1.0), abs=1e-3)


# An arm on another arm


def test_an_arm_on_a_lift_that_is_an_arm_of_its_own(tmp_path: Path) -> None:
    limit = '<limit lower="0" upper="0.5" effort="500" velocity="1"/>'
    parts = (
        link("base"),
        link("carriage"),
        link("upper"),
        link("hand"),
        joint("lift", "prismatic", "base", "carriage", limit),
        joint("a", "revolute", "carriage", "upper", axis="0 1 0"),
        joint("b", "revolute", "upper", "hand", xyz="0.3 0 0"),
    )
    lift = sim.robots.Limb(name="lift", joints=("lift",), tip="carriage", home=(0.0,))
    arm = sim.robots.Limb(name="arm", joints=("a", "b"), tip="hand", home=(0.2, 0.1))
    made = sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(lift, arm))
    with sim.World(robot=made) as world:
        pose = world.arm("arm").tip_pose()
        assert world.arm("lift").move_to_joints([0.3]).outcome == "succeeded"
        raised = world.arm("arm").tip_pose()
        assert raised[0][2] - pose[0][2] == pytest.approx(0.3, abs=1e-3)
        assert world.arm("arm").solve_ik(raised) == pytest.approx([0.2, 0.1], abs=5e-3)
        assert world.arm("arm").solve_ik(pose) is None


# The whole task


@pytest.fixture(params=range(3))
def scara(request: pytest.FixtureRequest) -> Iterator[sim.World]:
    with sim.World(robot=SCARA, seed=request.param) as world:
        world.load("table", TABLE, frame="world")
        yield world


def place(world: sim.World, y: tuple[float, float]) -> list[list[float]]:
    position = [world.random.uniform(0.4, 0.6), world.random.uniform(*y), 0.025]
    return [position, list(transforms.about_z(world.random.uniform(-math.pi, math.pi)))]


def test_an_arm_with_a_lift_a_continuous_wrist_and_a_mimic_gripper_picks(scara: sim.World) -> None:
    scara.load("block", place(scara, (-0.25, -0.05)))
    arm, goal = scara.arm(), transforms.grasp_pose(place(scara, (0.05, 0.25)))
    results: list[Any] = []
    for pose, command in ((arm.grasp_pose(scara.pose("block")), "close"), (goal, "open")):
        above = arm.solve_ik(pose, HOVER)
        assert above is not None
        results += [arm.move_to_joints(above), arm.move_along(pose), arm.grip(command)]
        results += [arm.check_grasp("block")] if command == "close" else []
        results.append(arm.move_along(pose, HOVER))
    assert [f"{result.outcome} {result.reason}".strip() for result in results] == ["succeeded"] * 9
    scara.sleep(0.5)
    assert scara.error("block", goal) < 0.004
    assert scara.at_rest("block")
    assert scara.events == []


def test_a_straight_way_over_half_a_turn_of_a_continuous_joint() -> None:
    with sim.World(robot=SCARA) as world:
        arm = world.arm()
        joints = [0.2, 0.5, -1.0, 3.1]
        assert arm.move_to_joints(joints).outcome == "succeeded"
        pose = arm.kinematics.tip(arm.limb, [0.1, 0.5, -1.0, -3.1])
        begun = world.time
        assert arm.move_along(pose).outcome == "succeeded"
        assert arm.joints == pytest.approx([0.1, 0.5, -1.0, math.tau - 3.1], abs=0.003)
        assert world.time - begun < 1.5


def test_a_preempted_lift_stays_where_it_is() -> None:
    with sim.World(robot=SCARA) as world:
        arm = world.arm()
        result = arm.move_to_joints([0.4, 0.5, -1.0, 0.0], preempted=lambda: world.time >= 0.5)
        assert result.outcome == "preempted"
        assert world.time == pytest.approx(0.5, abs=TIME_STEP)
        place = arm.joints
        world.sleep(1.0)
        assert arm.joints == pytest.approx(place, abs=0.01)


def test_a_seed_in_another_turn_is_answered_in_that_turn() -> None:
    part = sim.robots.load(SCARA).parts[0]
    (limb,), kinematics = part.limbs, Kinematics(part)
    pose = kinematics.tip(limb, [0.2, 0.5, -1.0, 0.3])
    seed = (0.2, 0.4, -0.9, 0.2 + 4 * math.pi)
    assert kinematics.solve(limb, pose, seed) == pytest.approx(
        [0.2, 0.5, -1.0, 0.3 + 4 * math.pi], abs=2e-4
    )


# Links without a mass


@pytest.mark.parametrize(
    "inside",
    [
        "",
        '<visual><geometry><sphere radius="0.01"/></geometry></visual>',
        '<collision><geometry><box size="0.01 0.01 0.01"/></geometry></collision>',
    ],
)
def test_a_frame_without_inertial_weighs_nothing(tmp_path: Path, inside: str) -> None:
    """1 kg at 0.6 m would need 5.9 N m."""
    weak = '<limit lower="-2" upper="2" effort="2" velocity="1"/>'
    names = ("tool", "camera", "tip")
    parts = (
        link("base"),
        '<link name="arm"><inertial><mass value="0.1"/><inertia ixx="0.001" ixy="0" ixz="0"'
        ' iyy="0.001" iyz="0" izz="0.001"/></inertial></link>',
        *(f'<link name="{name}">{inside}</link>' for name in names),
        joint("turn", "revolute", "base", "arm", weak, axis="0 1 0"),
        joint("to_tool", "fixed", "arm", "tool", "", xyz="0.6 0 0"),
        joint("to_camera", "fixed", "tool", "camera", "", xyz="0 0.1 0"),
        joint("to_tip", "fixed", "camera", "tip", "", xyz="0 -0.1 0"),
    )
    limb = sim.robots.Limb(name="arm", joints=("turn",), tip="tip", home=(0.0,))
    made = sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))
    with sim.World(robot=made) as world:
        arm = world.arm()
        masses = [world.engine.getDynamicsInfo(arm.body, number)[0] for number in range(4)]
        assert masses == [0.1, 0.0, 0.0, 0.0]
        for angle in (-0.5, 0.5, 0.0):
            assert arm.move_to_joints([angle]).outcome == "succeeded"
            reached = world.engine.getJointState(arm.body, 0)[0]
            assert reached == pytest.approx(angle, abs=2e-3)


def test_a_link_that_moves_has_a_mass(tmp_path: Path) -> None:
    parts = (link("base"), '<link name="hand"/>', joint("j", "revolute", "base", "hand"))
    limb = sim.robots.Limb(name="arm", joints=("j",), tip="hand", home=(0.0,))
    made = sim.robots.from_urdf(robot(tmp_path, *parts), limbs=(limb,))
    with sim.World(robot=made) as world:
        arm = world.arm()
        assert world.engine.getDynamicsInfo(arm.body, 0)[0] == 1.0
        assert arm.move_to_joints([1.0]).outcome == "succeeded"
