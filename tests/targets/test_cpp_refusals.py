"""What C++ cannot express is refused with SM601; what it can express is built."""

from __future__ import annotations

import pytest

import smachac
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build
from smachac.frontend.loader import memory_library
from smachac.targets.cpp import TARGET
from tests.support.typed_machines import BUILT_IN

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


GRASPS = """\
name: grasp
outcomes: [done]
states:
  - LIFT:
      template: StateMachine
      outcomes: [ok]
      states:
        - A: {template: Grasp, transitions: {ok: B}}
        - B: {template: Grasp, transitions: {ok: ok}}
      transitions: {ok: done}
      initial: A
"""


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("header: arm.hpp, class: grasp", "the class `grasp` of `Grasp` has the name"),
        ("header: arm.hpp, class: '::grasp'", "the class `grasp` of `Grasp` has the name"),
        ("header: arm.hpp, class: 'grasp::LIFT'", "generated for `LIFT`"),
        ("header: arm.hpp, class: Grasp, with: 'const grasp &arm'", "the class `grasp`"),
        ("header: grasp.hpp, class: Grasp", "would both be `grasp.hpp`"),
        ("header: arm/grasp.hpp, class: Grasp, with: 'arm::grasp &arm'", ""),
        ("header: arm.hpp, class: 'grasp::Arm'", ""),
    ],
)
def test_a_class_with_a_name_of_the_generated_header_is_refused(code: str, words: str) -> None:
    interface = f"outcomes: {{ok: {{}}}}\ncode: {{cpp: {{{code}}}}}\n"
    library = memory_library({"templates/Grasp.yml": interface}, BUILT_IN)
    checked = analyse(Source("grasp.yml", GRASPS), library, []).checked
    assert checked is not None
    report: Report = []
    files = build(checked, TARGET, library, report)
    assert [(item.code, item.span.text) for item in report] == [("SM601", "A")][: bool(words)]
    assert all(words in item.message for item in report)
    assert bool(files) != bool(words)
