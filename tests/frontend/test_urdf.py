"""Robot descriptions: what is read of them, what is refused, and that nothing else ever happens."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import smachac
from smachac.diagnostics.source import Source
from smachac.frontend.robots.urdf import robot_of_urdf
from smachac.ir.robot import Robot
from smachac.robots import urdf
from smachac.robots.xml_tree import XmlError


def joint(name: str, parent: str, child: str, kind: str = "revolute", more: str = "") -> str:
    limit = '<limit lower="-1" upper="2" effort="1" velocity="1"/>'
    limit = limit if kind in ("revolute", "prismatic") else ""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{limit}{more}</joint>'


def read_urdf(source: Source) -> Robot:
    return robot_of_urdf(urdf.read(source.text), source)


def source_text(links: str, *joints: str) -> str:
    names = "".join(f'<link name="{link}"/>' for link in links.split())
    return f'<robot name="arm">{names}{"".join(joints)}</robot>'


def robot(links: str, *joints: str) -> Robot:
    return read_urdf(Source("arm.urdf", source_text(links, *joints)))


def limbs(found: Robot) -> list[list[str]]:
    return [[item.name for item in limb] for limb in found.limbs]


def test_joints_limits_and_links() -> None:
    joints = joint("x", "a", "b"), joint("y", "b", "c", "continuous"), joint("z", "c", "d", "fixed")
    found = robot("a b c d", *joints)
    assert found.name == "arm"
    assert [(item.lower, item.upper) for item in found.joints] == [(-1, 2), (-math.inf, math.inf)]
    assert [item.span.text for item in found.joints] == ["x", "y"]
    assert found.frames == frozenset("abcd")
    assert limbs(found) == [["x", "y"]]


MIMIC = '<mimic joint="f"/>'


@pytest.mark.parametrize(
    ("links", "joints", "expected"),
    [
        ("a", [], []),
        ("a b", [joint("x", "a", "b", "fixed")], []),
        ("a b c", [joint("x", "a", "b"), joint("f", "b", "c", "fixed")], [["x"]]),
        # Fingers that slide end the arm; they are not of it.
        (
            "a b l r",
            [
                joint("x", "a", "b"),
                joint("l", "b", "l", "prismatic"),
                joint("r", "b", "r", "prismatic"),
            ],
            [["x"]],
        ),
        # One that turns, and one that follows it: the fork ends the arm as well.
        (
            "a b l r",
            [joint("x", "a", "b"), joint("f", "b", "l"), joint("g", "b", "r", more=MIMIC)],
            [["x"], ["f"], ["x", "f"]],
        ),
        # Two arms on a torso: each alone, or the torso with one of them.
        (
            "a t l m r s",
            [
                joint("turn", "a", "t"),
                joint("l1", "t", "l"),
                joint("l2", "l", "m"),
                joint("r1", "t", "r"),
                joint("r2", "r", "s"),
            ],
            [["turn"], ["l1", "l2"], ["turn", "l1", "l2"], ["r1", "r2"], ["turn", "r1", "r2"]],
        ),
    ],
)
def test_limbs(links: str, joints: list[str], expected: list[list[str]]) -> None:
    assert limbs(robot(links, *joints)) == expected


BILLION = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"/>'
OUTSIDE = '<!DOCTYPE robot SYSTEM "file:///etc/passwd"><robot name="x"/>'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("hello", "not valid XML"),
        ("<robot>", "`<robot>` is not closed"),
        ("<sdf/>", "the outermost element is `<sdf>`"),
        (BILLION, "a document type"),
        (OUTSIDE, "a document type"),
        ("<robot>&lol;</robot>", "undefined entity"),
        ("<robot>" + "<a>" * 200 + "</a>" * 200 + "</robot>", "more than 100 levels"),
        ("<robot>" + "<a/>" * 100_001 + "</robot>", "more than 100,000 elements"),
        (f"<robot>{' ' * 5_000_000}</robot>", "characters"),
        ("<robot><link/></robot>", "has no name"),
        ('<robot><link name="a"/><link name="a"/></robot>', "two links `a`"),
        (source_text("a b", joint("x", "a", "b", "turning")), "the unknown type `turning`"),
        ('<robot><joint name="x" type="fixed"/></robot>', "joint `x` has no `<parent>`"),
        ("<robot/>", "the robot has no link"),
        ("<robot><xacro:macro name='x'/></robot>", "not an element of URDF"),
        ("<robot><link name='a'/>\ud800</robot>", "describes"),
    ],
)
def test_what_is_refused(text: str, message: str) -> None:
    if message == "describes":
        read_urdf(Source("arm.urdf", text))
        return
    with pytest.raises(XmlError) as error:
        read_urdf(Source("arm.urdf", text))
    assert message in error.value.message


@pytest.mark.parametrize(
    ("limit", "message"),
    [
        ("", "has no `<limit>`"),
        ('<limit lower="low" upper="1"/>', "`lower` of `<limit>` is `low`, not a number"),
        ('<limit lower="nan" upper="1"/>', "`lower` of `<limit>` is `nan`, not a number"),
        ('<limit lower="${-pi}" upper="1"/>', "not a number"),
        (
            '<limit lower="2" upper="1"/>',
            "the lower limit 2.0 of joint `x` is above its upper limit 1.0",
        ),
    ],
)
def test_limits_that_are_none(limit: str, message: str) -> None:
    text = joint("x", "a", "b").replace(
        '<limit lower="-1" upper="2" effort="1" velocity="1"/>', limit
    )
    with pytest.raises(XmlError, match=message.replace("$", r"\$")) as error:
        robot("a b", text)
    place = "x" if not limit else 'lower="2"' if "above" in message else limit.split('"')[1]
    assert source_text("a b", text)[slice(*error.value.place)] == place
    swapped = 'write `lower="1" upper="2"`: are the two swapped?'
    assert "above" not in message or error.value.help == swapped


PIECES = st.sampled_from(
    "<robot> </robot> <link_name='a'/> <joint_name='x'_type='revolute'> </joint> <parent_link='a'/>"
    " <child_link='a'/> <limit_lower='0'/> <!-- & < \r é".replace("_", "\0").split(" ")
).map(lambda piece: piece.replace("\0", " "))


def refusal(source: Source) -> XmlError | None:
    try:
        read_urdf(source)
    except XmlError as error:
        return error
    return None


@given(st.lists(PIECES, max_size=12).map("".join) | st.text(max_size=30))
def test_any_text_is_a_robot_or_refused_with_its_place(text: str) -> None:
    error = refusal(Source("arm.urdf", text))
    assert error is None or 0 <= error.place[0] <= error.place[1] <= len(text)


def test_what_pybullet_ships() -> None:
    data = pytest.importorskip("pybullet_data")
    folder = Path(data.getDataPath())

    def read(name: str) -> Robot:
        return read_urdf(Source(name, (folder / name).read_text(encoding="utf-8")))

    assert [len(limb) for limb in read("franka_panda/panda.urdf").limbs] == [7]
    assert [len(limb) for limb in read("kuka_iiwa/model.urdf").limbs] == [7]
    assert read("r2d2.urdf").joints


SCRIPT = """
name: sm
template: Base
robot: {robot}
outcomes: [done]
states:
  - MOVE: {{template: ScriptedState, outcomes: [done], transitions: {{done: done}}}}
