"""Helps for slips of people: they name what is meant where it is certain, and choose nothing where
it is not."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

Files = dict[str, str]


def helps(files: Files, code: str) -> list[str | None]:
    return [help for found, _, help in reported(files) if found == code]


# --- a success never leads to a failure

LOCALISE = """\
name: sm
outcomes: [arrived, aborted]
states:
  - GO:
      template: ScriptedState
      outcomes: [there, lost]
      transitions: {there: CHECK, lost: FIND}
  - FIND:
      template: ScriptedState
      outcomes: [found_it, failed]
      transitions: {failed: aborted}
  - CHECK:
      template: ScriptedState
      outcomes: [closed]
      transitions: {closed: arrived}
"""


@pytest.mark.parametrize(
    ("old", "new", "help"),
    [
        ("", "", "add `found_it: CHECK` to the transitions of `FIND`"),
        ("{failed: aborted}", "{exhausted: aborted, preempted: aborted}\n"
                              "      retry: {on: [failed], max: 3}",
         "add `found_it: CHECK` to the transitions of `FIND`"),
        ("there: CHECK", "there: arrived", "add `found_it: CHECK` to the transitions of `FIND`"),
        ("outcomes: [found_it, failed]\n      transitions: {failed: aborted}",
         "outcomes: [found_it, failed]\n      transitions: {found_it: CHECK}",
         "add `failed: aborted` to the transitions of `FIND`"),
    ],
)  # fmt: skip
def test_the_target_of_a_forgotten_success(old: str, new: str, help: str) -> None:
    script = LOCALISE.replace(old, new) if old else LOCALISE
    assert helps({"main.yml": script}, "SM104") == [help]


# --- keys

LOOP = """\
name: sm
outcomes: [done]
userdata: {size: 2, orders: [a, b], label: x}
states:
  - ALL:
      template: Iterator
      outcomes: [done]
      input_keys: [orders, size, label]
      it: size
      it_label: order
      exhausted_outcome: done
      loop_outcomes: [served]
      states:
        - SERVE:
            template: ScriptedState
            outcomes: [served]
            input_keys: [order, size, label]
      transitions: {done: done}
"""


@pytest.mark.parametrize(
    ("old", "new", "help"),
    [
        ("", "", "did you mean `orders`, the only list here?"),
        ("label: x", "label: [x]", "write a list for `size`, such as `[1, 2, 3]`"),
        ("orders: [a, b]", "orders: a", "write a list for `size`, such as `[1, 2, 3]`"),
    ],
)
def test_the_only_list_of_a_loop(old: str, new: str, help: str) -> None:
    script = LOOP.replace(old, new, 1) if old else LOOP
    assert help in helps({"main.yml": script}, "SM304")


CSV = """\
name: sm
template: ROSBase
outcomes: [logged, aborted]
userdata: {file: a.csv, columns: [force, torque], force: 0.0, torque: 0.0}
states:
  - WRITE:
      template: WriteCSVFileState
      input_keys: [file, data_keys, force, torque]
      remapping: {data_keys: columns}
      transitions: {succeeded: logged, aborted: aborted}
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("", "", []),
        ("[force, torque]", "[force, torques]", ["did you mean `torque`?"]),
        (", force, torque]\n", ", force]\n",
         ["write `input_keys: [file, data_keys, force, torque]` in `WRITE`"]),
        ("[force, torque]", "[file, force, torque, width]",
         ["write `input_keys: [file, data_keys, force, torque, width]` in `WRITE`"]),
    ],
)  # fmt: skip
def test_the_names_in_a_list_of_keys(old: str, new: str, found: list[str]) -> None:
    script = CSV.replace(old, new) if old else CSV
    assert helps({"main.yml": script}, "SM310") == found


@pytest.mark.parametrize(
    ("given", "found"),
    [("[message]", []), ("message", ["write it as `[message]`"]),
     ("success", ["write it as `[success]`"])],
)  # fmt: skip
def test_one_name_is_no_list_of_keys(given: str, found: list[str]) -> None:
    script = f"""\
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - CALL:
      template: ServiceState
      service_namespace: /stop
      service: std_srvs/Trigger
      response_slots: {given}
      output_keys: [{given.strip("[]")}]
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
    assert helps({"main.yml": script}, "SM004") == found


# --- types and files

TYPES = """\
name: sm
outcomes: [done]
types: {Item: {mass: float}}
userdata: {item: {type: Item, value: {mass: 1.0}}}
states:
  - TAKE: {template: ScriptedState, outcomes: [done], input_keys: [item]}
"""


@pytest.mark.parametrize(
    ("name", "help"),
    [("Items", "did you mean `Item`?"), ("Itme", "did you mean `Item`?"),
     ("Bolt", "declare it under `types:`, or write a type of ROS as `pkg/Name`")],
)  # fmt: skip
def test_a_misspelt_type_of_the_script(name: str, help: str) -> None:
    script = TYPES.replace("type: Item,", f"type: {name},")
    assert helps({"main.yml": script}, "SM017") == [help]


CALL = """\
name: sm
outcomes: [done]
states:
  - PUT: {script: NAME, transitions: {done: done}}
