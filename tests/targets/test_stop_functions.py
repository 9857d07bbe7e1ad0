"""The function of programs that passes requests to stop on: only where a state answers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from smachac.runtime import smach
from smachac.targets.python import module
from tests.support.silent_smach import silent_smach
from tests.targets.test_python_functions import analysis_of, program

INTERFACE = "outcomes: {done: {}}\ncode: {python: 'own:Own'}\n"
NESTED = """\
name: sm
outcomes: [done, stopped]
states:
  - BOX:
      template: StateMachine
      outcomes: [done, stopped]
      transitions: {done: LAST}
      states:
        - A: {template: ScriptedState, outcomes: [done], transitions: {done: B}}
        - B: %s
  - LAST: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
"""
DEAF = "{template: ScriptedState, outcomes: [done], transitions: {done: done}}"


@pytest.mark.parametrize(
    ("state", "again"),
    [
        (DEAF, False),
        ("{template: StateMachine, outcomes: [done], transitions: {done: done},"
         f" states: [C: {DEAF}]}}", False),
        ("{template: SleepState, time: 1, transitions: {succeeded: done, preempted: done}}", True),
        ("{template: ScriptedState, outcomes: [done, preempted],"
         " transitions: {done: done, preempted: done}}", True),
        ("{template: Own, transitions: {done: done}}", True),
        ("{template: Concurrence, outcomes: [done], default_outcome: done,"
         f" transitions: {{done: done}}, states: [C: {DEAF[:-28]}}}]}}", True),
        (f"{DEAF[:-1]}, retry: {{on: [error], max: 2}}}}".replace("{done: done}",
         "{done: done, exhausted: stopped, preempted: stopped}"), True),
    ],
)  # fmt: skip
def test_a_second_request_is_passed_on_where_a_state_may_answer(state: str, again: bool) -> None:
    files = {"main.yml": NESTED % state, "templates/Own.yml": INTERFACE}
    text = program(analysis_of(files))
    assert ("    pass_on_stop_requests(sm)\n    return sm" in text) is again
    assert ("additions import" in text) is (again or "Sleep" in state)


def run(text: str, moments: tuple[int, ...]) -> Iterator[str]:
    """The states in the order of their visits, and the outcome. The machine is asked to stop in
    these visits."""
    names: dict[str, Any] = {"__name__": "generated"}
    exec(compile(text, "generated.py", "exec"), names)
    root = names["build"]()
    visits: list[str] = []

    def follow(machine: Any) -> None:
        for name, child in machine.get_children().items():
            if hasattr(child, "get_children"):
                follow(child)
                continue
            execute = child.execute

            def visit(userdata: Any, execute: Any = execute, name: str = name) -> Any:
                for _ in range(moments.count(len(visits))):
                    root.request_preempt()
                visits.append(name)
                return execute(userdata)

            child.execute = visit

    follow(root)
    with silent_smach():
        outcome = root.execute()
    yield from visits
    yield str(outcome)


@pytest.mark.parametrize("moments", [(0,), (0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2), (0, 3)])
def test_without_an_answer_the_run_is_the_same_on_smach(
    moments: tuple[int, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(smach, "compat", True)
    inner = f"{{template: StateMachine, outcomes: [done], transitions: {{done: done}}, states: [C: {DEAF}]}}"  # noqa: E501
    analysis = analysis_of({"main.yml": NESTED % inner})
    text = program(analysis)
    with monkeypatch.context() as patched:
        patched.setattr(module, "passes_requests_on", lambda machine: True)
        wrapped = program(analysis)
    assert "pass_on_stop_requests(sm)" in wrapped
    assert [*run(text, moments)] == [*run(wrapped, moments)] == ["A", "C", "LAST", "done"]
