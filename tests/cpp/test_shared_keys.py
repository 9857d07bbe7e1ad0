"""Containers use the keys of the containers around them without copies, where nobody can see it."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.ir.nodes import Machine
from smachac.targets.cpp.plan import plan
from tests.cpp.compiled_traces import LIBRARY, NOBODY, header
from tests.cpp.compilers import last_with
from tests.cpp.test_machines import agree
from tests.pipeline.test_differential import of_interpreter

SCRIPT = """
name: sm
outcomes: [old, new]
userdata: {n: 1, zero: 0}
states:
  - INNER:
      template: StateMachine
      outcomes: [done]
      input_keys: [n, zero]
      output_keys: [n]
      transitions: {done: CHECK}
      states:
        - SET:
            template: CallbacksState
            input_keys: [n]
            output_keys: [n]
            callbacks: {n: 'lambda ud: ud.n + 1'}
            transitions: {succeeded: USE}
        - USE:
            template: CallbacksState
            input_keys: [n, zero]
            output_keys: [n]
            callbacks: {n: 'lambda ud: ud.n // (ud.zero + 1)'}
            transitions: {succeeded: done}
  - CHECK:
      template: ConditionalOutcomeState
      input_keys: [n]
      outcomes: [old, new]
      callbacks: {old: 'lambda ud: ud.n == 1'}
      default_outcome: new
"""


def machine_of(script: str) -> Machine:
    report: Report = []
    checked = analyse(Source("main.yml", script), LIBRARY, report).checked
    assert checked is not None, report
    return checked


TRANSITIONS = "      transitions: {done: CHECK}\n"
LOCAL = [("output_keys: [n]\n", "output_keys: []\n")]
PRESET = [(TRANSITIONS, f"      userdata: {{n: 5}}\n{TRANSITIONS}")]
TWO_NAMES = [(TRANSITIONS, f"      remapping: {{zero: n}}\n{TRANSITIONS}")]
CAUGHT = [("(ud.zero + 1)", "ud.zero"), ("{done: CHECK}", "{done: CHECK, error: CHECK}")]


@pytest.mark.parametrize(
    ("changes", "shared"),
    [
        pytest.param([], {"n", "zero"}, id="in-and-out"),
        pytest.param(LOCAL, {"zero"}, id="written-inside-only"),
        pytest.param(PRESET, {"zero"}, id="preset-inside"),
        pytest.param(TWO_NAMES, set(), id="two-names-for-one-key"),
        pytest.param(CAUGHT, {"zero"}, id="caught"),
    ],
)
@pytest.mark.slow
def test_keys_are_shared_where_a_copy_makes_no_difference(
    changes: list[tuple[str, str]], shared: set[str], tmp_path: Path
) -> None:
    text = SCRIPT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    machine = machine_of(text)
    assert plan(machine).scopes["sm/INNER"].shared == shared
    ours, printed = of_interpreter(machine), header(machine)
    assert ours is not None
    assert printed is not None
    agree([((machine, printed, NOBODY), ours)], last_with("-O0"), tmp_path)


@pytest.mark.slow
def test_a_copy_of_userdata_is_independent(tmp_path: Path) -> None:
    text = header(machine_of(SCRIPT))
    assert text is not None
    main = """
int main() {
  sm::Userdata first;
  sm::Userdata second = first;
  sm::States states;
  smachac::Stop stop;
  sm::run(states, second, nullptr, stop);
  std::printf("%d %d\\n", static_cast<int>(first.n.get()), static_cast<int>(second.n.get()));
}
"""
    program = text.replace("#pragma once\n", "") + main
    assert last_with("-O0").run(program, tmp_path, "-pthread") == "1 2\n"
