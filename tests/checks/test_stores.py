"""Dead stores: a key that every path sets again before a state reads it."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

LOOK = (
    "{{template: ScriptedState, outcomes: [ok{more}], output_keys: [pose], transitions: {{{to}}}}}"
)
READ = "{template: ScriptedState, outcomes: [ok], input_keys: [pose], transitions: {ok: done}}"


def look(to: str, more: str = "") -> str:
    return LOOK.format(to=to, more=more)


def dead(*states: str, head: str = "outcomes: [done]", **files: str) -> list[str]:
    """The messages of SM320 for the states of a machine; `files`: sub-scripts."""
    listed = "".join(f"  - {state}\n" for state in states)
    text = f"name: sm\ntemplate: Base\n{head}\nstates:\n{listed}"
    library = memory_library({f"{name}.yml": each for name, each in files.items()}, BUILT_IN)
    report = analyse(Source("main.yml", text), library, []).report
    assert not [item for item in report if item.severity is Severity.ERROR]
    return [item.finding.message for item in report if item.code == "SM320"]


def test_a_store_that_the_next_state_overwrites() -> None:
    found = dead(f"A: {look('ok: B')}", f"B: {look('ok: GO')}", f"GO: {READ}")
    assert found == ["`A` sets `pose`, but `B` sets it again before a state reads it"]


def test_a_read_on_one_path_keeps_a_store_alive() -> None:
    more = ", near"
    assert not dead(f"A: {look('ok: B, near: GO', more)}", f"B: {look('ok: GO')}", f"GO: {READ}")


def test_overwritten_on_each_of_several_paths() -> None:
    found = dead(
        f"A: {look('ok: B, near: C', ', near')}",
        f"B: {look('ok: GO')}",
        f"C: {look('ok: GO')}",
        f"GO: {READ}",
    )
    assert found == ["`A` sets `pose`, but `B`, `C` sets it again before a state reads it"]


def test_a_state_that_fails_leaves_the_value_before_it() -> None:
    """The rough pose is the substitute if the exact one is not found."""
    exact = look("ok: GO, failed: GO", ", failed")
    assert not dead(f"ROUGH: {look('ok: EXACT')}", f"EXACT: {exact}", f"GO: {READ}")


def test_a_loop_that_tries_again_is_no_dead_store() -> None:
    again = look("ok: GO, unsure: A", ", unsure")
    assert not dead(f"A: {again}", f"GO: {READ}")


def test_the_end_of_the_machine_is_a_read() -> None:
    states = [f"A: {look('ok: B, none: done', ', none')}", f"B: {look('ok: done')}"]
    assert not dead(*states, head="outcomes: [done]\noutput_keys: [pose]")


def test_a_state_that_also_reads_the_key() -> None:
    count = (
        "{template: CallbacksState, input_keys: [n], output_keys: [n],"
        " callbacks: {n: 'lambda ud: ud.n + 1'}, transitions: {succeeded: %s}}"
    )
    assert not dead(
        f"A: {count % 'B'}", f"B: {count % 'done'}", head="outcomes: [done]\nuserdata: {n: 0}"
    )


def test_callbacks_are_judged_one_by_one() -> None:
    both = (
        "{template: CallbacksState, output_keys: [n, m], callbacks: {n: 'lambda ud: 1',"
        " m: 'lambda ud: 2'}, transitions: {succeeded: B}}"
    )
    one = (
        "{template: CallbacksState, output_keys: [n], callbacks: {n: 'lambda ud: 3'},"
        " transitions: {succeeded: SHOW}}"
    )
    show = "{template: PrintUserdataState, input_keys: [n, m], transitions: {succeeded: done}}"
    found = dead(f"A: {both}", f"B: {one}", f"SHOW: {show}")
    assert found == ["`A` sets `n`, but `B` sets it again before a state reads it"]


def test_a_state_whose_other_output_is_read_is_not_reported() -> None:
    two = LOOK.format(to="ok: B", more="").replace("[pose]", "[pose, quality]")
    read = READ.replace("[pose]", "[pose, quality]")
    assert not dead(f"A: {two}", f"B: {look('ok: GO')}", f"GO: {read}")


MACHINE = """{template: StateMachine, outcomes: [ok], input_keys: [pose], states: [
      X: {template: PrintUserdataState, input_keys: [pose], transitions: {succeeded: ok}}],
      transitions: {ok: B}}"""
ITERATOR = """{template: Iterator, outcomes: [ok], input_keys: [pose], it: '`lambda ud: ud.pose`',
      it_label: i, exhausted_outcome: ok, loop_outcomes: [succeeded],
      states: [X: {template: PrintUserdataState, input_keys: [i]}], transitions: {ok: B}}"""


@pytest.mark.parametrize("between", [MACHINE, ITERATOR])
def test_a_container_that_takes_the_key_in_may_read_it(between: str) -> None:
    assert not dead(f"A: {look('ok: IN')}", f"IN: {between}", f"B: {look('ok: GO')}", f"GO: {READ}")


def test_outputs_of_a_state_type_are_not_reported() -> None:
    grip = (
        "{template: GripperState, command: %s,"
        " transitions: {succeeded: %s, aborted: done, preempted: done}}"
    )
    read = READ.replace("[pose]", "[width]")
    assert not dead(f"A: {grip % ('open', 'B')}", f"B: {grip % ('close', 'GO')}", f"GO: {read}")
