"""Helps that name the one repair that the files decide."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed
from tests.trust.project_text import BUILT_IN

SCALE = """\
{% block meta %}
name: Scale
language: Python
framework: SMACH
type: State
input_keys:
- tare:
    description: Weight of the carrier.
    type: float
output_keys:
- net:
    description: Weight without the carrier.
    type: float
outcomes:
- succeeded
{% endblock meta %}
{% extends "State.tpl.py" %}
{% block class_defs %}
class Scale(smach.State):
    def __init__(self, input_keys=['tare'], output_keys=['net'], callbacks={}):
        smach.State.__init__(self, input_keys=input_keys, output_keys=output_keys,
                             outcomes=['succeeded'])

    def execute(self, userdata):
        userdata.weight = 10.0 - userdata.tare
        return 'succeeded'
{% endblock class_defs %}
"""

WEIGH = """\
name: sm
outcomes: [succeeded]
userdata: {tare: 1.5}
output_keys: [net]
states:
  - READ: {template: Scale, input_keys: [tare], output_keys: [net], transitions: {succeeded: SHOW}}
  - SHOW: {template: PrintUserdataState, input_keys: [net], transitions: {succeeded: succeeded}}
"""


def test_a_key_that_a_template_class_sets_in_place_of_its_output() -> None:
    files = {"main.yml": WEIGH, "templates/Scale.tpl.py": SCALE}
    assert reported(files) == [("SM308", "weight", "write `userdata.net`")]


MONITOR = """\
name: sm
outcomes: [succeeded, stopped]
properties:
  - never: {after: "WORK:unsafe", enter: GO_ON}
states:
  - WORK:
      template: Concurrence
      outcomes: [done, unsafe, preempted]
      default_outcome: done
      join: any
      outcome_map:
        preempted: {WATCH: preempted, DRIVE: preempted}
        done: {DRIVE: arrived}
      transitions: {done: GO_ON, unsafe: stopped, preempted: stopped}
      states:
        - WATCH: {template: ScriptedState, outcomes: [WATCHED, preempted]}
        - DRIVE: {template: ScriptedState, outcomes: [arrived, lost, preempted]}
  - GO_ON: {template: ScriptedState, outcomes: [ok], transitions: {ok: succeeded}}
"""


def test_an_outcome_whose_rule_is_lost() -> None:
    found = reported({"main.yml": MONITOR.replace("WATCHED", "invalid, valid")})
    ((code, text, help),) = [item for item in found if item[0] != "SM408"]
    assert (code, text) == ("SM203", "unsafe")
    assert str(help).startswith("add a rule for `unsafe`")


LATCH = """\
name: sm
outcomes: [succeeded, aborted]
properties:
  - never: {after: ATTACH, until: DETACH, enter: DOCK}
states:
  - ATTACH:
      template: Latch
      closed: true
      transitions: {succeeded: UNLATCH, aborted: DETACH_ABORT}
  - UNLATCH: {template: Latch, closed: false, transitions: {succeeded: DOCK, aborted: aborted}}
  - DOCK: {template: Latch, closed: true, transitions: {succeeded: succeeded, aborted: aborted}}
  - DETACH_ABORT:
      template: Latch
      closed: false
      transitions: {succeeded: aborted, aborted: aborted}
"""
LATCH_TYPE = "name: Latch\nvariables: {closed: bool}\noutcomes: {succeeded: {}, aborted: {}}\n"


def test_an_event_is_no_state_after_a_failure() -> None:
    files = {"main.yml": LATCH, "templates/Latch.yml": LATCH_TYPE}
    ((_, place, help),) = [item for item in reported(files) if item[0] == "SM703"]
    assert place == "DETACH"
    assert "DETACH_ABORT" not in str(help)


BATTERY = """\
name: sm
template: ROSBase
outcomes: [full, low, preempted]
states:
  - WATCH:
      template: MonitorState
      topic: /battery
      msg_type: sensor_msgs/BatteryState
      cond_cb: 'lambda userdata, message: message.FIELD > 0.25'
      transitions: {valid: full, invalid: low, preempted: preempted}
"""


@pytest.mark.parametrize("field", ["charge_percent", "level", "percent", "prcentage"])
def test_a_field_with_a_word_of_the_same_meaning(field: str) -> None:
    found = reported({"main.yml": BATTERY.replace("FIELD", field)})
    assert [item for item in found if item[0] == "SM512"] == [
        ("SM512", field, "did you mean `percentage`?")
    ]


SORT = """\
name: sm
outcomes: [succeeded]
userdata: {level: 0.5}
states:
  - LOOK: {template: Look,REMAPPING transitions: {seen: LOG}}
  - LOG:
      template: PrintUserdataState
      input_keys: [part_score, level]
      transitions: {succeeded: succeeded}
