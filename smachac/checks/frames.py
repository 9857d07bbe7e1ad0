"""Rules over the names of a robot's parts that values hold: frames, joints."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from smachac.checks.hints import did_you_mean, guesser
from smachac.checks.once import states
from smachac.checks.robot import at, moves_arm, robot_of
from smachac.checks.types import types_of
from smachac.diagnostics import Finding, Severity, rule
from smachac.ir.behaviours import variable
from smachac.ir.fitting import present
from smachac.ir.nodes import Data, Leaf, Machine, Struct
from smachac.ir.places import Flow
from smachac.ir.robots import Robot

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
def unknown_frame(machine: Machine) -> Iterator[Finding]:
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
    robot = robot_of(machine)
    if robot is None:
        return
    yield from _unknown_joints(machine, robot)
    simulated = machine.base == SIMULATED
    known = _simulated(machine, robot) if simulated else _known(robot)
    if not known:
        return
    guess = guesser(sorted(known))
    for flow in types_of(machine).constants:
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


def _simulated(machine: Machine, robot: Robot) -> frozenset[str]:
    """The frames of the simulated world; none where code of the user may add to them."""
    found = {"base", "world", robot.name, *robot.added}
    for _, node in states(machine):
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


def _frames_in(flow: Flow) -> Iterator[str]:
    """The frames that a literal names."""
    place, wanted = flow.place, present(flow.place.declared)
    if wanted.name == "str" and isinstance(flow.value, str) and _holds_frame(flow):
        yield flow.value
    elif wanted.name in STAMPED and isinstance(flow.value, Struct):
        held = dict(flow.value.entries)
        header = held.get("header")
        inner = dict(header.entries) if isinstance(header, Struct) else held
        name = inner.get("frame_id")
        if isinstance(name, str) and place.role == "input":
            yield name


def _holds_frame(flow: Flow) -> bool:
    place = flow.place
    if place.role not in ("input", "variable"):
        return False
    last = place.key.removesuffix("_id").rpartition("_")[2]
    type_ = place.node.type if place.node is not None else ""
    return last == "frame" or place.key in FRAME_KEYS.get(type_, ())


def _unknown_joints(machine: Machine, robot: Robot) -> Iterator[Finding]:
    """Angles by joint, where one of the joints is not there."""
    joints = [joint.name for joint in robot.joints]
    for flow in types_of(machine).constants if joints else ():
        if moves_arm(flow) and isinstance(flow.value, Struct):
            yield from _strangers(flow, flow.value.entries, joints, robot)


def _strangers(
    flow: Flow, entries: Iterable[tuple[str, Data]], joints: list[str], robot: Robot
) -> Iterator[Finding]:
    names = [name for name, _ in entries]
    strange = [name for name in names if name not in joints]
    if len(strange) == len(names):
        return  # these are no joints at all
    guess = guesser(joints)
    for name in strange:
        help = did_you_mean(guess(name)) or f"its joints are {', '.join(joints)}"
        yield at(flow, f"`{robot.name}` has no joint `{name}`", help)
