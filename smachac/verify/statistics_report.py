"""Statistics and predictions of recorded traces, as text and as JSON."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from typing import Any, NamedTuple

from smachac.analysis.absorbing_chain import EndlessChainError
from smachac.analysis.markov_prediction import (
    MarkovModel,
    NoMeasurementError,
    Prediction,
    Sensitivity,
)
from smachac.ir.nodes import Machine
from smachac.ir.script_paths import script_paths
from smachac.ir.traversal import walk
from smachac.report.json import json_text
from smachac.report.terminal import on_one_line
from smachac.targets.dot.graph import Notes, picture
from smachac.verify.trace_report import UntakenTransition
from smachac.verify.trace_statistics import StateStatistics, TraceStatistics, wilson_interval

MOST_GAINS = 10
"""Limit on the failures in the text; JSON contains all of them."""


class Forecast(NamedTuple):
    """The prediction of a machine from its traces, and the failures that cost successes."""

    prediction: Prediction
    sensitivities: Sequence[Sensitivity]
    as_measured: Sequence[str]


def forecast(
    machine: Machine, statistics: TraceStatistics, successes: Collection[str]
) -> Forecast | str:
    """The prediction, or the reason why there is none."""
    shown = script_paths(machine.root)
    try:
        model = MarkovModel(machine, statistics.measured())
        found = model.sensitivities(successes)
    except NoMeasurementError as error:
        return f"no run has ended `{shown.get(error.path, error.path)}`"
    except EndlessChainError as error:
        return f"in these runs {error}"
    return Forecast(model.prediction, found, model.as_measured)


def statistics_text(
    machine: Machine, statistics: TraceStatistics, untaken: Sequence[UntakenTransition]
) -> str:
    """A line for each state, in the order of the script, then the failures that no run had."""
    shown = script_paths(machine.root)
    rows = [("state", "visits", "mean", "longest", "outcomes")]
    for path, state in _in_order(machine, statistics):
        name = f"{'  ' * path.count('/')}{shown.get(path, path).rpartition('/')[2]}"
        rows.append(
            (name, str(state.visits), seconds(state.mean), seconds(state.longest), _shares(state))
        )
    lines = list(table(rows))
    lines += [f"never taken: {item.path}: {item.outcome} -> {item.target}" for item, _ in untaken]
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def statistics_json(
    machine: Machine, statistics: TraceStatistics, untaken: Sequence[UntakenTransition]
) -> str:
    """One JSON object: the statistics of each state, and the transitions that no trace takes."""
    shown = script_paths(machine.root)
    states = [
        {"path": shown.get(path, path), "visits": state.visits, "unfinished": state.unfinished,
         "mean": state.mean, "longest": state.longest, "outcomes": dict(state.outcomes)}
        for path, state in _in_order(machine, statistics)
    ]  # fmt: skip
    never = [{"path": item.path, "outcome": item.outcome, "to": item.target} for item, _ in untaken]
    return json_text({"states": states, "never_taken": never})


def forecast_text(machine: Machine, statistics: TraceStatistics, found: Forecast | str) -> str:
    """The outcomes measured and predicted, then the failures that cost most."""
    root = statistics.states[machine.root.name]
    lines = [
        f"{root.visits} run{'s' * (root.visits != 1)}"
        + (f", {root.unfinished} not ended" * bool(root.unfinished))
    ]
    if isinstance(found, str):
        return "\n".join([*lines, f"no prediction: {found}"]) + "\n"
    shown = script_paths(machine.root)
    rows = [("outcome", "measured", "95 % interval", "predicted")]
    for name in dict.fromkeys([*root.outcomes, *found.prediction.outcomes]):
        low, high = wilson_interval(root.outcomes[name], root.ended)
        measured = root.outcomes[name] / root.ended
        interval = f"{percent(low)} to {percent(high)}"
        predicted = percent(found.prediction.outcomes.get(name, 0.0))
        rows.append((name, percent(measured), interval, predicted))
    rows.append(("mean duration", seconds(root.mean), "", seconds(found.prediction.seconds)))
    lines += table(rows)
    lines += [f"as measured, not computed: {shown.get(path, path)}" for path in found.as_measured]
    if found.sensitivities:
        lines.append("failures, by the successes that the machine would gain without them:")
    for each in found.sensitivities[:MOST_GAINS]:
        path = shown.get(each.path, each.path)
        lines.append(
            f"  {path}: {each.outcome} ({percent(each.probability)} of its visits):"
            f" +{percent(each.gain)}"
        )
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def forecast_dot(machine: Machine, statistics: TraceStatistics, found: Forecast | str) -> str:
    """The graph of the machine for Graphviz: the frequencies of outcomes, the visits and the mean
    duration of each state, and the successes that the machine would gain without its failures."""
    gains: dict[str, float] = {}
    if not isinstance(found, str):
        for each in found.sensitivities:
            gains[each.path] = max(each.gain, gains.get(each.path, 0.0))
    states = {}
    for path, state in statistics.states.items():
        gain = f", without failure +{percent(gains[path])}" if gains.get(path, 0.0) > 0 else ""
        states[path] = f"{state.visits} visits, {seconds(state.mean)}{gain}"
    outcomes = {
        path: {name: percent(share) for name, share in state.probabilities().items()}
        for path, state in statistics.states.items()
        if state.ended
    }
    return "\n".join([*picture(machine, notes=Notes(states, outcomes)), ""])


def forecast_json(machine: Machine, statistics: TraceStatistics, found: Forecast | str) -> str:
    """One JSON object: what was measured, the prediction or null, and every failure."""
    shown = script_paths(machine.root)
    root = statistics.states[machine.root.name]
    data: dict[str, Any] = {
        "runs": root.visits,
        "unfinished": root.unfinished,
        "measured": {"outcomes": root.probabilities(), "seconds": root.mean},
        "interval": {
            name: wilson_interval(count, root.ended) for name, count in root.outcomes.items()
        },
        "prediction": None,
    }
    if isinstance(found, str):
        return json_text({**data, "reason": found})
    prediction = found.prediction
    data["prediction"] = {
        "outcomes": dict(prediction.outcomes),
        "seconds": prediction.seconds,
        "visits": {shown.get(path, path): n for path, n in prediction.visits.items()},
    }
    data["as_measured"] = [shown.get(path, path) for path in found.as_measured]
    data["failures"] = [
        {"path": shown.get(each.path, each.path), "outcome": each.outcome,
         "probability": each.probability, "gain": each.gain}
        for each in found.sensitivities
    ]  # fmt: skip
    return json_text(data)


def _in_order(
    machine: Machine, statistics: TraceStatistics
) -> Iterator[tuple[str, StateStatistics]]:
    """The states that were visited, in the order of the script."""
    for path, _ in walk(machine.root):
        if path in statistics.states:
            yield path, statistics.states[path]


def _shares(state: StateStatistics) -> str:
    shares = [f"{name} {percent(p)}" for name, p in state.probabilities().items()]
    unfinished = [f"{state.unfinished} not ended"] if state.unfinished else []
    return ", ".join([*shares, *unfinished])


def percent(share: float) -> str:
    return f"{100 * share:.1f} %"


def seconds(time: float) -> str:
    return f"{time:.3g} s"


def table(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    """Rows in columns that are as wide as their widest text."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    for row in rows:
        cells = [text.ljust(width) for text, width in zip(row, widths, strict=True)]
        yield "  ".join(cells).rstrip()
