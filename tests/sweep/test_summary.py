"""The summary of a sweep: groups of failures, parts of ranges, the progress line."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

import smachac
from smachac.report.json import json_text
from smachac.sweep.comparison import BaselineError, compare, difference_interval, read_baseline
from smachac.sweep.page import summary_html
from smachac.sweep.summary import Summary, Totals, progress_line, replay, summarize
from smachac.sweep.task import Run
from smachac.sweep.text import first_text, summary_text
from smachac.sweep.variation import Single
from smachac.verify.trace_statistics import wilson_interval
from tests.support.sweeps import SCRIPT

EXAMPLES = Path(__file__).parents[2] / "examples"

MACHINE = smachac.load(SCRIPT, name="main.yml")


def totals(*runs: Run) -> Totals:
    found = Totals(MACHINE, {"succeeded"})
    for run in runs:
        found.add(run)
    return found


def summary(*runs: Run, planned: int = 0) -> Summary:
    command = ["smachac", "run", "my script.yml"]
    planned = planned or len(runs)
    return summarize(MACHINE, totals(*runs), planned=planned, first=0, command=command)


def failed(seed: int, *steps: tuple[str, str], error: str = "") -> Run:
    return Run(seed=seed, outcome=None if error else "aborted", error=error, steps=list(steps))


def causes(found: Summary) -> list[tuple[str, list[int]]]:
    return [(first_text(group), group["seeds"]) for group in found["failures"]]


def test_failures_are_grouped_by_the_state_that_failed_first() -> None:
    used_up = (("sm/FIND", "found"), ("sm/GRASP", "exhausted"))
    found = summary(
        failed(1, *used_up),
        failed(4, *used_up),
        failed(5, ("sm/FIND", "failed")),
        failed(6, ("sm/FIND", "found"), ("sm/GRASP", ""), error="ValueError: no\n  in work.py:3"),
        Run(seed=7, outcome="succeeded"),
    )
    assert causes(found) == [
        ("GRASP: exhausted (3 tries)", [1, 4]),
        ("FIND: failed", [5]),
        ("GRASP: an exception", [6]),
    ]
    groups = found["failures"]
    assert groups[0]["share"] == 2 / 5
    assert groups[0]["interval"] == list(wilson_interval(2, 5))
    assert groups[0]["replay"] == "smachac run 'my script.yml' --seed 1"
    assert groups[2]["error"] == "ValueError: no"


def test_ends_inside_a_state_do_not_hide_what_failed() -> None:
    """The tries and timers of later states follow the failure; none of them is its cause."""
    tries = [("sm/GRASP/GRASP", "failed")] * 3
    found = summary(failed(1, ("sm/FIND", "found"), *tries, ("sm/GRASP", "exhausted")))
    (group,) = found["failures"]
    assert [step["outcome"] for step in group["steps"]] == ["found", "exhausted"]


DELIVERY = smachac.load(EXAMPLES / "14_delivery_round" / "main.yml")


def of_delivery(*steps: tuple[str, str], error: str = "") -> Summary:
    counted = Totals(DELIVERY, {"done"})
    counted.add(failed(1, *(("delivery_round/" + path, end) for path, end in steps), error=error))
    return summarize(DELIVERY, counted, planned=1, first=0, command=["smachac"])


@pytest.mark.parametrize(
    ("steps", "cause"),
    [
        # a failure that the machine recovers from is no cause
        (
            [
                ("VISIT_ROOMS/VISIT_ROOMS/DRIVE", "exhausted"),
                ("VISIT_ROOMS/VISIT_ROOMS/STEP_BACK", "free"),
                ("VISIT_ROOMS", "visited"),
                ("GO_HOME", "exhausted"),
                ("CALL_OPERATOR", "succeeded"),
            ],
            "GO_HOME: exhausted (3 tries)",
        ),
        # the failure that leads to the turning point is the cause
        (
            [
                ("VISIT_ROOMS/VISIT_ROOMS/DRIVE", "exhausted"),
                ("VISIT_ROOMS/VISIT_ROOMS/STEP_BACK", "jammed"),
                ("VISIT_ROOMS", "stuck"),
                ("CALL_OPERATOR", "succeeded"),
            ],
            "DRIVE: exhausted (3 tries)",
        ),
        # in a concurrence, the branch without a way to a success
        (
            [
                ("CHECK_ROBOT/CHECK_DRAWERS", "locked"),
                ("CHECK_ROBOT/CHECK_BATTERY", "low"),
                ("CHECK_ROBOT/CHECK_LASER", "succeeded"),
                ("CALL_OPERATOR", "succeeded"),
            ],
            "CHECK_BATTERY: low",
        ),
        (
            [("GO_HOME", "timeout"), ("CALL_OPERATOR", "succeeded")],
            "GO_HOME: timeout (limit 5 min)",
        ),
    ],
)
def test_the_cause_of_a_failure(steps: list[tuple[str, str]], cause: str) -> None:
    (group,) = of_delivery(*steps)["failures"]
    assert first_text(group) == cause
    assert f"  {cause}: 1 run, 100.0 %" in summary_text(of_delivery(*steps))


def test_a_machine_without_a_success_has_the_last_failure_as_cause() -> None:
    counted = Totals(DELIVERY, ())
    counted.add(failed(3, ("delivery_round/DOCK", "exhausted"), error="it took too long"))
    found = summarize(DELIVERY, counted, planned=1, first=0, command=["smachac"])
    assert first_text(found["failures"][0]) == "DOCK: exhausted (5 tries)"


def test_a_failed_run_without_a_step_is_a_group() -> None:
    (group,) = of_delivery(error="no time left")["failures"]
    assert first_text(group) == "failed run: no time left"


def test_the_histogram_has_axes_with_units_and_labels_are_whole() -> None:
    name = "A_" * 60
    runs = [Run(seed=seed, outcome="succeeded", seconds=seed, values={name: str(seed % 2)})
            for seed in range(41)]  # fmt: skip
    page = summary_html(summary(*runs))
    drawn = ET.fromstring(page[page.index("<svg") : page.index("</svg>") + 6])
    assert ["".join(item.itertext()) for item in drawn.iter("text")] == [
        *("0", "1", "3"), *("0 s", "10 s", "20 s", "30 s", "40 s"), "runs", "duration",
    ]  # fmt: skip
    assert name in page


def test_two_sweeps_are_compared() -> None:
    before = summary(*[failed(seed, ("sm/FIND", "failed")) for seed in range(30)],
                     *[Run(seed=seed, outcome="succeeded") for seed in range(30, 100)])  # fmt: skip
    after = summary(*[failed(seed, ("sm/FIND", "failed")) for seed in range(10)],
                    *[Run(seed=seed, outcome="succeeded") for seed in range(10, 100)])  # fmt: skip
    success, find = compare(read_baseline(json_text(before)), after)
    assert (success.what, success.before, success.after) == ("", 0.7, 0.9)
    assert success.is_clear
    assert (find.what, round(find.difference, 3)) == ("sm/FIND: failed", -0.2)
    assert "  sm/FIND: failed  30.0 %  10.0 %  -20.0" in summary_text(after, [success, find])


def test_the_interval_of_a_difference() -> None:
    """The example of Newcombe's paper: 56 of 70 and 48 of 80."""
    low, high = difference_interval(56, 70, 48, 80)
    assert (round(low, 4), round(high, 4)) == (0.0524, 0.3339)


