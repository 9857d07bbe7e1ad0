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
from smachac.ir.written import written
from smachac.records import replace
from smachac.report.json import json_text
from smachac.report.terminal import on_one_line
from smachac.targets.dot.graph import Notes, picture
from smachac.verify.trace_report import UntakenTransition
from smachac.verify.trace_statistics import (
    StateStatistics,
    TraceStatistics,
    rounds_in_words,
    wilson_interval,
    written_statistics,
)

MOST_GAINS = 10
"""Limit on the failures in the text; JSON contains all of them."""


class Forecast(NamedTuple):
    """The prediction of a machine from its traces, and the failures that cost successes; paths are
    those of the states as they were written."""

    prediction: Prediction
    sensitivities: Sequence[Sensitivity]
    as_measured: Sequence[str]


def forecast(
    machine: Machine, statistics: TraceStatistics, successes: Collection[str]
) -> Forecast | str:
    """The prediction, or the reason why there is none."""
    view = written(machine)
    try:
        model = MarkovModel(machine, statistics.measured())
        found = model.sensitivities(successes)
    except NoMeasurementError as error:
        return f"no run has ended `{view.state(error.path)}`"
    except EndlessChainError as error:
        return f"in these runs {error}"
    return Forecast(
        replace(
            model.prediction,
            visits={
                view.state(path): number
                for path, number in model.prediction.visits.items()
                if view.is_whole(path)
            },
        ),
        [replace(sensitivity, path=view.state(sensitivity.path)) for sensitivity in found],
        list(dict.fromkeys(map(view.state, model.as_measured))),
    )


def statistics_text(
    machine: Machine, statistics: TraceStatistics, untaken: Sequence[UntakenTransition]
) -> str:
    """A line for each state, in the order of the script, then the failures that no run had."""
    rows = [("state", "visits", "mean", "longest", "outcomes")]
    for path, (state, rounds) in written_statistics(statistics.states, written(machine)).items():
        name = f"{'  ' * path.count('/')}{path.rpartition('/')[2]}"
        shares = ", ".join(filter(None, [_shares(state), rounds_in_words(rounds)]))
        rows.append((name, str(state.visits), seconds(state.mean), seconds(state.longest), shares))
    lines = list(table(rows))
    lines += [f"never taken: {item.path}: {item.outcome} -> {item.target}" for item, _ in untaken]
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def statistics_json(
    machine: Machine, statistics: TraceStatistics, untaken: Sequence[UntakenTransition]
) -> str:
    """One JSON object: the statistics of each state, and the transitions that no trace takes."""
    found = written_statistics(statistics.states, written(machine))
    states = [
        {"path": path, "visits": state.visits, "unfinished": state.unfinished,
         "mean": state.mean, "longest": state.longest, "outcomes": dict(state.outcomes),
         "rounds": dict(rounds)}
        for path, (state, rounds) in found.items()
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
    rows = [("outcome", "measured", "95 % interval", "predicted")]
    for name in dict.fromkeys([*root.outcomes, *found.prediction.outcomes]):
        low, high = wilson_interval(root.outcomes[name], root.ended)
        measured = root.outcomes[name] / root.ended
        interval = f"{percent(low)} to {percent(high)}"
        predicted = percent(found.prediction.outcomes.get(name, 0.0))
        rows.append((name, percent(measured), interval, predicted))
    rows.append(("mean duration", seconds(root.mean), "", seconds(found.prediction.seconds)))
    lines += table(rows)
    lines += [f"as measured, not computed: {path}" for path in found.as_measured]
    if found.sensitivities:
        lines.append("failures, by the successes that the machine would gain without them:")
    states = written(machine).states
    words = {None: "visits", "try": "tries", "item": "items"}
    for sensitivity in found.sensitivities[:MOST_GAINS]:
        visits = words[states[sensitivity.path].next_round(sensitivity.outcome)]
        lines.append(
            f"  {sensitivity.path}: {sensitivity.outcome}"
            f" ({percent(sensitivity.probability)} of its {visits}): +{percent(sensitivity.gain)}"
        )
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def forecast_dot(machine: Machine, statistics: TraceStatistics, found: Forecast | str) -> str:
    """The graph of the machine for Graphviz: the frequencies of outcomes, the visits and the mean
    duration of each state, and the successes that the machine would gain without its failures."""
    gains: dict[str, float] = {}
    if not isinstance(found, str):
        for sensitivity in found.sensitivities:
            gains[sensitivity.path] = max(sensitivity.gain, gains.get(sensitivity.path, 0.0))
    view = written(machine)
    states, outcomes = {}, {}
    for path, (state, rounds) in written_statistics(statistics.states, view).items():
        gain = f", without failure +{percent(gains[path])}" if gains.get(path, 0.0) > 0 else ""
        more = f", {rounds_in_words(rounds)}" if rounds else ""
        states[path] = f"{state.visits} visits{more}, {seconds(state.mean)}{gain}"
        if state.ended:
            outcomes[path] = {name: percent(p) for name, p in state.probabilities().items()}
    notes = Notes(states, outcomes)
    return "\n".join([*picture(machine, view, depth=view.fitting_depth(), notes=notes), ""])


def forecast_json(machine: Machine, statistics: TraceStatistics, found: Forecast | str) -> str:
    """One JSON object: what was measured, the prediction or null, and every failure."""
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
        "visits": dict(prediction.visits),
    }
    data["as_measured"] = list(found.as_measured)
    data["failures"] = [
        {"path": sensitivity.path, "outcome": sensitivity.outcome,
         "probability": sensitivity.probability, "gain": sensitivity.gain}
        for sensitivity in found.sensitivities
    ]  # fmt: skip
    return json_text(data)


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
