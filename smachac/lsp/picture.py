"""The picture of a machine, with the places of its states in the texts."""

from __future__ import annotations

from smachac.diagnostics.source import Span
from smachac.ir.traversal import walk
from smachac.lsp.session import View
from smachac.targets.dot import graph
from smachac.targets.dot.style import identifier


def picture(view: View) -> tuple[str, dict[str, Span]] | None:
    """The picture of the machine that uses a text, as DOT, and the span of each state by its node
    in the picture; None if there is no machine. Clusters have the prefix `cluster_`."""
    machine = view.machine
    if machine is None:
        return None
    lines = graph.picture(machine, depth=None, rankdir="TB")
    spans = {}
    for path, node in walk(machine.root):
        spans["/".join(map(identifier, path.split("/")))] = node.span
    return "\n".join([*lines, ""]), spans
