# ruff: noqa: E501 (tables of short texts)
"""URDF files: what is read, what is refused with its place, and the text for the engine."""

from __future__ import annotations

import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.robots import urdf
from smachac.robots.engine_text import engine_text, roll_pitch_yaw
from smachac.robots.files import find_mesh
from smachac.robots.xml_tree import XmlError

LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'


def joint(name: str, parent: str, child: str, kind: str = "fixed", more: str = "") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{more}</joint>'


def text(*parts: str, links: str = "a b", head: str = 'name="r"') -> str:
    names = [f'<link name="{link}"/>' for link in links.split()]
    return "\n".join([f"<robot {head}>", *names, *parts, "</robot>"])


def link(content: str) -> str:
    return f'<link name="c">{content}</link>'


def shape(geometry: str) -> str:
    return text(link(f"<collision><geometry>{geometry}</geometry></collision>"), links="")


def mistake(written: str) -> tuple[str, str]:
    """The message, and the text at its place."""
    with pytest.raises(XmlError) as error:
        urdf.read(written)
    assert error.value.help
    return error.value.message, written[slice(*error.value.place)]


def engine(written: str) -> str:
    return engine_text(urdf.read(written), lambda name: Path("/meshes") / name).text


AB = joint("j", "a", "b")


@pytest.mark.parametrize(
    ("written", "message", "place"),
    [
        # The graph
        (text(), "the robot has 2 roots: no joint leads to `a`, nor to `b`", "b"),
        (text(AB, joint("k", "b", "a")), "the links `b`, `a` are a circle of joints", None),
        (text(AB, joint("k", "b", "b")), "the link `b` is the child of two joints, `j` (line 4)", "k"),
        (text(AB, joint("k", "c", "c"), links="a b c"), "the links `c` are a circle", "k"),
        (text(AB, joint("k", "a", "b")), "the link `b` is the child of two joints, `j` (line 4)", "k"),
        (text(AB, AB), "there are two joints `j`", "j"),
        (text(links="a a"), "there are two links `a`", "a"),
        (text(link(AB)), "`<joint>` is inside `<link>`", '<joint name="j" type="fixed">'),
        (text(joint("j", "a", "b", more='<link name="x"/>')), "`<link>` is inside `<joint>`", None),
        (text(joint("j", "a", "d")), "joint `j` names the link `d`, which does not exist", "d"),
        (text('<joint name="j" type="fixed"><child link="b"/></joint>'), "joint `j` has no `<parent>`", None),
        (text('<joint name="j" type="fixed"><parent/><child link="b"/></joint>'), "`<parent>` has no `link`", "<parent/>"),
        # Followers
        (text(joint("j", "a", "b", "revolute", LIMIT + '<mimic joint="k"/>')),
         "joint `j` follows the joint `k`, which does not exist", "j"),
        (text(joint("j", "a", "b", "revolute", LIMIT + '<mimic joint="j"/>')),
         "joint `j` follows `j`, which follows it", "j"),
        (text(joint("j", "a", "b", "revolute", LIMIT + "<mimic/>")), "`<mimic>` has no `joint`", "<mimic/>"),
        # Joints
        (text(joint("j", "a", "b", "revolute")), "the revolute joint `j` has no `<limit>`", "j"),
        (text(joint("j", "a", "b", "prismatic")), "the prismatic joint `j` has no `<limit>`", "j"),
        (text(joint("j", "a", "b", "spherical")), "joint `j` has the unknown type `spherical`", "spherical"),
        (text(joint("j", "a", "b", "continuous", '<axis xyz="0,0,1"/>')),
         "`xyz` of `<axis>` is `0,0,1`, not 3 numbers with spaces between them", "0,0,1"),
        (text(joint("j", "a", "b", "continuous", '<axis xyz="0 0 0"/>')), "the axis of joint `j` is zero", "0 0 0"),
        (text(joint("j", "a", "b", "revolute", '<limit lower="1_0" upper="11"/>')), "`lower` of `<limit>` is `1_0`", "1_0"),
        (text(joint("j", "a", "b", "revolute", LIMIT + LIMIT)), "`<joint>` has two elements `<limit>`", None),
        # Origins and versions
        (text(joint("j", "a", "b", more='<origin quat_xyzw="0 0 0 1"/>')), "`quat_xyzw` needs URDF 1.1", "0 0 0 1"),
        (text(joint("j", "a", "b", more='<origin rpy="0 0 0" quat_xyzw="0 0 0 1"/>'), head='version="1.1"'),
         "`<origin>` has `rpy` and `quat_xyzw`", "0 0 0 1"),
        (text(joint("j", "a", "b", more='<origin quat_xyzw="0 0 0 0"/>'), head='version="1.2"'),
         "the quaternion is zero", "0 0 0 0"),
        (text(AB, head='version="2.0"'), "the URDF version `2.0` is not known", "2.0"),
        (text(AB, head='version="1"'), "the URDF version `1` is not known", "1"),
        (text(joint("j", "a", "b", more='<origin xzy="1 0 0"/>')), "the attribute `xzy` of `<origin>` is not one", "1 0 0"),
        (text(joint("j", "a", "b", more='<orign xyz="1 0 0"/>')), "`<orign>` is not one of URDF", None),
        # Links
        (text(link("<inertial/>")), "`<inertial>` has no `<mass>`", "<inertial/>"),
        (text(link('<inertial><mass value="1"/></inertial>')), "`<inertial>` has no `<inertia>`", "<inertial>"),
        (text(link('<inertial><mass/></inertial>')), "`<inertial>` has no `<inertia>`", "<inertial>"),
        (text(link('<inertial><mass value="-1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>')), "the mass is -1 kg", "-1"),
        (text(link('<inertial><mass value="1e9"/><inertia ixx="1" iyy="1" izz="1"/></inertial>')), "`value` of `<mass>` is `1e9`: it is too large", "1e9"),
        (text(link('<visual><geometry><box size="1 1 1"/></geometry><material/></visual>')), "`<material>` has no `name`", "<material/>"),
        (text(link("<visual/>")), "`<visual>` has no `<geometry>`", "<visual/>"),
        (shape(""), "`<geometry>` has no shape that is known", "<geometry>"),
        (shape("<cone/>"), "`<geometry>` has no shape that is known", "<geometry>"),
        (shape('<box size="1 1 1"/><sphere radius="1"/>'), "`<geometry>` has `<box>` and `<sphere>`", "<geometry>"),
        (shape('<cylinder radius="1"/>'), "`<cylinder>` has no `length`", '<cylinder radius="1"/>'),
        (shape('<sphere radius="-1"/>'), "`radius` of `<sphere>` is `-1`: no length is negative", "-1"),
        (shape('<capsule radius="1" length="1"/>'), "`<capsule>` needs URDF 1.1", None),
        (text(links="x" * 901), "`name` of `<link>` has more than 900 characters", "x" * 901),
        (shape("<mesh/>"), "`<mesh>` has no `filename`", "<mesh/>"),
    ],
)  # fmt: skip
def test_mistakes(written: str, message: str, place: str | None) -> None:
    found, there = mistake(written)
    assert found.startswith(message)
    assert place is None or there == place


