"""A name of the wrong kind, in the wrong field or of another key: one finding, whose help has the
text to write."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed, shown
from tests.trust.project_text import analysed

Row = tuple[str, str, str | None]

PART = """\
- PART:
    template: ScriptedState
    outcomes: [done]
    input_keys: {sample: {id: int, at: Point}}
"""
LOOK = """\
variables: {}
output_keys: {score: float}
outcomes: {good: {}}
writes: {good: [score]}
"""


@pytest.mark.parametrize(
    ("fields", "row"),
    [
        ("template: part", ("SM013", "part", "`part` is a sub-script: write `script: part`")),
        ("script: Look", ("SM011", "Look", "`Look` is a state type: write `template: Look`")),
    ],
)
def test_a_sub_script_in_place_of_a_template_and_the_other_way_round(fields: str, row: Row) -> None:
    text = f"""\
name: sm
outcomes: [done]
states:
  - A: {{{fields}, transitions: {{done: done}}}}
"""
    assert reported({"main.yml": text, "part.yml": PART, "templates/Look.yml": LOOK}) == [row]


def sampled(userdata: str, state: str, to: str) -> list[Row]:
    text = f"""\
name: sm
outcomes: [done]
userdata:
{userdata}
states:
  - ROCK: {{script: part, remapping: {{sample: rock}}, transitions: {{done: {state}}}}}
  - {state}: {{script: part, remapping: {{sample: {to}}}, transitions: {{done: done}}}}
"""
    return reported({"main.yml": text, "part.yml": PART})


VALUES = """\
  rock: {id: 1, at: [0.6, 0.1, -0.3]}
  sponge: {id: 2, at: [0.7, 0.1, -0.3]}"""


def test_a_remapping_to_an_unset_key_means_the_one_that_nothing_reads() -> None:
    found = [row for row in sampled(VALUES, "NEXT", "coral") if row[0] == "SM302"]
    ((_, place, help),) = found
    assert place == "coral"
    assert str(help).startswith("write `sample: sponge`, or set")


def test_a_remapping_to_an_unset_key_means_the_one_with_the_name_of_the_state() -> None:
    more = f"{VALUES}\n  shell: {{id: 3, at: [0.8, 0.1, -0.3]}}"
    found = sampled(more, "SPONGE", "coral")
    (help,) = [str(help) for code, _, help in found if code == "SM302"]
    assert help.startswith("write `sample: sponge` or `sample: shell`")


def test_a_rule_that_is_wrong_and_the_property_about_its_outcome() -> None:
    text = """\
name: sm
outcomes: [done, bad]
properties:
  - never: {after: "BOTH:unsafe", enter: NEXT}
states:
  - BOTH:
      template: Concurrence
      outcomes: [done, unsafe]
      default_outcome: done
      outcome_map: {unsafe: {LEFT: tripped}}
      states:
        - LEFT: {template: ScriptedState, outcomes: [clear, low, high]}
        - RIGHT: {template: ScriptedState, outcomes: [done]}
      transitions: {done: NEXT, unsafe: bad}
  - NEXT: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
"""
    help = "use one of its outcomes: `clear`, `high`, `low`"
    assert reported({"main.yml": text}) == [("SM403", "tripped", help)]


def test_a_slot_under_another_name_than_in_the_remapping() -> None:
    text = """\
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {wanted: true}
states:
  - ENABLE:
      template: ServiceState
      service_namespace: /enable
      service: std_srvs/SetBool
      request_slots: [value]
      remapping: {data: wanted}
      transitions: {succeeded: done, aborted: failed, preempted: failed}
"""
    help = "write `data`, which the remapping has, in place of `value`"
    assert reported({"main.yml": text}) == [("SM512", "value", help)]


def test_a_percentage_in_place_of_a_ratio() -> None:
    interface = "variables: {score: {type: float, min: 0, max: 1}}\noutcomes: [done]\n"
    text = """\
name: sm
outcomes: [done]
states:
  - A: {template: Rate, score: 70, transitions: {done: done}}
"""
    found = reported({"main.yml": text, "templates/Rate.yml": interface})
    assert found == [("SM520", "70", "write a number from 0 to 1; 70 % is `0.7`")]


def test_a_field_of_a_record_by_the_name_of_its_type() -> None:
    interface = """\
input_keys: {part: {type: {name: str, at: Pose}}}
outcomes: [done]
code: {python: "cell.look:Look"}
"""
    code = """\
import smach


class Look(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["part"])

    def execute(self, userdata):
        print(userdata.part["pose"])
        return "done"
"""
    text = """\
