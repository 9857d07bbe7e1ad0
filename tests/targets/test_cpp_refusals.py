"""What C++ cannot express is refused with SM601; what it can express is built."""

from __future__ import annotations

import pytest

import smachac

RECORDS = """\
name: m
outcomes: [done]
userdata: {parts: {type: "list[{name: str}]", value: [{name: bolt}]}}
states:
  - EACH:
      template: StateMachine
      outcomes: [succeeded]
      input_keys: [part]
      for_each: {item: part, in: parts}
      transitions: {succeeded: done, preempted: done}
      states:
        - A:
            template: ScriptedState
            outcomes: [ok]
            input_keys: [part]
            transitions: {ok: succeeded}
"""

COMPLETE = """\
name: m
outcomes: [done, failed]
states:
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      outcome_map:
        done: {A: ok, B: any}
        failed: {A: bad}
      states:
        - A: {template: ScriptedState, outcomes: [ok, bad]}
        - B: {template: ScriptedState, outcomes: [ok, bad]}
"""


def test_a_record_that_a_container_shares_is_refused() -> None:
    with pytest.raises(smachac.ScriptError) as caught:
        smachac.compile(RECORDS, "cpp", name="main.yml")
    assert {finding.code for finding in caught.value.report} >= {"SM601"}


def test_a_concurrence_whose_rules_are_complete_needs_no_default_outcome() -> None:
    text = smachac.compile(COMPLETE, "cpp", name="main.yml")["m.hpp"]
    assert text.count("return Outcome::failed;") == 2  # by the rule, and at the end of the function
