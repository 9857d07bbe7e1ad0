"""Speeds against the limits of joints, and frames of poses against those that states expect."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

MOVE = """
name: sm
template: PyBulletBase
outcomes: [done, failed]
{head}
userdata: {{home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}}
states:
  - MOVE:
      template: MoveToJointPositionsState
      {speed}
      remapping: {{positions: home}}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""

TURN = "variables: {speed: {type: float<rad/s>, role: joint_speed}}\noutcomes: {succeeded: {}}\n"

ARM = """<robot name="arm"><link name="a"/><link name="b"/><link name="c"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/>
<limit lower="-1" upper="1" effort="1" velocity="{one}"/></joint>
<joint name="two" type="continuous"><parent link="b"/><child link="c"/>{two}</joint></robot>"""


def faults(script: str, code: str, **files: str) -> list[tuple[str, str]]:
    """The marked text and the message of each finding with a code. `files`: interfaces, and
    `arm` for arm.urdf."""
    given = {"arm.urdf": files.pop("arm", "")}
    for name, text in files.items():
        given[f"templates/{name}.yml"] = f"name: {name}\n{text}"
        given[f"templates/{name}.tpl.py"] = ""
    report = analyse(Source("main.yml", script), memory_library(given, BUILT_IN), []).report
    assert not [item for item in report if item.code in ("SM003", "SM004", "SM005", "SM018")]
    found = [item for item in report if item.code == code]
    return [(item.span.text, item.finding.message) for item in found]


@pytest.mark.parametrize(
    ("speed", "wrong"),
    [("speed: 2.7", True), ("speed: 2.6", False), ("speed: 1", False), ("", False)],
)
def test_the_built_in_arm_has_speed_limits(speed: str, wrong: bool) -> None:
    found = faults(MOVE.format(head="robot: panda", speed=speed), "SM510")
    assert found == (
        [("2.7", "`speed` is 2.7 rad/s, but no joint of `panda` is faster than 2.61 rad/s")]
        if wrong
        else []
    )


def test_the_fastest_joint_counts() -> None:
    (found,) = faults(MOVE.format(head="robot: baxter", speed="speed: 99.0"), "SM510")
    assert found == ("99.0", "`speed` is 99 rad/s, but no joint of `baxter` is faster than 4 rad/s")


@pytest.mark.parametrize(
    ("one", "two", "wrong"),
    [
        ("2", '<limit velocity="3"/>', True),
        ("2", '<limit velocity="5"/>', False),
        ("2", "", False),
        ("2", '<limit velocity="0"/>', False),
        ("7", '<limit velocity="3"/>', False),
    ],
)
def test_the_fastest_joint_of_a_description_counts(one: str, two: str, wrong: bool) -> None:
    script = """
name: sm
template: Base
robot: arm.urdf
outcomes: [done]
states:
  - TURN: {template: Turn, speed: 4.0, transitions: {succeeded: done}}
"""
    found = faults(script, "SM510", Turn=TURN, arm=ARM.format(one=one, two=two))
    assert [text for text, _ in found] == (["4.0"] if wrong else [])


DETECT = "output_keys: {pose: {type: Pose, frame: camera}}\noutcomes: {succeeded: {}, none: {}}\n"
TRANSFORM = (
    "input_keys: {pose: {type: Pose, frame: camera}}\n"
    "output_keys: {moved: {type: Pose, frame: base_link}}\noutcomes: {succeeded: {}}\n"
)
GO = "input_keys: {goal: {type: Pose, frame: /base_link}}\noutcomes: {succeeded: {}}\n"
LOOK_AND_GO = """
name: sm
template: Base
outcomes: [done]
states:
  - LOOK:
      template: Detect
      remapping: {{pose: target}}
      transitions: {{succeeded: {next}, none: {other}}}
  - CHANGE:
      template: Transform
      remapping: {{pose: target, moved: {moved}}}
      transitions: {{succeeded: GO}}
  - GO: {{template: GoTo, remapping: {{goal: {goal}}}, transitions: {{succeeded: done}}}}
"""


@pytest.mark.parametrize(
    ("next", "other", "moved", "goal", "wrong"),
    [
        ("CHANGE", "done", "target", "target", False),  # the same key, overwritten
        ("CHANGE", "done", "moved", "moved", False),
        ("CHANGE", "done", "moved", "target", True),
        ("GO", "CHANGE", "target", "target", True),  # on one of two paths
    ],
)
def test_a_pose_in_the_frame_of_its_last_writer(
    next: str, other: str, moved: str, goal: str, wrong: bool
) -> None:
    script = LOOK_AND_GO.format(next=next, other=other, moved=moved, goal=goal)
    found = faults(script, "SM511", Detect=DETECT, Transform=TRANSFORM, GoTo=GO)
    message = "`GO` reads `target` as a pose in the frame `/base_link`, but it is given in `camera`"
    assert [text for _, text in found] == ([message] if wrong else [])


@pytest.mark.parametrize(("frame", "wrong"), [("base_link", False), ("camera", True)])
def test_the_frame_of_a_pose_in_the_userdata(frame: str, wrong: bool) -> None:
    script = f"""
name: sm
template: Base
outcomes: [done]
userdata:
  goal: {{header: {{frame_id: {frame}}}, pose: {{}}}}
states:
  - GO: {{template: GoTo, transitions: {{succeeded: done}}}}
"""
    go = GO.replace("Pose", "PoseStamped")
    assert bool(faults(script, "SM511", GoTo=go)) == wrong


def test_a_key_without_a_frame_is_not_judged() -> None:
    script = LOOK_AND_GO.format(next="GO", other="done", moved="moved", goal="target")
    plain = DETECT.replace(", frame: camera", "")
    assert faults(script, "SM511", Detect=plain, Transform=TRANSFORM, GoTo=GO) == []
