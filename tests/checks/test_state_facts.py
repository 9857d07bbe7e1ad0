"""Facts in the interface of a user's state type: the same findings as for a built-in one."""

from __future__ import annotations

import pytest

from smachac.analysis.context import Context
from smachac.checks.robot.workspace import poses_to_reach
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.ir.nodes import Leaf, Machine
from tests.support.typed_machines import BUILT_IN


def analysed(script: str, **interfaces: str) -> tuple[Machine, list[str]]:
    """The machine of a script with the user's interfaces, and the codes of its findings."""
    files = {
        f"templates/{name}.yml": f"name: {name}\n{text}" for name, text in interfaces.items()
    } | {f"templates/{name}.tpl.py": "" for name in interfaces}
    found = analyse(Source("main.yml", script), memory_library(files, BUILT_IN), [])
    assert found.machine is not None, [item.message for item in found.report]
    return found.machine, [item.code for item in found.report]


CALLS = """
name: sm
template: Base
outcomes: [done]
userdata: {{n: 1}}
states:
  - A:
      template: {type}
      input_keys: [n, unused]
      output_keys: [m, never]
      {variable}: {{m: 'lambda ud: ud.n + ud.other'}}
      transitions: {{succeeded: done}}
"""


def test_callbacks_of_a_user_s_type_are_checked_like_built_in_ones() -> None:
    _, built_in = analysed(CALLS.format(type="CallbacksState", variable="callbacks"))
    _, own = analysed(
        CALLS.format(type="Own", variable="handlers"),
        Own="variables: {handlers: {role: callbacks, default: {}}}\n"
        'input_keys: {"*": {role: argument}}\noutput_keys: {"*": {role: result}}\n'
        "outcomes: {succeeded: {}}\n",
    )
    assert own == built_in
    assert {"SM306", "SM310"} <= set(own)


CHOOSES = """
name: sm
template: Base
outcomes: [low, high]
userdata: {{level: 1}}
states:
  - A:
      template: {type}
      input_keys: [level]
      outcomes: [low, high]
      default_outcome: high
      {variable}: {{lwo: 'lambda ud: ud.level < 10'}}
"""


def test_conditions_of_a_user_s_type_are_for_its_outcomes() -> None:
    _, built_in = analysed(CHOOSES.format(type="ConditionalOutcomeState", variable="callbacks"))
    _, own = analysed(
        CHOOSES.format(type="Choose", variable="rules"),
        Choose="variables: {rules: {role: conditions}, default_outcome: {}}\n"
        'input_keys: {"*": {role: argument}}\noutcomes: {"*": {}}\n',
    )
    assert own == built_in
    assert "SM102" in own


MOVES = """
name: sm
template: {base}
outcomes: [done]
userdata: {{goal: {goal}}}
states:
  - A:
      template: {type}
      remapping: {{{key}: goal}}
      transitions: {{succeeded: done, aborted: done, preempted: done}}
"""
ENDS = "outcomes: {succeeded: {}, aborted: {}, preempted: {}}\nadds_frames: []\n"


@pytest.mark.parametrize(("role", "codes"), [("role: joint_positions", ["SM501"]), ("doc: x", [])])
def test_joint_positions_of_a_user_s_type_are_as_many_as_joints(
    role: str, codes: list[str]
) -> None:
    given = {"goal": "[0.0, 0.1]", "base": "PyBulletBase"}
    _, built_in = analysed(MOVES.format(type="MoveToJointPositionsState", key="positions", **given))
    assert built_in == ["SM501"]
    _, own = analysed(
        MOVES.format(type="Bend", key="angles", **given),
        Bend=f'input_keys: {{angles: {{type: "list[float<rad>]", {role}}}}}\n{ENDS}claims: [arm]\n',
    )
    assert own == codes


def test_goal_poses_of_a_user_s_type_are_reached() -> None:
    given = {"goal": "[[0.5, 0, 1.9], [1, 0, 0, 0]]", "base": "PyBulletBase"}
    machine, _ = analysed(
        MOVES.format(type="Reach", key="target", **given),
        Reach="variables: {from_above: {role: grasp, type: bool, default: false}}\n"
        f"input_keys: {{target: {{type: Pose, role: goal_pose}}}}\n{ENDS}",
    )
    (reach,) = poses_to_reach(Context(machine))
    assert reach.flow.cell.key == "target"
    assert not reach.grasp