"""
STATE = "- STATE: {template: ScriptedState, outcomes: [done]}\n"


@pytest.mark.parametrize(
    ("name", "files", "help"),
    [
        ("drop_block", ("drop", "pick"), "did you mean `drop`? (searched in `.`)"),
        ("pick", ("drop", "pick_block"), "did you mean `pick_block`? (searched in `.`)"),
        ("go_to_home_position", ("go_to", "home"),
         "put `go_to_home_position.yml` in one of the folders that were searched: `.`"),
    ],
)  # fmt: skip
def test_the_only_script_with_a_word_of_the_name(
    name: str, files: tuple[str, ...], help: str
) -> None:
    own = {f"{file}.yml": STATE for file in files}
    assert helps({"main.yml": CALL.replace("NAME", name), **own}, "SM011") == [help]


URDF = """\
<robot name="painter">
  <link name="base"/><link name="nozzle"/><link name="tip"/>
  <joint name="a" type="fixed"><parent link="base"/><child link="nozzle"/></joint>
  <joint name="b" type="fixed"><parent link="nozzle"/><child link="tip"/></joint>
</robot>
"""
PAINT = """\
name: sm
robot: painter.urdf
outcomes: [done]
states:
  - PAINT: {template: ScriptedState, outcomes: [done]}
"""


@pytest.mark.parametrize(
    ("script", "text", "help"),
    [
        ("painter_arm.urdf", URDF, "did you mean `painter.urdf`? (searched in `.`)"),
        ("arm.urdf", URDF, "write `painter.urdf`, the only robot file there is (searched in `.`)"),
        ("painter.urdf", URDF.replace('child link="nozzle"', 'child link="nozle"'),
         "did you mean `nozzle`?"),
        ("painter.urdf", URDF.replace('parent link="nozzle"', 'parent link="nozle"'),
         "did you mean `nozzle`?"),
        ("painter.urdf", URDF.replace('child link="tip"', 'child link="gripper"'),
         'add `<link name="gripper"/>` to the file, or correct the name'),
    ],
)  # fmt: skip
def test_the_robot_file(script: str, text: str, help: str) -> None:
    files = {"main.yml": PAINT.replace("painter.urdf", script), "painter.urdf": text}
    assert helps(files, "SM018") == [help]


# --- properties and numbers

GATE = """\
name: sm
outcomes: [done]
properties:
  - never: {after: OPEN_GATE, until: WORD, enter: PRESS}
states:
  - OPEN_GATE: {template: ScriptedState, outcomes: [ok], transitions: {ok: CLOSE_GATE}}
  - CLOSE_GATE: {template: ScriptedState, outcomes: [ok], transitions: {ok: PRESS}}
  - PRESS: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""


@pytest.mark.parametrize(
    ("word", "help"),
    [
        ("CLOSED_GATE", "did you mean `CLOSE_GATE`?"),
        ("GATE_CLOSED", "use one of `CLOSE_GATE`, `OPEN_GATE`, `PRESS`, `sm`"),
    ],
)
def test_an_unknown_event(word: str, help: str) -> None:
    assert helps({"main.yml": GATE.replace("WORD", word)}, "SM703") == [help]


@pytest.mark.parametrize(
    ("delay", "help"),
    [("0,5s", "a decimal comma? write `0.5s`"), ("1,25", "a decimal comma? write `1.25`"),
     ("0,5ms", "a decimal comma? write `0.5ms`")],
)  # fmt: skip
def test_a_decimal_comma_before_a_unit(delay: str, help: str) -> None:
    script = f"""\
name: sm
outcomes: [done, failed]
states:
  - GRAB:
      template: ScriptedState
      outcomes: [done, missed]
      retry: {{on: [missed], max: 3, delay: {delay}}}
      transitions: {{exhausted: failed, preempted: failed}}
"""
    assert helps({"main.yml": script}, "SM003") == [help]


# --- containers

SENSE = """\
name: sm
outcomes: [safe, gas]
states:
  - SENSE:
      FIELDS
      outcomes: [safe, gas]
      transitions: {safe: safe, gas: gas}
      states:
        - CAMERA: {template: ScriptedState, outcomes: [clear, dusty]}
        - GAS: {template: ScriptedState, outcomes: [clean, methane]}
"""


@pytest.mark.parametrize(
    ("fields", "kind", "field"),
    [
        ("outcome_map: {safe: {CAMERA: clear}}", "Concurrence", "outcome_map"),
        ("default_outcome: gas\n      outcome_map: {safe: {CAMERA: clear}}", "Concurrence",
         "default_outcome"),
        ("connector_outcome: clear", "Sequence", "connector_outcome"),
        ("it: [1, 2]", "Iterator", "it"),
    ],
)  # fmt: skip
def test_a_container_without_a_template(fields: str, kind: str, field: str) -> None:
    (help,) = helps({"main.yml": SENSE.replace("FIELDS", fields)}, "SM005")[:1]
    assert help is not None
    assert help.startswith(f"add `template: {kind}`: only a {kind} has `{field}`")


def test_no_target_is_chosen_for_outcomes_of_unknown_meaning() -> None:
    found = helps({"main.yml": SENSE.replace("FIELDS", "template: StateMachine")}, "SM104")
    assert found == [
        "write `transitions: {clear: GAS, dusty: ...}` in `CAMERA`",
        "write `transitions: {clean: ..., methane: ...}` in `GAS`",
    ]