name: sm
outcomes: [done]
userdata: {part: {name: nut, at: [[0.4, 0.1, 0.0], [0.0, 0.0, 0.0, 1.0]]}}
states:
  - A: {template: Look, transitions: {done: done}}
"""
    files = {"main.yml": text, "templates/Look.yml": interface, "cell/look.py": code}
    assert reported(files) == [("SM311", '"pose"', "did you mean `at`?")]


def test_the_long_form_of_a_record_in_a_script() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {part: {id: 1, at: [0.6, 0.1, -0.3]}}
states:
  - A:
      template: ScriptedState
      outcomes: [done]
      input_keys: {part: {type: {id: int, at: Point}}}
      transitions: {done: done}
"""
    help = (
        "write `part: {id: int, at: Point}` in the `input_keys` of `A`: only userdata and"
        " interfaces have the fields `type` and `value`"
    )
    found = reported({"main.yml": text})
    assert found == [("SM304", "{id: 1, at: [0.6, 0.1, -0.3]}", help)]


DRIVE = """\
variables: {speed: float}
input_keys: {torque: float}
output_keys: {angle: float}
outcomes: {tight: {}, slipped: {failure: true}, preempted: {}}
writes: {WRITES: [angle]}
code: {cpp: {header: cell/drive.hpp, class: "cell::Drive"}}
"""
HEADER = """\
#pragma once
#include <cstdint>
#include "smachac/smachac.hpp"
namespace cell {
class Drive {
public:
  enum class Outcome { tight, slipped, preempted };
  struct In { double torque; };
  struct Out { smachac::Key<double> &angle; };
  explicit Drive(double speed) : speed_(speed) {}
  Outcome execute(In in, Out out, smachac::Stop &stop) {
    if (stop.requested()) {
      stop.service();
      return Outcome::preempted;
    }
    if (in.torque > speed_) {
      return Outcome::slipped;
    }
    out.KEY = 1.0;
    return Outcome::tight;
  }
private:
  double speed_;
};
}  // namespace cell
"""
DRIVEN = """\
name: sm
outcomes: [done, failed]
userdata: {torque: 0.5}
states:
  - A: {template: Drive, speed: 1.0, transitions: {tight: done, slipped: failed, preempted: failed}}
"""


@pytest.mark.parametrize("key", ["turns", "angel"])
def test_a_member_that_the_struct_of_a_class_does_not_have(key: str) -> None:
    files = {
        "main.yml": DRIVEN,
        "templates/Drive.yml": DRIVE.replace("WRITES", "tight"),
        "cell/drive.hpp": HEADER.replace("KEY", key),
    }
    assert ("SM609", key, "did you mean `angle`?") in reported(files)


def test_an_outcome_in_writes_that_is_not_declared() -> None:
    files = {"main.yml": DRIVEN, "templates/Drive.yml": DRIVE.replace("WRITES", "done")}
    found = [row for row in reported(files) if row[0] == "SM004"]
    assert found == [("SM004", "done", "did you mean `tight`?")]


KITTING = """\
name: sm
outcomes: [done]
userdata:
  home: {type: "float<rad>[7]", value: [0, 0, 0, 0, 0, 0, 0]}
  above: [[0.0, 0.0, 0.12], ROTATION]
states:
  - MOVE:
      template: Drive
      remapping: {positions: POSITIONS, offset: above}
      transitions: {tight: OVER}
  - OVER: {template: Drive, remapping: {positions: home, offset: above}, transitions: {tight: done}}
"""
MOVED = """\
input_keys: {positions: "list[float<rad>]", offset: Pose}
outcomes: {tight: {}}
"""


def moved(positions: str, rotation: str) -> list[Row]:
    text = KITTING.replace("POSITIONS", positions).replace("ROTATION", rotation)
    return reported({"main.yml": text, "templates/Drive.yml": MOVED})


def test_a_remapping_to_a_key_of_another_type() -> None:
    assert moved("home", "[0.0, 0.0, 0.0, 1.0]") == []
    ((code, word, _),) = moved("above", "[0.0, 0.0, 0.0, 1.0]")
    assert (code, word) == ("SM304", "[0.0, 0.0, 0.12]")


