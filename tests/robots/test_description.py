"""Descriptions of robots, scenes and faults: what is read, and the place of each mistake."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from smachac.robots import description, fields, scene, urdf
from smachac.robots.description import Description, Station
from smachac.robots.fields import DataError
from smachac.robots.files import BUILT_IN, built_in, plain

ROBOT = """
name: arm
urdf: arm.urdf
arms:
  left:
    joints: [a, b]
    tool: {link: hand, offset: [0, 0, 0.1]}
    home: [0.0, 1.0]
    gripper:
      joints: {f: {open: 0.04}}
      width: {open: 0.08, closed: 0}
"""
URDF = urdf.read("""<robot name="r">
<link name="base"/><link name="arm"/><link name="hand"/><link name="pad"/>
<joint name="a" type="revolute"><parent link="base"/><child link="arm"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="arm"/><child link="hand"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="f" type="prismatic"><parent link="hand"/><child link="pad"/>
<limit lower="0" upper="0.04" effort="1" velocity="1"/></joint></robot>""")  # fmt: skip


def changed(text: str, place: tuple[str | int, ...], value: Any) -> Any:
    """The data of a YAML text with another value at a place; None removes the key."""
    data = plain(text)
    inner = data
    for step in place[:-1]:
        inner = inner[step]
    if value is None:
        del inner[place[-1]]
    else:
        inner[place[-1]] = value
    return data


def mistake(data: Any, file: urdf.Urdf = URDF) -> DataError | None:
    """The first mistake in the description of a robot with these joints and links."""
    try:
        found = description.read(copy.deepcopy(data))
        assert isinstance(found, Description)
        description.check(found, file)
    except DataError as error:
        return error
    return None


def test_a_description() -> None:
    found = description.read(plain(ROBOT))
    assert isinstance(found, Description)
    (limb,) = found.limbs
    assert limb.offset == ((0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0))
    assert limb.gripper is not None
    assert limb.gripper.width == (0.0, 0.08)
    assert mistake(plain(ROBOT)) is None


LEFT = ("arms", "left")
MISTAKES: list[tuple[tuple[str | int, ...], Any, tuple[str | int, ...], str]] = [
    (("name",), None, (), "the key `name` is missing"),
    (("arms", "left", "joint"), [], (*LEFT, "joint"), "the key `joint` is unknown"),
    ((*LEFT, "joints", 1), "bb", (*LEFT, "joints", 1), "the URDF file has no joint `bb`"),
    ((*LEFT, "tool", "link"), "hnad", (*LEFT, "tool"), "the URDF file has no link `hnad`"),
    ((*LEFT, "home"), [0.0], (*LEFT, "home"), "`home` has 1 items, but the arm has 2 joints"),
    ((*LEFT, "home", 1), 57.0, (*LEFT, "home", 1), "`b` is 57 rad, outside its limits -2 to 2"),
    ((*LEFT, "home", 1), "high", (*LEFT, "home", 1), "a number is expected, not 'high'"),
    (
        (*LEFT, "gripper", "joints", "f", "open"),
        40,
        (*LEFT, "gripper", "joints", "f", "open"),
        "`f` is 40 m, outside its limits 0 to 0.04",
    ),
    (
        (*LEFT, "gripper", "width", "open"),
        80,
        (*LEFT, "gripper", "width", "open"),
        "a gripper that opens 80 m wide is larger than an arm",
    ),
    (
        ("base",),
        [[0, 0, 400], [0, 0, 0, 1]],
        ("base", 0, 2),
        "400 m is more than 20 m, the largest length here",
    ),
    (("base",), [[0, 0], [0, 0, 0, 1]], ("base", 0), "three numbers are expected, not 2"),
    (("stand",), {"size": [1]}, ("stand", "size"), "two numbers are expected, not 1"),
    (("stand",), {"size": [1, 0]}, ("stand", "size", 1), "a number above 0 is expected, not 0"),
    (
        ("stand",),
        {"size": [250, 1]},
        ("stand", "size", 0),
        "250 m is more than 20 m, the largest length here",
    ),
    (
        ("stand",),
        {"size": [1, 1], "centre": [0, 40]},
        ("stand", "centre", 1),
        "40 m is more than 20 m, the largest length here",
    ),
    ((*LEFT, "joints", 1), "a", (*LEFT, "joints", 1), "the joint `a` is there twice"),
    (
        (*LEFT, "gripper", "joints", "b"),
        {"open": 1},
        (*LEFT, "gripper", "joints", "b"),
        "the joint `b` is one of the arm",
    ),
    (
        (*LEFT, "limits"),
        [[-1, 1], [2, -2]],
        (*LEFT, "limits", 1),
        "the lowest position 2 is above the highest -2",
    ),
    (
        (*LEFT, "limits"),
        [[-1, 1], [-2, 0.5]],
        (*LEFT, "home", 1),
        "`b` is 1 rad, outside its limits -2 to 0.5",
    ),
    (
        (*LEFT, "speeds"),
        [1, -1],
        (*LEFT, "speeds", 1),
        "a number above 0 is expected, not -1",
    ),
]


@pytest.mark.parametrize(("place", "value", "where", "message"), MISTAKES)
def test_a_mistake_has_its_place(
    place: tuple[str | int, ...], value: Any, where: tuple[str | int, ...], message: str
) -> None:
    found = mistake(changed(ROBOT, place, value))
    assert found is not None
    assert (found.place, found.message) == (where, message)


FOLLOWERS = URDF.text.replace(
    "</robot>",
    """<link name="right"/><link name="third"/><link name="wrist"/>