@pytest.mark.parametrize(
    ("written", "message", "help"),
    [
        ("", "the file is empty", "its first tag is"),
        (" \n\t", "the file is empty", "its first tag is"),
        ("<robot><!-- a -- b --></robot>", "a comment contains `--`", "another sign"),
        ("<robot><!-- ok --><!-- ---- x ---- --></robot>", "a comment contains `--`", "another sign"),
        ("<robot><!-- a </robot>", "a comment is not closed", "write `-->`"),
        ("<robot/><robot/>", "not valid XML: junk after document element", "one outermost element"),
        ("\n<?xml version='1.0'?><robot/>", "not valid XML", "only at the start of the file"),
        ("arm <robot/>", "not valid XML: syntax error", "text outside of all tags"),
        ("<robot name='a' name='b'/>", "not valid XML: duplicate attribute", "one name"),
        ("<robot name=&amp;/>", "not valid XML", 'name="value"'),
        ("<robot name='a & b'/>", "not valid XML", "`&amp;`"),
        ("<robot>&nbsp;</robot>", "not valid XML: undefined entity", "`&amp;`"),
        ("<robot><link name='a'</robot>", "not valid XML", 'name="value"'),
    ],
)  # fmt: skip
def test_faults_of_xml_have_a_help_of_their_own(written: str, message: str, help: str) -> None:
    with pytest.raises(XmlError) as error:
        urdf.read(written)
    assert message in error.value.message
    assert help in error.value.help


