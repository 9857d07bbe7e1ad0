"""JSON report, as described by grammars/report.schema.json."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from smachac.diagnostics.clusters import Cluster
from smachac.diagnostics.diagnostic import Diagnostic, Report, Severity
from smachac.diagnostics.repair import Edit, Repair
from smachac.diagnostics.source import NOWHERE, Span
from smachac.report.terminal import COMMAND

VERSION = 4
"""The version of the schema; it increases with every change."""


def render_json(
    report: Report,
    clusters: Sequence[Cluster] = (),
    coverage: Sequence[Mapping[str, Any]] = (),
    *,
    on_one_line: bool = False,
) -> str:
    """The findings in the order of the report, in ASCII. Equal reports give equal texts.

    `coverage` is that of Python files, as data (`report.coverage`).
    """
    counts = {
        severity.value: sum(item.severity is severity for item in report) for severity in Severity
    }
    whole: dict[str, Any] = {
        "version": VERSION,
        "diagnostics": list(map(diagnostic_data, report)),
        "clusters": clusters_data(report, clusters),
        "counts": counts,
    }
    if coverage:
        whole["coverage"] = list(coverage)
    return json_text(whole, sort_keys=True, on_one_line=on_one_line)


def json_text(data: object, *, sort_keys: bool = False, on_one_line: bool = False) -> str:
    """Data as JSON in ASCII, in which no line has the beginning of a command of a CI log."""
    text = json.dumps(data, indent=None if on_one_line else 2, sort_keys=sort_keys)
    return text.replace(COMMAND, "##\\u005b") + "\n"


def diagnostic_data(item: Diagnostic) -> dict[str, Any]:
    """A finding as data."""
    finding = item.finding
    return {
        "code": item.code,
        "name": item.kind.name,
        "severity": item.severity.value,
        "message": finding.message,
        "effect": item.effect or None,
        "help": finding.help,
        "place": place(finding.span),
        "related": [
            {"place": place(related.span), "message": related.message}
            for related in finding.related
        ],
        "path": list(finding.path_labels),
        "node": finding.node,
        "edits": edits_data(finding.edits),
        "repairs": [repair_data(repair) for repair in finding.all_repairs],
    }


def clusters_data(report: Report, clusters: Sequence[Cluster]) -> list[dict[str, Any]]:
    """Clusters as data; findings are numbers of the report, counted from 0."""
    number = {id(item): at for at, item in enumerate(report)}
    return [
        {
            "finding": number[id(cluster.finding)],
            "explained": [number[id(item)] for item in cluster.explained],
            "repair": repair_data(cluster.repair),
        }
        for cluster in clusters
    ]


def repair_data(repair: Repair) -> dict[str, Any]:
    """A repair as data."""
    return {
        "certainty": repair.certainty.value,
        "operator": repair.operator,
        "edits": edits_data(repair.edits),
    }


def edits_data(edits: Iterable[Edit]) -> list[dict[str, Any]]:
    """Edits as data."""
    return [{"place": place(edit.span), "text": edit.text} for edit in edits]


def place(span: Span) -> dict[str, Any] | None:
    """A span as data; None for NOWHERE.

    Lines and columns count from 1, offsets from 0, in characters; the end is excluded.
    """
    if span.source is NOWHERE.source:
        return None
    line, column = span.source.position(span.start)
    end_line, end_column = span.source.position(span.end)
    return {
        "file": span.source.name,
        "line": line,
        "column": column,
        "end_line": end_line,
        "end_column": end_column,
        "offset": span.start,
        "end_offset": span.end,
    }
