"""The world and the arm's skills: tasks done, and every refusal with its reason."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import pytest

from smachac import sim
from smachac.robots.fields import DataError
from smachac.sim import transforms
from smachac.sim.clock import TIME_STEP

pytest.importorskip("pybullet")

TABLE = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
HOVER = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
DOWN = [1.0, 0.0, 0.0, 0.0]
EDGE = 0.05


def block_pose(world: sim.World, y: tuple[float, float]) -> list[list[float]]:
    position = [world.random.uniform(0.35, 0.65), world.random.uniform(*y), EDGE / 2]
    return [position, list(transforms.about_z(world.random.uniform(-math.pi, math.pi)))]


def carry(world: sim.World, name: str, goal: list[list[float]]) -> list[str]:
    """Pick a block and put it down at `goal`: the outcomes of the skills."""
    arm = world.arm()
    results = [arm.grip("open")]
    for pose, command in ((arm.grasp_pose(world.pose(name)), "close"), (goal, "open")):
        joints = arm.solve_ik(pose, HOVER)
        assert joints is not None
        results += [arm.move_to_joints(joints), arm.move_along(pose), arm.grip(command)]
        if command == "close":
            results.append(arm.check_grasp(name))
        results.append(arm.move_along(pose, HOVER))
    return [f"{result.outcome} {result.reason}".strip() for result in results]


@pytest.fixture(scope="module")
def idle() -> Iterator[sim.World]:
    """A world that tests only look at, or ask for what it refuses."""
    with sim.World(seed=0) as world:
        assert world.load("table", TABLE, frame="world").outcome == "succeeded"
        assert world.load("block", [[0.5, 0.1, 0.025], [0, 0, 0, 1]]).outcome == "succeeded"
        yield world


@pytest.fixture
def world() -> Iterator[sim.World]:
    with sim.World(seed=0) as world:
        world.load("table", TABLE, frame="world")
        yield world


@pytest.mark.parametrize("seed", range(5))
def test_a_block_is_picked_and_placed_within_2_mm(seed: int) -> None:
    with sim.World(seed=seed) as world:
        world.load("table", TABLE, frame="world")
        world.load("block", block_pose(world, (-0.3, -0.05)))
        goal = transforms.grasp_pose(block_pose(world, (0.05, 0.3)))
        assert carry(world, "block", goal) == ["succeeded"] * 10
        world.sleep(0.5)
        assert world.error("block", goal) < 0.002
        assert world.at_rest("block")
        assert world.events == []


def test_two_blocks_are_stacked(world: sim.World) -> None:
    world.load("block", block_pose(world, (-0.3, -0.05)), "lower")
    world.load("block", block_pose(world, (0.17, 0.3)), "upper")
    for k, name in enumerate(("lower", "upper")):
        assert carry(world, name, [[0.5, 0.06, EDGE / 2 + k * EDGE], DOWN]) == ["succeeded"] * 10
    world.sleep(0.5)
    for k, name in enumerate(("lower", "upper")):
        assert world.error(name, [0.5, 0.06, EDGE / 2 + k * EDGE]) < 0.002
        assert world.at_rest(name)


def test_the_same_seed_gives_the_same_world_to_the_last_bit() -> None:
    def end(seed: int) -> tuple[str, float]:
        with sim.World(seed=seed) as world:
            world.load("table", TABLE, frame="world")
            pose = block_pose(world, (-0.2, 0.2))
            world.load("block", pose)
            arm = world.arm()
            arm.move_to_joints(arm.solve_ik(arm.grasp_pose(pose)) or [])
            arm.grip("close")
            return world.hash(), world.time

    first = end(3)
    assert end(3) == first
    assert end(4) != first


def test_threads_do_not_change_what_happens() -> None:
    def end() -> tuple[str, float, list[float]]:
        with sim.World(seed=0, patience=60.0) as world:
            arm = world.arm()
            seen: list[float] = []

            def watch() -> None:
                for _ in range(10):
                    world.sleep(0.03)
                    seen.append(arm.joints[0])
                arm.grip("close")

            goal = arm.solve_ik([[0.5, 0.2, 0.2], DOWN])
            world.together(lambda: arm.move_to_joints(goal or []), watch)
            return world.hash(), world.time, seen

    first = end()
    assert all(end() == first for _ in range(3))


# Refusals


def outcome(result: sim.Result) -> tuple[str, str]:
    assert isinstance(result, sim.Result)
    return result.outcome, result.reason


@pytest.mark.parametrize(
    ("call", "reason"),
    [
        ({"model": "spoon", "pose": [0, 0, 0]}, "no model `spoon`; known: `table`, "),
        ({"model": "x", "pose": [0, 0, 0], "path": "no/x.urdf"}, "model file `no/x.urdf` not foun"),
        ({"model": "wall", "pose": [0, 0, 0], "frame": "moon"}, "no frame `moon`; known: `base`"),
        ({"model": "block", "pose": [0, 0, 0]}, "a body `block` is there already"),
    ],
)
def test_a_model_that_cannot_be_loaded(idle: sim.World, call: dict[str, Any], reason: str) -> None:
    before = len(idle.events)
    said = outcome(idle.load(**call))
    assert said[0] == "aborted"
    assert said[1].startswith(reason)
    assert [(event.name, event.text) for event in idle.events[before:]] == [("load", said[1])]


def test_a_file_that_holds_no_model(idle: sim.World, tmp_path: Any) -> None:
    broken = tmp_path / "broken.urdf"
    broken.write_text("<robot", encoding="utf-8")
    result = idle.load("x", [0, 0, 0], path=broken)
    assert result.outcome == "aborted"
    assert result.reason.startswith(f"the file `{broken}`, line 1: ")


def test_models_from_files_stand_where_they_were_put(world: sim.World) -> None:
    pose = [[0.5, 0.2, 0.3], [0.0, 0.0, 0.6, 0.8]]
    assert outcome(world.load("cube", pose, path="cube_small.urdf")) == ("succeeded", "")
    assert world.error("cube", pose) < 1e-9
    assert outcome(world.load("arm", [2, 2, 0], path="kuka_iiwa/kuka_with_gripper2.sdf"))[0] == (
        "succeeded"
    )
    assert world.error("arm", [2, 2, 0]) < 1e-9
    world.remove("cube")
    with pytest.raises(sim.UnknownNameError, match="no body `cube`; known: `table`, `arm`"):
        world.pose("cube")


def test_frames(idle: sim.World) -> None:
    assert idle.pose("table", "world")[0] == pytest.approx([0.6, 0, 0])
    assert idle.pose("table")[0] == pytest.approx([0.6, 0, -0.4])
    assert idle.pose("block", "table")[0] == pytest.approx([-0.1, 0.1, 0.425])
    assert idle.error("block", [0.5, 0.1, 0.425], "world") < 1e-9
    assert idle.error("block", [0.5, 0.1, 0.028]) == pytest.approx(0.003)
    arm = idle.arm()
    base = arm.solve_ik([[0.5, 0.0, 0.2], DOWN])
    assert base == pytest.approx(arm.solve_ik([[0.5, 0.0, 0.6], DOWN], frame="world"), abs=1e-6)
    assert base == pytest.approx(arm.solve_ik([[0.5, 0.0, 0.05], DOWN], HOVER), abs=1e-6)


@pytest.mark.parametrize("limb", [None, "", "arm"])
def test_the_only_arm_needs_no_name(idle: sim.World, limb: str | None) -> None:
    assert idle.arm(limb).name == "arm"


def test_an_unknown_arm_is_refused_with_the_known_ones(idle: sim.World) -> None:
    with pytest.raises(KeyError) as caught:
        idle.arm("left")
    assert str(caught.value) == "no limb `left`; known: `arm`"


def test_solutions_are_checked_by_forward_kinematics(idle: sim.World) -> None:
    arm = idle.arm()
    for x in (0.35, 0.5, 0.65):
        for y in (-0.3, 0.0, 0.3):
            pose = transforms.as_pose(
                transforms.grasp_pose([[x, y, 0.025], transforms.about_z(x + y)])
            )
            joints = arm.solve_ik(pose)
            assert joints is not None
            tip = arm.kinematics.tip(arm.limb, joints)
            assert math.dist(tip[0], pose[0]) < 2e-4
            assert transforms.angle_between(tip[1], pose[1]) < 1e-3


def test_out_of_reach_is_none_with_an_event(idle: sim.World) -> None:
    assert idle.arm().solve_ik([[1.5, 0.0, 0.2], DOWN]) is None
    assert idle.events[-1].text == "arm: (1.500, 0.000, 0.200) is out of reach"


def test_moves_that_no_arm_can_make(idle: sim.World) -> None:
    arm, before = idle.arm(), idle.steps
    assert outcome(arm.move_to_joints([0.0])) == ("aborted", "7 joint positions wanted, 1 given")
    assert outcome(arm.move_to_joints([0, 0, 0, -1, 0, 9, 0])) == (
        "aborted",
        "panda_joint6: 9.000 is not in -0.087..3.822 rad",
    )
    far = arm.move_along([[1.5, 0.0, 0.2], DOWN])
    assert far.outcome == "aborted"
    assert far.reason.endswith("on the way is out of reach")
    assert idle.steps == before


@pytest.mark.parametrize("speed", [0, -1.0])
def test_a_speed_that_is_none(idle: sim.World, speed: float) -> None:
    with pytest.raises(ValueError, match="speed"):
        idle.arm().move_to_joints(idle.arm().limb.home, speed=speed)


def test_wrong_calls_are_errors(idle: sim.World) -> None:
    with pytest.raises(ValueError, match="no gripper command `shut`"):
        idle.arm().grip("shut")
    with pytest.raises(ValueError, match="not a pose"):
        idle.arm().solve_ik([1, 2])
    with pytest.raises(sim.UnknownNameError, match="no frame `moon`"):
        idle.arm().solve_ik([[1, 2, 3], DOWN], frame="moon")


def test_an_empty_grasp(world: sim.World) -> None:
    arm = world.arm()
    assert outcome(arm.check_grasp()) == ("aborted", "the fingers press nothing (80.0 mm open)")
    closed = arm.grip("close")
    assert closed.outcome == "aborted"
    assert closed.reason.startswith("the grasp is empty")
    assert closed.value == pytest.approx(0.0, abs=1e-3)
    assert not arm.holds()
    opened = arm.grip("open")
    assert (opened.outcome, opened.value) == ("succeeded", pytest.approx(0.08, abs=2e-3))


def test_a_move_into_the_table_is_not_settled(world: sim.World) -> None:
    arm = world.arm()
    arm.move_to_joints(arm.solve_ik([[0.5, 0.0, 0.05], DOWN]) or [])
    result = arm.move_along([[0.5, 0.0, -0.08], DOWN])
    assert result.outcome == "aborted"
    assert "rad off" in result.reason or "does not follow" in result.reason
    assert world.events[-1].name == "move along"


def test_a_preempted_arm_stays_where_it_is(world: sim.World) -> None:
    arm = world.arm()
    goal = arm.solve_ik([[0.5, 0.3, 0.2], DOWN]) or []
    end = world.time + 0.5
    result = arm.move_to_joints(goal, preempted=lambda: world.time >= end)
    assert result.outcome == "preempted"
    assert world.time == pytest.approx(end, abs=TIME_STEP)
    place = arm.joints
    assert math.dist(place, goal) > 0.05
    world.sleep(1.0)
    assert math.dist(place, arm.joints) < 0.02
    assert max(map(abs, arm.velocities)) < 0.01


@pytest.mark.parametrize("skill", ["sleep", "grip", "move_along"])
def test_every_skill_can_be_preempted_at_once(world: sim.World, skill: str) -> None:
    arm, before = world.arm(), world.steps
    result = {
        "sleep": lambda: world.sleep(1.0, lambda: True),
        "grip": lambda: arm.grip("close", lambda: True),
        "move_along": lambda: arm.move_along([[0.5, 0.0, 0.2], DOWN], preempted=lambda: True),
    }[skill]()
    assert result.outcome == "preempted"
    assert world.steps == before


def test_a_faster_move_takes_less_simulated_time(world: sim.World) -> None:
    arm = world.arm()
    times = []
    for speed, pose in ((0.5, [[0.5, 0.3, 0.2], DOWN]), (2.0, [[0.5, -0.3, 0.2], DOWN])):
        begun = world.time
        assert arm.move_to_joints(arm.solve_ik(pose) or [], speed).outcome == "succeeded"
        times.append(world.time - begun)
    assert times[1] < times[0]


def test_sleeping_takes_simulated_time(idle: sim.World) -> None:
    before = idle.steps
    assert idle.sleep(0.25).outcome == "succeeded"
    assert idle.steps - before == 60


# The process


def test_a_world_takes_what_was_configured_and_is_found() -> None:
    sim.configure(seed=11)
    try:
        with sim.World() as world:
            assert world.seed == 11
            assert sim.world() is world
            with sim.World(seed=12) as inner:
                assert sim.world() is inner
            assert sim.world() is world
    finally:
        sim.configure()
    opened = sim.world()
    assert opened.seed == 0
    assert sim.world() is opened
    sim.close()
    assert opened.engine.client == -1
    opened.close()


def test_a_robot_whose_file_or_joints_do_not_exist() -> None:
    with pytest.raises(FileNotFoundError, match=r"no robot description `no\.urdf`"):
        sim.robots.from_urdf("no.urdf", limbs=())
    limb = sim.robots.Limb(name="arm", joints=("elbow",), tip="tip", home=(0.0,))
    with pytest.raises(DataError, match="the URDF file has no joint `elbow`"):
        sim.robots.from_urdf("franka_panda/panda.urdf", limbs=(limb,))


def test_another_robot_of_another_file() -> None:
    joints = tuple(f"lbr_iiwa_joint_{k}" for k in range(1, 8))
    limb = sim.robots.Limb(
        name="iiwa",
        joints=joints,
        tip="lbr_iiwa_link_7",
        home=(0.0, 0.5, 0.0, -1.4, 0.0, 1.2, 0.0),
    )
    robot = sim.robots.from_urdf("kuka_iiwa/model.urdf", limbs=(limb,))
    with sim.World(seed=0, robot=robot) as world:
        arm = world.arm("iiwa")
        joints_there = arm.solve_ik([[0.5, 0.1, 0.4], DOWN])
        assert joints_there is not None
        assert arm.move_to_joints(joints_there).outcome == "succeeded"
        assert math.dist(arm.tip_pose()[0], [0.5, 0.1, 0.4]) < 0.005
