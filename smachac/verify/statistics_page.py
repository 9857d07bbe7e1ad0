"""Statistics of recorded traces as a page of the viewer: figures at states and transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir.nodes import Machine
from smachac.ir.outcome_names import fails
from smachac.ir.traversal import outcome_names
from smachac.ir.written import WrittenState, written
from smachac.targets.html.model import machine_model
from smachac.targets.html.page import render_page
from smachac.verify.coverage import Coverage, script_coverage
from smachac.verify.result import item_text
from smachac.verify.trace_statistics import (
    TraceStatistics,
    rounds_in_words,
    written_statistics,
)


def statistics_html(
    machine: Machine,
    statistics: TraceStatistics,
    taken: Coverage,
    findings: Sequence[Diagnostic] = (),
) -> str:
    """The page of a machine with the statistics of its traces; one file, without a network."""
    model = machine_model(machine, findings)
    return render_page(machine, {**model, "statistics": _data(machine, statistics, taken)})


def _data(machine: Machine, statistics: TraceStatistics, taken: Coverage) -> dict[str, Any]:
    """The field `statistics` of the viewer's model."""
    view = written(machine)
    covered = script_coverage(taken.items, taken.covered, view)
    states = written_statistics(statistics.states, view)
    return {
        "states": {
            path: {
                "visits": visits.visits,
                "unfinished": visits.unfinished,
                "mean": visits.mean,
                "longest": visits.longest,
                "outcomes": dict(visits.outcomes),
                "rounds": rounds_in_words(rounds),
            }
            for path, (visits, rounds) in states.items()
        },
        "transitions": len(covered.items),
        "never": [
            {
                "path": item.path,
                "text": item_text(item),
                "failure": item.kind != "rule" and _fails(view.states[item.path], item.outcome),
            }
            for item in covered.missing()
        ],
    }


def _fails(state: WrittenState, outcome: str) -> bool:
    own = outcome_names(state.outer)
    return fails(state.outer if outcome in own else state.node, outcome)
