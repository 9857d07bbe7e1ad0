"""The header of a robot: its constants are those that the simulation reads from the description."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands import cli
from smachac.sim import robots
from smachac.sim.robots import MountedLimb
from tests.cpp.compilers import BARE, COMPILERS, STRICT, Compiler, last_with

pytest.importorskip("pybullet")

SCRIPT = """
name: sm
template: Base
robot: {robot}
outcomes: [done]
states:
  - WAIT: {{template: SleepState, time: 1.0, transitions: {{succeeded: done, preempted: done}}}}
"""
URDF = """
<robot name="arm"><link name="base"/><link name="lift"/><link name="elbow"/><link name="hand"/>
<link name="pad"/><joint name="up" type="prismatic"><parent link="base"/><child link="lift"/>
<axis xyz="0 0 1"/><limit upper="0.6" effort="9" velocity="0.25"/></joint>
<joint name="turn &quot;a&quot;" type="continuous"><parent link="lift"/><child link="elbow"/>
<axis xyz="0 0 1"/></joint>
<joint name="b" type="revolute"><parent link="elbow"/><child link="hand"/><axis xyz="0 1 0"/>
<limit lower="-1.25" upper="0.1" effort="1" velocity="0.3"/></joint>
<joint name="f" type="prismatic"><parent link="hand"/><child link="pad"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04" effort="1" velocity="1"/></joint></robot>
"""
OWN = """
name: größe 2
urdf: own.urdf
base: [[0.1, -0.2, 0.3], [0.0, 0.0, 1.0, 0.0]]
arms:
  {first}:
    joints: [up, 'turn "a"', b]
    tool: {{link: hand, offset: [[0.0, 0.01, 0.155], [0.0, 0.6, 0.0, 0.8]]}}
    home: [0.2, 3.0, -1]
    grasp: [[0.0, 0.0, 0.02], [0.0, 1.0, 0.0, 0.0]]
    gripper: {{joints: {{f: {{open: 0.04, closed: 0.01}}}}, width: {{open: 0.085, closed: 0.002}}}}
  {second}: {{joints: [up], tool: lift, home: [0.05]}}
