"""The built-in robots: their kinematics against independent figures, and their skills."""

from __future__ import annotations

import importlib.util
import math
import random
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy
import pytest

from smachac import sim
from smachac.sim import transforms
from tests.support.arm_examples import carry
from tests.support.examples import seeds

pytest.importorskip("pybullet")

ROOT = Path(__file__).parents[2]
H = math.pi / 2

BAXTER = (
    ((0.055695, 0, 0.011038), (0, 0, 0)),
    ((0.069, 0, 0.27035), (-H, 0, 0)),
    ((0.102, 0, 0), (H, 0, H)),
    ((0.069, 0, 0.26242), (-H, -H, 0)),
    ((0.10359, 0, 0), (H, 0, H)),
    ((0.01, 0, 0.2707), (-H, -H, 0)),
    ((0.115975, 0, 0), (H, 0, H)),
)
"""Origin and rpy of s0 s1 e0 e1 w0 w1 w2, from baxter_common (baxter_base.urdf.xacro)."""
BAXTER_TIP = 0.11355 + 0.025 + 0.1327

KUKA = (0.36, 0.42, 0.40, 0.126)
"""Lengths of the LBR iiwa 14 from the data sheet: base to shoulder, elbow, wrist, flange."""


def turn(axis: str, angle: float) -> Any:
    c, s = math.cos(angle), math.sin(angle)
    rows = {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }
    return numpy.array(rows[axis])


def frame(at: Sequence[float], rotation: Any) -> Any:
    found = numpy.eye(4)
    found[:3, :3], found[:3, 3] = rotation, at
    return found


def rpy(angles: Sequence[float]) -> Any:
    roll, pitch, yaw = angles
    return turn("z", yaw) @ turn("y", pitch) @ turn("x", roll)


def baxter_tip(side: int, joints: Sequence[float]) -> Any:
    """The tip frame of an arm in the base frame, from the table alone."""
    found = frame((0.024645, side * 0.219645, 0.118588), turn("z", side * 0.7854))
    for (at, angles), joint in zip(BAXTER, joints, strict=True):
        found = found @ frame(at, rpy(angles)) @ frame((0, 0, 0), turn("z", joint))
    return found @ frame((0, 0, BAXTER_TIP), numpy.eye(3))


def kuka_flange(joints: Sequence[float]) -> Any:
    """The flange of the iiwa from its Denavit-Hartenberg parameters (alpha +-90 degrees, a = 0)."""
    found = numpy.eye(4)
    alphas = (-H, H, H, -H, -H, H, 0.0)
    lengths = (KUKA[0], 0.0, KUKA[1], 0.0, KUKA[2], 0.0, KUKA[3])
    for joint, alpha, d in zip(joints, alphas, lengths, strict=True):
        found = found @ frame((0, 0, d), turn("z", joint) @ turn("x", alpha))
    return found


@pytest.fixture(scope="module")
def baxter() -> Iterator[sim.World]:
    with sim.World(robot="baxter") as world:
        yield world


def draws(arm: sim.Arm, count: int) -> Iterator[list[float]]:
    source = random.Random(arm.name)
    for _ in range(count):
        yield [source.uniform(joint.lower, joint.upper) for joint in arm.facts]


@pytest.mark.parametrize(("name", "side"), [("left", 1), ("right", -1)])
def test_the_kinematics_of_baxter_are_those_of_the_table(
    baxter: sim.World, name: str, side: int
) -> None:
    arm = baxter.arm(name)
    for joints in draws(arm, 50):
        position, rotation = arm.kinematics.tip(arm.limb, joints)
        expected = baxter_tip(side, joints)
        assert math.dist(position, expected[:3, 3]) < 1e-6
        for k, axis in enumerate(numpy.eye(3)):
            assert math.dist(transforms.rotate(rotation, tuple(axis)), expected[:3, k]) < 1e-6


def test_the_kinematics_of_the_iiwa_are_those_of_the_data_sheet() -> None:
    with sim.World(robot="iiwa") as world:
        arm = world.arm()
        for joints in draws(arm, 50):
            position, rotation = arm.kinematics.tip(arm.limb, joints)
            # The tool is 0.145 m from the flange.
            flange = transforms.compose((position, rotation), ((0, 0, -0.145), (0, 0, 0, 1)))
            assert math.dist(flange[0], kuka_flange(joints)[:3, 3]) < 1e-6


def test_the_files_are_those_of_the_script() -> None:
    spec = importlib.util.spec_from_file_location("robots", ROOT / "scripts" / "robots.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for name, content in module.contents().items():
        assert (ROOT / "smachac" / "robots" / name).read_text("utf-8") == content
        assert "<mesh" not in content


MANY = seeds(1, 2, 6)


@pytest.mark.parametrize("seed", MANY)
@pytest.mark.parametrize("limb", ["left", "right"])
def test_baxter_places_a_block_within_1_mm(limb: str, seed: int) -> None:
    assert carry("baxter", limb, seed) < 0.001


@pytest.mark.parametrize("seed", MANY)
def test_the_iiwa_places_a_block_within_2_mm(seed: int) -> None:
    assert carry("iiwa", "arm", seed) < 0.002


STATION = """
name: two
base: [0, 0, 0.4]
parts:
  near: {robot: panda, base: [0, 0, 0]}
  far: {robot: panda, base: [[1.1, 0, 0], [0, 0, 1, 0]]}
"""


def test_two_robots_in_one_world(tmp_path: Path) -> None:
    (tmp_path / "two.yml").write_text(STATION)
    with sim.World(robot=str(tmp_path / "two.yml")) as world:
        near, far = world.arms
        assert (near.name, far.name) == ("near", "far")
        goal = [[0.55, 0.1, 0.3], [1, 0, 0, 0]]
        for arm, y in ((near, 0.2), (far, -0.2)):
            joints = arm.solve_ik([[0.55, y, 0.3], goal[1]])
            assert joints is not None
            assert arm.move_to_joints(joints).outcome == "succeeded"
            assert math.dist(arm.tip_pose()[0], [0.55, y, 0.3]) < 0.005
        assert near.tip_pose("near")[0][0] == pytest.approx(0.55, abs=0.005)
        assert far.tip_pose("far")[0][0] == pytest.approx(0.55, abs=0.005)


SCENE = """
bodies:
  table: {model: table, pose: [0.55, 0, 0], frame: world}
  block: {model: block, pose: [0.5, 0, 0.025], spread: [0.1, 0.1, 1], colour: [0, 1, 0]}
  lid: {size: [0.1, 0.1, 0.02], mass: 0.05, pose: [0, 0, 0.036], frame: block}
"""


def test_a_scene_is_placed_with_the_seed(tmp_path: Path) -> None:
    (tmp_path / "table.yml").write_text(SCENE)

    def poses(seed: int) -> list[list[list[float]]]:
        with sim.World(scene=tmp_path / "table.yml", seed=seed) as world:
            assert list(world.bodies) == ["table", "block", "lid"]
            world.sleep(0.5)
            assert world.pose("lid")[0][2] == pytest.approx(0.06, abs=0.002)
            return [world.pose(name) for name in world.bodies]

    assert poses(1) == poses(1) != poses(2)
