from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

import pytest

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Diagnostic
from smachac.frontend.robots.robots import built_in_robot, default_robot
from smachac.ir.parser import parse_machine
from smachac.robots.files import BUILT_IN
from tests.support.typed_machines import BUILT_IN as LIBRARY
from tests.support.typed_machines import with_state_types


def found(text: str) -> list[Diagnostic]:
    """What the rules over types find in a machine; `; ` ends a line."""
    machine = with_state_types(parse_machine(text.replace("; ", "\n"), "main.smir"))
    robot = default_robot(machine.state_types[machine.base], LIBRARY)
    for variable in machine.variables:
        if variable.name == "robot":
            robot = built_in_robot(str(variable.value.data), LIBRARY)
    report = check_machine(replace(machine, robot=robot))
    codes = ("SM304", "SM501", "SM502", "SM503", "SM504")
    return [item for item in report if item.code in codes]


def codes(text: str) -> list[str]:
    return [item.code for item in found(text)]


MOVE = """
variable robot = "{robot}"
machine sm: StateMachine {{
  outcomes done
  userdata home = {joints}
  initial MOVE
  state MOVE: Move {{
    outcomes ok
    input positions: {type}
    claims {claim}
    remap positions -> home
    on ok -> done
  }}
}}"""

HOME = "[0, -0.8, 0, -2.4, 0, 1.6, 0.8]"
BENT = "[0, -0.8, 0, 2.4, 0, 1.6, 0.8]"


def move(
    joints: str, robot: str = "panda", type: str = "list[float<rad>]", claim: str = "arm"
) -> list[str]:
    return codes(MOVE.format(joints=joints, robot=robot, type=type, claim=claim))


@pytest.mark.parametrize(
    ("machine", "expected"),
    [
        (move(HOME), []),
        (move(BENT), ["SM502"]),
        (move(BENT, claim='"arm.left"'), ["SM502"]),
        (move(BENT, type="float<rad>[7]?"), ["SM502"]),
        (move("[9, -9, 0, -2.4, 0, 1.6, 0.8]"), ["SM502"]),
        (move("[3.0542, 0, 0, 0, 0, 0, 0]", robot="baxter"), ["SM502"]),
        (move("[0, 0, 3.0542, 0, 0, 0, 0]", robot="baxter"), []),
        # Of another robot, of what is no angle, or of what moves no arm, nothing is known.
        (move(BENT, robot="my_arm.urdf"), []),
        (move(BENT, type="list[float]"), []),
        (move(BENT, claim="head"), []),
        # How many joints a state takes that is not ours only its type says.
        (move("[9.0]"), []),
        (move("[9.0]", type="float<rad>[7]"), ["SM501"]),
        (move("[`f()`, 0, 0, -2, 0, 1, 0]"), []),
    ],
)
def test_joint_positions(machine: list[str], expected: list[str]) -> None:
    assert machine == expected


def test_the_arm_that_a_base_has_by_itself() -> None:
    text = MOVE.format(joints="[9.0]", robot="", type="list[float<rad>]", claim="arm")
    text = text.replace('variable robot = ""', "base PyBulletBase")
    assert codes(text) == []
    assert codes(text.replace("Move {", "MoveToJointPositionsState {")) == ["SM501"]


def test_limits_are_those_of_the_simulated_arm() -> None:
    data = pytest.importorskip("pybullet_data")
    from pathlib import Path

    robot = ElementTree.parse(Path(data.getDataPath()) / "franka_panda" / "panda.urdf")
    limits = {joint.get("name"): joint.find("limit") for joint in robot.iter("joint")}
    panda = built_in_robot("panda", LIBRARY)
    assert panda is not None
    for joint in panda.joints:
        limit = limits[joint.name]
        assert limit is not None
        given = float(limit.get("lower", "")), float(limit.get("upper", ""))
        assert given == (joint.lower, joint.upper)
    links = {link.get("name") for link in robot.iter("link")}
    assert links == panda.frames
    robots = [built_in_robot(name, LIBRARY) for name in BUILT_IN]
    assert {len(limb) for item in robots if item is not None for limb in item.limbs} == {7}
    assert None not in robots


READ = """
machine sm: StateMachine {{
  outcomes done
  userdata x = {value}
  initial A
  state A: Any {{ outcomes ok; input x: {type}; on ok -> done; }}
}}"""


