"""A gripper that is closed when the tool comes to a body, and sequences that are correct."""

from __future__ import annotations

import pytest

from smachac.checks.findings.help_text import names_apart
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

HEAD = """
name: sm
template: PyBulletBase
outcomes: [succeeded, aborted]
userdata: {a: [[0.5, 0.1, 0.1], [0, 0, 0, 1]], up: [[0, 0, 0.1], [0, 0, 0, 1]],
  home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
states:
"""

STEPS = {
    "open": "template: GripperState, command: open",
    "close": "template: GripperState, command: close",
    "left": "template: GripperState, command: close, limb: left",
    "to": "template: MoveAlongState, grasp: true, remapping: {pose: a}",
    "lift": "template: MoveAlongState, grasp: true, remapping: {pose: a, offset: up}",
    "touch": "template: MoveAlongState, remapping: {pose: a}",
    "home": "template: MoveToJointPositionsState, remapping: {positions: home}",
    "wait": "template: SleepState, time: 1",
    "check": "template: CheckGraspState",
    "own": "template: ScriptedState, outcomes: [succeeded, aborted, preempted]",
}


def reported(steps: str, **targets: str) -> list[str]:
    """The states of SM513 in a chain of steps, which are called S0, S1, ...; `targets` are the
    states or outcomes to which `aborted` of a state leads."""
    names = steps.split()
    text = HEAD
    for number, name in enumerate(names):
        following = f"S{number + 1}" if number + 1 < len(names) else "succeeded"
        aborted = targets.get(f"S{number}", "aborted")
        ends = f"succeeded: {following}, preempted: aborted"
        ends += f", aborted: {aborted}" if name != "wait" else ""
        text += f"  - S{number}: {{{STEPS[name]}, transitions: {{{ends}}}}}\n"
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    assert not [item for item in report if item.code < "SM1"]
    return [str(item.finding.node) for item in report if item.code == "SM513"]


@pytest.mark.parametrize(
    "steps",
    ["to close to close", "to close lift home to close", "close home wait to wait close"],
)
def test_the_gripper_is_not_opened_before_the_next_body(steps: str) -> None:
    count = len(steps.split())
    assert reported(steps) == [f"sm/S{count - 1}"]


@pytest.mark.parametrize(
    "steps",
    [
        "open to close lift",
        "to close open to close",
        "to close lift open home to close",
        "to close lift close",  # a firmer grip
        "to close wait close",
        "to close touch close",  # the pose is not that of a body
        "close home to open",  # a part that a person hands over, placed
        "to close own to close",  # the stand-in may open the gripper
        "to left to close",  # another gripper
        "to close",
    ],
)
def test_correct_sequences(steps: str) -> None:
    assert reported(steps) == []


def test_a_grasp_that_fails_decides_nothing() -> None:
    """After a failure of the first state that closes, the gripper may be open."""
    assert reported("to close to close", S1="S2") == []


def test_on_one_path_the_gripper_was_opened() -> None:
    assert reported("open to close to close", S0="S1") == ["sm/S4"]
    assert reported("own open to close", S0="S2") == []
    assert reported("to close to open to close", S2="S5") == []


@pytest.mark.parametrize(
    ("steps", "state"),
    [
        ("to close check to close", "sm/S4"),
        ("to close check to close lift", "sm/S4"),
        ("to close check to close home close open", "sm/S4"),
        ("to close check to close home to open", None),  # the body is only held more firmly
        ("to close check to close open lift", None),
        ("to close check to close own", None),  # the stand-in may open the gripper
    ],
)
def test_a_gripper_that_holds_a_body_is_closed_again(steps: str, state: str | None) -> None:
    assert reported(steps) == ([state] if state else [])


def test_the_gripper_is_opened_only_after_a_failure() -> None:
    """The second state that closes the gripper was meant to place the body."""
    assert reported("to close check to close lift", S4="S6", S5="S6") == ["sm/S4"]
    steps = "to close check to close wait"
    text = steps + " open"
    assert reported(text, S0="S6", S4="S6") == []


def test_names_of_states_that_are_equal() -> None:
    """Each gets so much of its path as tells it apart."""
    assert names_apart(("sm/PLACE/GRIP", "sm/PICK/GRIP", "sm/CHECK")) == [
        "PLACE/GRIP",
        "PICK/GRIP",
        "CHECK",
    ]
    assert names_apart(("sm/A/C/GRIP", "sm/B/C/GRIP")) == ["A/C/GRIP", "B/C/GRIP"]
    assert names_apart(("sm/GRIP", "sm/GRIP")) == ["GRIP", "GRIP"]
    assert names_apart(("sm/GRIP", "sm/A/GRIP")) == ["sm/GRIP", "A/GRIP"]


@pytest.mark.parametrize("name", ["LET_GO", "RELEASE_PART", "DROP", "OPEN_HAND"])
def test_a_state_named_after_opening_is_to_open(name: str) -> None:
    steps = {"TO": "to", "GRIP": "close", "LIFT": "lift", "DOWN": "to", name: "close"}
    following = [*steps][1:]
    text = HEAD
    for own, after in zip(steps, [*following, "succeeded"], strict=True):
        ends = f"{{succeeded: {after}, preempted: aborted, aborted: aborted}}"
        text += f"  - {own}: {{{STEPS[steps[own]]}, transitions: {ends}}}\n"

    def helps(text: str) -> list[tuple[str, str | None]]:
        report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
        return [(item.span.text, item.help) for item in report if item.code == "SM513"]

    assert helps(text) == [("close", f"write `command: open` in `{name}`")]
    ((place, help),) = helps(text.replace(name, "SQUEEZE"))
    assert place == "SQUEEZE"
    assert help is not None
    assert help.endswith("before `DOWN`")
