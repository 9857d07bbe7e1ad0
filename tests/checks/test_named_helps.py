"""Help lines that name the text to write, with the names and values of the script."""

from __future__ import annotations

import pytest

from smachac.diagnostics.repair import edited_texts
from smachac.repair.search import again, clusters
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed


def helps(text: str, code: str, **files: str) -> list[str]:
    report = analysed({"main.yml": text, **files}).report
    return [item.help or "" for item in report if item.code == code]


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
        ("{before: {A: B}}", "{before: {B: A}}"),
        ("{never: {after: B, until: A, enter: C}}", "{never: {after: A, until: B, enter: C}}"),
        ("{never: {enter: C}}", None),
    ],
)
def test_a_property_with_two_names_swapped(written: str, meant: str | None) -> None:
    text = PATH.replace("PROPERTY", f"properties: [{written}]")
    analysis = analysed({"main.yml": text})
    repairs = [cluster.repair for cluster in clusters(analysis, analysis.report, again(analysis))]
    right = [*edited_texts(repairs[0].edits).values()] if repairs else []
    assert right == ([text.replace(written, meant)] if meant is not None else [])


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
    (found,) = [item for item in report if item.code == "SM406"]
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
    (found,) = [item.message for item in report if item.code == "SM501"]
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


def test_an_unread_key() -> None:
    (found, *_) = helps(READER, "SM305")
    assert found.startswith("remove `arm_frame`")


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
        ("PrintUserdataState, input_keys: []", "after", "write `slip: DARK` in `LIT`"),
    ],
)
def test_an_answer_without_another_state_of_its_type(kind: str, place: str, start: str) -> None:
    report = analysed({"main.yml": LIGHTS.replace("KIND", kind)}).report
    (found,) = [item for item in report if item.code == "SM701"]
    assert found.span.text == place
    assert (found.help or "").startswith(start)


def test_properties_without_dashes() -> None:
    text = LIGHTS.replace("  - after: {LIT: DARK}", "  after: {LIT: DARK}\n  at_most: {LIT: 3}")
    report = analysed({"main.yml": text.replace("KIND", "SleepState, time: 1.0")}).report
    (found,) = [item for item in report if item.code == "SM004"]
    assert found.help == "begin each property with a dash: `- after: {LIT: DARK}`"


GRIPS = """
name: sm
template: PyBulletBase
outcomes: [done, failed]
PROPERTY
userdata: {up: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
states:
  - CLOSE:
      template: GripperState
      command: close
      transitions: {succeeded: GO, aborted: LET_GO, preempted: failed}
  - GO:
      template: MoveToJointPositionsState
      remapping: {positions: up}
      transitions: {succeeded: RELEASE, aborted: failed, preempted: failed}
  - RELEASE:
      template: GripperState
      command: open
      transitions: {succeeded: HOME, aborted: failed, preempted: failed}
  - LET_GO:
      template: GripperState
      command: open
      transitions: {succeeded: HOME, aborted: failed, preempted: failed}
  - HOME:
      template: MoveToJointPositionsState
      remapping: {positions: up}
      transitions: {succeeded: done, aborted: failed, preempted: failed}
"""


def test_the_retry_is_one_of_a_failure() -> None:
    rule = "properties: [always_ends]"
    text = GRIPS.replace("PROPERTY", rule).replace(
        "succeeded: RELEASE, aborted: failed", "succeeded: RELEASE, aborted: CLOSE"
    )
    (found,) = helps(text, "SM701")
    assert "in `GO`: write `retry: {on: [aborted], max: 3}`" in found


WAIT = """
name: sm
template: Base
outcomes: [done]
userdata: {wait: {type: "float<UNIT>", value: 3000}}
states:
  - WAIT:
      template: SleepState
      time: "`lambda ud: CODE`"
      input_keys: [wait]
      transitions: {succeeded: done, preempted: done}
"""


@pytest.mark.parametrize(
    ("unit", "code", "help"),
    [
        ("ms", "ud.wait", "write `ud.wait * 0.001`"),
        ("ms", "ud.wait + 5", "write `(ud.wait + 5) * 0.001`"),
        ("s", "ud.wait", None),
        ("ms", "ud.wait / 1000.0 if ud.wait else 1", None),
        ("ms", "ud.wait * 0.001", None),
        ("ms", "(ud.wait + 5) * 0.001", None),
    ],
)
def test_the_result_of_a_function_has_the_unit_of_the_variable(
    unit: str, code: str, help: str | None
) -> None:
    found = helps(WAIT.replace("UNIT", unit).replace("CODE", code), "SM504")
    assert found == ([help] if help else [])


TURN = """
name: sm
template: Base
outcomes: [done]
TYPES
userdata: VALUE
states:
  - LOOK:
      template: ScriptedState
      input_keys: {parts: "list[Part]"}
      outcomes: [done]
      transitions: {done: done}
"""


def test_a_rotation_in_an_item_of_a_list() -> None:
    text = TURN.replace("TYPES", "types: {Part: {id: int, at: Pose}}")
    text = text.replace("VALUE", "{parts: [{id: 1, at: [[0, 0, 0], [0, 0, 1]]}]}")
    report = analysed({"main.yml": text}).report
    (found,) = [item for item in report if item.code == "SM501"]
    assert found.message.startswith("the rotation in `at` of the first item of `parts` has 3")
    assert found.span.text == "[0, 0, 1]"


FORCE = """
name: sm
template: Base
outcomes: [done]
params: {seconds: 2.0}
states:
  - WAIT:
      template: SleepState
      time: seconds
      transitions: {succeeded: done, preempted: done}
"""


def test_a_param_as_a_text() -> None:
    report = analysed({"main.yml": FORCE}).report
    assert [item.code for item in report] == ["SM306", "SM304"]
    items, repair = shown(analysed({"main.yml": FORCE}))
    assert len(items) == 1
    assert repair is not None
    assert [edit.text for edit in repair.edits] == ["[params, seconds]"]


CALLS = """
name: sm
template: Base
outcomes: [done, failed]
states:
  - ONE: {script: part, transitions: {done: BOTH}}
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      default_outcome: failed
      outcome_map: {done: {L: done, R: done}}
      states:
        - L: {script: part}
        - R: {script: part}
      transitions: {done: done, failed: failed}
"""
PART = """
- PART:
    template: StateMachine
    outcomes: [done, failed]
    transitions: {failed: failed}
    states:
      - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: done, bad: failed}}
"""


def test_a_transition_of_a_sub_script_that_one_call_needs() -> None:
    assert helps(CALLS, "SM101", **{"part.yml": PART}) == []
    alone = CALLS.replace("  - ONE: {script: part, transitions: {done: BOTH}}\n", "")
    assert helps(alone, "SM101", **{"part.yml": PART})


def test_a_key_in_place_of_the_value_of_an_input_key() -> None:
    text = """
name: sm
template: PyBulletBase
robot: panda
outcomes: [succeeded, aborted, preempted]
userdata: {home: [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785]}
states:
  - GO: {template: MoveToJointPositionsState, positions: home}
"""
    found = [(item.code, item.help) for item in analysed({"main.yml": text}).report
             if item.severity.value != "info"]  # fmt: skip
    help = "`positions` is an input key: write `remapping: {positions: home}`"
    assert ("SM003", help) in found
    assert all(code != "SM301" for code, _ in found)
