"""Userdata is kept between visits of a container: by the runtime, the interpreter and C++.

SM319 is about counters that nobody sets back, so it rests on this.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from tests.cpp.compiled_traces import NOBODY, header, traces
from tests.cpp.compilers import compilers
from tests.support.examples import every

STATES = """\
      userdata: {tries: 0}
      states:
        - PICK: {template: ScriptedState, outcomes: [slipped], transitions: {slipped: COUNT}}
        - COUNT:
            template: CallbacksState
            input_keys: [tries]
            output_keys: [tries]
            callbacks: {tries: 'lambda ud: ud.tries + 1'}
            transitions: {succeeded: AGAIN}
        - AGAIN:
            template: ConditionalOutcomeState
            input_keys: [tries]
            outcomes: [again]
            callbacks: {again: 'lambda ud: ud.tries < 3'}
            default_outcome: enough
            transitions: {again: PICK, enough: lost}
"""

HEAD = "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
SERVE = "  - SERVE:\n      template: StateMachine\n      outcomes: [lost]\n"

CYCLE = f"""{HEAD}{SERVE}      transitions: {{lost: MORE}}
{STATES}  - MORE:
      template: ScriptedState
      outcomes: [more, last]
      steps: [{{outcome: more}}, {{outcome: more}}, {{outcome: last}}]
      transitions: {{more: SERVE, last: done}}
"""
FOR_EACH = f"""{HEAD}{SERVE}      for_each: {{item: part, in: [1, 2, 3], on: [lost]}}
      transitions: {{lost: done, preempted: done}}
{STATES}"""
RETRY = f"""{HEAD}{SERVE}      retry: {{on: [lost], max: 3}}
      transitions: {{exhausted: done, preempted: done}}
{STATES}"""


def picks(events: list[dict[str, Any]]) -> int:
    entered = [event for event in events if event["event"] == "enter"]
    return sum(event["path"].endswith("/PICK") for event in entered)


@pytest.mark.parametrize(
    "text", every(3, [CYCLE, FOR_EACH, RETRY]), ids=["cycle", "for_each", "retry"]
)
def test_three_visits_of_a_counter_give_three_tries_and_then_one_each(
    text: str, tmp_path: Path
) -> None:
    script = tmp_path / "sm.yml"
    script.write_text(text, "utf-8")
    machine = smachac.load(str(script))
    told: dict[str, list[dict[str, Any]]] = {"python": [], "interpreter": []}
    smachac.run(str(script), observe=told["python"].append)
    run(machine, builtin_behaviour(), told["interpreter"].append)
    for compiler in compilers()[:1]:
        made = header(machine)
        assert made is not None
        (told["cpp"],) = traces([(machine, made, NOBODY)], compiler, tmp_path)
    assert {name: picks(events) for name, events in told.items()} == dict.fromkeys(told, 5)
