"""The picture of a machine, with the places of its states in the texts."""

from __future__ import annotations

from smachac.diagnostics.source import Span
from smachac.ir.written import written
from smachac.lsp.session import View
from smachac.targets.dot import graph
from smachac.targets.dot.style import identifier


def picture(view: View, line: int | None = None) -> tuple[str, dict[str, Span]] | None:
    """The picture of the machine that uses a text, as DOT, and the span of each state by its node
    in the picture; None if there is no machine. Clusters have the prefix `cluster_`. In a Python
    file it is the machine at a line, counted from 1."""
    machine = view.machine
    if view.python is not None:
        from smachac.lsp.python_view import machine_at

        machine = machine_at(view.python, line)
    if machine is None:
        return None
    shown = written(machine)
    lines = graph.picture(machine, shown)
    spans = {}
    for path, state in shown.states.items():
        spans["/".join(map(identifier, path.split("/")))] = state.node.span
    return "\n".join([*lines, ""]), spans
