"""Requests to stop on every target: whatever the moment, a loop ends as preempted."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.explore import explore
from smachac.interpreter.interpreter import run
from smachac.runtime import smach
from tests.conformance_ir import generated_vectors
from tests.conformance_ir.test_ir_vectors import expected, replay
from tests.support.stop_machines import cases

EARLY = """\
name: sm
outcomes: [done, stopped]
states:
  - BOTH:
      template: Concurrence
      join: any
      outcomes: [done, stopped]
      default_outcome: done
      outcome_map: {stopped: {ITEMS: preempted}}
      states:
        - ITEMS: {template: SleepState, time: 30, for_each: {item: i, in: [1, 2, 3]}}
        - NOW: {template: ScriptedState, outcomes: [succeeded]}
"""

DEAF = """\
name: sm
outcomes: [good, bad, stopped]
states:
  - WORK:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      %s
      transitions: {succeeded: good, %s, preempted: stopped}
"""

SUGAR = [
    ("for_each: {item: i, in: [1, 2, 3]}", "aborted: bad"),
    ("for_each: {item: i, in: []}", "aborted: bad"),
    ("retry: {on: [aborted], max: 3}", "exhausted: bad"),
    ("timeout: 5s", "aborted: bad, timeout: bad"),
]


def written(folder: Path, text: str) -> Path:
    script = folder / "main.yml"
    script.write_text(text, "utf-8")
    return script


def built(script: Path) -> Any:
    names: dict[str, Any] = {"__name__": "generated"}
    (text,) = smachac.compile(script, "python").values()
    exec(compile(text, "generated.py", "exec"), names)
    return names["build"]()


@pytest.mark.parametrize("number", range(5))
def test_a_loop_that_has_not_begun_is_stopped(tmp_path: Path, number: int) -> None:
    """With threads the instant branch ends before or after the loop has begun: both end at once."""
    script = written(tmp_path, EARLY)
    machine = smachac.load(script)
    result = run(machine, builtin_behaviour(), seed=number)
    assert (result.outcome, result.time) == ("stopped", 0.0)
    assert built(script).execute() == "stopped"


@pytest.mark.parametrize(("sugar", "transitions"), SUGAR)
def test_no_success_comes_from_a_stopped_loop(tmp_path: Path, sugar: str, transitions: str) -> None:
    script = written(tmp_path, DEAF % (sugar, transitions))
    machine = smachac.load(script)
    assert run(machine, builtin_behaviour()).outcome == "good"
    assert run(machine, builtin_behaviour(), preempt_at=[0]).outcome == "stopped"
    if "[]" not in sugar:  # a visit of the state, which does not answer
        assert run(machine, builtin_behaviour(), preempt_at=[1]).outcome == "stopped"
    program = built(script)
    program.request_preempt()
    assert program.execute() == "stopped"


@pytest.mark.usefixtures("silent_smach")
def test_generated_code_does_the_same_on_smach(monkeypatch: pytest.MonkeyPatch) -> None:
    """On the bundled runtime as SMACH, which loses requests: the module passes them on itself."""
    monkeypatch.setattr(smach, "compat", True)
    for case in cases(3, 60):
        assert asked(replay(case)) == asked(expected(case, generated_vectors.replay(case)))


def asked(runs: Any) -> Any:
    """Runs, with the states that began with a request, without the moments of requests."""
    return [(run["outcome"], _entered(run["events"])) for run in runs]


def _entered(events: Any) -> Any:
    found: list[Any] = []
    for event in events:
        if isinstance(event, dict):
            branches = {label: _entered(inner) for label, inner in event.items()}
            found += [{label: inner for label, inner in branches.items() if inner}]
        elif event[0] != "P":
            found.append(event)
    return [event for event in found if event]


def test_every_order_of_branches_includes_the_moments_of_a_stop(tmp_path: Path) -> None:
    results = list(explore(smachac.load(written(tmp_path, EARLY)), builtin_behaviour))
    assert {result.outcome for result in results} == {"stopped"}