LOADS = """
name: sm
template: {base}
outcomes: [done]
userdata: {{here: tabel}}
states:
  - LOAD: {{template: Load, part: table, transitions: {{succeeded: LOOK}}}}
  - LOOK:
      template: Look
      remapping: {{target: here}}
      transitions: {{succeeded: done}}
"""
LOAD = "variables: {part: {type: str}}\noutcomes: {succeeded: {}}\n"
LOOK = "input_keys: {target: {type: str%s}}\noutcomes: {succeeded: {}}\nadds_frames: []\n"
FRAME = LOOK % ", role: frame"


@pytest.mark.parametrize(
    ("base", "load", "look", "codes"),
    [
        ("PyBulletBase", f"{LOAD}adds_frames: [part]\n", FRAME, ["SM505"]),
        ("PyBulletBase", f"{LOAD}adds_frames: [part]\n", LOOK % "", []),
        ("PyBulletBase", LOAD, FRAME, []),
        ("Lab", f"{LOAD}adds_frames: [part]\n", FRAME, ["SM505"]),
    ],
)
def test_frames_of_a_user_s_type(base: str, load: str, look: str, codes: list[str]) -> None:
    lab = "kind: base\nsimulation: true\nvariables: {robot: {default: panda}}\n"
    _, own = analysed(LOADS.format(base=base), Load=load, Look=look, Lab=lab)
    assert [item for item in own if item == "SM505"] == codes


def test_a_stand_in_of_the_user_sets_the_keys_of_its_steps() -> None:
    script = """
name: sm
template: Base
outcomes: [done]
states:
  - A:
      template: {type}
      outcomes: [done]
      output_keys: [n]
      steps: [{{outcome: done, set: {{m: 1}}}}]
"""
    _, built_in = analysed(script.format(type="ScriptedState"))
    _, own = analysed(
        script.format(type="Draft"),
        Draft='variables: {steps: {role: steps, default: []}}\noutput_keys: {"*": {role: listed}}\n'
        'outcomes: {"*": {}}\nstand_in: true\n',
    )
    assert own == built_in
    assert "SM308" in own


def test_an_unknown_role_is_reported() -> None:
    script = MOVES.format(type="Reach", key="target", base="Base", goal="1")
    _, right = analysed(script, Reach=f"input_keys: {{target: {{role: goal_pose}}}}\n{ENDS}")
    _, wrong = analysed(script, Reach=f"input_keys: {{target: {{role: goal_psoe}}}}\n{ENDS}")
    assert (right, wrong) == ([], ["SM004"])


def test_a_user_s_type_with_the_name_of_a_built_in_one_is_not_taken_for_it() -> None:
    script = CHOOSES.format(type="ConditionalOutcomeState", variable="callbacks")
    machine, _ = analysed(
        script,
        ConditionalOutcomeState="variables: {callbacks: {}, default_outcome: {}}\n"
        'input_keys: {"*": {}}\noutcomes: {"*": {}}\n',
    )
    (leaf,) = machine.root.children
    assert isinstance(leaf, Leaf)
    assert (leaf.type, leaf.built_in) == ("ConditionalOutcomeState", "")
    assert run(machine, builtin_behaviour()).outcome == "low"  # the first one, by default


def test_the_interpreter_calls_callbacks_of_a_user_s_type() -> None:
    script = CALLS.replace("[n, unused]", "[n]").replace(" + ud.other", " + 1")
    script = script.replace("[m, never]", "[m]").format(type="Own", variable="handlers")
    script = script.replace("transitions: {succeeded: done}", "transitions: {succeeded: B}")
    script += (
        "  - B:\n      template: ConditionalOutcomeState\n      input_keys: [m]\n"
        "      outcomes: [done, wrong]\n      default_outcome: wrong\n"
        "      callbacks: {done: 'lambda ud: ud.m == 2'}\n"
    )
    script = script.replace("outcomes: [done]", "outcomes: [done, wrong]", 1)
    machine, _ = analysed(
        script,
        Own="variables: {handlers: {role: callbacks, default: {}}}\n"
        'input_keys: {"*": {role: argument}}\noutput_keys: {"*": {role: result}}\n'
        "outcomes: {succeeded: {}}\n",
    )
    assert run(machine, builtin_behaviour()).outcome == "done"
