"""Varied values: how they are written, drawn, and put into a script."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import parse
from smachac.sweep.variation import (
    Single,
    Variation,
    VariationError,
    check_values,
    edited,
    names_of,
    poses,
    read_variation,
)

TEXT = """\
name: sm
params: {speed: 0.5, arm: left}
userdata:
  count: 3
  pose: [[0.1, 0.2, 0.3], [0.0, 0.0, 0.0, 1.0]]   # metres
  careful: true
"""
SOURCE = Source("main.yml", TEXT)
TREE = parse(SOURCE, [])


def test_the_values_of_a_script_that_can_vary() -> None:
    names = names_of(TREE)
    assert names[:4] == ["userdata.count", "userdata.pose.0.0", "userdata.pose.0.1",
                         "userdata.pose.0.2"]  # fmt: skip
    assert names[-3:] == ["userdata.careful", "params.speed", "params.arm"]


def test_a_range_and_a_list() -> None:
    assert read_variation("params.speed=0.1..0.5") == Variation("params.speed", (), 0.1, 0.5)
    assert read_variation("userdata.count=1..5") == Variation("userdata.count", (), 1, 5)
    assert read_variation("params.arm=left, right").choices == ("left", "right")
    assert read_variation("userdata.careful=true,false").choices == (True, False)


def test_a_value_depends_on_seed_and_name_only() -> None:
    speed, count = Variation("speed", (), 0.1, 0.5), Variation("count", (), 1, 3)
    drawn = [speed.drawn(seed) for seed in range(200)]
    assert drawn == [speed.drawn(seed) for seed in range(200)]
    assert all(0.1 <= float(value) <= 0.5 for value in drawn)
    assert len(set(drawn)) > 190
    assert {count.drawn(seed) for seed in range(50)} == {1, 2, 3}


def test_values_replace_those_of_the_text_and_keep_the_rest() -> None:
    values: dict[str, Single] = {
        "params.speed": 0.25,
        "userdata.pose.0.2": 1,
        "params.arm": "right",
    }
    text = edited(SOURCE, TREE, {**values, "scene.block.x": 0.4}).text
    assert text == TEXT.replace("speed: 0.5", "speed: 0.25").replace("0.3]", "1.0]").replace(
        "arm: left", 'arm: "right"'
    )


def test_poses_of_a_scene() -> None:
    values = {"scene.block.x": 0.4, "scene.block.yaw": 1, "params.speed": 0.2}
    assert poses(values) == {"block": {"x": 0.4, "yaw": 1.0}}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("params.sped=1..2", "did you mean `params.speed`?"),
        ("scene.blok.x=1..2", "did you mean `scene.block.x`?"),
        ("params.arm=1..2", "`params.arm` is a text in the script, `1` is not"),
        ("userdata.careful=maybe", "`userdata.careful` is true or false in the script"),
        ("scene.block.x=left", "`scene.block.x` is a number"),
        ("params.speed", "is not `NAME=LOW..HIGH` or `NAME=A,B,...`"),
        ("params.speed=0.5..0.1", "the range begins with 0.5, and ends with 0.1 below it"),
        ("params.speed=a..b", "`a` is not a number"),
        ("params.speed=0..Infinity", "`inf` is not a number"),
    ],
)
def test_mistakes_have_help(given: str, message: str) -> None:
    with pytest.raises(VariationError) as caught:
        check_values([read_variation(given)], TREE, ["block"])
    assert message in str(caught.value)


def test_a_name_is_given_once() -> None:
    twice = [read_variation("params.speed=0.1..0.5"), read_variation("params.speed=1,2")]
    with pytest.raises(VariationError, match="varied twice"):
        check_values(twice, TREE, [])
