"""Rules over numbers that reach a robot: how many, within the limits, a rotation, in which unit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

from smachac.analysis.context import Context
from smachac.analysis.type_inference import TypeFlow
from smachac.analysis.type_lattice import inside, present, unit_of
from smachac.checks.expressions import mixed_units
from smachac.checks.messages import calls, did_you_mean, other_place
from smachac.checks.rule import rule
from smachac.checks.types import clash_findings
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.spelling import guesser
from smachac.ir.leaf import variable
from smachac.ir.nodes import Data, Leaf, Machine, Struct
from smachac.ir.robot import BUILT_IN, DEFAULTS, Joint, Robot
from smachac.ir.types import Type

ROTATION_TOLERANCE = 1e-3
"""How far the length of a quaternion may be from 1: what three decimals leave open."""

JOINT_TOLERANCE = 1e-4
"""rad: limits are given with as many decimals."""


@rule("SM501", "wrong-length", Severity.ERROR)
def wrong_length(context: Context) -> Iterator[Finding]:
    """A list has more or fewer items than where it is read.

    Seven joints take seven numbers: with six the skill fails when its turn comes, with the arm in
    the middle of the task.

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
    robot = robot_of(context.machine)
    limbs = robot.limbs if robot is not None else ()
    lengths = sorted({len(limb) for limb in limbs})
    for flow in context.types.constants if lengths else ():
        if moves_arm(flow) and flow.cell.node and flow.cell.node.type in ARM_STATES:
            assert isinstance(flow.value, tuple)
            if len(flow.value) not in lengths:
                have = " or ".join(map(str, lengths))
                message = f"the arm has {have} joints, and `{flow.origin.cell.key}` has"
                yield at(flow, f"{message} {len(flow.value)} numbers", "give one for each joint")


ARM_STATES = frozenset(["MoveToJointPositionsState"])
"""State types whose list of angles is that of all joints of an arm, however many it has."""


@rule("SM502", "joint-limit", Severity.ERROR)
def joint_limit(context: Context) -> Iterator[Finding]:
    """A joint position is beyond what the joint of the robot can reach.

    The arm stops at its limit and the skill fails. `robot:` names a built-in arm (panda, baxter) or
    a URDF file. Its limits are asked of the literals that a state which claims an arm reads: lists
    of angles, one for each joint of a limb, and mappings of joint names to angles.

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
    robot = robot_of(context.machine)
    for flow in context.types.constants if robot is not None else ():
        assert robot is not None
        if not moves_arm(flow):
            continue
        given = _angles(flow.value, robot)
        wrong = [
            (number, joint, angle)
            for number, (joint, angle) in enumerate(given, 1)
            if _is_number(angle) and not _within(joint, _as_float(angle))
        ]
        for number, joint, angle in wrong:
            what = f"joint {number}" if isinstance(flow.value, tuple) else f"`{joint.name}`"
            yield at(
                flow,
                f"{what} of `{flow.origin.cell.key}` is {angle} rad, beyond its limits"
                f" {joint.lower:g} to {joint.upper:g}",
                "are these degrees?" if abs(_as_float(angle)) > 2 * math.pi else None,
                other_place(joint.span, f"the limits of `{joint.name}`"),
            )


def robot_of(machine: Machine) -> Robot | None:
    """The robot of a machine: as its script was read with, else by its name."""
    name: Data = DEFAULTS.get(machine.base)
    for held in machine.variables:
        if held.name == "robot":
            name = held.value.data
    return machine.robot or (BUILT_IN.get(name) if isinstance(name, str) else None)


def _within(joint: Joint, angle: float) -> bool:
    return joint.lower - JOINT_TOLERANCE <= angle <= joint.upper + JOINT_TOLERANCE


def _angles(value: Data, robot: Robot) -> list[tuple[Joint, Data]]:
    """The angles of a literal by their joints: of the limb that they suit best, where they are of
    any limb of that many joints."""
    if isinstance(value, Struct):
        joints = {joint.name: joint for joint in robot.joints}
        return [(joints[name], angle) for name, angle in value.entries if name in joints]
    assert isinstance(value, tuple)
    limbs = [limb for limb in robot.limbs if len(limb) == len(value)]
    pairs = [list(zip(limb, value, strict=True)) for limb in limbs]
    return min(pairs, key=_misses, default=[])


def _misses(pairs: list[tuple[Joint, Data]]) -> int:
    return sum(not _within(joint, _as_float(angle)) for joint, angle in pairs)


def moves_arm(flow: TypeFlow) -> bool:
    """Whether a literal holds angles, in a list or by name, that a state which holds an arm
    reads."""
    node, wanted = flow.cell.node, present(flow.cell.declared)
    if flow.cell.role != "input" or not isinstance(node, Leaf):
        return False
    held = any(claim == "arm" or claim.startswith("arm.") for claim in node.claims)
    if not held or unit_of(inside(wanted)) != "rad":
        return False
    shape = {"list": tuple, "array": tuple, "dict": Struct}.get(wanted.name)
    return shape is not None and isinstance(flow.value, shape)


@rule("SM503", "not-a-rotation", Severity.WARNING)
def not_a_rotation(context: Context) -> Iterator[Finding]:
    """A quaternion does not have the length 1, so it is no rotation.

    Some programs read the nearest rotation, others refuse it, and others bend the pose: the hand
    comes from where nobody sent it. Four zeros are read as no rotation at all in the simulation.

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
    for flow in context.types.constants:
        for rotation in _rotations(flow.value, flow.cell.declared):
            numbers = [_as_float(each) for each in rotation if _is_number(each)]
            if len(numbers) != 4:
                continue
            length = math.hypot(*numbers)
            if abs(length - 1.0) <= ROTATION_TOLERANCE:
                continue
            help = "write no rotation as `[0.0, 0.0, 0.0, 1.0]`"
            if length > 0.0 and math.isfinite(length):
                nearest = ", ".join(f"{number / length:.4f}" for number in numbers)
                help = f"the nearest rotation is `[{nearest}]`"
            yield at(flow, f"the quaternion {list(rotation)} has the length {length:.4g}", help)


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


