"""Values against types, limits and names of interfaces: the fault at its token, with its help; and
unusual values that are correct."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.ir.robot import MODELS
from smachac.sim import models
from tests.trust.project_text import analysed

FAULTS = ("SM003", "SM004", "SM005", "SM304", "SM501", "SM505", "SM520", "SM521", "SM522")


def findings(files: dict[str, str]) -> list[Diagnostic]:
    report = analysed(files).report
    return [item for item in report if item.severity is not Severity.INFO]


def seen(files: dict[str, str]) -> list[tuple[str, str]]:
    """The codes of FAULTS that are found, each with the text that it marks."""
    return [(item.code, item.span.text) for item in findings(files) if item.code in FAULTS]


SIMULATED = """
name: sm
template: PyBulletBase
outcomes: [done, failed]
params: {{slow: -0.5, none: 0}}
userdata: {{home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785], place: {place}, way: 0.5}}
states:
  - LOAD: {{template: LoadModelState, {load}, remapping: {{pose: place}},
      transitions: {{succeeded: MOVE, aborted: failed}}}}
  - MOVE: {{template: MoveToJointPositionsState, {move}, remapping: {{positions: home}},
      transitions: {{succeeded: ALONG, aborted: failed, preempted: failed}}}}
  - ALONG: {{template: MoveAlongState, {along}, remapping: {{pose: place}},
      transitions: {{succeeded: HELD, aborted: failed, preempted: failed}}}}
  - HELD: {{template: CheckGraspState, {held}, transitions: {{succeeded: WAIT, aborted: failed}}}}
  - WAIT: {{template: SleepState, time: {time}, transitions: {{succeeded: done}}}}
"""


def simulated(**given: str) -> list[tuple[str, str]]:
    """What is found in a program for the simulated arm with some of its values."""
    values = {
        "place": "[0.5, 0.0, 0.02]",
        "load": "model_name: block",
        "move": "speed: 0.5",
        "along": "grasp: true",
        "held": "body: block",
        "time": "1",
    }
    return seen({"main.yml": SIMULATED.format(**(values | given))})


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"time": "5s"}, ("SM304", "5s")),
        ({"time": "1:30"}, ("SM304", "1:30")),
        ({"time": "0.5 s"}, ("SM304", "0.5 s")),
        ({"time": "-5"}, ("SM520", "-5")),
        ({"time": "[1]"}, ("SM304", "[1]")),
        ({"time": "true"}, ("SM304", "true")),
        ({"move": "speed: 0"}, ("SM520", "0")),
        ({"move": "speed: [params, none]"}, ("SM520", "0")),
        ({"move": "speed: [[slow]]"}, ("SM520", "-0.5")),
        ({"move": "speed: fast"}, ("SM304", "fast")),
        ({"move": "limb: left"}, ("SM521", "left")),
        ({"load": "model_name: blok, body: block"}, ("SM521", "blok")),
        ({"load": "model_name: block, apart: {tabel: 0.1}"}, ("SM521", "{tabel: 0.1}")),
        ({"held": "body: blok"}, ("SM521", "blok")),
        ({"held": "body: brick"}, ("SM521", "brick")),
        ({"place": "[500, 0, 20]"}, ("SM522", "500")),
        ({"place": "[0,5, 0,0, 0,02]"}, ("SM501", "[0,5, 0,0, 0,02]")),
    ],
    ids=str,
)
def test_values_of_built_in_states(given: dict[str, str], expected: tuple[str, str]) -> None:
    code, text = expected
    found = simulated(**given)
    # YAML reads `0,5` in a list as two numbers: no point, in two states.
    assert (("SM304", text) if code == "SM501" else expected) in found, found
    assert len(found) == 1, found


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"time": "0"},
        {"time": "'`lambda ud: ud.way`'"},
        {"time": "'`math.pi`'"},
        {"time": "1e-3"},
        {"move": "limb: null"},
        {"move": "limb: arm"},
        {"move": "speed: 0.001"},
        {"load": "model_name: cup, model_path: cup.urdf, body: block"},
        {"load": "model_name: cup, model_path: cup.urdf", "held": "body: cup"},
        {"load": "model_name: brick, body: lid", "held": "body: lid"},
        {"load": "model_name: block, spread: [-0.1, 0, 0]"},
        {"held": "body: null"},
        {"place": "[9.5, -9, 0]"},
    ],
    ids=str,
)
def test_unusual_values_of_built_in_states(given: dict[str, str]) -> None:
    assert simulated(**given) == []


def test_a_body_that_is_apart_from_itself() -> None:
    """It is not there before it is loaded; and no distance is negative."""
    apart = "{block: -0.1}"
    found = simulated(load=f"model_name: block, apart: {apart}")
    assert found == [("SM521", "block"), ("SM520", "-0.1")]


def test_the_models_of_the_simulation_are_known() -> None:
    assert tuple(sorted(models.MODELS)) == MODELS


SCRIPT = """
name: sm
outcomes: [done]
{more}
states:
  - GRIP:
      template: Grip
      {values}
      transitions: {{ok: done}}