def test_facts_of_joints() -> None:
    more = '<limit effort="10"/>', '<limit lower="-2" effort="5" velocity="0"/>'
    found = urdf.read(
        text(
            joint("turn", "a", "b", "continuous"),
            joint("wheel", "b", "c", "continuous", '<limit lower="0" upper="0" effort="7"/>'),
            joint("lift", "c", "d", "prismatic", more[0]),
            joint("elbow", "d", "e", "revolute", more[1] + '<mimic joint="lift" multiplier="-2"/>'),
            links="a b c d e",
        )
    )
    facts = [(j.lower, j.upper, j.velocity, j.effort, j.unit) for j in found.joints.values()]
    none = math.inf
    assert facts == [
        (-none, none, none, none, "rad"),
        (-none, none, none, 7.0, "rad"),
        (0.0, 0.0, none, 10.0, "m"),
        (-2.0, 0.0, none, 5.0, "rad"),
    ]
    assert found.joints["elbow"].mimic == urdf.Mimic(joint="lift", multiplier=-2.0)
    assert [j.name for j in found.chain("d")] == ["turn", "wheel", "lift"]
    assert found.chain(found.root) == ()


EXTENSIONS = """
<link name="c" type="laser_link"><self_collision_checking><origin xyz="x"/></self_collision_checking>
<visual group="g"><geometry name="n"><mesh filename="m.stl"/></geometry>
<material name="m"/><material name="n"/></visual>
<contact><friction_anchor/><stiffness value="3"/></contact></link>
<gazebo reference="c"><origin xyz="none"/><link/></gazebo>
<transmission name="t"><joint name="j"/></transmission>
<ros2_control name="x" type="system"><joint name="j"/></ros2_control>
<joint name="j" type="revolute"><parent link="a"/><child link="c"/><controller_gains Kp="1"/>
<limit lower="-1" upper="1" effort="1" velocity="1" acceleration="2" jerk="3" drake:accel="9"/>
<safety_controller k_velocity="1"/><calibration rising="0"/></joint>
"""


def test_what_other_programs_add_is_left_out() -> None:
    printed = engine(text(EXTENSIONS, links="a"))
    for word in ("drake", "gazebo", "Kp", "self_collision", "safety", "acceleration", "group"):
        assert word not in printed
    assert printed.count("<material") == 1
    assert '<mesh filename="/meshes/m.stl"/>' in printed
    assert "<friction_anchor/>" in printed


def test_the_text_for_the_engine_has_what_the_format_means() -> None:
    more = '<origin xyz="0 0 0.1" quat_xyzw="0 0 0.1 0.1"/><axis xyz="0 0 2"/>'
    more += '<limit lower="-2" effort="10"/>'
    printed = engine(
        text(
            joint("j", "a", "b", "revolute", more),
            joint("k", "b", "c", "floating"),
            joint("l", "b", "d", "planar", LIMIT),
            joint("m", "b", "e", "continuous", LIMIT),
            links="a b c d e",
            head='version="1.1"',
        )
    )
    assert printed.startswith('<robot name="robot">\n')
    (angles,) = re.findall(r'<origin xyz="0 0 0.1" rpy="([^"]*)"/>', printed)
    assert [*map(float, angles.split())] == pytest.approx([0.0, 0.0, math.pi / 2])
    assert '<axis xyz="0.0 0.0 1.0"/>' in printed
    assert '<limit effort="10.0" lower="-2.0" upper="0.0"/>' in printed
    assert printed.count('<axis xyz="1.0 0.0 0.0"/>') == 1
    assert printed.count('type="fixed"') == 2
    assert '<joint name="m" type="continuous">' in printed
    assert '<limit effort="3.0" velocity="4.0"/>' in printed


