"""The help for a state without `template` names the sub-script or the state types that fit it."""

from __future__ import annotations

import pytest

from tests.trust.project_text import MAIN, analysed

SCRIPT = """name: m
template: Base
outcomes: [done, bad]
states:
- %s
"""

PLACE = """- PLACE:
    template: StateMachine
    outcomes: [done, bad]
    states:
    - W: {template: SleepState, time: 1.0, transitions: {succeeded: done, preempted: bad}}
"""


@pytest.mark.parametrize(
    ("state", "help"),
    [
        (
            "WAIT: {time: 2.0, transitions: {succeeded: done, preempted: bad}}",
            "add `template: SleepState`: this type has `time`",
        ),
        (
            "PLACE: {transitions: {done: done, bad: bad}}",
            "add `script: place`, or `template: TYPE` if it is no call of that sub-script",
        ),
        (
            "G: {command: close, transitions: {succeeded: done, aborted: bad, preempted: bad}}",
            "add `template: GripperInterfaceState` or `template: GripperState`:"
            " these types have `command`",
        ),
        ("X: {transitions: {left: done, right: bad}}", "add `template: TYPE`"),
    ],
)
def test_the_help_names_what_fits(state: str, help: str) -> None:
    (found,) = analysed({MAIN: SCRIPT % state, "place.yml": PLACE}).report
    assert (found.code, found.help) == ("SM005", f"{help}; `smachac states` lists the types")


def test_a_misspelt_script_is_one_finding() -> None:
    state = "PLACE: {sccript: place, transitions: {done: done, bad: bad}}"
    (found,) = analysed({MAIN: SCRIPT % state, "place.yml": PLACE}).report
    assert (found.code, found.help) == ("SM005", "write `script:` in place of `sccript:`")
