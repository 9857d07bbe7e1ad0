"""Predictions against measured runs: outcomes, visits, and the gain of a state that never fails."""

from __future__ import annotations

from collections import Counter

import pytest

import smachac
from smachac.analysis.markov_prediction import MarkovModel, Measured, NoMeasurementError
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.userdata import Userdata
from smachac.ir.nodes import Leaf, Machine
from smachac.verify.trace_statistics import TraceStatistics, wilson_interval

SCRIPT = """\
name: sm
outcomes: [succeeded, aborted]
states:
  - FIND:
      template: ScriptedState
      outcomes: [found, lost]
      transitions: {found: GRASP, lost: FIND}
  - GRASP:
      template: ScriptedState
      outcomes: [held, failed]
      retry: {on: [failed], max: 3}
      transitions: {held: BOTH, exhausted: aborted, preempted: aborted}
  - BOTH:
      template: Concurrence
      outcomes: [good, failed]
      default_outcome: failed
      outcome_map: {good: {LEFT: ok, RIGHT: ok}}
      transitions: {good: succeeded, failed: FIND}
      states:
        - LEFT: {template: ScriptedState, outcomes: [ok, failed]}
        - RIGHT: {template: ScriptedState, outcomes: [ok, failed]}
"""

CHANCES = {
    "sm/FIND": {"found": 0.6, "lost": 0.4},
    "sm/GRASP/GRASP": {"held": 0.7, "failed": 0.3},
    "sm/BOTH/LEFT": {"ok": 0.8, "failed": 0.2},
    "sm/BOTH/RIGHT": {"ok": 0.9, "failed": 0.1},
}

RUNS = 1_000


def success(grasp: float, both: float) -> float:
    """The probability of success: three tries of the grasp, and again from the start if one of both
    branches fails."""
    held = 1 - (1 - grasp) ** 3
    return held * both / (1 - held * (1 - both))


@pytest.fixture(name="machine")
def _machine() -> Machine:
    return smachac.load(SCRIPT, name="main.yml")


@pytest.fixture(name="statistics")
def _statistics(machine: Machine) -> TraceStatistics:
    """The statistics of RUNS runs with these chances; seeds are the numbers of the runs."""
    import random

    statistics = TraceStatistics()
    default = builtin_behaviour()
    for number in range(RUNS):
        rng = random.Random(number)

        def behave(
            path: str, leaf: Leaf, visit: int, userdata: Userdata, rng: random.Random = rng
        ) -> str:
            if path not in CHANCES:
                return default(path, leaf, visit, userdata)
            chances = CHANCES[path]
            return rng.choices([*chances], [*chances.values()])[0]

        run(machine, behave, statistics.record, seed=number)
        statistics.end_trace()
    return statistics


def exact(machine: Machine) -> MarkovModel:
    measured = {path: Measured(100, chances, 1.0) for path, chances in CHANCES.items()}
    for path in ("sm", "sm/GRASP", "sm/BOTH"):
        measured[path] = Measured(100, {"succeeded": 1.0}, 1.0)
    return MarkovModel(machine, measured)


def test_the_prediction_is_the_closed_form(machine: Machine) -> None:
    model = exact(machine)
    prediction = model.prediction
    wanted = success(0.7, 0.72)
    assert prediction.outcomes["succeeded"] == pytest.approx(wanted)
    assert sum(prediction.outcomes.values()) == pytest.approx(1.0)
    assert model.as_measured == []
    grasps = prediction.visits["sm/GRASP/GRASP"] / prediction.visits["sm/GRASP"]
    assert grasps == pytest.approx(1 + 0.3 + 0.09)


def test_gains_are_those_of_a_machine_without_the_failure(machine: Machine) -> None:
    gains = {
        sensitivity.path: sensitivity.gain
        for sensitivity in exact(machine).sensitivities({"succeeded"})
    }
    base = success(0.7, 0.72)
    assert gains["sm/GRASP/GRASP"] == pytest.approx(1 - base)
    assert gains["sm/BOTH/LEFT"] == pytest.approx(success(0.7, 0.9) - base)
    assert gains["sm/BOTH/RIGHT"] == pytest.approx(success(0.7, 0.8) - base)
    assert list(gains) == ["sm/GRASP/GRASP", "sm/BOTH/LEFT", "sm/BOTH/RIGHT"]


def test_predictions_agree_with_runs(machine: Machine, statistics: TraceStatistics) -> None:
    """The success rate of the runs, the exact one, and the one predicted from the runs."""
    root = statistics.states["sm"]
    low, high = wilson_interval(root.outcomes["succeeded"], root.ended)
    prediction = MarkovModel(machine, statistics.measured()).prediction
    assert low <= prediction.outcomes["succeeded"] <= high
    assert low <= success(0.7, 0.72) <= high
    for path, visits in prediction.visits.items():
        assert visits == pytest.approx(statistics.states[path].visits / RUNS, rel=0.1)


def test_a_state_that_no_run_ended(machine: Machine) -> None:
    measured = {"sm": Measured(1, {"succeeded": 1.0}), "sm/FIND": Measured(1, {"found": 1.0})}
    with pytest.raises(NoMeasurementError, match="sm/GRASP"):
        MarkovModel(machine, measured)


def test_the_interval_has_95_percent() -> None:
    """Of 1,000 estimates of a probability about 950 intervals contain it."""
    import random

    rng = random.Random(0)
    inside = Counter(
        low <= 0.3 <= high
        for low, high in (
            wilson_interval(sum(rng.random() < 0.3 for _ in range(50)), 50) for _ in range(1_000)
        )
    )
    assert 930 <= inside[True] <= 970