def test_long_names_are_printed_on_short_lines() -> None:
    names = "x" * 900, "y" * 900
    printed = engine(text(joint("j" * 900, *names), links=" ".join(names)))
    assert max(map(len, printed.splitlines())) < 1000
    again = urdf.read(printed)
    assert again.links == names


unit = st.floats(-1.0, 1.0)


def difference(quaternion: tuple[float, float, float, float]) -> float:
    """1 minus the cosine of half the angle between a rotation and its angles as a rotation."""
    cr, sr, cp, sp, cy, sy = (
        function(angle / 2)
        for angle in roll_pitch_yaw(quaternion)
        for function in (math.cos, math.sin)
    )
    again = (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )
    cosine = sum(a * b for a, b in zip(again, quaternion, strict=True)) / math.hypot(*quaternion)
    return abs(abs(cosine) - 1.0)


@given(st.tuples(unit, unit, unit, unit).filter(lambda q: math.hypot(*q) > 0.1))
def test_angles_turn_as_their_quaternion(quaternion: tuple[float, float, float, float]) -> None:
    assert difference(quaternion) < 1e-8


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("turn", [0.0, 0.4, -2.0])
def test_angles_straight_up_and_down(sign: float, turn: float) -> None:
    half, x, w = math.sqrt(0.5), math.sin(turn / 2), math.cos(turn / 2)
    assert difference((x * half, sign * w * half, -sign * x * half, w * half)) < 1e-8


def frames(count: int) -> str:
    fixed = [joint(f"f{k}", "a", f"f{k}") for k in range(count)]
    return text(*fixed, links=" ".join(["a", *(f"f{k}" for k in range(count))]))


def test_a_robot_with_many_links() -> None:
    printed = engine_text(urdf.read(frames(200)), lambda name: None, ["f150"]).text
    assert printed.count("<link") == 2
    moving = text(
        *(joint(f"j{k}", f"l{k}", f"l{k + 1}", "continuous") for k in range(130)),
        links=" ".join(f"l{k}" for k in range(131)),
    )
    with pytest.raises(XmlError, match="131 links, more than the 128 of the simulation"):
        engine(moving)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("meshes/a.stl", "arm_description/meshes/a.stl"),
        ("../meshes/a.stl", "arm_description/meshes/a.stl"),
        ("package://arm_description/meshes/a.stl", "arm_description/meshes/a.stl"),
        ("model://arm_description/meshes/a.stl", "arm_description/meshes/a.stl"),
        ("package://renamed/meshes/a.stl", "arm_description/meshes/a.stl"),
        ("package://hand/b.stl", "ws/hand/b.stl"),
        ("package://tool/c.stl", "opt/share/tool/c.stl"),
        ("package://given/d.stl", "elsewhere/d.stl"),
        ("package://given/none.stl", None),
        ("package://nobody/a.stl", None),
        ("package://", None),
        ("", None),
        ("a\0b.stl", None),
        ("x" * 5000, None),
    ],
)
def test_where_meshes_are_searched(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, found: str | None
) -> None:
    files = ["arm_description/meshes/a.stl", "ws/hand/b.stl", "opt/share/tool/c.stl"]
    for file in [*files, "elsewhere/d.stl", "arm_description/urdf/arm.urdf"]:
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).touch()
    (tmp_path / "arm_description" / "package.xml").write_text("<p><name>renamed</name></p>")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "opt"))
    place = tmp_path / "arm_description" / "urdf" / "arm.urdf"
    path = find_mesh(name, place, {"given": tmp_path / "elsewhere"})
    assert (path and path.resolve()) == (found and (tmp_path / found).resolve())


def test_a_mesh_is_missing_or_has_an_unknown_format() -> None:
    robot = urdf.read(shape('<mesh filename="package://arm/a.step"/>'))
    with pytest.raises(
        XmlError, match=r"the mesh file `package://arm/a\.step` was not found"
    ) as error:
        engine_text(robot, lambda name: None)
    assert "ROS_PACKAGE_PATH" in error.value.help
    with pytest.raises(XmlError, match="does not read mesh files such as") as error:
        engine_text(robot, Path)
    assert "`.stl`" in error.value.help or ".stl" in error.value.help
