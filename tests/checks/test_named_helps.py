"""Help lines that name the text to write, with the names and values of the script."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed


def helps(text: str, code: str, **files: str) -> list[str]:
    report = analysed({"main.yml": text, **files}).report
    return [each.help or "" for each in report if each.code == code]


PATH = """
name: sm
outcomes: [done]
PROPERTY
states:
  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: B}}
  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: C}}
  - C: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("{before: {A: B}}", "before: {B: A}"),
        ("{never: {after: B, until: A, enter: C}}", "after: A, until: B"),
        ("{never: {after: A, until: [], enter: C}}", None),
        ("{never: {enter: C}}", None),
        ("{after: {C: A}}", None),
    ],
)
def test_a_property_with_two_names_swapped(written: str, meant: str | None) -> None:
    found = helps(PATH.replace("PROPERTY", f"properties: [{written}]"), "SM701")
    ends = (
        ""
        if meant is None
        else f"write `{meant}`: with it the property holds; are the two names swapped?"
    )
    assert all((ends in each) if ends else ("swapped" not in each) for each in found)
    assert found or meant is None


LIMBS = """
name: sm
template: PyBulletBase
robot: ROBOT
outcomes: [succeeded, aborted]
states:
  - BOTH:
      template: Concurrence
      outcomes: [succeeded, aborted]
      default_outcome: aborted
      outcome_map: {succeeded: {ONE: succeeded, TWO: succeeded}}
      transitions: {succeeded: succeeded, aborted: aborted}
      states:
        - ONE: {template: GripperState, command: open, limb: left}
        - TWO: {template: GripperState, command: open, limb: left}
"""


def test_another_limb_is_free() -> None:
    (found,) = helps(LIMBS.replace("ROBOT", "baxter"), "SM406")
    assert found.startswith("write `right` in place of `left`, or put `ONE` and `TWO` into one")
    (found,) = helps(LIMBS.replace("ROBOT", "panda"), "SM406")
    assert "arm" in found or found.endswith("another `limb`")


PARTS = """
name: sm
template: PyBulletBase
robot: baxter
outcomes: [succeeded, aborted]
userdata: {home: [0, 0, 0, 0, 0, 0, 0]}
states:
  - BOTH:
      template: Concurrence
      outcomes: [succeeded, aborted]
      input_keys: [home]
      default_outcome: aborted
      outcome_map: {succeeded: {ONE: succeeded, TWO: succeeded}}
      transitions: {succeeded: succeeded, aborted: aborted}
      states:
        - ONE: {script: move, params: {limb: left}}
        - TWO: {script: move, params: {limb: left}}
"""
MOVE = """
- MOVE:
    template: StateMachine
    outcomes: [succeeded, aborted]
    input_keys: [home]
    states:
      - OPEN:
          template: GripperState
          command: open
          limb: [params, limb]
          transitions: {succeeded: GO, aborted: aborted, preempted: aborted}
      - GO:
          template: MoveToJointPositionsState
          limb: [params, limb]
          remapping: {positions: home}
          transitions: {succeeded: succeeded, aborted: aborted, preempted: aborted}
"""


def test_one_param_of_a_call_chooses_two_resources() -> None:
    report = analysed({"main.yml": PARTS, "move.yml": MOVE}).report
    (found,) = [each for each in report if each.code == "SM406"]
    assert (found.span.line, found.span.text) == (17, "left")
    assert "claim `arm.left` and `gripper.left` at the same time" in found.message
    assert (found.help or "").startswith("write `right` in place of `left`, or put")


POSE = """
name: sm
template: PyBulletBase
outcomes: [done]
userdata: {goal: VALUE}
states:
  - PUT:
      template: MoveAlongState
      remapping: {pose: goal}
      transitions: {succeeded: done, aborted: done, preempted: done}
"""


def test_a_rotation_with_three_numbers() -> None:
    text = POSE.replace("VALUE", "[[0.5, 0.0, 0.1], [0.0, 0.0, 1.57]]")
    report = analysed({"main.yml": text}).report
    (found,) = [each.message for each in report if each.code == "SM501"]
    start = "the rotation in `goal` has 3 numbers, but a `Pose` needs 4 (a quaternion)"
    assert found.startswith(start)


