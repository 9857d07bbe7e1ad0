"""Poses: the laws of rotations, and the pose that grips a cube."""

from __future__ import annotations

import itertools
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.sim import transforms
from smachac.sim.transforms import IDENTITY, Pose, Quaternion, as_pose
from tests.support.examples import examples

LAW = settings(derandomize=True, deadline=None, max_examples=examples(30))

metres = st.floats(-2.0, 2.0)
vectors = st.tuples(metres, metres, metres)


@st.composite
def rotations(draw: st.DrawFn) -> Quaternion:
    axis = draw(vectors.filter(lambda v: math.hypot(*v) > 0.1))
    half = draw(st.floats(-math.pi, math.pi)) / 2
    x, y, z = (item / math.hypot(*axis) * math.sin(half) for item in axis)
    return x, y, z, math.cos(half)


poses = st.tuples(vectors, rotations())


def near(a: Pose, b: Pose) -> bool:
    return math.dist(a[0], b[0]) < 1e-9 and transforms.angle_between(a[1], b[1]) < 1e-7


@LAW
@given(poses)
def test_a_pose_and_its_inverse_cancel(pose: Pose) -> None:
    assert near(transforms.compose(pose, transforms.inverse(pose)), IDENTITY)
    assert near(transforms.compose(transforms.inverse(pose), pose), IDENTITY)


@LAW
@given(poses, poses, poses)
def test_frames_chain_in_any_grouping(a: Pose, b: Pose, c: Pose) -> None:
    left = transforms.compose(transforms.compose(a, b), c)
    assert near(left, transforms.compose(a, transforms.compose(b, c)))


@LAW
@given(poses, poses)
def test_a_straight_way_ends_where_it_should_in_even_steps(start: Pose, end: Pose) -> None:
    way = [start, *transforms.straight(start, end, 6)]
    assert near(way[-1], end)
    lengths = [math.dist(a[0], b[0]) for a, b in itertools.pairwise(way)]
    assert max(lengths) - min(lengths) < 1e-9
    turns = [transforms.angle_between(a[1], b[1]) for a, b in itertools.pairwise(way)]
    assert max(turns) - min(turns) < 1e-6
    assert sum(turns) <= math.pi + 1e-6


@LAW
@given(vectors, st.floats(-10.0, 10.0))
def test_a_grasp_points_down_and_turns_at_most_45_degrees(
    place: tuple[float, float, float], yaw: float
) -> None:
    position, rotation = as_pose(transforms.grasp_pose([place, transforms.about_z(yaw)]))
    assert position == place
    assert transforms.rotate(rotation, (0.0, 0.0, 1.0)) == pytest.approx((0, 0, -1), abs=1e-9)
    turned = transforms.yaw_of(transforms.multiply(rotation, (-1.0, 0.0, 0.0, 0.0)))
    assert abs(turned) <= math.pi / 4 + 1e-9
    # A cube's sides come round every quarter turn.
    quarters = (yaw - turned) / (math.pi / 2)
    assert quarters == pytest.approx(round(quarters), abs=1e-6)


def test_a_hand_grasps_at_its_own_pose() -> None:
    grasp: Pose = ((0.0, 0.0, 0.1), (0.0, 1.0, 0.0, 0.0))
    position, rotation = as_pose(transforms.grasp_pose(IDENTITY, grasp))
    assert position == (0.0, 0.0, 0.1)
    assert transforms.angle_between(rotation, (0.0, 1.0, 0.0, 0.0)) < 1e-9


def test_an_offset_moves_along_the_outer_axes() -> None:
    down: Pose = ((0.5, 0.0, 0.025), (1.0, 0.0, 0.0, 0.0))
    above = transforms.shifted(down, ((0.0, 0.0, 0.15), IDENTITY[1]))
    assert near(above, ((0.5, 0.0, 0.175), (1.0, 0.0, 0.0, 0.0)))


@pytest.mark.parametrize("rotation", [(0, 0, 0, 0), (0, 0, 0, 7), [0.0, 0.0, 0.0, -1.0]])
def test_quaternions_are_normalized_and_zero_is_no_rotation(rotation: tuple[float, ...]) -> None:
    assert near(as_pose([[1, 2, 3], rotation]), ((1.0, 2.0, 3.0), IDENTITY[1]))


def test_the_rotation_may_be_left_out() -> None:
    assert as_pose([1, 2, 3]) == ((1.0, 2.0, 3.0), IDENTITY[1])


@pytest.mark.parametrize(
    "value",
    [None, 3, [], [1, 2], "xy", [[1, 2, 3]], [[1, 2], [0, 0, 0, 1]], [[1, 2, 3], [0, 0, 1]]],
)
def test_what_is_no_pose_is_refused_with_the_value(value: object) -> None:
    with pytest.raises(ValueError, match="not a pose"):
        as_pose(value)


def test_infinite_numbers_are_refused() -> None:
    with pytest.raises(ValueError, match="not a pose"):
        as_pose([[math.nan, 0, 0], [0, 0, 0, 1]])