@pytest.mark.parametrize("text", ["", "[]", "{}", '{"machine": 1}', "[" * 100_000])
def test_what_is_no_report_is_refused(text: str) -> None:
    with pytest.raises(BaselineError, match="it is no"):
        read_baseline(text)


def test_a_replay_has_the_varied_values() -> None:
    values: dict[str, Single] = {"userdata.a": 0.5, "params.arm": "left arm", "userdata.b": True}
    assert replay(["smachac", "run", "m.yml"], 3, values) == (
        "smachac run m.yml --seed 3 --set userdata.a=0.5 --set 'params.arm=left arm'"
        " --set userdata.b=true"
    )


def test_numbers_are_divided_into_parts_and_others_by_value() -> None:
    runs = [
        Run(
            seed=seed,
            values={"speed": seed / 100, "arm": "left" if seed % 2 else "right"},
            outcome="succeeded" if seed < 50 else "aborted",
        )
        for seed in range(100)
    ]
    speed, arm = summary(*runs)["varied"]
    assert [part["runs"] for part in speed["parts"]] == [10] * 10
    assert [part["share"] for part in speed["parts"]] == [1.0] * 5 + [0.0] * 5
    assert [(part["value"], part["count"]) for part in arm["parts"]] == [
        ("left", 25),
        ("right", 25),
    ]


def test_no_runs_yet() -> None:
    assert summary_text(summary(planned=50)) == "0 of 50 runs of sm\n"


@pytest.mark.parametrize(
    ("given", "line"),
    [
        ((0, 100, 0, 0.0), f"[{'.' * 24}] 0 of 100 (0 %)"),
        ((25, 100, 0, 60.0), f"[{'#' * 6}{'.' * 18}] 25 of 100 (25 %), 3:00 min left"),
        ((75, 100, 50, 3600.0), f"[{'#' * 18}{'.' * 6}] 75 of 100 (75 %), 1 h 00 min left"),
        ((100, 100, 50, 9.0), f"[{'#' * 24}] 100 of 100 (100 %)"),
    ],
)
def test_the_progress_line(given: tuple[int, int, int, float], line: str) -> None:
    assert progress_line(*given) == line