"""
INTERFACE = """
name: Grip
variables: {{{variables}}}
input_keys: {{{keys}}}
outcomes: {{ok: {{}}}}
"""


def grip(variables: str = "", values: str = "doc: x", keys: str = "", more: str = "doc: x") -> dict[
    str, str
]:  # fmt: skip
    """A script with a state of a type with an interface."""
    return {
        "main.yml": SCRIPT.format(values=values, more=more),
        "templates/Grip.yml": INTERFACE.format(variables=variables, keys=keys),
    }


@pytest.mark.parametrize(
    ("variable", "value", "expected"),
    [
        ("{type: float, min: 0}", "0", None),
        ("{type: float, min: 0}", "-1", "SM520"),
        ("{type: float, min: 0, exclusive: true}", "0", "SM520"),
        ("{type: float, max: 3, exclusive: true}", "3", "SM520"),
        ("{type: float, min: 1, max: 3}", "3", None),
        ("{type: float, min: 1, max: 3}", "3.01", "SM520"),
        ("{type: int, max: 3}", "2.5", "SM304"),
        ("{min: 0}", "fast", "SM304"),
        ("{type: 'list[float]', min: 0}", "[1, -1]", "SM520:-1"),
        ("{type: 'list[float]', min: 0}", "[1, 0]", None),
        ("{type: 'dict[str, float]', max: 1}", "{a: 2}", "SM520:2"),
        ("{one_of: [open, close]}", "clsoe", "SM304"),
        ("{one_of: [open, close]}", "open", None),
        ("{one_of: [1, 2], type: int}", "3", "SM304"),
        ("{one_of: [0.5, 1], type: float}", "0.7", "SM520"),
        ("{one_of: [0.5, 1], type: float}", "1.0", None),
        ("{type: float, unit: m}", "30cm", "SM304"),
        ("{type: float, unit: m}", "0.3", None),
        ("{role: duration}", "2s", "SM304"),
        ("{role: duration}", "-2", "SM520"),
        ("{type: 'float?', min: 0}", "null", None),
        ("{type: float<rad>}", "90", "SM522"),
        ("{type: float<rad>}", "12.566", None),
        ("{type: 'float<rad>[2]'}", "[1, 12.566]", "SM522:12.566"),
        ("{type: 'float<rad>[2]'}", "[6.28, -6.28]", None),
        (
            "{type: 'list[{x: float<m>, yaw: float<rad>}]'}",
            "[{x: 1, yaw: 0}, {x: 90, yaw: 90}]",
            "SM522:90",
        ),
        ("{type: '{x: float<m>, yaw: float<rad>?}'}", "{x: 90, yaw: 1.57}", None),
        ("{type: '{x: float<m>, yaw: float<rad>}'}", "{x: 9, yaw: -45.0}", "SM522:-45.0"),
        ("{type: 'dict[str, {yaw: float<rad>}]'}", "{a: {yaw: 180}}", "SM522:180"),
        ("{type: '{joints: list[float<rad>]}'}", "{joints: [7.5, 0]}", "SM522:7.5"),
        ("{type: '{yaw: float<deg>}'}", "{yaw: 90}", None),
        ("{type: '{yaw: float<rad>}'}", "{yaw: 12.566}", None),
        ("{names: limb}", "anything", None),
        ("{names: model}", "anything", None),
    ],
)
def test_facts_of_a_variable(variable: str, value: str, expected: str | None) -> None:
    found = seen(grip(f"force: {variable}", f"force: {value}"))
    code, _, part = (expected or "").partition(":")
    assert found == ([] if expected is None else [(code, part or value)])


@pytest.mark.parametrize(
    ("more", "remap", "expected"),
    [
        ("userdata: {width: -1}", "width", [("SM520", "-1")]),
        ("userdata: {w: -1}", "w", [("SM520", "-1")]),
        ("userdata: {w: {type: float, value: -1}}", "w", [("SM520", "-1")]),
        ("userdata: {w: '`0 - 1`'}", "w", []),
        ("userdata: {w: 0.5}", "w", []),
    ],
)
def test_limits_of_a_key(more: str, remap: str, expected: list[tuple[str, str]]) -> None:
    found = seen(grip("", f"remapping: {{width: {remap}}}", "width: {min: 0, unit: m}", more))
    assert found == expected


def test_a_value_that_is_replaced_before_it_is_read_is_a_placeholder() -> None:
    script = """
    name: sm
    outcomes: [done]
    userdata: {width: -1}
    states:
      - LOOK: {template: ScriptedState, output_keys: [width], outcomes: [ok],
          transitions: {ok: GRIP}}
      - GRIP: {template: Grip, transitions: {ok: done}}
    """
    files = grip(keys="width: {min: 0}") | {"main.yml": script}
    assert "SM520" not in [code for code, _ in seen(files)]


@pytest.mark.parametrize(
    ("variable", "expected"),
    [
        ("{type: int, default: 0.5}", ("SM304", "0.5")),
        ("{type: float, default: fast}", ("SM304", "fast")),
        ("{type: 'list[int]', default: 3}", ("SM304", "3")),
        ("{type: float, min: 0, default: -1}", ("SM520", "-1")),
        ("{one_of: [a, b], default: c}", ("SM304", "c")),
        ("{type: float, defualt: 1}", ("SM003", "defualt")),
        ("{typ: float, default: 1}", ("SM003", "typ")),
        ("{type: float, min: 5s, default: 6}", ("SM004", "5s")),
        ("{type: str, min: 5, default: a}", ("SM004", "5")),
        ("{type: float, min: 5, max: 1, default: 3}", ("SM004", "1")),
        ("{type: str, unit: m, default: a}", ("SM004", "m")),
        ("{type: float<m>, unit: mm, default: 1}", ("SM004", "mm")),
        ("{names: lmb, default: a}", ("SM004", "lmb")),
        ("{one_of: open, default: open}", ("SM004", "open")),
        ("{type: float, default: null, min: 0}", None),
        ("{type: float, default: 1, min: 0, unit: m, doc: x}", None),
        ("{default: {}}", None),
        ("{type: float, default: '`math.pi`'}", None),
        ("float", None),
    ],
)
def test_the_entry_of_a_variable(variable: str, expected: tuple[str, str] | None) -> None:
    values = "force: 2" if variable == "float" else "doc: x"
    assert seen(grip(f"force: {variable}", values)) == ([] if expected is None else [expected])


@pytest.mark.parametrize(
    ("field", "expected"),
    [
        ("name: Gripp", ("SM004", "Gripp")),
        ("name: Grip\ncode: {pyhton: a.tpl.py}", ("SM003", "pyhton")),
        ("name: Grip\ncode: {c++: {header: a.hpp, class: A}}", ("SM003", "c++")),
        ("name: Grip\ncode: {rust: a.rs}", ("SM003", "rust")),
    ],
)
def test_the_interface(field: str, expected: tuple[str, str]) -> None:
    files = grip() | {"templates/Grip.yml": f"{field}\noutcomes: {{ok: {{}}}}\n"}
    found = [item for item in findings(files) if item.code in FAULTS]
    assert [(item.code, item.span.text) for item in found] == [expected]
    strict = Severity.WARNING if "rust" in field else Severity.ERROR
    assert found[0].severity is strict


@pytest.mark.parametrize(
    ("preset", "expected"),
    [
        ("{type: float, vlaue: 3}", ["vlaue"]),
        ("{typ: float, value: 3}", ["typ"]),
        ("{type: float, val: 3}", ["val"]),
        ("{type: float, default: 3}", ["default"]),
        ("{type: float, value: 3, unit: m}", ["unit"]),
        ("{type: float, value: 3, docs: x}", ["docs"]),
        ("{type: Width, vlaue: 3}", ["vlaue"]),
        ("{type: float, value: 3, doc: x}", []),
    ],
)
def test_the_long_form_of_userdata(preset: str, expected: list[str]) -> None:
    more = f"types: {{Width: float}}\nuserdata: {{width: {preset}}}"
    found = seen(grip(keys="width: float", more=more))
    faults = [text for code, text in found if code == "SM003"]
    assert faults == expected
    assert [code for code, _ in found if code not in ("SM003", "SM306")] == []


@pytest.mark.parametrize(
    "data",
    [
        "{type: block, valve: 3}",
        "{type: block, value: 3, colour: red}",
        "{kind: float, values: [1]}",
        "{type: float}",
        "{type: valve, val: 2}",
        "{default: 1, unit: m}",
    ],
)
def test_a_mapping_that_is_no_long_form_is_data(data: str) -> None:
    assert seen(grip(keys="width: dict", more=f"userdata: {{width: {data}}}")) == []


@pytest.mark.parametrize(
    ("type_", "value", "help"),
    [
        ("float", "'0,5'", "a decimal comma? write `0.5`"),
        ("float<s>", "1:30", "write the seconds: `90`"),
        ("float<s>", "500ms", "write the number in `s`, without the unit: `0.5`"),
        ("float<s>", "5s", "write the number without its unit: `5`"),
        ("float<rad>", "90deg", "write the number in `rad`, without the unit: `1.5708`"),
        ("float<m>", "3 parsecs", "write the number in `m`, without the unit"),
        ("float", "'0.5'", "write the number without quotes: `0.5`"),
        ("bool", "yes", "write `true`"),
        ("bool", "'false'", "write `false`"),
        ("Point", "[0,5, 0,0, 0,1]", "decimal commas? write `0.5` in place of `0,5`"),
        ("Pose", "[[0,5, 0, 0,1], [0, 0, 0, 1]]", "decimal commas? write `0.5` in place of `0,5`"),
        ("float<rad>[3]", "[0,5, 1.0, -0,1]", "decimal commas? write `0.5` in place of `0,5`"),
        ("Point", "[0, 5, 0, 0]", "write a point as `[x, y, z]`"),
    ],
)
def test_help_for_texts_meant_as_numbers(type_: str, value: str, help: str) -> None:
    found = findings(grip(keys=f"w: '{type_}'", more=f"userdata: {{w: {value}}}"))
    assert [(item.help, item.code in ("SM304", "SM501")) for item in found] == [(help, True)]


def test_a_decimal_comma_in_a_mapping() -> None:
    script = """
    name: sm
    outcomes: [done]
    states:
      - GRIP: {template: Grip, force: 0,5, transitions: {ok: done}}
    """
    found = findings(grip("force: float") | {"main.yml": script})
    assert [(item.code, item.span.text, item.help) for item in found] == [
        ("SM003", "5", "a decimal comma? write `0.5`")
    ]


def test_names_of_frames_and_joints() -> None:
    robot = """<robot name="arm"><link name="base"/><link name="hand"/>
    <joint name="elbow" type="revolute"><parent link="base"/><child link="hand"/>
    <limit lower="-1.5" upper="1.5" effort="10" velocity="1"/></joint></robot>"""
    variables = (
        "joint: {names: joint}, seen_from: {names: frame}, all: {type: 'list[str]', names: joint}"
    )
    good = "{joint: elbow, seen_from: hand, all: [elbow]}".strip("{}").replace(", ", "\n      ")
    files = grip(variables, good, more="robot: arm.urdf") | {"arm.urdf": robot}
    assert seen(files) == []
    bad = good.replace("joint: elbow", "joint: elbwo").replace("hand", "hnad")
    bad = bad.replace("[elbow]", "[elbow, wrist]")
    files |= {"main.yml": grip(variables, bad, more="robot: arm.urdf")["main.yml"]}
    expected = ["elbwo", "wrist", "hnad"]
    assert sorted(text for code, text in seen(files) if code == "SM505") == sorted(expected)


def test_limbs_of_a_robot_with_two_arms() -> None:
    files = grip("arm: {names: limb}", "arm: lefft", more="robot: baxter")
    assert seen(files) == [("SM521", "lefft")]
    assert seen(grip("arm: {names: limb}", "arm: left", more="robot: baxter")) == []


TWO_ARMS = """
name: sm
template: PyBulletBase
robot: baxter
outcomes: [done, failed]
params: {none: null, arm: right}
userdata: {home: [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.5]}
states:
  - MOVE: {template: MoveToJointPositionsState, LIMB remapping: {positions: home},
      transitions: {succeeded: done, aborted: failed, preempted: failed}}
