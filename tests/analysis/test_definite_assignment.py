"""What the data flow says of a machine against what happens in it."""

from __future__ import annotations

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st

from smachac.analysis.def_use import key_status, path_without
from smachac.analysis.definite_assignment import data_flow
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import Interpreter
from smachac.interpreter.result import Event
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from tests.strategies.userdata_machines import Brute, data_machines, keys_of
from tests.support.examples import examples


@settings(max_examples=150)
@given(data_machines(linear=True))
@pytest.mark.slow
def test_the_flow_says_what_all_that_can_happen_shows(machine: Machine) -> None:
    flow = data_flow(machine)
    brute = Brute(machine)
    for path, around, key in keys_of(machine):
        entries = brute.entries.get(path, set())
        found = {(around, key) in slots for slots in entries}
        meant = {0: "unreachable", 2: "sometimes"}.get(len(found))
        meant = meant or ("always" if True in found else "never")
        event(meant)
        assert key_status(flow, path, key) == meant, (path, key)


@settings(max_examples=200)
@given(data_machines(), st.integers(0, 9), st.integers(0, 6))
@pytest.mark.slow
def test_runs_find_what_is_called_always_set_and_miss_what_is_called_never(
    machine: Machine, seed: int, asked: int
) -> None:
    flow = data_flow(machine)
    said = {
        (path, key): (around, key_status(flow, path, key)) for path, around, key in keys_of(machine)
    }
    entered: set[str] = set()

    def observe(told: Event) -> None:
        path = told["path"]
        if told["event"] != "enter":
            return
        entered.add(path)
        for (where, key), (around, status) in said.items():
            if where == path:
                is_set = key in interpreter._scopes[around]
                assert status == "sometimes" or is_set == (status == "always"), (path, key, status)

    interpreter = Interpreter(
        machine, builtin_behaviour(seed), observe, seed=seed, max_steps=60, preempt_at={asked} - {0}
    )
    interpreter.execute()
    assert entered <= flow.entered


@settings(max_examples=examples(60))
@given(data_machines())
def test_a_path_on_which_a_key_is_unset_leads_to_the_state(machine: Machine) -> None:
    flow = data_flow(machine)
    for path, _, key in keys_of(machine):
        way = path_without(flow, path, key)
        missing = key_status(flow, path, key) in ("sometimes", "never")
        assert bool(way) == missing
        assert not way or way[-1] == path.rpartition("/")[2]


@settings(max_examples=examples(60))
@given(data_machines())
def test_every_state_is_entered_or_said_not_to_be(machine: Machine) -> None:
    flow = data_flow(machine)
    for path, _, key in keys_of(machine):
        assert (key_status(flow, path, key) == "unreachable") == (path not in flow.entered)
    assert flow.entered <= {path for path, _ in walk(machine.root)}
