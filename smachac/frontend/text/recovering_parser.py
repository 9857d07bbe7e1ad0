"""The parser of files: as `yaml_tree.parse`, and a lost or wrong sign is repaired."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import ParseAnomalies, Tree, parse


def parse_with_recovery(source: Source, report: Report) -> Tree | None:
    """As `parse`; of a text with a lost or wrong sign, the tree without that fault."""
    found: Report = []
    anomalies = ParseAnomalies([], [], [])
    tree = parse(source, found, anomalies)
    if any(anomalies):
        from smachac.frontend.text.yaml_recovery import recovered

        return recovered(source, tree, found, anomalies, report)
    report.extend(found)
    return tree
