# ruff: noqa: E501 (tables of short texts)
"""What `check` accepts can be simulated: the joints of arms, meshes, and the files of bodies."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac

SCRIPT = """
name: sm
template: PyBulletBase
robot: arm.yml
{scene}outcomes: [done, failed]
userdata: {{up: [{up}]}}
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {{positions: up}}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
LIMIT = '<limit lower="-1" upper="1" effort="{effort}" velocity="1"/>'


def joint(name: str, parent: str, child: str, kind: str = "revolute", effort: str = "9") -> str:
    limit = LIMIT.format(effort=effort) if kind in ("revolute", "prismatic") else ""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{limit}</joint>'


JOINTS = joint("j1", "base", "a"), joint("j2", "a", "b"), joint("j3", "b", "c")
MORE = joint("camera", "base", "eye", "fixed"), joint("neck", "base", "head")


def project(
    folder: Path, arm: str, *joints: str, up: str = "0.1", scene: str = "", **texts: str
) -> list[tuple[str, str, str, str]]:
    """The findings of a script: code, message, file and text at the place."""
    links = "".join(f'<link name="{link}"/>' for link in ["base", "a", "b", "c", "eye", "head"])
    robot = f'<robot name="r">\n{links}\n{"".join(joints or JOINTS)}{"".join(MORE)}</robot>'
    files = {"arm.yml": f"name: r\nurdf: arm.urdf\narms:\n  arm: {arm}\n", "arm.urdf": robot}
    files |= {name.replace("_", "."): text for name, text in texts.items()}
    files["main.yml"] = SCRIPT.format(up=up, scene=scene)
    for name, text in files.items():
        (folder / name).write_text(text)
    return [
        (
            item.code,
            item.finding.message,
            Path(item.finding.span.source.name).name,
            item.finding.span.text + (f" | {item.finding.help}"),
        )
        for item in smachac.check(folder / "main.yml")
    ]


@pytest.mark.parametrize(
    ("arm", "up"),
    [
        ("{joints: [j1, j2, j3], tool: c, home: [0, 0, 0]}", "0, 0, 0"),
        ("{joints: [j1, j2], tool: b, home: [0, 0]}", "0, 0"),
        ("{joints: [j2, j3], tool: c, home: [0, 0]}", "0, 0"),  # j1 stays at 0
    ],
)
def test_joints_from_the_base_to_the_tool(tmp_path: Path, arm: str, up: str) -> None:
    assert project(tmp_path, arm, up=up) == []


@pytest.mark.parametrize(
    ("arm", "message", "place"),
    [
        ("{joints: [j3, j2, j1], tool: c, home: [0, 0, 0]}", "the joints are not in the order from the base to the tool",
         "joints | write `joints: [j1, j2, j3]`, and `home` in the same order"),
        ("{joints: [j2, j1], tool: b, home: [0, 0]}", "the joints are not in the order from the base to the tool",
         "joints | write `joints: [j1, j2]`, and `home` in the same order"),
        ("{joints: [j1, j3], tool: c, home: [0, 0]}", "the joint `j2` also moves the tool link `c`",
         "joints | write `joints: [j1, j2, j3]`, with its position in `home`"),
        ("{joints: [j1, j2], tool: c, home: [0, 0]}", "the joint `j3` also moves the tool link `c`",
         "joints | write `joints: [j1, j2, j3]`, with its position in `home`"),
        ("{joints: [j1, j2, j3], tool: a, home: [0, 0, 0]}", "the joint `j2` does not move the tool link `a`",
         "j2 | write `joints: [j1]`: the joints from the root `base` to it"),
        ("{joints: [j1], tool: base, home: [0]}", "the joint `j1` does not move the tool link `base`",
         "j1 | name another link as `tool`"),
        ("{joints: [j1], tool: eye, home: [0]}", "the joint `j1` does not move the tool link `eye`",
         "j1 | name another link as `tool`"),
        ("{joints: [neck, j1], tool: a, home: [0, 0]}", "the joint `neck` does not move the tool link `a`",
         "neck | write `joints: [j1]`: the joints from the root `base` to it"),
        ("{joints: [camera], tool: eye, home: [0]}", "the joint `camera` has the type fixed: no motor moves it",
         "camera | write a joint that moves: `j1`, `j2`, `j3`, `neck`"),
    ],
)  # fmt: skip
def test_joints_off_the_chain(tmp_path: Path, arm: str, message: str, place: str) -> None:
    ((code, found, file, there),) = project(tmp_path, arm)
    assert (code, file) == ("SM018", "arm.yml")
    assert found == f"the robot file `arm.yml` has a mistake: {message}"
    assert there == place


def test_a_joint_of_another_type_in_the_arm(tmp_path: Path) -> None:
    joints = joint("j1", "base", "a"), joint("f", "a", "b", "floating"), joint("j3", "b", "c")
    ((_, message, _, _),) = project(tmp_path, "{joints: [j1, j3], tool: c, home: [0, 0]}", *joints)
    assert "an arm has no joint of the type floating" in message


