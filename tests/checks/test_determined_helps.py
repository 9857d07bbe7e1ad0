"""Helps that name the one candidate which is determined, in place of a list of all of them."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed

LOOK = """\
name: sm
template: Base
outcomes: [succeeded, aborted, preempted]
states:
  - LOOK:
      template: ScriptedState
      outcomes: OUTCOMES
      transitions: {TRANSITIONS}
  - SAY:
      template: ScriptedState
      outcomes: [said]
      transitions: {said: succeeded}
"""
ENDS = "{succeeded: {}, aborted: {failure: true}, preempted: {}}"


def look(outcomes: str, transitions: str) -> list[tuple[str, str, str | None]]:
    script = LOOK.replace("OUTCOMES", outcomes).replace("TRANSITIONS", transitions)
    return [item for item in reported({"main.yml": script}) if item[0] != "SM203"]


@pytest.mark.parametrize(
    ("outcomes", "transitions", "found"),
    [
        # words of other frameworks
        (ENDS, "succeeded: SAY, aborted: aborted, canceled: preempted",
         [("canceled", "did you mean `preempted`?")]),
        (ENDS, "finished: SAY, failed: aborted, cancelled: preempted",
         [("finished", "did you mean `succeeded`?"), ("failed", "did you mean `aborted`?"),
          ("cancelled", "did you mean `preempted`?")]),
        (ENDS, "success: SAY, failure: aborted, preempted: preempted",
         [("success", "did you mean `succeeded`?"), ("failure", "did you mean `aborted`?")]),
        ("[succeeded, canceled]", "succeeded: SAY, preempted: aborted",
         [("preempted", "did you mean `canceled`?")]),
        # the only outcome without a transition
        (ENDS, "succeeded: SAY, aborted: aborted, rejected: preempted",
         [("rejected", "did you mean `preempted`?")]),
        # no outcome is left
        ("[found, lost]", "found: SAY, lost: aborted, preempted: preempted",
         [("preempted", "remove this transition: `found` and `lost`, all outcomes, have"
           " transitions")]),
        # outcomes that a field adds
        (ENDS, "succeeded: SAY, aborted: aborted, preempted: preempted, timeout: aborted",
         [("timeout", "a state has the outcome `timeout` only with the field `timeout`: write"
           " `timeout: SECONDS` in `LOOK`, or remove this transition")]),
        (ENDS, "succeeded: SAY, aborted: aborted, preempted: preempted, exhausted: aborted",
         [("exhausted", "a state has the outcome `exhausted` only with the field `retry`: write"
           " `retry: {on: [aborted], max: 3}` in `LOOK`, or remove this transition")]),
        # a failure is not the outcome after a stop
        (ENDS, "succeeded: SAY, aborted: aborted, failed: aborted",
         [("failed", "use one of its outcomes: `aborted`, `preempted`, `succeeded`")]),
    ],
)  # fmt: skip
def test_an_unknown_outcome(outcomes: str, transitions: str, found: list[tuple[str, str]]) -> None:
    assert look(outcomes, transitions) == [("SM102", *item) for item in found]


RETRY = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
  - GRIP:
      template: ScriptedState
      outcomes: [held, slipped]
      retry: {RETRY}
      transitions: {held: succeeded, exhausted: aborted, preempted: aborted}
"""


@pytest.mark.parametrize(
    ("retry", "found"),
    [
        ("on: [slipped, timeout], max: 3",
         ("SM004", "timeout", "a state has the outcome `timeout` only with the field `timeout`: add"
          " `timeout: SECONDS`, or write `on: [slipped]`")),
        ("on: [timeout], max: 3",
         ("SM004", "timeout", "a state has the outcome `timeout` only with the field `timeout`: add"
          " `timeout: SECONDS`, or write `on: [slipped]`")),
        ("on: [slipped, exhausted], max: 3",
         ("SM004", "exhausted", "the state ends with `exhausted` after the last try: write"
          " `on: [slipped]`")),
        ("on: [slipped, preempted], max: 3",
         ("SM004", "preempted", "write `on: [slipped]`: a state that a stop request ends does not"
          " run again")),
        ("on: [slipped], times: 3", ("SM003", "times", "did you mean `max`?")),
    ],
)  # fmt: skip
def test_the_parts_of_a_retry(retry: str, found: tuple[str, str, str]) -> None:
    assert reported({"main.yml": RETRY.replace("RETRY", retry)}) == [found]


