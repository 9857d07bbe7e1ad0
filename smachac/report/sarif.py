"""SARIF 2.1.0 report (OASIS, 2020) for GitHub, Azure DevOps and editors.

Lines and columns count from 1, columns in UTF-16 units, as most readers expect. File names are
relative to the working directory.
"""

from __future__ import annotations

from collections import Counter
from pathlib import PurePath
from typing import Any
from urllib.parse import quote

from smachac.diagnostics.diagnostic import Code, Diagnostic, Report, Severity, fingerprint
from smachac.diagnostics.repair import Repair
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.report.explain_code import explanation, render_code, render_section
from smachac.report.json import json_text
from smachac.version import __version__

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"

BASE = "%SRCROOT%"
"""The conventional name of the folder that file names are relative to; readers define its path."""

FINGERPRINT = "smachac/v2"
"""The name of the fingerprints, with the version of their computation (3.27.17)."""

_LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}


def render_sarif(report: Report, *, on_one_line: bool = False) -> str:
    """One run with a result for each finding, and the rules they refer to. ASCII."""
    codes = {item.code: item.kind for item in report}
    rules = [codes[name] for name in sorted(codes)]
    numbers = {code.code: number for number, code in enumerate(rules)}
    seen: Counter[str] = Counter()
    results = []
    for item in report:
        mark = fingerprint(item)
        seen[mark] += 1
        results.append(_result(item, numbers[item.code], f"{mark}:{seen[mark]}"))
    driver = {"name": "smachac", "version": __version__, "rules": [_rule(code) for code in rules]}
    run = {
        "tool": {"driver": driver},
        "columnKind": "utf16CodeUnits",
        "originalUriBaseIds": {BASE: {"description": {"text": "The folder of the run."}}},
        "results": results,
    }
    log = {"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}
    return json_text(log, on_one_line=on_one_line)


def _rule(code: Code) -> dict[str, Any]:
    parts = explanation(code)
    return {
        "id": code.code,
        "name": code.name,
        "shortDescription": {"text": parts.summary},
        "fullDescription": {"text": " ".join(filter(None, (parts.summary, parts.reason)))},
        "help": {"text": render_code(code), "markdown": render_section(code)},
        "defaultConfiguration": {"level": _LEVELS[code.severity]},
    }


def _result(item: Diagnostic, rule: int, mark: str) -> dict[str, Any]:
    finding = item.finding
    text = "\n".join(filter(None, (finding.message, item.effect, finding.help)))
    node = finding.node
    logical = [{"name": node.rpartition("/")[2], "fullyQualifiedName": node}] if node else []
    result: dict[str, Any] = {
        "ruleId": item.code,
        "ruleIndex": rule,
        "level": _LEVELS[item.severity],
        "message": _message(text),
        "partialFingerprints": {FINGERPRINT: mark},
    }
    place = _location(finding.span)
    if place or logical:
        result["locations"] = [{**place, **({"logicalLocations": logical} if logical else {})}]
    if finding.related:
        result["relatedLocations"] = [
            {"id": number, **_location(related.span), "message": _message(related.message)}
            for number, related in enumerate(finding.related, 1)
        ]
    if finding.path:
        result["codeFlows"] = [{"threadFlows": [{"locations": _flow(item)}]}]
    if finding.all_repairs:
        result["fixes"] = [_fix(item, repair) for repair in finding.all_repairs]
    return result


def _message(text: str) -> dict[str, str]:
    """A text with the characters escaped that would begin a link (SARIF 2.1.0, 3.11.6)."""
    if "](" in text:
        text = text.replace("\\", "\\\\").replace("[", "\\[").replace("]", "\\]")
    return {"text": text}


def _location(span: Span) -> dict[str, Any]:
    if span.source is NOWHERE.source:
        return {}
    return {
        "physicalLocation": {"artifactLocation": _artifact(span.source), "region": _region(span)}
    }


def _artifact(source: Source) -> dict[str, str]:
    """A file by its URI; names outside the folder have no base (3.4.4)."""
    path = PurePath(source.name)
    name = quote(path.as_posix().encode("utf-8", "surrogatepass"))
    if path.is_absolute():
        return {"uri": f"file://{name}"}
    return {"uri": name} if ".." in path.parts else {"uri": name, "uriBaseId": BASE}


def _region(span: Span) -> dict[str, int]:
    line, column = _position(span.source, span.start)
    end_line, end_column = _position(span.source, max(span.start, span.end))
    return {
        "startLine": line,
        "startColumn": column,
        "endLine": end_line,
        "endColumn": end_column,
    }


def _position(source: Source, offset: int) -> tuple[int, int]:
    line, _ = source.position(offset)
    before = source.text[source.line_starts[line - 1] : offset]
    return line, len(before) + sum(character > "\uffff" for character in before) + 1


def _flow(item: Diagnostic) -> list[dict[str, Any]]:
    """The states of a witness path; each message has the outcome that leads on."""
    flow: list[dict[str, Any]] = []
    places = item.steps or (None,) * len(item.finding.path)
    for step, span in zip(item.finding.path, places, strict=True):
        if step.is_outcome and flow:
            flow[-1]["location"]["message"]["text"] += f" -{step.label}->"
            continue
        place = _location(span if span is not None else item.span)
        flow.append({"location": {**place, "message": _message(step.label)}})
    return flow


def _fix(item: Diagnostic, repair: Repair) -> dict[str, Any]:
    files: dict[int, dict[str, Any]] = {}
    for edit in repair.edits:
        change = files.setdefault(
            id(edit.span.source),
            {"artifactLocation": _artifact(edit.span.source), "replacements": []},
        )
        change["replacements"].append(
            {"deletedRegion": _region(edit.span), "insertedContent": {"text": edit.text}}
        )
    return {
        "description": _message(item.finding.help or "correct it"),
        "artifactChanges": list(files.values()),
    }