"""


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("panda", []),
        ("baxter", []),
        ("pnada", ["`pnada` is not a known robot"]),
        ("sub/arm.urdf", []),
        (
            "sub/broken.urdf",
            [
                "the robot file `sub/broken.urdf` has a mistake: "
                + "`</a>` ends no element: `<robot>` in line 1 is open"
            ],
        ),
        ("sub/none.urdf", ["the file `sub/none.urdf` was not found"]),
        ("../arm.urdf", ["the file `../arm.urdf` was not found"]),
        ("/etc/passwd.urdf", ["the file `/etc/passwd.urdf` was not found"]),
        ("package://my_robot/arm.urdf", ["the file `package://my_robot/arm.urdf` was not found"]),
        ("arm.urdf.xacro", ["the file `arm.urdf.xacro` was not found"]),
        ("sub/odd.urdf", ["the byte 0xff is not valid in UTF-16-LE"]),
    ],
)
def test_the_robot_of_a_script(tmp_path: Path, name: str, expected: list[str]) -> None:
    folder = tmp_path / "project"
    (folder / "sub").mkdir(parents=True)
    (tmp_path / "arm.urdf").write_text("<robot><link name='a'/></robot>")
    (folder / "sub" / "arm.urdf").write_text("<robot><link name='a'/></robot>")
    (folder / "sub" / "broken.urdf").write_text("<robot>\n</a>")
    (folder / "sub" / "odd.urdf").write_bytes(b"\xff\xfe\xff")
    (folder / "main.yml").write_text(SCRIPT.format(robot=name))
    report = smachac.check(folder / "main.yml")
    assert [item.finding.message for item in report if item.code in ("SM018", "SM007")] == expected


@pytest.mark.parametrize(
    ("text", "place", "words"),
    [
        ('<robot name="a">\n <link name="b"/><link name="c">\n <link name="d"></link>\n</robot>',
         '<link name="c">', "`<link>` is not closed"),
        ('<robot name="a">\n <link name="b">', '<link name="b">', "`<link>` is not closed"),
        ('<robot name="a">\n <link name="b"/>', '<robot name="a">', "`<robot>` is not closed"),
        ('<robot name="a">\n <link name="b"></lnk>\n</robot>', "lnk",
         "`</lnk>` ends no element: `<link>` in line 2 is open"),
        ('<robot name="a">\n <link name=b/>\n</robot>', "b",
         "the file is not valid XML: not well-formed (invalid token)"),
    ],
)  # fmt: skip
def test_a_tag_that_is_not_closed(text: str, place: str, words: str) -> None:
    with pytest.raises(XmlError) as caught:
        read_urdf(Source("arm.urdf", text))
    assert (caught.value.message, text[slice(*caught.value.place)]) == (words, place)