@pytest.mark.parametrize("effort", ["0", "-0.0", "0e3"])
def test_a_joint_without_effort(tmp_path: Path, effort: str) -> None:
    joints = joint("j1", "base", "a", effort=effort), *JOINTS[1:]
    arm = "{{joints: [j1], tool: a, home: [0]{}}}"
    ((code, message, file, place),) = project(tmp_path, arm.format(""), *joints)
    assert (code, file) == ("SM018", "arm.yml")
    assert message.endswith(
        "the joint `j1` has the effort 0 in the URDF file: its motor cannot move it"
    )
    assert place.startswith("j1 | add `efforts: {j1: 100}` to the arm, with the largest torque")
    assert project(tmp_path, arm.format(", efforts: {j1: 5}"), *joints) == []


def test_positions_of_a_joint_that_slides_are_in_metres(tmp_path: Path) -> None:
    joints = joint("j1", "base", "a", "prismatic"), *JOINTS[1:]
    arm = "{joints: [j1], tool: a, home: [0]}"
    assert project(tmp_path, arm, *joints, up="0.9") == []
    ((code, message, _, place),) = project(tmp_path, arm, *joints, up="900.0")
    assert code == "SM502"
    assert message == "joint 1 of `up` is 900.0 m, outside its limits -1 to 1"
    assert place.endswith("write `0.9`: positions of joints that slide are in metres")
    ((_, message, _, _),) = project(tmp_path, arm.replace("[0]", "[7]"), *joints)
    assert message.endswith("`j1` is 7 m, outside its limits -1 to 1")


MESH = '<link name="eye"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("eye.stl", None),
        ("package://my_arm/eye.stl", None),
        ("package://other/eye.stl", "the mesh file `package://other/eye.stl` was not found"),
        ("none.stl", "the mesh file `none.stl` was not found"),
        ("eye.step", "the simulation does not read mesh files such as `eye.step`"),
    ],
)
def test_meshes_of_a_simulated_robot(tmp_path: Path, name: str, message: str | None) -> None:
    folder = tmp_path / "my_arm"
    folder.mkdir()
    (folder / "eye.stl").touch()
    (folder / "eye.step").touch()
    links = "".join(f'<link name="{link}"/>' for link in ["base", "a"]) + MESH.format(name)
    joints = joint("j1", "base", "a"), joint("camera", "base", "eye", "fixed")
    robot = f'<robot name="r">{links}{"".join(joints)}</robot>'
    found = project(folder, "{joints: [j1], tool: a, home: [0]}", arm_urdf=robot)
    expected = f"the robot file `arm.urdf` has a mistake: {message}"
    assert [row[:3] for row in found] == (
        [("SM018", expected, "arm.urdf")] if message is not None else []
    )


def test_a_package_of_the_description(tmp_path: Path) -> None:
    (tmp_path / "vendor").mkdir()
    (tmp_path / "vendor" / "eye.stl").touch()
    links = '<link name="base"/><link name="a"/>' + MESH.format("package://eyes/eye.stl")
    joints = joint("j1", "base", "a"), joint("camera", "base", "eye", "fixed")
    robot = f'<robot name="r">{links}{"".join(joints)}</robot>'
    arm = "{joints: [j1], tool: a, home: [0]}"
    ((_, message, _, _),) = project(tmp_path, arm, arm_urdf=robot)
    assert "was not found" in message
    assert project(tmp_path, arm + "\npackages: {eyes: vendor}", arm_urdf=robot) == []


@pytest.mark.parametrize(
    ("path", "text", "message"),
    [
        ("box.urdf", '<robot name="b"><link name="b"/></robot>', None),
        ("box.urdf", '<robot name="b"></robot>', "the robot file `box.urdf` has a mistake: the robot has no link"),
        ("box.urdf", "no robot", "the robot file `box.urdf` has a mistake: the file is not valid XML: syntax error"),
        ("box.sdf", "<sdf><world/></sdf>", None),
        ("box.sdf", "<world/>", "the robot file `box.sdf` has a mistake: the outermost element is `<world>`, not `<sdf>`"),
        ("none.urdf", "", "the scene file `table.yml` has a mistake: the file `none.urdf` was not found"),
        ("cube_small.urdf", "", None),  # of PyBullet's data
    ],
)  # fmt: skip
def test_the_files_of_bodies(tmp_path: Path, path: str, text: str, message: str | None) -> None:
    if path.startswith("cube"):
        pytest.importorskip("pybullet_data")
    files = {"table_yml": f"bodies: {{box: {{path: {path}}}}}"} | ({path: text} if text else {})
    arm = "{joints: [j1], tool: a, home: [0]}"
    found = project(tmp_path, arm, scene="scene: table.yml\n", **files)
    assert [row[:2] for row in found] == ([("SM018", message)] if message is not None else [])
