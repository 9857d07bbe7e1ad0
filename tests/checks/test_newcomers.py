"""Slips of people who come from SMACH and FlexBE, each with a correct script beside it."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

LOOP = """\
name: tour
template: PyBulletBase
outcomes: [succeeded, aborted]
userdata:
  poses:
    - [[0.5, 0.1, 0.2], [0.0, 1.0, 0.0, 0.0]]
    - [[0.5, -0.1, 0.2], [0.0, 1.0, 0.0, 0.0]]
states:
  - MOVE_ALL:
      template: Iterator
      outcomes: [all_visited, aborted]
      input_keys: [poses]
      it: poses
      it_label: current
      loop_outcomes: [succeeded]
      exhausted_outcome: all_visited
      transitions: {all_visited: succeeded, aborted: aborted}
      states:
        - MOVE:
            template: StateMachine
            outcomes: [succeeded, aborted]
            input_keys: [current, poses]
            states:
              - GO:
                  template: MoveAlongState
                  remapping: {pose: poses}
                  transitions: {succeeded: succeeded, aborted: aborted, preempted: aborted}
"""
CONDITION = """\
name: approach
outcomes: [succeeded, aborted]
userdata: {distance: 3.0}
states:
  - MEASURE:
      template: ConditionalOutcomeState
      outcomes: [near, far]
      input_keys: [distance]
      callbacks: {near: 'lambda ud: RESULT'}
      default_outcome: far
      transitions: {near: succeeded, far: aborted}
"""
SUMS = {
    "main.yml": """\
name: add
template: AddBase
outcomes: [succeeded]
userdata: {a: 1, b: 2}
output_keys: [total]
states:
  - ADD:
      template: CallbacksState
      input_keys: [a, b]
      output_keys: [total]
      callbacks: {total: add_up}
      transitions: {succeeded: succeeded}
""",
    "templates/AddBase.tpl.py": """\
{% extends "Base.tpl.py" %}
{% block imports %}
{{ super() }}
from sums import add_up
{% endblock imports %}
""",
    "sums.py": "def add_up(userdata):\n    userdata.total = userdata.a + userdata.b\n    RETURN\n",
}
BEST_EFFORT = """\
name: tidy
outcomes: [tidied, aborted]
states:
  - WORK:
      template: Concurrence
      outcomes: [tidied, aborted]
      outcome_map: {tidied: {MOVE: succeeded, EXTRAS: any}, aborted: {MOVE: aborted}}
      states:
        - MOVE: {template: ScriptedState, outcomes: [succeeded, aborted]}
        - EXTRAS:
            template: Concurrence
            outcomes: [ended]
            default_outcome: ended
            states:
              - HUM: {template: ScriptedState, outcomes: [succeeded, aborted]}
              - BLINK: {template: ScriptedState, outcomes: [lit, broken]}
"""
EACH = """\
name: collect
outcomes: [all_tried, preempted]
userdata: {targets: [1, 2]}
states:
  - HOVER:
      template: ScriptedState
      input_keys: [block]
      outcomes: OUTCOMES
      timeout: 40s
      retry: {on: [timeout, unreachable], max: 2}
      for_each: {item: block, in: targets, on: [succeeded, exhausted]}
      transitions: {succeeded: all_tried, preempted: preempted}
"""


def findings(files: dict[str, str] | str) -> list[tuple[str, str, str]]:
    """Code, marked text and help of each finding above an info."""
    files = {"main.yml": files} if isinstance(files, str) else files
    return [
        (item.code, f"{item.span.line} {item.span.text}", item.help or "")
        for item in analysed(files).report
        if item.severity.value != "info"
    ]


def test_the_list_of_a_loop_in_place_of_its_item() -> None:
    assert ("SM304", "26 poses", "write `pose: current`") in findings(LOOP)
    undeclared = LOOP.replace("[current, poses]", "[poses]")
    help = "write `pose: current`, and add `current` to the `input_keys` of `MOVE`"
    assert findings(undeclared) == [("SM304", "26 poses", help)]


def test_the_item_of_a_loop() -> None:
    fixed = LOOP.replace("pose: poses", "pose: current").replace("[current, poses]", "[current]")
    assert findings(fixed) == []


def test_a_list_whose_items_do_not_fit_either() -> None:
    other = LOOP.replace("[[0.5, 0.1, 0.2], [0.0, 1.0, 0.0, 0.0]]", "[0.5, 0.1]")
    found = findings(other.replace("[[0.5, -0.1, 0.2], [0.0, 1.0, 0.0, 0.0]]", "[0.5, 0.2]"))
    assert found
    assert not any("pose: current" in help for _, _, help in found)


@pytest.mark.parametrize(
    ("result", "help"),
    [
        ('"near" if ud.distance < 1.0 else "far"', "write `ud.distance < 1.0` in place of"),
        ('"near"', "return a comparison"),
        ("1 if ud.distance < 1.0 else 2", "write `ud.distance < 1.0` in place of"),
        ("ud.distance < 1.0", None),
        ("1 if ud.distance < 1.0 else 0", None),
        ('"near" if ud.distance < 1.0 else ""', None),
        ("True", None),
    ],
)
def test_a_condition_that_is_always_true(result: str, help: str | None) -> None:
    found = findings(CONDITION.replace("RESULT", result))
    found = [item for item in found if item[0] == "SM318"]
    assert len(found) == (help is not None)
    assert all(item[2].startswith(help or "") for item in found)


@pytest.mark.parametrize(
    ("end", "number"),
    [
        ("return 'succeeded'", 1),
        ("return userdata.total", 0),
        ("return userdata.a + userdata.b", 0),
    ],
)
def test_a_callback_that_returns_an_outcome(end: str, number: int) -> None:
    found = findings({**SUMS, "sums.py": SUMS["sums.py"].replace("RETURN", end)})
    help = "return the value, or decorate the function with `smach.cb_interface`"
    assert found == [("SM318", "3 'succeeded'", help)] * number


def test_a_function_with_an_interface_returns_an_outcome() -> None:
    head = "import smach\n\n\n@smach.cb_interface(input_keys=['a', 'b'], output_keys=['total'],"
    code = head + " outcomes=['succeeded'])\n" + SUMS["sums.py"]
    code = code.replace("RETURN", "return 'succeeded'")
    assert [
        finding for finding in findings({**SUMS, "sums.py": code}) if finding[0] == "SM318"
    ] == []


def test_a_best_effort_branch_with_one_outcome() -> None:
    assert findings(BEST_EFFORT) == []
    needed = BEST_EFFORT.replace("EXTRAS: any", "EXTRAS: ended")
    assert "SM404" in [code for code, _, _ in findings(needed)]


def test_the_failure_of_an_item_is_declared_at_the_state() -> None:
    (found,) = findings(EACH.replace("OUTCOMES", "[succeeded, unreachable, preempted]"))
    assert found[0] == "SM404"
    assert found[2].endswith("write `outcomes: {unreachable: {failure: false}}` at `HOVER`")
    declared = "{succeeded: {}, unreachable: {failure: false}, preempted: {}}"
    assert findings(EACH.replace("OUTCOMES", declared)) == []


COUNT = {
    "main.yml": """\
