"""Rules over the values that a robot receives: lengths, joint limits, rotations, units, frames."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator

from smachac.analysis.context import Context
from smachac.analysis.reaching_values import reaching_flows
from smachac.analysis.type_inference import TypeFlow
from smachac.analysis.type_lattice import inside, present
from smachac.checks.findings.clash_findings import clash_findings
from smachac.checks.findings.help_text import did_you_mean, other_place
from smachac.checks.findings.literals import literal_finding, reader
from smachac.checks.findings.number_help import decimal_commas
from smachac.checks.findings.value_places import Part
from smachac.checks.robot.joint_limits import _angles, joint_faults, within_limits
from smachac.checks.robot.literal_parts import (
    as_float,
    frame_of,
    moves_arm,
    names_in,
    part_named,
    role_of,
)
from smachac.checks.robot.simulated_world import is_simulated, loaded_too_late, uses_simulation
from smachac.checks.robot.units import mixed_units, wrong_units
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Severity
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import MOST_LISTED, listed
from smachac.ir.nodes import Data, Leaf, Struct, is_number
from smachac.ir.types import Type
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: few scripts have a robot
if TYPE_CHECKING:
    from smachac.ir.robot import Joint, Robot

ROTATION_TOLERANCE = 10e-3
"""Tolerance for the squared length of a quaternion, with which tf2 accepts transforms (geometry2,
tf2/src/buffer_core.cpp, QUATERNION_NORMALIZATION_TOLERANCE)."""


@rule(
    "SM501",
    "wrong-length",
    Severity.ERROR,
    effect="the state cannot use a list of this length: it fails, or uses wrong numbers",
)
def wrong_length(context: Context) -> Iterator[Finding]:
    """A list has more or fewer items than its reader requires.

    Seven joints need seven numbers: with six numbers the skill fails when it starts, and the arm
    stops in the middle of the task.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {home: [0.0, -0.8, 0.0, -2.4, 0.0, 1.6]}
        states:
          - MOVE:
              template: ScriptedState
              input_keys: {joints: "float<rad>[7]"}
              remapping: {joints: home}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {home: [0.0, -0.8, 0.0, -2.4, 0.0, 1.6, 0.8]}
        states:
          - MOVE:
              template: ScriptedState
              input_keys: {joints: "float<rad>[7]"}
              remapping: {joints: home}
              outcomes: [done]
              transitions: {done: done}
    """
    yield from clash_findings(context.clashes["length"])
    robot = context.machine.robot
    limbs = robot.limbs if robot is not None else ()
    lengths = sorted({len(limb) for limb in limbs})
    for flow in context.types.constants if lengths else ():
        if moves_arm(flow) and role_of(flow.cell) == "joint_positions":
            assert isinstance(flow.value, tuple)
            if len(flow.value) not in lengths:
                have = " or ".join(map(str, lengths))
                message = f"`{flow.origin.cell.key}` has {len(flow.value)} numbers, but the arm has"
                help = decimal_commas(flow.origin.span.text, lengths)
                help = help or f"write one number for each joint: {have} in all"
                yield literal_finding(flow, f"{message} {have} joints", help)


@rule(
    "SM502",
    "joint-limit",
    Severity.ERROR,
    effect="the joint cannot reach the angle: the state ends with `aborted`, or its controller"
    " raises an error",
)
def joint_limit(context: Context) -> Iterator[Finding]:
    """A joint position is outside the limits of the joint.

    The joint cannot reach the angle: the state ends with `aborted`, or the controller of the arm
    raises an error.

    Exactly: the limits are those of the robot that `robot:` names, a built-in arm (panda, baxter)
    or a URDF file. The rule checks the literals that a state with a claim on an arm reads: lists of
    positions, one for each joint of a limb, and mappings of joint names to positions. They are in
    rad, or in m for a joint that slides.

    Wrong:
        name: sm
        template: PyBulletBase
        robot: panda
        outcomes: [done, failed]
        userdata: {home: [0.0, -0.785, 0.0, 2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: MoveToJointPositionsState
              remapping: {positions: home}
              transitions: {succeeded: done, aborted: failed, preempted: failed}

    Right:
        name: sm
        template: PyBulletBase
        robot: panda
        outcomes: [done, failed]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: MoveToJointPositionsState
              remapping: {positions: home}
              transitions: {succeeded: done, aborted: failed, preempted: failed}
    """
    robot = context.machine.robot
    for flow in context.types.constants if robot is not None else ():
        assert robot is not None
        if not moves_arm(flow):
            continue
        faults = joint_faults(flow, robot)
        degrees = [fault for fault in faults if _seems_degrees(fault[1], fault[2])]
        if degrees and isinstance(flow.value, tuple):
            yield _in_degrees(flow, robot, faults)
            continue
        for number, joint, angle in faults:
            in_list = isinstance(flow.value, tuple)
            what = f"joint {number}" if in_list else f"`{joint.name}`"
            limits = f"{joint.lower:g} to {joint.upper:g}"
            yield literal_finding(
                flow,
                f"{what} of `{flow.origin.cell.key}` is {angle} {joint.unit}, outside its limits"
                f" {limits}",
                f"convert the angle from degrees to radians: `{_radians(angle)}`"
                if _seems_degrees(joint, angle)
                else _position_help(joint, as_float(angle), limits),
                (str(number) if in_list else joint.name,),
                part=Part((number - 1,) if in_list else (joint.name,)),
                more=other_place(joint.span, f"the limits of `{joint.name}`"),
            )


def _seems_degrees(joint: Joint, angle: Data) -> bool:
    """Whether a position is larger than a full turn in radians."""
    return joint.turns and abs(as_float(angle)) > 2 * math.pi


def _position_help(joint: Joint, position: float, limits: str) -> str:
    """The help for a position outside the limits of a joint: that with the other sign, or in
    metres, if it is within them."""
    if not joint.turns and within_limits(joint, position / 1000):
        return f"write `{position / 1000:g}`: positions of joints that slide are in metres"
    help = f"write {'an angle' if joint.turns else 'a position'} from {limits}, in "
    help += "radians" if joint.turns else "metres"
    return f"{help}: did you mean `{-position:g}`?" if within_limits(joint, -position) else help


def _in_degrees(flow: TypeFlow, robot: Robot, faults: list[tuple[int, Joint, Data]]) -> Finding:
    """SM502 for a list in which an angle is larger than a full turn in radians."""
    assert isinstance(flow.value, tuple)
    number, joint, angle = faults[0]
    names = ", ".join(f"joint {number} is {given}" for number, _, given in faults[:MOST_LISTED])
    message = f"`{flow.origin.cell.key}` is outside the limits of the joints, in rad: {names}"
    if len(faults) == len(flow.value):
        message = f"`{flow.origin.cell.key}` seems to be in degrees: all {len(faults)} angles are"
        message += " outside the limits of the joints, in rad"
    if len(faults) == 1:
        limits = f"outside its limits {joint.lower:g} to {joint.upper:g}"
        message = f"joint {number} of `{flow.origin.cell.key}` is {angle} rad, {limits}"
    rows = _angles(flow.value, robot)
    new = ", ".join(
        _radians(given) if is_number(given) and joint.turns else str(given) for joint, given in rows
    )
    return literal_finding(
        flow,
        message,
        f"convert the angles from degrees to radians: `[{new}]`",
        tuple(str(number) for number, _, _ in faults),
        more=other_place(joint.span, f"the limits of `{joint.name}`"),
    )


def _radians(angle: Data) -> str:
    """An angle in degrees as text in radians."""
    return f"{math.radians(as_float(angle)):.4g}"


@rule(
    "SM503",
    "not-a-rotation",
    Severity.WARNING,
    effect="some programs use the nearest rotation, others fail or distort the pose",
)
def not_a_rotation(context: Context) -> Iterator[Finding]:
    """A quaternion does not have the length 1, so it is not a rotation.

    Some programs use the nearest rotation, others stop with an error, and others distort the pose:
    the hand moves to an unexpected place. The simulation reads four zeros as no rotation.

    Exactly: the squared length differs from 1 by more than 0.01, the tolerance of tf2.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {grasp: [[0.5, 0.0, 0.1], [1.0, 0.0, 0.0, 1.0]]}
        states:
          - PICK:
              template: ScriptedState
              input_keys: {grasp: Pose}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {grasp: [[0.5, 0.0, 0.1], [0.7071, 0.0, 0.0, 0.7071]]}
        states:
          - PICK:
              template: ScriptedState
              input_keys: {grasp: Pose}
              outcomes: [done]
              transitions: {done: done}
    """
    known: dict[tuple[TypeFlow, Type], list[tuple[tuple[Data, ...], float]]] = {}
    for flow in context.types.constants:
        which = flow.origin, flow.cell.declared
        if which not in known:
            known[which] = [*_wrong_rotations(*which)]
        for rotation, length in known[which]:
            help = "write `[0.0, 0.0, 0.0, 1.0]` for no rotation"
            if length > 0.0 and math.isfinite(length):
                numbers = [as_float(value) for value in rotation]
                nearest = ", ".join(f"{number / length:.4f}" for number in numbers)
                help = f"write the nearest rotation, `[{nearest}]`"
            message = f"the quaternion {list(rotation)} has the length {length:.4g}, not 1"
            yield literal_finding(flow, message, help, tuple(map(str, rotation)))


def _wrong_rotations(origin: TypeFlow, wanted: Type) -> Iterator[tuple[tuple[Data, ...], float]]:
    """The quaternions in a literal that is read as a type, if their length is not 1, with it."""
    for rotation in _rotations(origin.value, wanted):
        numbers = [as_float(number) for number in rotation if is_number(number)]
        length = math.hypot(*numbers)
        if len(numbers) == 4 and not abs(length * length - 1.0) <= ROTATION_TOLERANCE:  # also NaN
            yield rotation, length


def _rotations(data: Data, wanted: Type) -> Iterator[tuple[Data, ...]]:
    """The quaternions in a literal that is read as a type."""
    match wanted.name, data:
        case "optional", _:
            yield from _rotations(data, inside(wanted))
        case "Quaternion", tuple():
            yield data
        case (("Pose" | "Transform"), (_, tuple() as rotation)):
            yield rotation
        case (("list" | "array"), tuple()) if inside(wanted).name in HOLDERS:
            for item in data:
                yield from _rotations(item, inside(wanted))
        case "dict", Struct(entries=entries) if inside(wanted).name in HOLDERS:
            for _, item in entries:
                yield from _rotations(item, inside(wanted))


HOLDERS = frozenset(["Pose", "Transform", "Quaternion", "optional", "list", "array", "dict"])
"""Types that a rotation may be in."""


@rule(
    "SM504",
    "unit-mismatch",
    Severity.ERROR,
    effect="nothing converts the number, so it is wrong by the ratio of the two units",
)
def unit_mismatch(context: Context) -> Iterator[Finding]:
    """A number is written in one unit and read in another.

    Ninety degrees that are read as radians turn a joint fourteen times, or move it to its limit. A
    number without a unit fits every unit.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {angle: {type: "float<deg>", value: 90.0}}
        states:
          - TURN:
              template: ScriptedState
              input_keys: {angle: "float<rad>"}
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {angle: {type: "float<rad>", value: 1.5708}}
        states:
          - TURN:
              template: ScriptedState
              input_keys: {angle: "float<rad>"}
              outcomes: [done]
              transitions: {done: done}
    """
    yield from clash_findings(context.clashes["unit"], context.machine.aliases)
    yield from mixed_units(context)
    yield from wrong_units(context)


USUAL = frozenset(["base", "base_footprint", "base_link", "earth", "map", "odom", "world"])
"""Frames that no description has and every robot may: REP 105 (ros.org/reps/rep-0105.html), and
`base`, as robots of the industry and our simulation call it."""

STAMPED = frozenset(["PoseStamped", "geometry_msgs/PoseStamped", "geometry_msgs/msg/PoseStamped"])


@rule(
    "SM505",
    "unknown-frame",
    Severity.WARNING,
    effect="a state that uses this name fails, or waits for it without end",
)
def unknown_frame(context: Context) -> Iterator[Finding]:
    """A value names a frame or a joint that the robot does not have.

    The state waits for a transform that never comes, or the hand moves to a place that is measured
    from the wrong frame.

    Exactly: the frames are the links of the URDF file that `robot:` names, those that the script
    lists under `frames:`, and common ones (`base_link`, `map`, `odom`, `world`). The rule checks
    the literals that a state reads as `str` from a key whose name is or ends with `frame` or
    `frame_id`, and the frame of a PoseStamped. In the simulation the frames are `base`, `world` and
    the loaded bodies, and an unknown one is an error; so is the frame of a body that no path loads
    before a state of the simulation uses it, unless the state leads to the loading one when it
    fails. A frame with a leading slash is reported where a built-in state looks it up in tf2, which
    refuses it. The rule also checks the joint names in mappings of joint names to angles, and the
    values of variables and keys with `names: joint` or `names: frame` in the interface.

    Wrong:
        name: sm
        template: Base
        robot: arm.urdf
        outcomes: [done]
        userdata: {from_frame: hnad}
        states:
          - LOOK:
              template: ScriptedState
              input_keys: {from_frame: str}
              outcomes: [done]
              transitions: {done: done}
        == arm.urdf ==
        <robot name="arm"><link name="hand"/></robot>

    Right:
        name: sm
        template: Base
        robot: arm.urdf
        frames: [camera]
        outcomes: [done]
        userdata: {from_frame: hand, to_frame: camera}
        states:
          - LOOK:
              template: ScriptedState
              input_keys: {from_frame: str, to_frame: str}
              outcomes: [done]
              transitions: {done: done}
        == arm.urdf ==
        <robot name="arm"><link name="hand"/></robot>
    """
    slashed = [flow for flow in context.types.constants if _begins_with_slash(context, flow)]
    for flow in reaching_flows(slashed):
        yield _frame_with_slash(flow)
    robot = context.machine.robot
    if robot is None:
        return
    yield from _unknown_joints(context, robot)
    simulated = is_simulated(context)
    known = _simulated(context, robot) if simulated else _known(robot)
    if not known:
        return
    guess = guesser(sorted(known))
    for flow in context.types.constants:
        for name in _frames_in(flow):
            if name.removeprefix("/") in known or not name or _begins_with_slash(context, flow):
                continue
            where = "the simulation" if simulated else f"the robot `{robot.name}`"
            help = f"write one of the robot's frames: {listed(robot.frames | robot.added)}"
            help += f"{_or_default(context, flow)}; if another program provides `{name}`, add it"
            help += " to `frames: [...]` of the script"
            if simulated:
                help = f"its frames are {', '.join(f'`{text}`' for text in sorted(known))}"
            message = f"{where} has no frame `{name}`"
            severity = Severity.ERROR if simulated else None
            help = did_you_mean(guess(name)) or help
            part = Part(frame_place(flow.value))
            finding = literal_finding(flow, message, help, (name,), part=part)
            yield replace(finding, severity=severity)
    if simulated:
        yield from _late_frames(context, robot)


def _or_default(context: Context, flow: TypeFlow) -> str:
    """The end of a help for a variable whose interface has another value as its default."""
    cell = flow.cell
    type_ = context.machine.state_types.get(cell.node.type) if cell.node is not None else None
    held = type_.variables.get(cell.key) if type_ and cell.role == "variable" else None
    default = held.default.data if held is not None and held.default is not None else None
    if not isinstance(default, str) or default == flow.value or flow.origin.cell is not cell:
        return ""
    return f"; or remove `{cell.key}`: its default is `{default}`"


def _begins_with_slash(context: Context, flow: TypeFlow) -> bool:
    """Whether a literal is a frame with a leading slash for a built-in state that looks it up in
    tf2, which refuses such names (geometry2, tf2/src/buffer_core.cpp, stripSlash and
    validateFrameId)."""
    value, node = flow.value, flow.cell.node
    if not isinstance(value, str) or not value.startswith("/") or value.strip("/") == "":
        return False
    tf2 = isinstance(node, Leaf) and node.built_in != "" and not uses_simulation(context, flow.cell)
    return tf2 and flow.cell.role in ("input", "variable") and role_of(flow.cell) == "frame"


def _frame_with_slash(flow: TypeFlow) -> Finding:
    """SM505 for a frame with a leading slash, as the tf of old versions of ROS 1 accepted it."""
    name = str(flow.value)
    message, help = f"the frame `{name}` begins with a slash", f"write `{name.lstrip('/')}`"
    effect = f"tf2 refuses such a name: {reader(flow)} ends with `aborted` in each run"
    return replace(literal_finding(flow, message, help, (name,)), effect=effect)


def _known(robot: Robot) -> frozenset[str]:
    """The frames of a robot; none where they are not known."""
    return robot.frames | robot.added | USUAL if robot.frames else robot.frames


def _simulated(context: Context, robot: Robot) -> frozenset[str]:
    """The frames of the simulated world; none where code of the user may add to them."""
    loaded = context.bodies_loaded
    if loaded is None:
        return frozenset()
    return _given_frames(robot) | frozenset(loaded.values())


def _given_frames(robot: Robot) -> frozenset[str]:
    """The frames that the simulated world has from the start."""
    return frozenset({"base", "world", robot.name, *robot.added, *robot.scene})


def _late_frames(context: Context, robot: Robot) -> Iterator[Finding]:
    """The frames of bodies that are loaded only after the state that names the frame."""
    given = _given_frames(robot)
    flows = [
        flow
        for flow in context.types.constants
        if uses_simulation(context, flow.cell) and not given.issuperset(_frames_in(flow))
    ]
    for flow in reaching_flows(flows):
        for name in _frames_in(flow):
            if name not in given:
                yield from loaded_too_late(
                    context,
                    flow,
                    name,
                    "frame",
                    "write another frame, such as `base`",
                    part=Part(frame_place(flow.value)),
                )


def _frames_in(flow: TypeFlow) -> Iterator[str]:
    """The frames that a literal names."""
    cell, wanted = flow.cell, present(flow.cell.declared)
    if wanted.name == "str" and isinstance(flow.value, str) and _holds_frame(flow):
        yield flow.value
    elif wanted.name in STAMPED and cell.role == "input":
        name = frame_of(flow.value)
        if name is not None:
            yield name


def frame_place(pose: Data) -> tuple[str, ...]:
    """The steps to the frame in a literal that `frame_of` reads; none for a text."""
    if not isinstance(pose, Struct):
        return ()
    return ("header", "frame_id") if "header" in dict(pose.entries) else ("frame_id",)


def _holds_frame(flow: TypeFlow) -> bool:
    cell = flow.cell
    if cell.role not in ("input", "variable"):
        return False
    last = cell.key.removesuffix("_id").rpartition("_")[2]
    return last == "frame" or role_of(cell) == "frame"


def _unknown_joints(context: Context, robot: Robot) -> Iterator[Finding]:
    """The unknown joints in mappings of joint names to angles."""
    joints = [joint.name for joint in robot.joints]
    for flow in context.types.constants if joints else ():
        if role_of(flow.cell) == "joint":
            yield from _strangers(flow, [*names_in(flow.value)], joints, robot)
        elif moves_arm(flow) and isinstance(flow.value, Struct):
            names = list(names_in(flow.value))
            if not set(joints).isdisjoint(names):  # else the names are not those of joints
                yield from _strangers(flow, names, joints, robot)


def _strangers(
    flow: TypeFlow, names: Collection[str], joints: list[str], robot: Robot
) -> Iterator[Finding]:
    strange = dict.fromkeys(name for name in names if name not in joints)
    free = [joint for joint in joints if joint not in {*names}]
    guess = guesser(free)
    for name in strange:
        help = did_you_mean(guess(name)) or f"its joints are {listed(joints)}"
        if not free:
            help = f"remove it: all joints of the robot are here, {listed(joints)}"
        message = f"the robot `{robot.name}` has no joint `{name}`"
        finding = literal_finding(flow, message, help, (name,), part=part_named(flow.value, name))
        yield replace(finding, effect="the state cannot move a joint of this name: it fails")