<joint name="g" type="prismatic"><parent link="hand"/><child link="right"/>
<limit lower="-0.04" upper="0" effort="1" velocity="1"/><mimic joint="f" multiplier="-1"/></joint>
<joint name="h" type="prismatic"><parent link="hand"/><child link="third"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="g" multiplier="2" offset="0.1"/>
</joint>
<joint name="w" type="revolute"><parent link="hand"/><child link="wrist"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/><mimic joint="b"/></joint></robot>""",
)
FINGERS = (*LEFT, "gripper", "joints")


@pytest.mark.parametrize(
    ("place", "value", "where", "message", "help"),
    [
        (FINGERS, {"g": {"open": -0.04}}, (*FINGERS, "g"),
         "the joint `g` follows `f` (`<mimic>`): no command moves it",
         "write `f`, with its own positions, in its place, or remove it"),
        (FINGERS, {"g": {"open": -0.04}, "h": {"open": 0.02}}, (*FINGERS, "g"),
         "the joint `g` follows `f` (`<mimic>`): no command moves it", None),
        (FINGERS, {"f": {"open": 0.04}, "g": {"open": -0.02}}, (*FINGERS, "g", "open"),
         "`g` follows `f` (`<mimic>`) to -0.04",
         "remove `g`, which needs no entry, or write `open: -0.04`"),
        (FINGERS, {"f": {"open": 0.04}, "h": {"open": 0.02}}, (*FINGERS, "h", "closed"),
         "`h` follows `f` (`<mimic>`) to 0.1", None),
        ((*LEFT, "joints", 1), "w", (*LEFT, "joints", 1),
         "the joint `w` follows `b` (`<mimic>`): no command moves it", None),
        (FINGERS, {"f": {"open": 0.04}, "g": {"open": -0.04}}, None, "", None),
        (FINGERS, {"f": {"open": 0.04}, "h": {"open": 0.02, "closed": 0.1}}, None, "", None),
    ],
)  # fmt: skip
def test_a_joint_that_follows_another_one_is_not_commanded(
    place: tuple[str | int, ...],
    value: Any,
    where: tuple[str | int, ...] | None,
    message: str,
    help: str | None,
) -> None:
    found = mistake(changed(ROBOT, place, value), urdf.read(FOLLOWERS))
    assert (found and found.place, found.message if found else "") == (where, message)
    assert help is None or (found is not None and found.help == help)


def test_a_wrong_unit_has_help() -> None:
    wrong = {
        (*LEFT, "home", 1): (57.0, "write `0.9948`: angles are in radians, not in degrees"),
        (*LEFT, "gripper", "joints", "f", "open"): (
            40,
            "write `0.04`: lengths are in metres, not in millimetres",
        ),
    }
    for place, (value, help) in wrong.items():
        found = mistake(changed(ROBOT, place, value))
        assert found is not None
        assert found.help == help


def test_a_station_has_parts() -> None:
    found = description.read(
        plain("{name: two, parts: {near: {robot: panda}, far: {robot: iiwa, base: [1, 0, 0]}}}")
    )
    assert isinstance(found, Station)
    assert [part.name for part in found.parts] == ["near", "far"]
    assert description.limb_names("near", ["arm"]) == ("near",)
    assert description.limb_names("b", ["left", "right"]) == ("b_left", "b_right")


@pytest.mark.parametrize("name", ["base", "world"])
def test_no_part_and_no_body_has_the_name_of_a_frame(name: str) -> None:
    with pytest.raises(DataError, match=f"`{name}` is the name of a frame") as part:
        description.read({"name": "two", "parts": {name: {"robot": "panda"}}})
    assert part.value.place == ("parts", name)
    with pytest.raises(DataError, match=f"`{name}` is the name of a frame") as body:
        scene.read({"bodies": {name: {"model": "block"}}})
    assert body.value.place == ("bodies", name)


@pytest.mark.parametrize("name", BUILT_IN)
def test_the_built_in_robots_are_read(name: str) -> None:
    found = built_in(name)
    assert isinstance(found, Description)
    assert found.name == name


SCENE = """
bodies:
  table: {model: table, frame: world}
  block: {model: block, pose: [0.5, 0, 0.025], spread: [0.1, 0.1, 1], colour: [1, 0, 0]}
  cap: {size: [0.1, 0.1, 0.02], mass: 0.1, pose: [0, 0, 0.1], frame: block, apart: {table: 0.2}}
