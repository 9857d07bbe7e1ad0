"""Paths as the script shows them: every combination of sugar, around states and containers."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine
from smachac.ir.script_paths import script_paths, walk_script
from smachac.runtime.tracing.writer import shown_path

SCRIPT = """\
name: sm
template: Base
outcomes: [done, failed]
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [succeeded, aborted]
      SUGAR
      transitions: {succeeded: done, aborted: failed, preempted: failed, timeout: failed,
                    exhausted: failed}
"""


def machine(sugar: str, script: str = SCRIPT) -> Machine:
    text = script.replace("SUGAR", "\n      ".join(sugar.split("; ")))
    found = analyse_script(Source("m.yml", text)).machine
    assert found is not None
    return found


LIMIT = "timeout: 5s"
RETRY = "retry: {on: [aborted], max: 3}"
SLOWLY = "retry: {on: [aborted], max: 3, delay: 1s}"
EACH = "for_each: {item: one, in: [a, b]}"


@pytest.mark.parametrize(
    ("sugar", "shown"),
    [
        (LIMIT, {"": " (timeout)", "/DRIVE": "", "/TIMER": " (timeout)/TIMER"}),
        (RETRY, {"": " (retry)", "/DRIVE": ""}),
        (EACH, {"": " (for_each)", "/DRIVE": ""}),
        (
            f"{SLOWLY}; {LIMIT}; {EACH}",
            {
                "": " (for_each)",
                "/TRIES": " (retry)",
                "/TRIES/TRY": " (try)",
                "/TRIES/TRY/PAUSE": " (try)/PAUSE",
                "/TRIES/TRY/TIMED": " (timeout)",
                "/TRIES/TRY/TIMED/DRIVE": "",
                "/TRIES/TRY/TIMED/TIMER": " (timeout)/TIMER",
            },
        ),
    ],
)
def test_the_path_of_a_state_is_that_of_the_script(sugar: str, shown: dict[str, str]) -> None:
    root = machine(sugar).root
    found = {item.full: item.shown for item in walk_script(root)}
    expected = {f"sm/DRIVE{full}": f"sm/DRIVE{path}" for full, path in shown.items()}
    assert found == {"sm": "sm", **expected}
    assert len(set(found.values())) == len(found)
    assert script_paths(root) == {full: path for full, path in expected.items() if full != path}


def test_a_machine_without_sugar_has_the_same_paths() -> None:
    assert script_paths(machine("steps: []").root) == {}


def test_states_inside_a_container_with_sugar_have_its_path() -> None:
    states = "SUGAR\n      states: [{GO: {template: ScriptedState, outcomes: [aborted]}}]"
    text = SCRIPT.replace("ScriptedState", "StateMachine").replace("SUGAR", states)
    paths = script_paths(machine(f"{RETRY}; {LIMIT}", text).root)
    assert paths["sm/DRIVE/TIMED/DRIVE/GO"] == "sm/DRIVE/GO"
    assert paths["sm/DRIVE/TIMED/DRIVE"] == "sm/DRIVE"


def test_names_of_states_do_not_clash_with_those_of_sugar() -> None:
    for name in ("TIMED", "TRY", "TRIES", "TIMER", "PAUSE"):
        root = machine(f"{SLOWLY}; {LIMIT}; {EACH}", SCRIPT.replace("DRIVE", name)).root
        found = [item.shown for item in walk_script(root)]
        assert len(set(found)) == len(found)
        assert f"sm/{name}" in found


def test_the_end_of_a_container_is_in_script_paths_too() -> None:
    paths = {"sm/A:B": "sm/X", "sm/A": "sm/Y"}
    assert shown_path("sm/A:done", paths) == "sm/Y:done"
    assert shown_path("sm/A:B:done", paths) == "sm/Y:B:done"
    assert shown_path("sm/A:B", paths) == "sm/X"
    assert shown_path("sm/Z:done", paths) == "sm/Z:done"
