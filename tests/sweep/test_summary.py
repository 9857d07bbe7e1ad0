"""The summary of a sweep: groups of failures, parts of ranges, the progress line."""

from __future__ import annotations

import pytest

import smachac
from smachac.sweep.summary import Summary, Totals, progress_line, replay, summarize
from smachac.sweep.task import Run
from smachac.sweep.text import summary_text
from smachac.sweep.variation import Single
from tests.support.sweeps import SCRIPT

MACHINE = smachac.load(SCRIPT, name="main.yml")


def totals(*runs: Run) -> Totals:
    found = Totals({"succeeded"})
    for run in runs:
        found.add(run)
    return found


def summary(*runs: Run, planned: int = 0) -> Summary:
    command = ["smachac", "run", "my script.yml"]
    planned = planned or len(runs)
    return summarize(MACHINE, totals(*runs), planned=planned, first=0, command=command)


def failed(seed: int, *steps: tuple[str, str], error: str = "") -> Run:
    return Run(seed=seed, outcome=None if error else "aborted", error=error, steps=list(steps))


def test_failures_are_grouped_by_their_last_three_states() -> None:
    end = (("sm/A", "ok"), ("sm/B", "ok"), ("sm/C", "lost"))
    found = summary(
        failed(1, *end),
        failed(4, ("sm/D", "ok"), *end),
        failed(5, *end[1:]),
        failed(6, *end, error="ValueError: no\n  in work.py:3"),
        Run(seed=7, outcome="succeeded"),
    )
    groups = found["failures"]
    assert [(group["count"], group["seeds"]) for group in groups] == [
        (2, [1, 4]),
        (1, [5]),
        (1, [6]),
    ]
    assert groups[2]["error"] == "ValueError: no"
    assert groups[0]["replay"] == "smachac run 'my script.yml' --seed 1"


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
