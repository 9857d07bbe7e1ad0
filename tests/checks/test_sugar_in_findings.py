"""Findings about states with sugar name the states of the script, not the containers made of it."""

from __future__ import annotations

import random
import re

import pytest

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script

SCRIPT = """\
name: sm
template: Base
outcomes: [done, failed, stopped]
userdata: {todo: [1, 2], total: 0}
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [succeeded, aborted, preempted]
      input_keys: [wp, total]
      output_keys: [total, made]
      claims: [arm]
      timeout: 5s
      retry: {on: [aborted, timeout], max: 3, delay: 1s}
      for_each: {item: wp, in: todo}
      transitions: {succeeded: BOTH, exhausted: failed, preempted: stopped}
  - BOTH:
      template: Concurrence
      outcomes: [succeeded, failed, preempted]
      default_outcome: failed
      input_keys: [todo, total, made]
      output_keys: [total]
      outcome_map: {succeeded: {LEFT: succeeded, RIGHT: succeeded}}
      timeout: 7s
      retry: {on: [failed], max: 2}
      states:
        - LEFT:
            template: CallbacksState
            input_keys: [total, made]
            output_keys: [total]
            callbacks: {total: "lambda ud: ud.total + ud.made"}
            claims: [arm]
            timeout: 1s
            retry: {on: [timeout], max: 2}
        - RIGHT:
            template: SleepState
            time: 3
            claims: [arm]
            timeout: 2s
            for_each: {item: one, in: todo}
      transitions: {succeeded: INNER, failed: failed, exhausted: failed, preempted: stopped,
                    timeout: failed}
  - INNER:
      template: StateMachine
      outcomes: [succeeded, aborted]
      input_keys: [total, made]
      output_keys: [found]
      retry: {on: [aborted, timeout], max: 4, delay: 2s}
      timeout: 30s
      for_each: {item: two, in: [1, 2]}
      states:
        - LIFT:
            template: PrintUserdataState
            input_keys: [total]
            timeout: 3s
            retry: {on: [timeout], max: 2}
            transitions: {succeeded: TURN, exhausted: aborted, preempted: aborted}
        - TURN:
            template: ScriptedState
            outcomes: [there, lost]
            output_keys: [found]
            timeout: 4s
            retry: {on: [lost], max: 2, delay: 1s}
            transitions: {there: succeeded, timeout: LIFT, exhausted: aborted, preempted: aborted}
      transitions: {succeeded: SHOW, exhausted: failed, preempted: stopped}
  - SHOW:
      template: PrintUserdataState
      input_keys: [found]
      timeout: 1s
      for_each: {item: one, in: todo}
      transitions: {succeeded: done, preempted: stopped, timeout: failed}
"""

INNER_NAME = re.compile(r"\b(TIMED|TRIES|TRY)\b|\b([A-Z]+)/\2\b")
WORDS = re.findall(r"[A-Za-z_]{3,}", SCRIPT)


def damaged(draw: random.Random) -> str:
    """The script without some lines and entries, and with some words replaced."""
    text = SCRIPT
    for _ in range(draw.randint(1, 5)):
        match draw.randrange(4):
            case 0:
                lines = text.splitlines(keepends=True)
                del lines[draw.randrange(5, len(lines))]
                text = "".join(lines)
            case 1:
                found = draw.choice(list(re.finditer(r"[A-Za-z_]{3,}", text)))
                text = text[: found.start()] + draw.choice(WORDS) + text[found.end() :]
            case 2:
                found = draw.choice(list(re.finditer(r"\w+: \w+, |, \w+: \w+|, \w+|\w+, ", text)))
                text = text[: found.start()] + text[found.end() :]
            case _:
                found = draw.choice(list(re.finditer(r"transitions: \{", text)))
                new = f"error: {draw.choice(WORDS)}, "
                text = text[: found.end()] + new + text[found.end() :]
    return text


def words_of(item: Diagnostic) -> list[str]:
    finding = item.finding
    related = [one.message for one in finding.related]
    steps = [*finding.path_labels, *(step.node or "" for step in finding.path)]
    return [finding.message, finding.help or "", finding.node or "", *related, *steps,
            *finding.arguments]  # fmt: skip


@pytest.mark.parametrize(
    "start",
    [0, 20, *(pytest.param(start, marks=pytest.mark.nightly) for start in range(40, 160, 20))],
)
def test_containers_made_of_sugar_are_not_named(start: int) -> None:
    found = 0
    for seed in range(start, start + 20):
        text = damaged(random.Random(seed)) if seed else SCRIPT
        for item in analyse_script(Source("main.yml", text)).report:
            found += 1
            named = [one for one in words_of(item) if INNER_NAME.search(one)]
            assert named == [], (seed, item.code)
    assert found > 50


def test_a_witness_path_has_one_step_for_a_state_and_its_sugar() -> None:
    text = SCRIPT.replace("output_keys: [found]\n            timeout", "timeout")
    report = analyse_script(Source("main.yml", text)).report
    (item,) = [one for one in report if one.code == "SM301" and one.finding.node == "sm/SHOW"]
    assert item.finding.path_labels == (
        *("DRIVE", "(succeeded)", "BOTH", "(succeeded)", "INNER", "(succeeded)", "SHOW"),
    )