@pytest.mark.parametrize(
    ("value", "type", "expected"),
    [
        ("[[0, 0, 0], [0, 0, 0, 1]]", "Pose", []),
        ("[[0, 0, 0], [0, 0, 0.7071, 0.7071]]", "Pose", []),
        ("[[0, 0, 0], [0, 0, 0.7, 0.7]]", "Pose", ["SM503"]),
        ("[[0, 0, 0], [0, 0, 0, 0]]", "Pose?", ["SM503"]),
        ("[0, 0, 0, 2]", "Quaternion", ["SM503"]),
        ("[[[0, 0, 0], [0, 0, 0, 1]], [[0, 0, 0], [1, 0, 0, 1]]]", "list[Pose]", ["SM503"]),
        ("{a: [[0, 0, 0], [1, 0, 0, 1]]}", "dict[str, Transform]", ["SM503"]),
        ("[[0, 0, 0], [1, 0, 0, 1]]", "any", []),
        ("[[0, 0, 0], [1, 0, 0, `x()`]]", "Pose", []),
        ("[0, 0, 0]", "Pose", []),
        ("[0, 0, 0, 1]", "float[4]", []),
        ("[0, 0, 0, inf]", "Quaternion", ["SM503"]),
        ("[0, 0, 0, 1" + "0" * 400 + "]", "Quaternion", ["SM503"]),
        ("[0, 0, 0]", "Quaternion", ["SM501"]),
        ("[[0, 0], [0, 0, 0, 1]]", "Pose", ["SM501"]),
        ('[0, 0, "z"]', "Point", ["SM304"]),
    ],
)
def test_literals_that_reach_a_type(value: str, type: str, expected: list[str]) -> None:
    assert codes(READ.format(value=value, type=type)) == expected


def test_the_writer_the_remaps_and_the_reader_are_shown() -> None:
    (item,) = found(
        """machine sm: StateMachine {
          outcomes done
          initial A
          state A: Any { outcomes ok; output made: str; remap made -> k; on ok -> B; }
          machine B: StateMachine {
            outcomes ok
            input inner
            remap inner -> k
            initial C
            state C: Any { outcomes ok; input read: Pose; remap read -> inner; on ok -> ok; }
            on ok -> done
          }
        }"""
    )
    assert item.finding.message == "`C` reads `read` as `Pose`, but `A` writes `made` as `str`"
    assert item.finding.span.text == "read"
    shown = [f"{place.span.text}: {place.message}" for place in item.finding.related]
    assert shown == [
        "made: `A` writes `made` as `str`",
        "read: `read` of `C` is remapped to `inner` of `B`",
        "inner: `inner` of `B` is remapped to `k` of `sm`",
        "made: `made` of `A` is remapped to `k` of `sm`",
    ]
    assert item.finding.node == "sm/B/C"


def test_deep_nesting_is_no_matter() -> None:
    depth = 1_000
    lines = ["machine M0: StateMachine {", "outcomes ok", "userdata k0 = 5", "initial M1"]
    for level in range(1, depth):
        inner = f"M{level + 1}" if level + 1 < depth else "LEAF"
        lines += [f"machine M{level}: StateMachine {{", "outcomes ok", f"initial {inner}"]
        lines += [f"input k{level}", f"remap k{level} -> k{level - 1}", "on ok -> ok"]
    lines += ["state LEAF: Any {", "outcomes ok", "input x: str", f"remap x -> k{depth - 1}"]
    assert codes("\n".join([*lines, "on ok -> ok", "}" * (depth + 1)])) == ["SM304"]


def test_many_writers_and_readers_that_clash_take_no_longer_than_they_should() -> None:
    """Were every pair looked at, this would take minutes."""
    lines = ["machine sm: StateMachine {", "outcomes done", "initial S0"]
    count = 1_000
    for number in range(count):
        after = f"S{number + 1}" if number + 1 < count else "done"
        lines += [f"state S{number}: Any {{", "outcomes ok", f"on ok -> {after}"]
        lines += ["input x: str", "output x: float", "}"]
    assert set(codes("\n".join([*lines, "}"]))) == {"SM304"}


def test_an_input_of_the_machine_is_what_its_caller_provides() -> None:
    (item,) = found("""
machine sm: StateMachine {
  outcomes done
  input part: Pose
  initial SAY
  state SAY: Say {
    outcomes ok
    input part: str
    on ok -> done
  }
}
""")
    first, _, second = item.message.partition(", but ")
    assert first == "`SAY` reads `part` as `str`"
    assert second == "the caller of `sm` provides `part` as `Pose`"
    assert item.help == "change the type in the `input_keys` of `sm`, or where it is read"
