"""Rules over motions of a robot: speeds, and the frames of poses."""

from __future__ import annotations

import math
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.analysis.reaching_values import Read, last_writers
from smachac.analysis.uses import place_of
from smachac.checks.findings.help_text import calls, other_place
from smachac.checks.findings.literals import literal_finding
from smachac.checks.robot.literal_parts import as_float, frame_of, role_of
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.ir.graph import START
from smachac.ir.nodes import Key, Leaf, Node, is_number
from smachac.ir.traversal import outer_inputs, outputs_to


@rule(
    "SM510",
    "too-fast",
    Severity.WARNING,
    effect="the driver of the arm refuses the motion, or the arm is slower than the script assumes",
)
def too_fast(context: Context) -> Iterator[Finding]:
    """A speed is larger than the speed limit of every joint of the robot.

    The driver of the arm refuses the motion, or the arm moves slower than the script assumes and a
    time limit ends it.

    Exactly: the limits are those of the robot that `robot:` names; of a URDF file they are the
    attribute `velocity` of `<limit>`. The rule checks the literals of variables with
    `role: joint_speed`, which is the speed of the fastest joint.

    Wrong:
        name: sm
        template: PyBulletBase
        robot: panda
        outcomes: [done, failed]
        userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
        states:
          - MOVE:
              template: MoveToJointPositionsState
              speed: 5.0
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
              speed: 1.5
              remapping: {positions: home}
              transitions: {succeeded: done, aborted: failed, preempted: failed}
    """
    robot = context.machine.robot
    joints = robot.joints if robot is not None else ()
    speeds = [joint.velocity for joint in joints if joint.turns]
    most = max(speeds, default=math.inf)
    for flow in context.types.constants if math.isfinite(most) else ():
        if role_of(flow.cell) != "joint_speed" or not is_number(flow.value):
            continue
        speed = as_float(flow.value)
        if speed > most:
            assert robot is not None
            message = f"`{flow.origin.cell.key}` is {speed:g} rad/s, but no joint of"
            message += f" `{robot.name}` is faster than {most:g} rad/s"
            yield literal_finding(flow, message, f"write a speed of at most {most:g} rad/s")


@rule(
    "SM511",
    "wrong-frame",
    Severity.WARNING,
    effect="nothing transforms the pose: the robot moves to a place measured from the wrong frame",
)
def wrong_frame(context: Context) -> Iterator[Finding]:
    """A pose is given in one frame and read in another.

    The hand moves to a place that is measured from the wrong frame: beside the body, or into the
    table.

    Exactly: interfaces state the frame of the poses of a key with `frame:`. The rule compares the
    key that a state reads with the states that can be the last to write it, in the same container,
    and with a PoseStamped in its userdata.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK: {template: Detect, transitions: {succeeded: GO}}
          - GO: {template: GoTo, transitions: {succeeded: done}}
        == templates/Detect.yml ==
        name: Detect
        output_keys: {pose: {type: Pose, frame: camera}}
        outcomes: {succeeded: {}}
        code: {python: "cell.states:Detect"}
        == templates/GoTo.yml ==
        name: GoTo
        input_keys: {pose: {type: Pose, frame: base_link}}
        outcomes: {succeeded: {}}
        code: {python: "cell.states:GoTo"}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - LOOK: {template: Detect, transitions: {succeeded: GO}}
          - GO: {template: GoTo, transitions: {succeeded: done}}
        == templates/Detect.yml ==
        name: Detect
        output_keys: {pose: {type: Pose, frame: base_link}}
        outcomes: {succeeded: {}}
        code: {python: "cell.states:Detect"}
        == templates/GoTo.yml ==
        name: GoTo
        input_keys: {pose: {type: Pose, frame: base_link}}
        outcomes: {succeeded: {}}
        code: {python: "cell.states:GoTo"}
    """
    framed: dict[Read, tuple[Leaf, Key]] = {}
    for path, container in context.linear:
        for child in container.children:
            if isinstance(child, Leaf) and any(key.frame for key in child.inputs):
                for key, outer in zip(child.inputs, outer_inputs(child), strict=True):
                    if key.frame:
                        framed[Read(path, container, outer, child.name)] = child, key
    for read, sources in last_writers(framed):
        child, key = framed[read]
        writers = {child.name: child for child in read.container.children}
        for source in sources:
            is_start = source == START
            given = _preset(read) if is_start else _output(writers[str(source)], read.key)
            if given is not None and _bare(given[0]) != _bare(key.frame):
                yield _wrong_frame(read, child, key, *given)


def _wrong_frame(read: Read, child: Leaf, key: Key, frame: str, span: Span) -> Finding:
    place = place_of(child, key)
    related: tuple[Related, ...] = other_place(span, f"the pose is given in `{frame}` here")
    return Finding(
        span=child.span if place.source is not child.span.source else place,
        message=f"`{child.name}` reads `{read.key}` as a pose in the frame `{key.frame}`, but it is"
        f" given in `{frame}`",
        arguments=(key.name, frame, key.frame),
        help=f"add a state before `{child.name}` that transforms the pose from `{frame}` to"
        f" `{key.frame}`, or correct the frame of one of the two",
        related=(*related, *calls(child, child.span)),
        node=f"{read.path}/{child.name}",
    )


def _preset(read: Read) -> tuple[str, Span] | None:
    """The frame of a pose that the container presets, and its place."""
    for preset in read.container.userdata:
        if preset.key == read.key and (frame := frame_of(preset.value.data)):
            return frame, preset.span
    return None


def _output(node: Node, key: str) -> tuple[str, Span] | None:
    """The frame of the poses that a state writes to a key of its container, and its place."""
    for output in outputs_to(node, key) if isinstance(node, Leaf) else ():
        if output.frame:
            return output.frame, node.span
    return None


def _bare(frame: str) -> str:
    """A frame without the slash with which tf of ROS 1 began its names."""
    return frame.removeprefix("/")