"""


@pytest.mark.parametrize(
    ("limb", "expected"),
    [
        ("", "MOVE"),
        ("limb: null,", "null"),
        ("limb: [params, none],", "null"),
        ("limb: left,", None),
        ("limb: [params, arm],", None),
    ],
)
def test_a_state_without_a_limb_on_a_robot_with_two(limb: str, expected: str | None) -> None:
    text = TWO_ARMS.replace("LIMB", limb)
    found = [
        (item.span.text, item.message, item.help)
        for item in findings({"main.yml": text})
        if item.code in FAULTS
    ]
    message = "`MOVE` names no limb, but `baxter` has two: `left` and `right`"
    help = "write `limb: left` or `limb: right`"
    assert found == ([(expected, message, help)] if expected is not None else [])
    assert seen({"main.yml": text.replace("robot: baxter", "robot: panda")}) == (
        [("SM521", "left" if "left" in limb else "right")] if expected is None else []
    )


@pytest.mark.parametrize(
    ("variable", "expected"),
    [
        ("{names: limb, default: null}", [("SM521", "GRIP")]),
        ("{names: limb, default: left}", []),
        ("{type: 'list[str]', names: limb, default: null}", []),
    ],
)
def test_a_type_of_the_user_without_a_limb(variable: str, expected: list[tuple[str, str]]) -> None:
    assert seen(grip(f"arm: {variable}", more="robot: baxter")) == expected


GRIPS = """\
name: sm
template: PyBulletBase
robot: arm.yml
outcomes: [done, failed]
states:
  - GRIP:
      template: GripperState
      command: close
      limb: LIMB
      transitions: {succeeded: READ, aborted: failed, preempted: failed}
  - READ:
      template: ReadBodyPoseState
      body: base
      transitions: {succeeded: done, aborted: failed}