"""
STATION = """
name: cell
base: [[0.0, 0.0, 0.4], [0.0, 0.0, 0.7071067811865476, 0.7071067811865476]]
parts:
  near: {robot: iiwa, base: [[0.5, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]}
  far: {robot: own.yml}
"""

PRINTED = """
#include "robots/{file}.hpp"
static void print(const char *text) {{ std::printf("%s\\n", text); }}
static void print(double number) {{ std::printf("%.17g\\n", number); }}
static void print(const smachac::Pose &pose) {{
  const smachac::Point &p = pose.position;
  const smachac::Quaternion &q = pose.orientation;
  for (const double number : {{p.x, p.y, p.z, q.x, q.y, q.z, q.w}}) {{
    print(number);
  }}
}}
int main() {{
  print(robots::{scope}::base);
  for (const smachac::ArmDescription &arm : robots::{scope}::arms) {{
    print(arm.name);
    print(arm.link);
    print(arm.tool);
    print(arm.grasp);
    print(arm.base);
    for (const smachac::JointDescription &joint : arm.joints) {{
      print(joint.name);
      for (const double number : {{joint.lower, joint.upper, joint.speed, joint.home}}) {{
        print(number);
      }}
      print(joint.turns ? "rad" : "m");
    }}
    if (arm.gripper.has_value()) {{
      print(arm.gripper->open);
      print(arm.gripper->closed);
      for (const smachac::FingerDescription &finger : arm.gripper->fingers) {{
        print(finger.name);
        print(finger.open);
        print(finger.closed);
      }}
    }}
  }}
}}
"""


def project(folder: Path, robot: str, first: str = "left arm", second: str = "base") -> Path:
    """A script for a robot, with the descriptions above beside it."""
    texts = {
        "main.yml": SCRIPT.format(robot=robot),
        "own.yml": OWN.format(first=first, second=second),
        "own.urdf": URDF,
        "cell.yml": STATION,
    }
    for name, text in texts.items():
        (folder / name).write_text(text, "utf-8")
    return folder / "main.yml"


def build(script: Path, *options: str) -> int:
    call = ["build", str(script), "--target", "cpp", "-o", str(script.parent / "out")]
    return cli.main([*call, *(word for option in options for word in ("--option", option))])


def simulated(robot: robots.Robot) -> tuple[MountedLimb, ...]:
    """The limbs as the simulation has them after it has loaded the URDF files."""
    from smachac import sim

    with sim.World(robot=robot) as world:
        return tuple(world.limbs)


def listed(robot: robots.Robot) -> list[str | float]:
    """What PRINTED prints, from the simulation."""
    found: list[str | float] = [*robot.base[0], *robot.base[1]]
    for mounted in simulated(robot):
        limb = mounted.limb
        found += [limb.name, limb.tip]
        for pose in (limb.offset, limb.grasp, mounted.base):
            found += [*pose[0], *pose[1]]
        for joint, home in zip(mounted.facts, limb.home, strict=True):
            found += [joint.name, joint.lower, joint.upper, joint.velocity, home, joint.unit]
        if (gripper := limb.gripper) is not None:
            found += [gripper.width[1], gripper.width[0]]
            for finger in gripper.fingers:
                found += [finger.joint, finger.opened, finger.closed]
    return found


@COMPILERS
@pytest.mark.parametrize(
    ("name", "file"),
    [
        pytest.param("panda", "panda", marks=pytest.mark.slow),
        ("baxter", "baxter"),
        pytest.param("iiwa", "iiwa", marks=pytest.mark.slow),
        ("own.yml", "grosse_2"),
        ("cell.yml", "cell"),
    ],
)
@pytest.mark.slow
def test_the_constants_are_those_of_the_simulation(
    name: str, file: str, compiler: Compiler, tmp_path: Path
) -> None:
    assert build(project(tmp_path, name)) == 0
    text = PRINTED.format(file=file, scope=file)
    printed = compiler.run(text, tmp_path, *STRICT, f"-I{tmp_path / 'out'}").splitlines()
    wanted = listed(robots.load(name, folders=[tmp_path]))
    assert len(printed) == len(wanted)
    for line, value in zip(printed, wanted, strict=True):
        if isinstance(value, str):
            assert line == value
        else:
            assert float(line) == pytest.approx(value, abs=1e-9)


USED = """
#include "robots/grosse_2.hpp"
#include "robots/grosse_2.hpp"
namespace robot = robots::grosse_2;
static_assert(robot::left_arm.joints.size() == 3 && robot::left_arm.gripper->open == 0.085);
static_assert(!robot::base_.gripper.has_value() && robot::base_.joints[0].upper == 0.6);
static_assert(!robot::base_.joints[0].turns && robot::left_arm.joints[1].turns);
static_assert(robot::base.position.z == 0.3);
static_assert(smachac::within_limits(robot::left_arm, std::array<double, 3>{{0.6, -700.0, 0.1}}));
static_assert(!smachac::within_limits(robot::left_arm, std::array<double, 3>{{0.0, 0.0, 0.11}}));
static_assert(!smachac::within_limits(robot::left_arm, std::array<double, 1>{{0.0}}));
static bool is_way(std::size_t joint, double from, double to, double way) {
  return std::fabs(smachac::joint_way(robot::left_arm.joints[joint], from, to) - way) < 1e-9;
}
int main() {
  const std::vector<double> wrong{0.0, 0.0, std::numeric_limits<double>::quiet_NaN()};
  const bool good = smachac::find_arm(robot::arms, std::string("left arm")) == &robot::arms[0] &&
                    smachac::find_arm(robot::arms, std::string("arm")) == nullptr &&
                    smachac::find_arm(robot::arms, std::nullopt) == nullptr &&
                    !smachac::within_limits(robot::left_arm, wrong) &&
                    is_way(0, 0.1, 7.1, 7.0) && is_way(2, 3.1, -3.1, -6.2) &&
                    is_way(1, 3.1, -3.1, 0.08318530717958605) &&
                    is_way(1, 0.0, -13.0, -0.43362938564082735);
  return good ? 0 : 1;
}
"""


@pytest.mark.slow
def test_arms_are_found_and_limits_checked(tmp_path: Path) -> None:
    assert build(project(tmp_path, "own.yml")) == 0
    last_with(*BARE).run(USED, tmp_path, *STRICT, *BARE, f"-I{tmp_path / 'out'}")


def test_a_machine_without_described_arms_has_no_header_of_a_robot(tmp_path: Path) -> None:
    assert build(project(tmp_path, "own.urdf")) == 0
    assert not (tmp_path / "out" / "robots").exists()
    assert not (tmp_path / "out" / "smachac" / "arm.hpp").exists()


@pytest.mark.parametrize(
    ("first", "second", "name"),
    [("left arm", "left-arm", "left_arm"), ("a", "a_joints", "a_joints")],
)
def test_arms_with_one_name_in_cpp_are_refused(
    first: str, second: str, name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(project(tmp_path, "own.yml", first, second)) == 1
    told = capsys.readouterr().err
    message = f"the arms `{first}` and `{second}` of `größe 2` would both have the name `{name}`"
    assert f"SM601]: not supported in C++: {message}" in told
    assert "main.yml:4:8" in told


@pytest.mark.parametrize(
    ("option", "file", "code"),
    [
        ("package=cell", "include/cell/robots/baxter.hpp", "install(DIRECTORY include/"),
        ("cmake=true", "robots/baxter.hpp", "install(DIRECTORY smachac robots DESTINATION"),
    ],
)
def test_packages_have_the_header(option: str, file: str, code: str, tmp_path: Path) -> None:
    assert build(project(tmp_path, "baxter"), option) == 0
    assert (tmp_path / "out" / file).exists()
    assert code in (tmp_path / "out" / "CMakeLists.txt").read_text()