@pytest.mark.parametrize(
    ("angles", "rotation"),
    [
        ("[0.0, 0.0, 0.0]", "[0.0, 0.0, 0.0, 1.0]` for no rotation"),
        (
            "[3.14159, 0.0, 0.0]",
            "[1.0, 0.0, 0.0, 0.0]` for these 3 angles (roll, pitch, yaw in rad)",
        ),
        (
            "[0.0, 0.0, 1.5707963]",
            "[0.0, 0.0, 0.7071, 0.7071]` for these 3 angles (roll, pitch, yaw in rad)",
        ),
    ],
)
def test_three_angles_in_place_of_a_quaternion(angles: str, rotation: str) -> None:
    help = f"write a quaternion, `[qx, qy, qz, qw]`: `{rotation}"
    assert {row[2] for row in moved("home", angles)} == {help}


@pytest.mark.parametrize(
    "written", ["$(suction)", "$(arg suction)", "'${suction}'", "'{{suction}}'"]
)
def test_a_param_in_the_syntax_of_another_tool(written: str) -> None:
    text = f"""\
name: sm
outcomes: [done]
params: {{suction: 0.4}}
states:
  - A: {{template: SleepState, time: {written}, transitions: {{succeeded: done, preempted: done}}}}
"""
    _, repair = shown(analysed({"main.yml": text}))
    assert repair is not None
    assert [edit.text for edit in repair.edits] == ["[params, suction]"]


def test_lost_brackets_around_a_list_in_braces() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {home: 0.9, -1.2, count: 1}
states:
  - A: {template: PrintUserdataState, input_keys: [home, count], transitions: {succeeded: done}}
"""
    row = ("SM001", "0.9, -1.2", "write `home: [0.9, -1.2]`")
    assert reported({"main.yml": text}) == [row]


def test_a_unit_after_a_number_in_code() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {angle: 1.0}
states:
  - A:
      template: ConditionalOutcomeState
      input_keys: [angle]
      outcomes: [far]
      callbacks: {far: "lambda ud: ud.angle > 0.5 rad"}
      default_outcome: near
      transitions: {far: done, near: done}
"""
    help = "remove `rad`: a number in code has no unit"
    assert reported({"main.yml": text}) == [("SM016", "rad", help)]


def test_a_key_of_the_caller_in_a_sub_script() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {rock: {id: 1, at: [0.6, 0.1, -0.3]}}
states:
  - A: {script: pick, remapping: {sample: rock}, transitions: {done: done}}
"""
    pick = """\
- PICK:
    template: StateMachine
    outcomes: [done]
    input_keys: [sample]
    states:
      - LOOK: {script: part, transitions: {done: GRASP}}
      - GRASP: {script: part, remapping: {sample: rock}, transitions: {done: done}}
"""
    found = reported({"main.yml": text, "pick.yml": pick, "part.yml": PART})
    help = "add `rock` to the `input_keys` of `A`"
    assert [row for row in found if row[0] == "SM303"] == [("SM303", "sample", help)]


def test_a_forgotten_remapping_of_a_key_of_an_interface() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {hover_offset: [0.0, 0.0, 0.1]}
states:
  - A: {template: Hover, transitions: {done: B}}
  - B: {template: Hover, remapping: {offset: hover_offset}, transitions: {done: done}}
"""
    interface = "input_keys: {offset: Point}\noutcomes: {done: {}}\n"
    found = printed({"main.yml": text, "templates/Hover.yml": interface})
    assert [row[2] for row in found] == ["write `remapping: {offset: hover_offset}` in `A`"]


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("front: a, rear: b", ["front", "rear"]),
        ("front: a, rear: 2", ["front"]),  # `rear` is no text
        ("front: a, rear: b, left: c, right: d", []),  # too many
    ],
)
def test_the_keys_that_a_key_of_an_interface_can_read(keys: str, expected: list[str]) -> None:
    text = f"""\
name: sm
outcomes: [done]
userdata: {{above: x, {keys}}}
states:
  - A: {{template: Log, remapping: {{spot: above}}, transitions: {{done: done}}}}
"""
    interface = "input_keys: {label: str, spot: str}\noutcomes: {done: {}}\n"
    report = analysed({"main.yml": text, "templates/Log.yml": interface}).report
    (finding,) = [item.finding for item in report if item.code == "SM301"]
    new = [repair.edits[0].text for repair in finding.repairs]
    assert new == [f", label: {key}" for key in expected]
    if len(expected) == 2:
        ways = [f"add `label: {key}` to the `remapping` of `A`" for key in expected]
        assert finding.help == ", or ".join(ways)


def test_a_field_of_the_script_by_a_word_of_the_same_meaning() -> None:
    text = """\
name: sm
outcomes: [done, failed]
on_failure: HALT
states:
  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
  - HALT: {template: ScriptedState, outcomes: [ok], transitions: {ok: failed}}
"""
    assert ("SM003", "on_failure", "did you mean `on_error`?") in reported({"main.yml": text})