"""
ARMS = """\
name: arms
urdf: arm.urdf
arms:
  bare: {joints: [shoulder], tool: hand, home: [0.0]}
  grip:
    joints: [elbow]
    tool: lower
    home: [0.0]
    gripper: {joints: {finger: {open: 0.04}}, width: {open: 0.08, closed: 0.0}}
"""
JOINT = """\
<joint name="NAME" type="KIND"><parent link="base"/><child link="LINK"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
"""
LINKS = (("shoulder", "revolute", "hand"), ("elbow", "revolute", "lower"),
         ("finger", "prismatic", "pad"))  # fmt: skip


@pytest.mark.parametrize(
    ("limb", "expected"), [("bare", ["SM521 bare", "SM521 base"]), ("grip", ["SM521 base"])]
)
def test_an_arm_without_a_gripper(limb: str, expected: list[str]) -> None:
    links = "".join(f'<link name="{name}"/>' for name in ("base", "hand", "lower", "pad"))
    joints = "".join(
        JOINT.replace("NAME", name).replace("KIND", kind).replace("LINK", link)
        for name, kind, link in LINKS
    )
    files = {
        "main.yml": GRIPS.replace("LIMB", limb),
        "arm.yml": ARMS,
        "arm.urdf": f'<robot name="arms">{links}{joints}</robot>',
    }
    assert [f"{code} {text}" for code, text in seen(files)] == expected


@pytest.mark.parametrize(
    ("variable", "expected"),
    [
        ("{type: float<rad>, default: 90}", [("SM522", "90")]),
        ("{type: float<rad>, default: 1.57}", []),
        ("{type: 'list[{yaw: float<rad>}]', default: [{yaw: 1}, {yaw: 45}]}", [("SM522", "45")]),
        ("{type: float<deg>, default: 90}", []),
        ("{type: float<rad>, default: 90, max: 6.29}", [("SM520", "90")]),
        ("{type: float<rad>?, default: null}", []),
    ],
)
def test_a_default_in_degrees(variable: str, expected: list[tuple[str, str]]) -> None:
    assert seen(grip(f"force: {variable}", "tags: [slow]")) == expected
