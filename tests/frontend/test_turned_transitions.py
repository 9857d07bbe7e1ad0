"""Transitions whose outcome and target have changed places are one finding with the repair."""

from __future__ import annotations

import pytest

from tests.trust.project_text import MAIN, analysed

SCRIPT = """name: kit
template: Base
outcomes: [kitted, failed]
states:
- FETCH:
    template: ScriptedState
    outcomes: [found, lost]
    transitions: {found: REPORT, lost: failed}
- REPORT:
    template: ScriptedState
    outcomes: [succeeded, aborted]
    transitions: {succeeded: kitted, aborted: failed}
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("succeeded: kitted", "kitted: succeeded"),
        ("aborted: failed", "failed: aborted"),
        ("found: REPORT", "REPORT: found"),
    ],
)
def test_a_turned_transition_is_one_finding(old: str, new: str) -> None:
    report = analysed({MAIN: SCRIPT.replace(old, new)}).report
    assert [(item.code, item.finding.help) for item in report] == [
        ("SM004", f"write `{old}`: the outcome comes first, then its target")
    ]


def test_a_second_transition_for_an_outcome_can_be_turned() -> None:
    text = SCRIPT.replace("outcomes: [kitted, failed]", "outcomes: [kitted, aborted]")
    text = text.replace("lost: failed", "lost: aborted").replace(
        "aborted: failed", "aborted: aborted"
    )
    right = text.replace("[succeeded, aborted]", "[succeeded, aborted, stopped]")
    right = right.replace("aborted: aborted}", "aborted: aborted, stopped: aborted}")
    assert analysed({MAIN: right}).report == []
    report = analysed({MAIN: right.replace("stopped: aborted", "aborted: stopped")}).report
    assert [(item.code, item.finding.help) for item in report] == [
        ("SM004", "write `stopped: aborted`: the outcome comes first, then its target")
    ]


def test_the_edits_of_the_finding_turn_it_back() -> None:
    text = SCRIPT.replace("succeeded: kitted", "kitted: succeeded")
    (found,) = analysed({MAIN: text}).report
    for edit in sorted(found.finding.edits, key=lambda edit: -edit.span.start):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    assert text == SCRIPT