"""


def test_a_scene() -> None:
    table, block, cap = scene.read(plain(SCENE))
    assert (table.frame, block.frame, cap.frame) == ("world", "base", "block")
    assert block.colour == (1.0, 0.0, 0.0)
    assert cap.box is not None
    assert cap.box.mass == 0.1
    assert cap.apart == (("table", 0.2),)


@pytest.mark.parametrize(
    ("place", "value", "where", "message"),
    [
        (("bodies", "block", "model"), "blok", ("bodies", "block", "model"), "no model `blok`"),
        (("bodies", "cap", "frame"), "lid", ("bodies", "cap", "frame"), "no frame `lid`"),
        (("bodies", "cap", "apart"), {"lid": 1}, ("bodies", "cap", "apart", "lid"), "no body"),
        (
            ("bodies", "cap", "size"),
            [100, 1, 1],
            ("bodies", "cap", "size", 0),
            "100 m is more than",
        ),
        (
            ("bodies", "block", "spread"),
            [0.1, -0.1, 1],
            ("bodies", "block", "spread", 1),
            "a shift is not negative",
        ),
        (("bodies", "cap", "size"), None, ("bodies", "cap"), "a `model`, a `path` or a `size`"),
        (("bodies", "block", "mass"), 1, ("bodies", "block", "mass"), "`mass` needs `size`"),
        (
            ("bodies", "block", "colour"),
            [255, 0, 0],
            ("bodies", "block", "colour", 0),
            "a part of a colour is from 0 to 1",
        ),
    ],
)
def test_a_mistake_in_a_scene_has_its_place(
    place: tuple[str | int, ...], value: Any, where: tuple[str | int, ...], message: str
) -> None:
    with pytest.raises(DataError, match=message) as found:
        scene.read(changed(SCENE, place, value))
    assert found.value.place == where


@pytest.mark.parametrize(
    ("width", "message", "help"),
    [
        (
            "{open: 0.0, closed: 0.085}",
            "`open` is 0.0 m, less than `closed`, 0.085 m",
            "write `{open: 0.085, closed: 0.0}`",
        ),
        (
            "{open: 0.08, closed: 0.08}",
            "`open` and `closed` are the same width, 0.08 m",
            "write a larger width for `open` than `0.08`",
        ),
        (
            "{open: 0.08, closed: -0.1}",
            "`closed` is -0.1 m: a width is not negative",
            "write `closed: 0.0` if the fingers touch",
        ),
    ],
)
def test_widths_that_are_swapped_or_wrong(width: str, message: str, help: str) -> None:
    text = ROBOT.replace("width: {open: 0.08, closed: 0}", f"width: {width}")
    with pytest.raises(DataError) as error:
        description.read(plain(text))
    assert (error.value.message, error.value.help) == (message, help)


@pytest.mark.parametrize(
    ("frame", "message", "help"),
    [
        ("tray", "the frame `tray` is defined after `gear`", "move `tray` before `gear`"),
        ("gear", "there is no frame `gear` before `gear` in the file", ""),
        ("tabel", "there is no frame `tabel` before `gear` in the file", "did you mean `table`?"),
    ],
)
def test_the_frame_of_a_body_that_is_not_before_it(frame: str, message: str, help: str) -> None:
    pose = [[0, 0, 0], [0, 0, 0, 1]]
    bodies = {
        "table": {"model": "table", "pose": pose},
        "gear": {"model": "block", "pose": pose, "frame": frame},
        "tray": {"model": "block", "pose": pose, "frame": "table"},
    }
    with pytest.raises(DataError) as caught:
        scene.read({"bodies": bodies})
    assert caught.value.message == message
    assert help in (caught.value.help or "")


@pytest.mark.parametrize(
    ("shape", "data", "help"),
    [
        (fields.number, "0.5", "write the number without quotes: `0.5`"),
        (fields.number, [0.5], "write the number without the brackets: `0.5`"),
        (fields.number, "0,5", "a decimal comma? write `0.5`"),
        (fields.number, "50mm", "write the number without its unit: `0.05`"),
        (fields.number, True, "write a finite number, as in `0.5`"),
        (fields.text, ["base"], "write one text, as in `base`"),
        (fields.text, 5, 'write it in quotes: `"5"`'),
        (fields.truth, "yes", "write `true` or `false`, without quotes"),
        (fields.positive, -0.2, "write `0.2`"),
        (fields.probability, 30, "write `0.3` for 30 %"),
        (fields.texts, "base", "write `[base]`"),
        (fields.pose, [0.1, 0.2], "add one number: the form is `[x, y, z]`"),
        (fields.pose, [[0.1, 0.2, 0.3]], "write the position, as in `[0.5, 0.0, 0.2]`, or a list"),
        (fields.pose, [[0.1, 0.2], [0, 0, 0, 1]], "add one number: the form is `[x, y, z]`"),
        (fields.pose, [[0, 0, 0], [0, 0, 1]], "add one number: the form is `[qx, qy, qz, qw]`"),
    ],
)
def test_a_value_of_another_shape_has_a_repair(
    shape: fields.Shape[object], data: object, help: str
) -> None:
    with pytest.raises(DataError) as error:
        shape(data, ("here",))
    assert error.value.help.startswith(help)


@pytest.mark.parametrize(
    ("old", "new", "help"),
    [
        ("gripper", ("pads", "force"), "move `pads`, `force` into `gripper`: indent them as its"),
        ("gripper", ("force",), "move `force` into `gripper`: indent it as its other keys"),
        ("gripper", ("forces",), "did you mean"),
        ("home", (), "move `home` out of `gripper`: indent it as `gripper` itself"),
        ("tolerance", (), "move `tolerance` out of `gripper`: indent it as `gripper` itself"),
    ],
)
def test_a_key_of_a_mapping_beside_or_around(old: str, new: tuple[str, ...], help: str) -> None:
    data = plain(ROBOT)
    limb = data["arms"]["left"]
    if old == "gripper":
        limb.update(dict.fromkeys(new, 1.0))
    else:
        limb["gripper"][old] = limb.pop(old, 0.1)
    with pytest.raises(DataError) as raised:
        description.read(data)
    assert raised.value.help.startswith(help)