def test_a_point_in_millimetres() -> None:
    (found,) = helps(POSE.replace("VALUE", "[[500, -200, 25], [0, 0, 0, 1]]"), "SM522")
    assert found == "if it is in millimetres, write the point as `[0.5, -0.2, 0.025]`"
    (found,) = helps(POSE.replace("VALUE", "[[500, 0.2, 25], [0, 0, 0, 1]]"), "SM522")
    assert found == "if it is in millimetres, write 0.5"


READER = """
name: sm
template: ROSBase
outcomes: [done]
userdata: {piece: 1, arm_frame: base_link}
states:
  - TO_ARM:
      template: TransformMsgState
      timeout: 2.0
      input_keys: [msg]
      output_keys: [output_msg]
      remapping: {msg: piece}
      transitions: {succeeded: done, aborted: done, preempted: done}
"""


def test_an_unread_key_that_a_state_can_read() -> None:
    (found, *_) = helps(READER, "SM305")
    assert found.startswith("`TO_ARM` can read it as `frame_id`: write `remapping: {frame_id:")
    (found, *_) = helps(READER.replace("arm_frame", "colour"), "SM305")
    assert found.startswith("remove `colour`")


def test_a_type_in_braces_without_quotes() -> None:
    text = POSE.replace("goal: VALUE", "ready: {type: list[float<rad>], value: [0]}")
    assert helps(text, "SM001") == ['put the type in quotes: `type: "list[float<rad>]"`']


QOS = """
name: sm
template: ROSBase
outcomes: [done]
userdata: {topic: /a}
states:
  - READ:
      template: ReadTopicState
      timeout: 2.0
      qos: VALUE
      input_keys: [topic]
      output_keys: [msg]
      transitions: {succeeded: done, aborted: done, preempted: done}
"""


@pytest.mark.parametrize(
    ("value", "policy"),
    [("transient_local", "durability"), ("best_effort", "reliability"), ("keep_last", "history")],
)
def test_a_policy_in_place_of_a_preset(value: str, policy: str) -> None:
    (found,) = helps(QOS.replace("VALUE", value), "SM004")
    assert found == f"`{value}` is a value of `{policy}`: write `{{{policy}: {value}}}`"
    assert helps(QOS.replace("VALUE", f"{{{policy}: {value}}}"), "SM004") == []


LIGHTS = """
name: sm
template: Base
outcomes: [succeeded, aborted]
properties:
  - after: {LIT: DARK}
states:
  - LIT: {template: ScriptedState, outcomes: [done, slip], transitions: {done: DARK, slip: OTHER}}
  - DARK: {template: SleepState, time: 1.0, transitions: {succeeded: succeeded}}
  - OTHER: {template: KIND, transitions: {succeeded: aborted}}
"""


@pytest.mark.parametrize(
    ("kind", "place", "start"),
    [
        ("SleepState, time: 2.0", "after", "write `slip: DARK` in `LIT`"),
        (
            "SleepState, time: 1.0",
            "DARK",
            "`OTHER`, a `SleepState` too, has the same variables: write `[DARK, OTHER]`\n",
        ),
        ("PrintUserdataState, input_keys: []", "after", "write `slip: DARK` in `LIT`"),
    ],
)
def test_an_answer_without_another_state_of_its_type(kind: str, place: str, start: str) -> None:
    report = analysed({"main.yml": LIGHTS.replace("KIND", kind)}).report
    (found,) = [each for each in report if each.code == "SM701"]
    assert found.span.text == place
    assert (found.help or "").startswith(start)


def test_properties_without_dashes() -> None:
    text = LIGHTS.replace("  - after: {LIT: DARK}", "  after: {LIT: DARK}\n  at_most: {LIT: 3}")
    report = analysed({"main.yml": text.replace("KIND", "SleepState, time: 1.0")}).report
    (found,) = [each for each in report if each.code == "SM004"]
    assert found.help == "begin each property with a dash: `- after: {LIT: DARK}`"
