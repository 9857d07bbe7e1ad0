"""SM301 where a failure leads to a state that reads what is unset then, and the outcome that is
meant is never reached."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

ROUND = """\
name: sm
template: Base
outcomes: [done, camera_failed]
states:
  - LOOK:
      template: Measure
      EXTRAtransitions: {measured: JUDGE, FAILED: TARGET}
  - JUDGE:
      template: ConditionalOutcomeState
      outcomes: [dry]
      input_keys: [moisture]
      callbacks: {dry: 'lambda ud: ud.moisture < 0.35'}
      default_outcome: wet
      transitions: {dry: done, wet: WET}
"""
MEASURE = """\
name: Measure
output_keys: {moisture: float}
outcomes: {measured: {}, FAILED: {FACT}}
writes: {measured: [moisture]}
"""
Row = tuple[str, str, str | None]


def found(
    failed: str = "failed", target: str = "JUDGE", wet: str = "done", extra: str = "",
    fact: str = "", outcomes: str = "done, camera_failed", first: str = "",
) -> list[Row]:  # fmt: skip
    own = "blurred" if failed == "exhausted" else failed
    stop = ", preempted: preempted" if failed == "exhausted" else ""
    text = (
        ROUND.replace("TARGET}", f"TARGET{stop}}}")
        .replace("FAILED", failed)
        .replace("TARGET", target)
        .replace("WET}", f"{wet}}}")
    )
    text = text.replace("EXTRA", extra).replace("done, camera_failed", outcomes)
    text = text.replace("states:\n", f"{first}states:\n", 1)
    type_ = MEASURE.replace("FAILED", own).replace("FACT", fact)
    return reported({"main.yml": text, "templates/Measure.yml": type_})


@pytest.mark.parametrize(
    ("failed", "extra", "fact"),
    [
        ("failed", "", ""),
        ("aborted", "", ""),
        ("blurred", "", "failure: true"),
        ("exhausted", "retry: {on: [blurred], max: 3}\n      ", ""),
    ],
)
def test_a_failure_leads_past_its_outcome(failed: str, extra: str, fact: str) -> None:
    help = f"write `{failed}: camera_failed`, to which nothing leads"
    outcomes = "done, camera_failed" + ", preempted" * (failed == "exhausted")
    assert found(failed, extra=extra, fact=fact, outcomes=outcomes) == [("SM301", "moisture", help)]


def test_a_correct_script() -> None:
    assert found(target="camera_failed") == []
    assert found(wet="camera_failed", first="userdata: {moisture: 1.0}\n") == []


def test_other_slips_are_two_findings() -> None:
    """No failure is used; no outcome is left, or two; the state reads a value that is set."""
    assert [each[0] for each in found("seen")] == ["SM203", "SM301"]
    assert [each[0] for each in found(outcomes="done")] == ["SM301"]
    assert [each[0] for each in found(outcomes="done, lost, camera_failed")] == [
        "SM203", "SM203", "SM301",
    ]  # fmt: skip
    assert [each[0] for each in found(wet="camera_failed")] == ["SM301"]
    assert [each[0] for each in found(first="userdata: {moisture: 1.0}\n")] == ["SM203"]
