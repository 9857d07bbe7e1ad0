"""A name of the wrong kind, in the wrong field or of another key: one finding, whose help has the
text to write."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

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
def test_a_sub_script_in_place_of_a_template_and_the_other_way_round(
    fields: str, row: Row
) -> None:
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
    assert sampled(VALUES, "NEXT", "coral") == [("SM302", "coral", "write `sample: sponge`")]


def test_a_remapping_to_an_unset_key_means_the_one_with_the_name_of_the_state() -> None:
    more = f"{VALUES}\n  shell: {{id: 3, at: [0.8, 0.1, -0.3]}}"
    found = sampled(more, "SPONGE", "coral")
    assert ("SM302", "coral", "did you mean `sponge`?") in found


def test_an_output_key_that_is_listed_in_place_of_its_remapping() -> None:
    text = """\
name: sm
outcomes: [done]
states:
  - A: {template: Look, REMAP output_keys: [part_score], transitions: {good: B}}
  - B: {template: PrintUserdataState, input_keys: [part_score], transitions: {succeeded: done}}
"""
    help = "write `remapping: {score: part_score}` in place of this entry"
    files = {"main.yml": text.replace("REMAP ", ""), "templates/Look.yml": LOOK}
    assert reported(files) == [("SM004", "part_score", help)]
    help = "remove it: the remapping gives `score` the name `part_score`"
    files["main.yml"] = text.replace("REMAP ", "remapping: {score: part_score}, ")
    assert reported(files) == [("SM004", "part_score", help)]


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


def test_the_long_form_of_a_key_in_a_script() -> None:
    text = """\
name: sm
outcomes: [done]
userdata: {place: [0.6, 0.1, -0.3]}
states:
  - A:
      template: ScriptedState
      outcomes: [done]
      input_keys: {place: {type: Point}}
      transitions: {done: done}
"""
    help = "write `place: Point`: only userdata and interfaces have fields beside the type"
    assert reported({"main.yml": text}) == [("SM004", "{type: Point}", help)]
