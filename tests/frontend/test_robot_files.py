"""Robots and scenes that a script names in files: what is known, and mistakes with their place."""

from __future__ import annotations

from pathlib import Path

import pytest

import smachac
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.frontend.loader import memory_library
from smachac.targets.python import TARGET
from tests.support.typed_machines import BUILT_IN

SCRIPT = """
name: sm
template: PyBulletBase
robot: arm.yml
{scene}outcomes: [done, failed]
userdata: {{up: [0.0, {angle}], goal: [[0.5, 0, 0.1], [1, 0, 0, 0]], frame: {frame}}}
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {{positions: up}}
      transitions: {{succeeded: LOAD, aborted: failed, preempted: failed}}
  - LOAD:
      template: LoadModelState
      model_name: block
      remapping: {{pose: goal, reference_frame: frame}}
      transitions: {{succeeded: done, aborted: failed}}
"""
ARM = """
name: arm
urdf: arm.urdf
arms:
  left: {joints: [a, b], tool: hand, home: [0.0, 0.5]}
"""
URDF = """
<robot name="arm"><link name="base"/><link name="elbow"/><link name="hand"/>
<joint name="a" type="revolute"><parent link="base"/><child link="elbow"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="b" type="revolute"><parent link="elbow"/><child link="hand"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>
"""
SCENE = "bodies: {{tray: {{size: [0.2, 0.2, {height}]}}}}"


def project(folder: Path, *, angle: str = "0.5", frame: str = "base", **texts: str) -> Path:
    files = {"arm.yml": ARM, "arm.urdf": URDF, "table.yml": SCENE.format(height="0.1")}
    files |= {name.replace("_", "."): text for name, text in texts.items()}
    scene = "scene: table.yml\n"
    files["main.yml"] = SCRIPT.format(angle=angle, frame=frame, scene=scene)
    for name, text in files.items():
        (folder / name).write_text(text)
    return folder / "main.yml"


def messages(path: Path) -> list[str]:
    return [f"{item.code} {item.finding.message}" for item in smachac.check(path)]


def test_a_description_is_complete(tmp_path: Path) -> None:
    assert messages(project(tmp_path)) == []
    assert messages(project(tmp_path, frame="tray")) == []


def test_the_checks_use_the_description(tmp_path: Path) -> None:
    (limit,) = messages(project(tmp_path, angle="1.5"))
    assert limit.startswith("SM502 joint 2 of `up` is 1.5 rad, outside its limits -1 to 1")
    (frame,) = messages(project(tmp_path, frame="trai"))
    assert frame.startswith("SM505 the simulation has no frame `trai`")


@pytest.mark.parametrize(
    ("file", "old", "new", "message", "place"),
    [
        ("arm.yml", "[a, b]", "[a, c]", "robot: the URDF file has no joint `c`", (5, 22)),
        ("arm.yml", "0.5]", "57]", "robot: `b` is 57 rad, outside its limits -1 to 1", (5, 50)),
        ("arm.yml", "hand", "hnad", "robot: the URDF file has no link `hnad`", (5, 32)),
        ("arm.yml", "arm.urdf", "no.urdf", "robot: the file `no.urdf` was not found", (3, 7)),
        ("arm.yml", "home", "hom", "robot: the key `hom` is unknown", (5, 38)),
        (
            "table.yml",
            "0.1]",
            "100]",
            "scene: 100 m is more than 20 m, the largest length here",
            (1, 34),
        ),
    ],
)
def test_a_mistake_is_a_diagnostic_with_its_place(
    tmp_path: Path, file: str, old: str, new: str, message: str, place: tuple[int, int]
) -> None:
    texts = {"arm.yml": ARM, "table.yml": SCENE.format(height="0.1")}
    assert old in texts[file]
    path = project(tmp_path, **{file.replace(".", "_"): texts[file].replace(old, new, 1)})
    (found,) = [item for item in smachac.check(path) if item.code == "SM018"]
    assert found.finding.message == in_file(file, message)
    span = found.finding.span
    assert Path(span.source.name).name == file
    assert (span.line, span.column) == place
    (named,) = found.finding.related
    assert (Path(named.span.source.name).name, named.span.text) == ("main.yml", file)


