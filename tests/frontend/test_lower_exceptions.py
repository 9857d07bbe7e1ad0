"""Exceptions as outcomes: which states catch them, where they lead, what is then set."""

from __future__ import annotations

from pathlib import Path
from textwrap import indent

import pytest

import smachac
from smachac.diagnostics.diagnostic import Severity
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import Event
from smachac.ir.nodes import Machine
from smachac.ir.traversal import own_outcomes

HEAD = """
name: sm
outcomes: [succeeded, failed]
userdata: {n: 0}
"""

FAILS = """{template: CallbacksState, input_keys: [n], output_keys: [out],
          callbacks: {out: 'lambda ud: 1 // ud.n'}, TRANSITIONS}"""


def machine_of(folder: Path, states: str, head: str = "") -> Machine:
    path = folder / "main.yml"
    path.write_text(f"{HEAD}{head}\nstates:\n{indent(states, '  ')}", encoding="utf-8")
    return smachac.load(path)


def fails(transitions: str) -> str:
    return FAILS.replace("TRANSITIONS", transitions)


def ended(machine: Machine) -> tuple[str | None, list[str]]:
    """The outcome of a run, and what each state ended with."""
    events: list[Event] = []
    result = run(machine, builtin_behaviour(), events.append)
    return result.outcome, [f"{e['path']} {e['outcome']}" for e in events if e["event"] == "exit"]


def test_a_transition_for_error_catches(tmp_path: Path) -> None:
    machine = machine_of(
        tmp_path, f"- A: {fails('transitions: {succeeded: succeeded, error: failed}')}"
    )
    (leaf,) = machine.root.children
    assert leaf.catches == "error"
    assert own_outcomes(leaf) == ("succeeded",)
    assert ended(machine) == ("failed", ["sm/A error"])


def test_without_one_the_run_fails(tmp_path: Path) -> None:
    machine = machine_of(tmp_path, f"- A: {fails('transitions: {succeeded: succeeded}')}")
    result = run(machine, builtin_behaviour())
    assert result.outcome is None
    assert result.error is not None
    assert "ZeroDivisionError" in result.error.message


def test_a_state_with_an_outcome_error_keeps_it(tmp_path: Path) -> None:
    states = """- A:
    template: ScriptedState
    outcomes: [succeeded, error]
    transitions: {succeeded: succeeded, error: failed}"""
    (leaf,) = machine_of(tmp_path, states).root.children
    assert leaf.catches == ""
    machine = machine_of(tmp_path, states, "on_error: failed")
    (leaf,) = machine.root.children
    assert leaf.catches == "caught_error"
    assert {step.outcome: step.target for step in leaf.transitions}["caught_error"] == "failed"


def test_the_state_of_on_error_does_not_lead_to_itself(tmp_path: Path) -> None:
    recover = fails("transitions: {succeeded: failed}")
    states = f"- A: {fails('transitions: {succeeded: succeeded}')}\n- RECOVER: {recover}"
    machine = machine_of(tmp_path, states, "on_error: RECOVER")
    assert [child.catches for child in machine.root.children] == ["error", ""]
    result = run(machine, builtin_behaviour())
    assert result.error is not None
    assert result.error.path == "sm/RECOVER"


@pytest.mark.parametrize("kind", ["transitions", "on_error"])
def test_a_container_ends_with_what_fails_in_it(tmp_path: Path, kind: str) -> None:
    own = ", error: failed" if kind == "transitions" else ""
    states = f"""- BOX:
    template: StateMachine
    outcomes: [succeeded]
    input_keys: [n]
    output_keys: [out]
    transitions: {{succeeded: succeeded{own}}}
    states:
      - FIRST:
          template: CallbacksState
          output_keys: [out]
          callbacks: {{out: 'lambda ud: 7'}}
          transitions: {{succeeded: A}}
      - A: {fails("transitions: {succeeded: succeeded}")}"""
    machine = machine_of(tmp_path, states, "on_error: failed" if kind == "on_error" else "")
    outcome, exits = ended(machine)
    assert (outcome, exits) == ("failed", ["sm/BOX/FIRST succeeded", "sm/BOX error"])
    assert "out" not in run(machine, builtin_behaviour()).userdata, "nothing is handed out"


def test_a_branch_that_fails_is_told_from_one_that_does_not(tmp_path: Path) -> None:
    states = f"""- BOTH:
    template: Concurrence
    outcomes: [succeeded, lost]
    default_outcome: succeeded
    outcome_map: {{lost: {{A: error}}}}
    input_keys: [n]
    transitions: {{succeeded: succeeded, lost: failed}}
    states:
      - A: {fails("doc: x")}
      - B: {{template: SleepState, time: 1}}"""
    machine = machine_of(tmp_path, states)
    outcome, exits = ended(machine)
    assert outcome == "failed"
    assert exits == ["sm/BOTH/A error", "sm/BOTH/B succeeded", "sm/BOTH lost"]


def test_tries_end_with_exhausted(tmp_path: Path) -> None:
    leads = "{succeeded: succeeded, exhausted: failed, preempted: failed}"
    way = f"retry: {{on: [error], max: 3}}, transitions: {leads}"
    outcome, exits = ended(machine_of(tmp_path, f"- A: {fails(way)}"))
    assert outcome == "failed"
    assert exits == ["sm/A/A error"] * 3 + ["sm/A exhausted"]


def test_a_run_without_an_end_is_not_caught(tmp_path: Path) -> None:
    states = """- BOX:
    template: StateMachine
    outcomes: [succeeded]
    forever: true
    transitions: {succeeded: succeeded, error: failed}
    states:
      - A: {template: SleepState, time: 1, transitions: {succeeded: A, preempted: succeeded}}"""
    result = run(machine_of(tmp_path, states), builtin_behaviour(), max_steps=50)
    assert result.error is not None
    assert result.error.kind == "no-end"


def test_what_an_exception_leaves_unset_is_told(tmp_path: Path) -> None:
    states = f"""- A: {fails("transitions: {succeeded: USE, error: USE}")}
- USE:
    {{template: ScriptedState, input_keys: [out], outcomes: [done], transitions: {{done: failed}}}}
- NEVER: {fails("transitions: {succeeded: succeeded}")}"""
    path = tmp_path / "main.yml"
    path.write_text(f"{HEAD}states:\n{states}", encoding="utf-8")
    found = {item.code for item in smachac.check(path) if item.severity is not Severity.INFO}
    assert "SM301" in found


def test_a_template_that_prints_itself_is_refused(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Old.tpl").write_text(
        "{% block meta %}\nname: Old\noutcomes:\n- done\n{% endblock %}"
        "{% block body %}smach.StateMachine.add('{{ name }}', Old()){% endblock %}"
    )
    machine_of(
        tmp_path,
        "- A: {template: Old, outcomes: [done], transitions: {done: succeeded, error: failed}}",
    )
    with pytest.raises(smachac.ScriptError, match="cannot have an outcome for its exceptions"):
        smachac.compile(tmp_path / "main.yml", "python")