name: count_parts
outcomes: [succeeded]
userdata: {count: 0}
states:
  - COUNT: {template: Count, transitions: {more: COUNT, enough: succeeded}}
""",
    "templates/Count.yml": """\
name: Count
input_keys: {count: int}
outcomes: {more: {}, enough: {}}
code: {python: "counter:Count"}
""",
    "counter.py": """\
import smach


class Count(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['more', 'enough'], input_keys=['count'])

    def on_enter(self, userdata):
        self.start = 0

    def execute(self, userdata):
        CODE
        if userdata.count < 5:
            return 'more'
        return 'enough'
""",
}


def of_class(code: str, *changes: tuple[str, str]) -> list[tuple[str, str, str]]:
    text = COUNT["counter.py"].replace("CODE", code)
    for old, new in changes:
        text = text.replace(old, new)
    return findings({**COUNT, "counter.py": text})


def test_a_key_is_added_to_the_interface_and_to_the_class() -> None:
    help = "add `count` to the `output_keys` of the interface `Count` and of `__init__`"
    assert of_class("userdata.count += 1") == [("SM308", "12 count", help)]
    listed = ("input_keys=['count'])", "input_keys=['count'], output_keys=['count'])")
    found = [item for item in of_class("userdata.count += 1", listed) if item[0] == "SM308"]
    assert [help for _, _, help in found] == [
        "add `count` to the `output_keys` of the interface `Count`"
    ]


def test_the_userdata_has_no_methods_of_a_dictionary() -> None:
    files = {**COUNT, "counter.py": COUNT["counter.py"].replace("CODE", "userdata.get('count')")}
    effects = [item.finding.effect for item in analysed(files).report if item.code == "SM310"]
    assert effects == ["the userdata has no method `get`: AttributeError"]


def test_a_state_of_flexbe_waits_in_execute() -> None:
    words = "SMACH calls `execute` once and never `on_enter`: wait in `execute`"
    last = ("        return 'enough'\n", "")
    (help,) = [help for code, _, help in of_class("pass", last) if code == "SM309"]
    assert help.endswith(f"; {words}")
    called = of_class("self.on_enter(userdata)", last)
    (help,) = [help for code, _, help in called if code == "SM309"]
    assert words not in help


def test_an_unknown_outcome_that_continues_a_loop() -> None:
    loop = LOOP.replace("pose: poses", "pose: current").replace("[current, poses]", "[current]")
    found = findings(loop.replace("loop_outcomes: [succeeded]", "loop_outcomes: [continue]"))
    assert found == [("SM102", "15 continue", "use one of `aborted`, `succeeded`")]
    found = findings(loop.replace("[succeeded]\n      ex", "[succeeded, continue]\n      ex"))
    assert ("SM102", "15 continue", "use one of `aborted`, `succeeded`") in found


FOLLOW = {
    "main.yml": """\
name: follow
outcomes: [succeeded, aborted]
states:
  - FOLLOW:
      template: Follow
      timeout: 10s
      transitions: {arrived: succeeded, timeout: aborted, preempted: aborted}
""",
    "templates/Follow.yml": """\
name: Follow
outcomes: {arrived: {}}
blocking: true
code: {python: "follow_state:Follow"}
""",
    "follow_state.py": """\
import smach


class Follow(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['arrived'])
        self.near = False

    def execute(self, userdata):
        while not self.near:
            self.near = True
        return 'arrived'
""",
}


def test_a_time_limit_that_stops_nothing() -> None:
    ((code, _, help),) = findings(FOLLOW)
    assert code == "SM207"
    assert "timeout:" not in help
    answer = "if self.preempt_requested(): self.service_preempt(); return 'preempted'"
    assert help.endswith(f"and in the loop of `execute` write `{answer}`")