@pytest.mark.parametrize(
    ("arm", "help"),
    [
        (
            ARM.replace("[a, b]", "[a]"),
            "`b` also moves the tool link `hand`: write `joints: [a, b]`, or remove its angle",
        ),
        (
            ARM.replace("[a, b]", "[a]").replace("tool: hand", "tool: elbow"),
            "write 1, one for each of the `joints`: `a`",
        ),
        (ARM.replace("[0.0, 0.5]", "[0.0]"), "add the items of `b`: one for each of the `joints`"),
        (
            ARM.replace("[a, b]", "[a]").replace("arm.urdf", "no.urdf"),
            "write 1, one for each of the `joints`: `a`",
        ),
        (
            ARM.replace("[a, b]", "[a]").replace("urdf: arm.urdf", ""),
            "add `urdf: ...` (the URDF or xacro file: beside this file, or in PyBullet's data)",
        ),
    ],
)
def test_the_joint_that_an_arm_lacks(tmp_path: Path, arm: str, help: str) -> None:
    (found,) = [i for i in smachac.check(project(tmp_path, arm_yml=arm)) if i.code == "SM018"]
    assert found.help == help


def test_a_urdf_file_alone_cannot_be_simulated(tmp_path: Path) -> None:
    path = project(tmp_path)
    path.write_text(path.read_text().replace("robot: arm.yml", "robot: arm.urdf"))
    assert messages(path) == []
    report: list[Diagnostic] = []
    library = disk_library(path, report)
    source = read_source(path, report)
    assert source is not None
    checked = analyse(source, library, report).checked
    assert checked is not None
    assert build(checked, TARGET, library, report) == {}
    assert [item.code for item in report] == ["SM601"]
    assert report[0].finding.help == (
        "describe its arms in a YAML file, and name that file: `robot: arm.yml`"
    )


@pytest.mark.parametrize(
    ("file", "text", "message", "place"),
    [
        ("arm.yml", "", "robot: the file is empty", ("arm.yml", 1, 1)),
        ("table.yml", "# nothing", "scene: the file is empty", ("table.yml", 1, 1)),
        (
            "arm.yml",
            "name: x\nparts: {a: {robot: arm.yml}}",
            "robot: a part has no parts of its own",
            ("arm.yml", 2, 1),
        ),
        (
            "arm.yml",
            "name: x\nparts: {a: {robot: baxter}, a_left: {robot: panda}}",
            "robot: there are two arms `a_left`",
            ("arm.yml", 2, 45),
        ),
        (
            "arm.yml",
            "name: x\nparts: {tray: {robot: panda}, b: {robot: iiwa}}",
            "scene: `tray` is the name of a robot",
            ("table.yml", 1, 10),
        ),
    ],
)
def test_a_mistake_between_files(
    tmp_path: Path, file: str, text: str, message: str, place: tuple[str, int, int]
) -> None:
    path = project(tmp_path, **{file.replace(".", "_"): text})
    found = [item.finding for item in smachac.check(path) if item.code == "SM018"]
    assert [one.message.partition(" has a mistake: ")[2] for one in found] == [
        message.partition(": ")[2]
    ]
    span = found[0].span
    assert (Path(span.source.name).name, span.line, span.column) == place


STATION = "{name: two, parts: {near: {robot: panda}, far: {robot: arm.yml}}}"


def test_several_robots() -> None:
    files = {"arm.yml": ARM, "arm.urdf": URDF, "two.yml": STATION}
    text = SCRIPT.format(angle="0.5", frame="near", scene="").replace("arm.yml", "two.yml")
    text = text.replace("JointPositionsState", "JointPositionsState\n      limb: far")
    found = analyse(Source("main.yml", text), memory_library(files, BUILT_IN), [])
    assert [item.code for item in found.report] == []
    assert found.machine is not None
    robot = found.machine.robot
    assert robot is not None
    assert robot.limb_names == ("near", "far")
    assert [len(limb) for limb in robot.limbs] == [7, 2]
    assert robot.description == "two.yml"


@pytest.mark.parametrize(
    ("before", "after", "help", "effect"),
    [
        ("robot: arm.yml", "robot: amr.yml", "did you mean `arm.yml`?", "the robot is not known"),
        (
            "scene: table.yml",
            "scene: tabel.yml",
            "did you mean `table.yml`?",
            "the bodies are not known",
        ),
    ],
)
def test_a_file_with_nearly_the_name(
    tmp_path: Path, before: str, after: str, help: str, effect: str
) -> None:
    path = project(tmp_path)
    path.write_text(path.read_text().replace(before, after))
    (item,) = [item for item in smachac.check(path) if item.code == "SM018"]
    assert item.help is not None
    assert item.help.startswith(help)
    assert (item.finding.effect or item.kind.effect).startswith(effect)


def in_file(name: str, fault: str) -> str:
    """The message on a fault with its kind of file, such as `scene: there is no frame`."""
    what, _, message = fault.partition(": ")
    return f"the {what} file `{name}` has a mistake: {message}"