@rule("SM504", "unit-mismatch", Severity.ERROR)
def unit_mismatch(context: Context) -> Iterator[Finding]:
    """A number is written in one unit and read in another.

    Ninety degrees read as radians turn a joint fourteen times, or run it into its limit. Numbers
    without a unit fit every unit.

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
    yield from clash_findings(context.clashes["unit"])
    yield from mixed_units(context)


def _is_number(data: Data) -> bool:
    return isinstance(data, int | float) and not isinstance(data, bool)


def _as_float(data: Data) -> float:
    """A number as a float; one that is too large for it is infinite."""
    try:
        return float(data) if isinstance(data, int | float) else math.nan
    except OverflowError:
        return math.inf


def at(flow: TypeFlow, message: str, help: str | None, more: tuple[Related, ...] = ()) -> Finding:
    """A finding at a literal, with where it is read."""
    origin, cell = flow.origin, flow.cell
    reader = cell.node.name if cell.node is not None else "the base"
    related: tuple[Related, ...] = ()
    if cell.span != origin.span and cell is not origin.cell:
        related = other_place(cell.span, f"`{reader}` reads it here as `{cell.key}`")
    node = origin.cell.node
    return Finding(
        span=origin.span,
        message=message,
        help=help,
        related=(*related, *more, *(calls(node, origin.span) if node is not None else ())),
        node=origin.cell.path,
    )


USUAL = frozenset(["base", "base_footprint", "base_link", "earth", "map", "odom", "world"])
"""Frames that no description has and every robot may: REP 105 (ros.org/reps/rep-0105.html), and
`base`, as robots of the industry and our simulation call it."""

FRAME_KEYS = {"TF2ListenerState": frozenset(["source", "target"])}
"""Keys of state types that hold frames though they are not called so."""

STAMPED = frozenset(["PoseStamped", "geometry_msgs/PoseStamped", "geometry_msgs/msg/PoseStamped"])

LOADING = "LoadModelState"

SIMULATED = "PyBulletBase"

TAME = frozenset(
    [
        "CallbacksState",
        "CheckGraspState",
        "CheckPlacedState",
        "ConditionalOutcomeState",
        "DeleteFileState",
        "GripperState",
        "LoadModelState",
        "MoveAlongState",
        "MoveToJointPositionsState",
        "PoseToJointPositionsState",
        "PrintUserdataState",
        "RandomOutcomeState",
        "ScriptedState",
        "SleepState",
        "WriteCSVFileState",
    ]
)
"""The state types of ours: none but LoadModelState puts a body into the simulated world."""


@rule("SM505", "unknown-frame", Severity.WARNING)
def unknown_frame(context: Context) -> Iterator[Finding]:
    """A frame, or a joint, is named that the robot does not have.

    The transform is waited for in vain, or the hand goes to a place measured from another one.
    Known are the links of the URDF file that `robot:` names, the frames that the script lists under
    `frames:`, and the usual ones (`base_link`, `map`, `odom`, `world`); asked are the literals that
    a state reads as `str` under a key that is called `frame` or `frame_id`, or ends so, and the
    frames of a PoseStamped. In the simulation the frames are `base`, `world` and the bodies that
    are loaded, so there it is an error.

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
        <robot name="arm"><link name="base"/><link name="hand"/></robot>

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
        <robot name="arm"><link name="base"/><link name="hand"/></robot>
    """
    robot = robot_of(context.machine)
    if robot is None:
        return
    yield from _unknown_joints(context, robot)
    simulated = context.machine.base == SIMULATED
    known = _simulated(context, robot) if simulated else _known(robot)
    if not known:
        return
    guess = guesser(sorted(known))
    for flow in context.types.constants:
        for name in _frames_in(flow):
            if name.removeprefix("/") in known or not name:
                continue
            where = "the simulation" if simulated else f"`{robot.name}`"
            help = "give it under `frames: [...]` if something else than the robot provides it"
            if simulated:
                help = f"known are {', '.join(f'`{each}`' for each in sorted(known))}"
            found = at(flow, f"{where} has no frame `{name}`", did_you_mean(guess(name)) or help)
            yield found if not simulated else _as_error(found)


def _as_error(found: Finding) -> Finding:
    return replace(found, severity=Severity.ERROR)


def _known(robot: Robot) -> frozenset[str]:
    """The frames of a robot; none where they are not known."""
    return robot.frames | robot.added | USUAL if robot.frames else robot.frames


def _simulated(context: Context, robot: Robot) -> frozenset[str]:
    """The frames of the simulated world; none where code of the user may add to them."""
    found = {"base", "world", robot.name, *robot.added}
    for _, node in context.states:
        if not isinstance(node, Leaf):
            continue
        if node.type not in TAME:
            return frozenset()
        if node.type == LOADING:
            body = variable(node, "body") or variable(node, "model_name")
            if not isinstance(body, str):
                return frozenset()
            found.add(body)
    return frozenset(found)


def _frames_in(flow: TypeFlow) -> Iterator[str]:
    """The frames that a literal names."""
    cell, wanted = flow.cell, present(flow.cell.declared)
    if wanted.name == "str" and isinstance(flow.value, str) and _holds_frame(flow):
        yield flow.value
    elif wanted.name in STAMPED and isinstance(flow.value, Struct):
        held = dict(flow.value.entries)
        header = held.get("header")
        inner = dict(header.entries) if isinstance(header, Struct) else held
        name = inner.get("frame_id")
        if isinstance(name, str) and cell.role == "input":
            yield name


def _holds_frame(flow: TypeFlow) -> bool:
    cell = flow.cell
    if cell.role not in ("input", "variable"):
        return False
    last = cell.key.removesuffix("_id").rpartition("_")[2]
    type_ = cell.node.type if cell.node is not None else ""
    return last == "frame" or cell.key in FRAME_KEYS.get(type_, ())


def _unknown_joints(context: Context, robot: Robot) -> Iterator[Finding]:
    """Angles by joint, where one of the joints is not there."""
    joints = [joint.name for joint in robot.joints]
    for flow in context.types.constants if joints else ():
        if moves_arm(flow) and isinstance(flow.value, Struct):
            yield from _strangers(flow, flow.value.entries, joints, robot)


def _strangers(
    flow: TypeFlow, entries: Iterable[tuple[str, Data]], joints: list[str], robot: Robot
) -> Iterator[Finding]:
    names = [name for name, _ in entries]
    strange = [name for name in names if name not in joints]
    if len(strange) == len(names):
        return  # these are no joints at all
    guess = guesser(joints)
    for name in strange:
        help = did_you_mean(guess(name)) or f"its joints are {', '.join(joints)}"
        yield at(flow, f"`{robot.name}` has no joint `{name}`", help)
