"""Compiled machines hide the values of secret keys in their traces."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.runtime.tracing.writer import SECRET
from tests.cpp.compiled_traces import NOBODY, header
from tests.cpp.compilers import last_with
from tests.cpp.test_machines import agree
from tests.cpp.test_shared_keys import machine_of
from tests.pipeline.test_differential import of_interpreter

SCRIPT = """
name: sm
outcomes: [done]
userdata:
  pin: {type: str, value: '', secret: true}
  shown: ''
states:
  - ASK:
      template: ScriptedState
      outcomes: [done]
      output_keys: [pin, shown]
      steps: [{outcome: done, set: {pin: '4711', shown: '12'}}]
      transitions: {done: INNER}
  - INNER:
      template: StateMachine
      outcomes: [done]
      input_keys: [code]
      output_keys: [code]
      remapping: {code: pin}
      transitions: {done: done}
      states:
        - ADD:
            template: CallbacksState
            input_keys: [code]
            output_keys: [code]
            callbacks: {code: 'lambda ud: ud.code + "08"'}
            transitions: {succeeded: done}
"""


@pytest.mark.slow
def test_traces_of_compiled_machines_hide_secret_keys(tmp_path: Path) -> None:
    machine = machine_of(SCRIPT)
    ours, printed = of_interpreter(machine), header(machine)
    assert ours is not None
    assert printed is not None
    values = [event["value"] for event in ours if event["event"] == "write"]
    assert values == [SECRET, "12", SECRET]
    agree([((machine, printed, NOBODY), ours)], last_with("-O0"), tmp_path)