EACH = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
userdata: {parts: [a, b]}
states:
  - KIT:
      template: ScriptedState
      outcomes: {placed: {}, missed: {failure: true}}
      input_keys: [part]
      for_each: {item: part, in: parts, on: [placed]}
      transitions: {placed: succeeded, missed: aborted, preempted: aborted}
"""


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ("on: [placed]", "on: [succeeded]",
         [("SM004", "succeeded", "write `placed` in place of `succeeded`")]),
    ],
)  # fmt: skip
def test_a_loop(old: str, new: str, found: list[tuple[str, str, str]]) -> None:
    assert reported({"main.yml": EACH}) == []
    assert reported({"main.yml": EACH.replace(old, new)}) == found


@pytest.mark.parametrize("word", ["continue", "break", "next"])
def test_a_loop_has_no_words_as_targets(word: str) -> None:
    text = EACH.replace("missed: aborted", f"missed: {word}")
    assert [row[:2] for row in reported({"main.yml": text})] == [("SM101", word)]


ITERATOR = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
userdata: {seams: [a, b]}
states:
  - ALL:
      template: Iterator
      outcomes: [done, camera_failed]
      input_keys: [seams]
      it: seams
      it_label: seam
      exhausted_outcome: done
      loop_outcomes: [next]
      final_outcome_map: {next: camera_failed}
      transitions: {done: succeeded, camera_failed: aborted}
      states:
        - ONE:
            template: ScriptedState
            input_keys: [seam]
            outcomes: {next: {}, camera_failed: {failure: true}}
"""


@pytest.mark.parametrize("word", ["succeeded", "done", "continue"])
def test_the_outcome_that_continues_an_iterator(word: str) -> None:
    text = ITERATOR.replace("loop_outcomes: [next]", f"loop_outcomes: [{word}]")
    ((code, place, help),) = printed({"main.yml": text})
    assert (code, place) == ("SM102", word)
    assert help.startswith("did you mean `next`?")


MAP = """\
name: sm
template: Base
outcomes: [polished, failed]
states:
  - G:
      template: Concurrence
      outcomes: [polished, hot, pressed, failed]
      default_outcome: failed
      join: any
      outcome_map: {RULES}
      transitions: {polished: polished, hot: failed, pressed: failed, failed: failed}
      states:
        - POLISH: {template: ScriptedState, outcomes: [done, slipped, preempted]}
        - DOOR: {template: ScriptedState, outcomes: [invalid, valid, preempted]}
        - FORCE: {template: ScriptedState, outcomes: [invalid, valid, preempted]}
"""
HOT, PRESSED = "hot: {DOOR: invalid}", "pressed: {FORCE: invalid}"


@pytest.mark.parametrize(
    ("rules", "found"),
    [
        (f"POLISH: {{polished: done}}, {HOT}, {PRESSED}",
         ("SM103", "POLISH", "the outcome comes first: `outcome_map: {polished: {POLISH: done}}`")),
        (f"POLISH: {{done: polished}}, {HOT}, {PRESSED}",
         ("SM103", "POLISH", "the outcome comes first: `outcome_map: {polished: {POLISH: done}}`")),
        (f"polished: {{POLISH: done}}, {HOT}, pressed: {{DOOR: invalid}}",
         ("SM402", "pressed", "add a condition to the rule that must win, as in `hot: {POLISH:"
          " preempted, DOOR: invalid}`: the rule with more conditions wins")),
    ],
)  # fmt: skip
def test_a_rule_of_an_outcome_map(rules: str, found: tuple[str, str, str]) -> None:
    right = f"polished: {{POLISH: done}}, {HOT}, {PRESSED}"
    assert reported({"main.yml": MAP.replace("RULES", right)}) == []
    assert reported({"main.yml": MAP.replace("RULES", rules)}) == [found]


