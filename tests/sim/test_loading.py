"""Files that the physics engine cannot load: the reason, the file and the line reach the user."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from smachac import sim
from smachac.sim import loading, robot_file
from smachac.sim.inverse_kinematics import Kinematics
from smachac.sim.robot_file import EngineFile, LoadError
from tests.support.urdf_texts import joint, link, one_joint, robot

pytest.importorskip("pybullet")

OBJ = "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"
LIMB = sim.robots.Limb(name="arm", joints=("j",), tip="hand", home=(0.0,))


def with_mesh(folder: Path, name: str) -> Path:
    """The file of a robot whose base has the mesh `name`, in line 2."""
    visual = f'<visual><geometry><mesh filename="{name}"/></geometry></visual>'
    return robot(folder, link("base", visual), link("hand"), joint("j", "revolute", "base", "hand"))


def opened(path: Path) -> sim.World:
    return sim.World(robot=sim.robots.from_urdf(path, limbs=(LIMB,)))


# Meshes


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("mesh.obj", "arm/urdf/mesh.obj"),
        ("mesh.OBJ", "arm/urdf/mesh.OBJ"),
        ("../meshes/mesh.obj", "arm/meshes/mesh.obj"),
        ("meshes/mesh.obj", "arm/meshes/mesh.obj"),
        ("package://arm/meshes/mesh.obj", "arm/meshes/mesh.obj"),
        ("model://arm/meshes/mesh.obj", "arm/meshes/mesh.obj"),
        ("package://my_arm/meshes/mesh.obj", "arm/meshes/mesh.obj"),
        ("package://ros_1/mesh.obj", "one/ros_1/mesh.obj"),
        ("package://ros_2/mesh.obj", "two/share/ros_2/mesh.obj"),
        ("file://{folder}/elsewhere/mesh.obj", "elsewhere/mesh.obj"),
        ("{folder}/elsewhere/mesh.obj", "elsewhere/mesh.obj"),
        ("a & b <c>.obj", "arm/urdf/a & b <c>.obj"),
    ],
)
def test_a_mesh_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, place: str
) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "one"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path / 'none'}:{tmp_path / 'two'}")
    for path in (tmp_path / place, tmp_path / "arm" / "urdf" / "arm.urdf"):
        path.parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / place).write_text(OBJ)
    (tmp_path / "arm" / "package.xml").write_text("<package><name> my_arm </name></package>")
    written = name.format(folder=tmp_path).replace("&", "&amp;").replace("<", "&lt;")
    with opened(with_mesh(tmp_path / "arm" / "urdf", written)) as world:
        (body,) = world.kinematics
        assert [shape[1] for shape in world.engine.getVisualShapeData(body)] == [-1]


@pytest.mark.parametrize(
    "name",
    [
        "mesh.stl",
        "package://my_arm/meshes/base.stl",
        "package://my_arm",
        "http://a/b.stl",
        "/a.stl",
    ],
)
def test_a_mesh_that_is_not_found_is_named_with_its_line(tmp_path: Path, name: str) -> None:
    path = with_mesh(tmp_path, name)
    with pytest.raises(LoadError) as caught:
        opened(path)
    begin = f"the file `{path}`, line 2: the mesh file `{name}` was not found; "
    assert str(caught.value).startswith(begin)


def test_a_format_of_meshes_that_the_engine_does_not_read(tmp_path: Path) -> None:
    (tmp_path / "arm.glb").write_bytes(b"glTF")
    with pytest.raises(LoadError, match=r"line 2: .*`arm\.glb`.*\.obj, \.stl, \.dae"):
        opened(with_mesh(tmp_path, "arm.glb"))


def test_kinematics_need_no_meshes(tmp_path: Path) -> None:
    part = sim.robots.from_urdf(with_mesh(tmp_path, "no.stl"), limbs=(LIMB,)).parts[0]
    assert Kinematics(part).tip(LIMB, [0.5])[0] == pytest.approx((0.0, 0.0, 0.1))


# The text for the engine


def test_a_file_with_one_long_line_is_loaded(tmp_path: Path) -> None:
    path = robot(
        tmp_path,
        *(link(name) for name in ("base", "hand", "a" * 700, "b" * 900)),
        joint("j", "revolute", "base", "hand"),
        joint("k" * 900, "fixed", "hand", "a" * 700, ""),
        joint("l", "fixed", "hand", "b" * 900, ""),
    )
    path.write_text(path.read_text().replace("\n", " "))
    with opened(path) as world:
        assert world.engine.getNumJoints(world.arm().body) == 3


@pytest.mark.parametrize("name", ["", "my & robot", 'a "quoted" name', "Roböter"])
def test_names_are_printed_as_they_are(tmp_path: Path, name: str) -> None:
    path = with_mesh(tmp_path, "a.obj")
    (tmp_path / "a.obj").write_text(OBJ)
    escaped = name.replace("&", "&amp;").replace('"', "&quot;")
    path.write_text(path.read_text().replace('name="robot"', f'name="{escaped}"' if name else ""))
    with opened(path) as world:
        (body,) = world.kinematics
        assert world.engine.getBodyInfo(body)[1].decode() == (name or "robot")


@pytest.mark.parametrize(("frames", "loads"), [(10, True), (200, True)])
def test_empty_links_beyond_the_limit_of_the_engine_are_left_out(
    tmp_path: Path, frames: int, loads: bool
) -> None:
    empty = [f'<link name="frame_{k}"/>' for k in range(frames)]
    welds = [joint(f"weld_{k}", "fixed", "hand", f"frame_{k}", "") for k in range(frames)]
    path = robot(
        tmp_path, link("base"), link("hand"), joint("j", "revolute", "base", "hand"), *empty, *welds
    )
    last = f"frame_{frames - 1}"
    limb = sim.robots.Limb(name="arm", joints=("j",), tip=last, home=(0.0,))
    with sim.World(robot=sim.robots.from_urdf(path, limbs=(limb,))) as world:
        assert world.arm().move_to_joints([0.5]).outcome == "succeeded"
        assert world.arm().tip_pose()[0] == pytest.approx([0.0, 0.0, 0.2], abs=1e-3)


def test_a_robot_with_too_many_links_is_refused(tmp_path: Path) -> None:
    links = [link(f"part_{k}") for k in range(130)]
    welds = [joint(f"weld_{k}", "fixed", "hand", f"part_{k}", "") for k in range(130)]
    path = robot(
        tmp_path, link("base"), link("hand"), joint("j", "revolute", "base", "hand"), *links, *welds
    )
    with pytest.raises(LoadError, match="line 1: the robot has 132 links, more than the 128 "):
        opened(path)


# Bodies of a scene


def scene(folder: Path, name: str) -> Path:
    path = folder / "scene.yml"
    path.write_text(f"bodies:\n  thing: {{path: '{folder / name}', pose: [0.5, 0, 0]}}\n")
    return path


@pytest.mark.parametrize(
    ("name", "text", "reason"),
    [
        ("a.urdf", "<robot", "line 1: "),
        ("a.urdf", '<robot name="r">\n<link/>\n</robot>', "line 2: this link has no name"),
        ("a.sdf", "no SDF", "cannot be loaded: Error=XML_ERROR_PARSING_TEXT"),
        ("a.sdf", "", "cannot be loaded: PyBullet prints no reason"),
        ("a.sdf", "<sdf/>", "cannot be loaded: expected a world element, continuing without it."),
    ],
)
def test_a_body_that_cannot_be_loaded(tmp_path: Path, name: str, text: str, reason: str) -> None:
    path = tmp_path / name
    path.write_text(text)
    with sim.World() as world:
        result = world.load("thing", [0.5, 0, 0], path=path)
        assert result.outcome == "aborted"
        assert f"`{path}`" in result.reason
        assert reason in result.reason
        assert world.bodies == {}
    with pytest.raises((LoadError, ValueError)) as caught:
        sim.World(scene=scene(tmp_path, name))
    assert reason in str(caught.value)


def test_a_body_of_a_urdf_file_with_joints(tmp_path: Path) -> None:
    path = robot(tmp_path, link("box"), link("lid"), joint("hinge", "continuous", "box", "lid", ""))
    with sim.World() as world:
        result = world.load("box", [[0.5, 0.2, 0.3], [0, 0, 0.6, 0.8]], path=path)
        assert (result.outcome, result.reason) == ("succeeded", "")
        assert world.error("box", [0.5, 0.2, 0.3]) < 1e-9


# The trial in a child process


def test_each_file_is_tried_once_in_a_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[Any] = []
    start = subprocess.Popen

    def counted(*arguments: Any, **options: Any) -> Any:
        started.append(arguments)
        return start(*arguments, **options)

    monkeypatch.setattr(subprocess, "Popen", counted)
    monkeypatch.setattr(loading, "_tried", set())
    made = one_joint(tmp_path, "revolute")
    for _ in range(3):
        sim.World(robot=made).close()
    assert len(started) == 1
    sim.World(robot="iiwa").close()
    assert len(started) == 1
    (tmp_path / "a.obj").write_text(OBJ)
    for text in (OBJ, OBJ + "# more\n"):  # another mesh is another file
        (tmp_path / "a.obj").write_text(text)
        opened(with_mesh(tmp_path, "a.obj")).close()
    assert len(started) == 3


def ending(folder: Path, code: str, monkeypatch: pytest.MonkeyPatch) -> EngineFile:
    """A file whose child process runs `code` in place of the trial."""
    script = folder / "trial.py"
    script.write_text(
        "import json, os, pathlib, signal, sys\n"
        "task = json.loads(sys.argv[1])\n"
        "pathlib.Path(task['progress']).write_text('0')\n"
        f"{code}\n"
    )
    monkeypatch.setattr(loading, "__file__", str(folder / "loading.py"))
    path = folder / "arm.urdf"
    path.write_text("<robot/>")
    return EngineFile(path=path, text="<robot>\n</robot>\n", lines=(1, 7))


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no signals")
@pytest.mark.parametrize("signal", ["SIGSEGV", "SIGABRT", "SIGKILL"])
def test_a_child_that_ends_with_a_signal(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, signal: str
) -> None:
    code = f"os.kill(os.getpid(), signal.{signal})"
    file = ending(tmp_path, code, monkeypatch)
    with pytest.raises(LoadError) as caught, loading.tried([file]):
        pass
    reason = f"cannot be loaded: PyBullet ended with the signal {signal}"
    assert str(caught.value) == f"the file `{file.path}` {reason}"


def test_a_child_that_ends_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = (
        "print('b3Error[a/b.cpp,12]:'); print(task['files'][0] + ':2: no', flush=True); os._exit(3)"
    )
    file = ending(tmp_path, code, monkeypatch)
    with pytest.raises(LoadError) as caught, loading.tried([file]):
        pass
    reason = f"cannot be loaded: {file.path}:7: no; PyBullet ended with the exit code 3"
    assert str(caught.value) == f"the file `{file.path}` {reason}"


def test_a_child_that_does_not_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(loading, "_LONGEST_TRIAL", 0.5)
    file = ending(tmp_path, "print('stuck', flush=True); signal.pause()", monkeypatch)
    file.path.write_text("x")
    with pytest.raises(LoadError, match="did not end within"), loading.tried([file]):
        pass


def test_a_mesh_on_which_the_engine_ends_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    good, bad = tmp_path / "good.obj", tmp_path / "bad.obj"
    for path in (good, bad):
        path.write_text(OBJ)
    code = (
        "for number, name in enumerate(task['files']):\n"
        "    pathlib.Path(task['progress']).write_text(str(number))\n"
        "    if 'bad.obj' in pathlib.Path(name).read_text(): os._exit(3)\n"
        "pathlib.Path(task['progress']).write_text(str(len(task['files'])))"
    )
    file = ending(tmp_path, code, monkeypatch)
    text = f"<robot>\n{good}\n{bad}\n</robot>\n"
    file = EngineFile(path=file.path, text=text, meshes=(good, bad))
    with pytest.raises(LoadError) as caught:
        loading.try_out([file])
    reason = "cannot be loaded: PyBullet ended with the exit code 3"
    assert str(caught.value) == f"the file `{bad}` {reason}"


def test_a_child_that_cannot_start_refuses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = ending(tmp_path, "", monkeypatch)
    (tmp_path / "trial.py").write_text("import no_such_module")
    ran = False
    with loading.tried([file]):
        ran = True
    assert ran


def test_an_error_inside_ends_the_child(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = ending(tmp_path, "signal.pause()", monkeypatch)
    with pytest.raises(ZeroDivisionError), loading.tried([file]):
        raise ZeroDivisionError


def test_the_lines_of_the_engine_become_those_of_the_file(tmp_path: Path) -> None:
    file = EngineFile(path=Path("arm.urdf"), text="", lines=(4, 9, 9))
    output = (
        "b3Warning[x.cpp,3]:\nNo inertial data for link\n"
        "temporary/0.urdf:2: bad\nLine number=3: x\n"
    )
    error = robot_file.explained(file, output, "temporary/0.urdf")
    reason = "arm.urdf:9: bad; Line number=9: x"
    assert str(error) == f"the file `arm.urdf` cannot be loaded: {reason}"
