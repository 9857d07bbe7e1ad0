"""Statistics of recorded traces as a page of the viewer: figures at states and transitions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir.nodes import Machine
from smachac.ir.outcome_names import fails
from smachac.ir.script_paths import script_paths
from smachac.ir.traversal import walk
from smachac.targets.html.model import machine_model
from smachac.targets.html.page import render_page
from smachac.verify.coverage import Coverage
from smachac.verify.result import item_text
from smachac.verify.trace_statistics import TraceStatistics


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
    """The field `statistics` of the viewer's model; states have their full paths."""
    shown = script_paths(machine.root)
    nodes = dict(walk(machine.root))
    missing = taken.missing()
    return {
        "states": {
            path: {
                "visits": state.visits,
                "unfinished": state.unfinished,
                "mean": state.mean,
                "longest": state.longest,
                "outcomes": dict(state.outcomes),
            }
            for path, state in statistics.states.items()
        },
        "transitions": len(taken.items),
        "never": [
            {
                "path": each.path,
                "text": item_text(each.renamed(shown)),
                "failure": each.kind != "rule" and fails(nodes[each.path], each.outcome),
            }
            for each in missing
        ],
    }
