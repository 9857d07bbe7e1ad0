"""Baseline: a file with the known findings of a project; only new findings count."""

from __future__ import annotations

import json
from collections import Counter
from pathlib import PurePath

from smachac.diagnostics.diagnostic import Report, fingerprint
from smachac.diagnostics.severities import is_firm

VERSION = 2
"""The version of the fingerprints: it increases when they are computed in another way."""


class BaselineError(Exception):
    """A text is not a baseline; the message has the reason."""


def acceptable(report: Report) -> Report:
    """The findings that a baseline may hold: all but firm errors."""
    return [item for item in report if not is_firm(item)]


def render(report: Report) -> str:
    """A report as a baseline: sorted, one finding a line, so that it merges well."""
    counts = Counter(fingerprint(item) for item in report)
    lines = {}
    for item in report:
        mark = fingerprint(item)
        entry = {
            "file": PurePath(item.span.source.name).name,
            "code": item.code,
            "fingerprint": mark,
            "count": counts[mark],
            "message": item.finding.message,
        }
        lines[mark] = json.dumps(entry, ensure_ascii=True)
    body = ",\n    ".join(sorted(lines.values()))
    findings = f"[\n    {body}\n  ]" if body else "[]"
    return f'{{\n  "version": {VERSION},\n  "findings": {findings}\n}}\n'


def is_baseline(text: str) -> bool:
    """Whether a text is a baseline, of any version."""
    try:
        data = json.loads(text)
    except (ValueError, RecursionError):
        return False
    return isinstance(data, dict) and isinstance(data.get("version"), int) and "findings" in data


def read(text: str) -> Counter[str]:
    """The number of findings by fingerprint in a baseline. Raises BaselineError."""
    try:
        data = json.loads(text)
        if data["version"] != VERSION:
            raise BaselineError(
                f"the baseline has version {data['version']!r}, but version {VERSION} is required;"
                " run `smachac check` with `--write-baseline` to write it again"
            )
        return Counter({str(each["fingerprint"]): int(each["count"]) for each in data["findings"]})
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise BaselineError("the file was not written by --write-baseline") from error


def compare(report: Report, known: Counter[str]) -> tuple[Report, int, int]:
    """The findings that are not in a baseline, the number that are, and the number of its entries
    that no longer occur.

    Of several equal findings the first ones count as known. A firm error is always new.
    """
    left = Counter(known)
    new = []
    for item in report:
        mark = fingerprint(item)
        is_known = left[mark] > 0
        if is_known:
            left[mark] -= 1
        if not is_known or is_firm(item):
            new.append(item)
    return new, len(report) - len(new), sum(left.values())