"""
LOOK_TYPE = "name: Look\noutput_keys: {score: float, place: Pose}\noutcomes: {seen: {}}\n"


@pytest.mark.parametrize(
    ("remapping", "help"),
    [
        ("", "write `remapping: {score: part_score}` in `LOOK`, whose `score` nothing reads"),
        (" remapping: {place: spot},",
         "add `score: part_score` to the `remapping` of `LOOK`, whose `score` nothing reads"),
    ],
)  # fmt: skip
def test_the_output_that_is_not_remapped(remapping: str, help: str) -> None:
    files = {"main.yml": SORT.replace("REMAPPING", remapping), "templates/Look.yml": LOOK_TYPE}
    found = [item for item in reported(files) if item[0] == "SM301"]
    assert found == [("SM301", "part_score", help)]


POUR = """\
name: sm
outcomes: [succeeded]
userdata: {level: 0.8}
states:
  - POUR: {template: Pour, remapping: {amount: poured}, transitions: {full: SHOW}}
  - SHOW: {template: PrintUserdataState, input_keys: [poured], transitions: {succeeded: succeeded}}
"""
POUR_TYPE = """\
name: Pour
input_keys: {fill: float}
output_keys: {amount: float}
outcomes: {full: {}}
"""


def test_an_entry_that_a_remapping_lacks() -> None:
    found = printed({"main.yml": POUR, "templates/Pour.yml": POUR_TYPE})
    assert found == [("SM301", "POUR", "add `fill: level` to the `remapping` of `POUR`")]


VACUUM = """\
{% extends "State.tpl.py" %}
{% block class_defs %}
class Vacuum(smach.State):
    def __init__(self, pressure):
        super().__init__(outcomes=["done"], input_keys=["offset"])
        self.pressure = pressure

    def execute(self, userdata):
        print(self.pressure, userdata.offset)
        return "done"
{% endblock class_defs %}
{% block body %}
{{ add(class_name, pressure, offset) }}
{% endblock body %}
"""
VACUUM_TYPE = """\
name: Vacuum
variables: {pressure: float}
input_keys: {offset: float}
outcomes: {done: {}}
"""
SUCK = """\
name: sm
outcomes: [done]
userdata: {offset: 0.1}
states:
  - SUCK: {template: Vacuum, pressure: 0.5, transitions: {done: done}}
"""


def test_a_key_among_the_arguments_of_a_template() -> None:
    files = {"templates/Vacuum.tpl.py": VACUUM, "templates/Vacuum.yml": VACUUM_TYPE}
    library = memory_library({"main.yml": SUCK, **files}, BUILT_IN)
    (found,) = analyse(Source("main.yml", SUCK), library, [], render=True).report
    assert (found.code, found.span.text) == ("SM605", "offset")
    assert str(found.help).startswith(
        "write `{{ add(class_name, pressure) }}`: `offset` is an input key"
    )


LOOP = """\
name: sm
outcomes: [done]
userdata: {parts: [1, 2]}
states:
  - SHOW:
      template: PrintUserdataState
      input_keys: [part]
      for_each: {FIELDS}
      transitions: {succeeded: done}
"""


@pytest.mark.parametrize(
    ("fields", "expected"),
    [
        ("it: parts, it_label: part",
         [("SM003", "it", "write `for_each: {in: parts, item: part}`")]),
        ("it: parts, item: part", [("SM003", "it", "did you mean `in`?")]),
    ],
)  # fmt: skip
def test_the_words_of_an_iterator_in_for_each(
    fields: str, expected: list[tuple[str, str, str]]
) -> None:
    assert reported({"main.yml": LOOP.replace("FIELDS", fields)}) == expected


MEASURE = """\
import smach


class Measure(smach.State):
    def __init__(self):
        super().__init__(outcomes=["measured", "no_image"])

    def execute(self, userdata):
        return "no_image" if userdata is None else "measured"
"""


def test_the_second_repair_of_a_renamed_outcome_names_its_file() -> None:
    interface = "name: Measure\noutcomes: [measured, no_picture]\ncode: {python: 'cell:Measure'}\n"
    main = (
        "name: sm\noutcomes: [done]\nstates:\n"
        "  - A: {template: Measure, transitions: {measured: done, no_picture: done}}\n"
    )
    files = {"main.yml": main, "templates/Measure.yml": interface, "cell.py": MEASURE}
    ((code, _, help),) = reported(files)
    assert code == "SM309"
    assert str(help).endswith("or write `no_image` in place of `no_picture` in `Measure.yml`")
