"""The arguments of findings over the graph: the names that each is about, whoever calls them."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Report
from smachac.driver import CODES, analyse_script
from smachac.report.explain_code import MAIN, explanation

ARGUMENTS = {
    "SM101": ("sm", "PALCE_BLOCK"),
    "SM102": ("PICK", "sliped"),
    "SM103": ("BOTH", "partly"),
    "SM104": ("PICK", "blocked"),
    "SM105": ("PICK", "failed"),
    "SM106": ("MOVE",),
    "SM107": ("done",),
    "SM108": ("PICK",),
    "SM201": ("OPEN_GRIPPER",),
    "SM202": ("APPROACH", "LOOK"),
    "SM203": ("sm", "lost"),
    "SM204": ("PICK", "failed"),
    "SM205": ("sm", "PIKC"),
    "SM206": ("PLACE", "aborted", "PLACE"),
    "SM207": ("WAIT",),
    "SM208": ("EACH", "done"),
    "SM209": ("WAIT", "preempted"),
    "SM210": ("WAIT", "preempted", "succeeded"),
    "SM211": ("WAIT", "preempted", "LIFT"),
    "SM212": ("SETTLE", "succeeded"),
    "SM213": ("AGAIN", "tries"),
    "SM404": ("BOTH", "ready", "", "LEFT", "RIGHT"),
    "SM407": ("WATCH",),
}
"""Those of the finding in the example of each code."""


def every_finding(files: dict[str, str], folder: Path) -> Report:
    """The findings of the rules over the graph, also those that calls repeat."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    machine = analyse_script(folder / MAIN).machine
    assert machine is not None
    return check_machine(machine)


@pytest.mark.parametrize("code", ARGUMENTS)
def test_the_example_of_a_code_has_these_arguments(code: str, tmp_path: Path) -> None:
    report = every_finding(dict(explanation(CODES[code]).wrong), tmp_path)
    found = [item.finding.arguments for item in report if item.code == code]
    assert found == [ARGUMENTS[code]]


CALLS = """\
name: sm
template: Base
outcomes: [succeeded, failed]
states:
  - FIRST: {script: sub, transitions: {ok: succeeded, bad: SECOND, never: failed}}
  - SECOND: {script: sub, transitions: {ok: succeeded, bad: failed, never: failed}}
"""

CALLED = """\
- PLAIN:
    template: StateMachine
    outcomes: [ok, bad, never, FIRST]
    states:
      - WORK: {template: ScriptedState, outcomes: [fine, failed, x], transitions: {fine: LOOP}}
      - LOOP: {template: ScriptedState, outcomes: [ok, failed],
          transitions: {ok: ok, failed: LOOP, side: ok}}
      - LOST: {template: ScriptedState, outcomes: [ok], transitions: {ok: NOWHERE}}
    transitions: {okk: bad, failed: bda}
"""


@pytest.mark.parametrize(
    ("code", "replaced", "arguments"),
    [
        ("SM101", {}, {("", "bad"), ("", "bda"), ("", "NOWHERE")}),
        ("SM102", {}, {("LOOP", "side"), ("", "okk"), ("", "failed")}),
        ("SM104", {}, {("WORK", "failed", "x")}),
        ("SM105", {"never": "failed"}, {("WORK", "failed")}),
        ("SM201", {", failed, x]": "]"}, {("LOST",)}),
        ("SM203", {"NOWHERE": "ok", ", x]": "]", "never": "failed"}, {("", "bad"), ("", "FIRST")}),
        ("SM204", {}, {("LOOP", "failed")}),
        ("SM205", {"states": "initial: A\n    states"}, {("", "A")}),
        ("SM206", {"failed: LOOP": "failed: ok"}, {("LOOP", "failed", "LOOP")}),
    ],
)
def test_arguments_do_not_depend_on_the_caller_of_a_sub_script(
    code: str, replaced: dict[str, str], arguments: set[tuple[str, ...]], tmp_path: Path
) -> None:
    called = CALLED
    for old, new in replaced.items():
        called = called.replace(old, new)
    report = every_finding({MAIN: CALLS, "sub.yml": called}, tmp_path)
    for call in ("FIRST", "SECOND"):
        found = {
            item.finding.arguments
            for item in report
            if item.code == code
            and item.span.source.name.endswith("sub.yml")
            and str(item.finding.node).startswith(f"sm/{call}")
        }
        assert found == arguments