RACK = """\
name: rack_round
template: Base
outcomes: [docked, stranded]
states:
  - TO_RACK:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      transitions: {succeeded: DOCK, aborted: CLEAR}
  - COUNT:
      template: ScriptedState
      outcomes: [counted]
      transitions: {counted: ENOUGH}
  - ENOUGH:
      template: ScriptedState
      outcomes: [give_up, again]
      transitions: {give_up: stranded, again: CLEAR}
  - CLEAR:
      template: ScriptedState
      outcomes: [done, aborted]
      transitions: {done: TO_RACK, aborted: stranded}
  - DOCK:
      template: ScriptedState
      outcomes: [done]
      transitions: {done: docked}
"""


def test_states_that_a_failure_leads_past() -> None:
    help = (
        "write `aborted: COUNT` in `TO_RACK`, or remove `COUNT` and `ENOUGH` if their work is not"
        " needed"
    )
    assert reported({"main.yml": RACK}) == [("SM201", "COUNT", help)]


LAMP = """\
name: scan
template: Base
outcomes: [succeeded, aborted]
properties:
  - after: {LIGHT_ON: [LIGHT_OFF, LIGHT_OFF_GOOD]}
states:
  - LIGHT_ON: {template: Lamp, level: 0.8, transitions: {done: READ}}
  - READ:
      template: ScriptedState
      outcomes: [done, aborted]
      transitions: {done: SHOW, aborted: LIGHT_OFF}
  - SHOW: {template: ScriptedState, outcomes: [done], transitions: {done: LIGHT_OFF_GOOD}}
  - LIGHT_OFF_GOOD: {template: Lamp, level: 0.1, transitions: {done: succeeded}}
  - LIGHT_OFF: {template: Lamp, level: 0.1, transitions: {done: aborted}}
"""
TYPE = {
    "templates/Lamp.yml": "name: Lamp\nvariables: {level: float}\noutcomes: {done: {}}\n",
    "templates/Lamp.tpl.py": """\
{% block class_defs %}
class Lamp(smach.State):
    def __init__(self, level):
        smach.State.__init__(self, outcomes=["done"])
        self.level = level

    def execute(self, userdata):
        print(self.level)
        return "done"
{% endblock %}
""",
}


@pytest.mark.parametrize(
    ("old", "new", "code", "word", "help"),
    [
        ("done: LIGHT_OFF_GOOD", "done: succeeded", "SM701", "succeeded",
         "write `done: LIGHT_OFF_GOOD` in `SHOW`, or correct the property if this path is right"),
        ("[LIGHT_OFF, LIGHT_OFF_GOOD]", "[LIGHT_OFF, LIGHT_OF_GOOD]", "SM703", "LIGHT_OF_GOOD",
         "did you mean `LIGHT_OFF_GOOD`?"),
    ],
)  # fmt: skip
def test_the_state_that_a_property_requires(
    old: str, new: str, code: str, word: str, help: str
) -> None:
    assert reported({"main.yml": LAMP, **TYPE}) == []
    ((found, text, lines),) = reported({"main.yml": LAMP.replace(old, new, 1), **TYPE})
    assert lines is not None
    assert (found, text, lines.splitlines()[0]) == (code, word, help)


def test_a_property_behind_a_wrong_transition_is_no_second_finding() -> None:
    retried = LAMP.replace("outcomes: [done, aborted]", "outcomes: [done, slipped, aborted]")
    retried = retried.replace(
        "transitions: {done: SHOW, aborted: LIGHT_OFF}",
        "retry: {on: [slipped], max: 2}\n"
        "      transitions: {done: SHOW, aborted: LIGHT_OFF, slipped: LIGHT_OFF,"
        " preempted: LIGHT_OFF}",
    ).replace("outcomes: [succeeded, aborted]", "outcomes: [succeeded, aborted, exhausted]", 1)
    found = reported({"main.yml": retried, **TYPE})
    assert [(code, text) for code, text, _ in found if code != "SM203"] == [("SM102", "slipped")]
