"""A check of a grasp that never succeeds, and sequences that are correct."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

HEAD = """
name: sm
template: PyBulletBase
robot: baxter
outcomes: [succeeded, aborted]
userdata: {a: [[0.5, 0.1, 0.1], [0, 0, 0, 1]]}
states:
"""

STEPS = {
    "open": "template: GripperState, command: open, limb: left",
    "close": "template: GripperState, command: close, limb: left",
    "shut": "template: GripperInterfaceState, command: close, limb: left",
    "right": "template: GripperState, command: close, limb: right",
    "open_right": "template: GripperState, command: open, limb: right",
    "any": "template: GripperState, command: close, limb: '`str(7)`'",
    "to": "template: MoveAlongState, grasp: true, limb: left, remapping: {pose: a}",
    "check": "template: CheckGraspState, limb: left",
    "wait": "template: SleepState, time: 1",
    "own": "template: ScriptedState, outcomes: [succeeded, aborted, preempted]",
}


def reported(steps: str, base: str = "PyBulletBase", **targets: str) -> list[tuple[str, str]]:
    """The states of SM516 and what is marked, in a chain of steps S0, S1, ...; `targets` are the
    targets of outcomes, such as `S3_aborted`."""
    names = steps.split()
    text = HEAD.replace("PyBulletBase", base)
    for number, name in enumerate(names):
        following = f"S{number + 1}" if number + 1 < len(names) else "succeeded"
        ends = {"succeeded": following, "preempted": "aborted", "aborted": "aborted"}
        ends |= {end: targets.get(f"S{number}_{end}", target) for end, target in ends.items()}
        gone = {"wait": ("aborted",), "check": ("preempted",)}.get(name, ())
        inner = ", ".join(f"{end}: {target}" for end, target in ends.items() if end not in gone)
        text += f"  - S{number}: {{{STEPS[name]}, transitions: {{{inner}}}}}\n"
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    assert not [item for item in report if item.code < "SM1"]
    return [(str(item.finding.node), item.span.text) for item in report if item.code == "SM516"]


@pytest.mark.parametrize("steps", ["open to open check", "open to open to wait check"])
def test_the_gripper_is_opened_in_place_of_closed(steps: str) -> None:
    assert reported(steps) == [("sm/S2", "open")]


@pytest.mark.parametrize("steps", ["open to right check", "to right to check"])
def test_the_gripper_of_another_limb_is_closed(steps: str) -> None:
    number = steps.split().index("right")
    assert reported(steps) == [(f"sm/S{number}", "right")]


@pytest.mark.parametrize(
    "steps",
    [
        "open to close check",
        "open to shut check",
        "open open to check",  # no word is certainly wrong
        "open to check",
        "check",
        "to close to open check",  # the gripper has to be empty
        "open to any check",
        "open to own open check",
        "open to open own check",
        "open_right to right check",  # both grippers are used
    ],
)
def test_correct_sequences(steps: str) -> None:
    assert reported(steps) == []


@pytest.mark.parametrize(
    ("steps", "state"),
    [
        ("open to open", "sm/S2"),
        ("open to open wait to open", "sm/S2"),
        ("open to close to open", None),
        ("open wait open", None),  # no tool comes to a body
        ("open to right to open", None),
        ("to open", None),
        ("open to own open", None),
        ("open to any open", None),
    ],
)
def test_no_state_closes_the_gripper(steps: str, state: str | None) -> None:
    assert reported(steps) == ([(state, "open")] if state else [])


def test_the_gripper_is_opened_again_after_a_failure() -> None:
    assert reported("open to open", S1_aborted="S0") == [("sm/S2", "open")]
    assert reported("open to open", S0_aborted="S1") == []


def test_a_check_that_the_gripper_is_empty() -> None:
    targets = {"S3_succeeded": "aborted", "S3_aborted": "succeeded"}
    assert reported("open to open check", **targets) == []


def test_a_path_on_which_the_gripper_is_closed() -> None:
    """The second try comes to the check with a closed gripper."""
    assert reported("open to open check close", S4_succeeded="S3") == []


def test_a_machine_outside_of_the_simulation() -> None:
    assert reported("open to open check", base="Base") == []


BESIDE = """\
  - OPEN: {template: GripperState, command: open, limb: left,
      transitions: {succeeded: TO, aborted: aborted, preempted: aborted}}
  - TO: {template: MoveAlongState, grasp: true, limb: left, remapping: {pose: a},
      transitions: {succeeded: AGAIN, aborted: aborted, preempted: aborted}}
  - AGAIN: {template: GripperState, command: open, limb: left,
      transitions: {succeeded: BOTH, aborted: aborted, preempted: aborted}}
  - BOTH:
      template: Concurrence
      outcomes: [succeeded, aborted]
      default_outcome: aborted
      outcome_map: {succeeded: {CHECK: succeeded}}
      transitions: {succeeded: succeeded, aborted: aborted}
      states:
        - CHECK: {template: CheckGraspState, limb: left}
        - BESIDE: {template: GripperState, command: close, limb: LIMB}
"""


@pytest.mark.parametrize(("limb", "expected"), [("left", []), ("right", ["SM516"])])
def test_a_branch_beside_the_check(limb: str, expected: list[str]) -> None:
    text = HEAD + BESIDE.replace("LIMB", limb)
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    assert [item.code for item in report if item.code == "SM516"] == expected
