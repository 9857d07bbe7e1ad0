"""Baseline: a file with the known findings of a project; only new findings count."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TypeAlias

from smachac.diagnostics.diagnostic import Diagnostic, Report, fingerprint
from smachac.diagnostics.severities import is_firm
from smachac.records import dataclass

VERSION, OLDEST = 3, 2
"""The version of the fingerprints, which increases when they are computed in another way or from
other arguments, and the oldest version that is read."""


FIELDS = ("file", "code", "fingerprint")

Entry: TypeAlias = "tuple[str, ...]"
"""The name of a file, a code, and a fingerprint: all equal findings."""


@dataclass(frozen=True, slots=True)
class Baseline:
    """The known findings with their numbers, and the version of the file that has them."""

    entries: Counter[Entry]
    version: int = VERSION


class BaselineError(Exception):
    """A text is not a baseline; the message has the reason."""


def acceptable(report: Report) -> Report:
    """The findings that a baseline may hold: all but unsuppressible errors."""
    return [item for item in report if not is_firm(item)]


def render(report: Report) -> str:
    """A report as a baseline: sorted, one finding a line, so that it merges well."""
    counts = Counter(map(_entry_of, report))
    return _text(_row(item, counts[_entry_of(item)]) for item in report)


def _row(item: Diagnostic, count: int) -> dict[str, object]:
    row: dict[str, object] = dict(zip(FIELDS, _entry_of(item), strict=True))
    return row | {"count": count, "message": item.finding.message}


def _text(rows: Iterable[Mapping[str, object]]) -> str:
    lines = {tuple(row[field] for field in FIELDS): json.dumps(row) for row in rows}
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


def read(text: str) -> Baseline:
    """The known findings of a baseline. Raises BaselineError."""
    try:
        data = json.loads(text)
        version = data["version"]
        if version not in range(OLDEST, VERSION + 1):
            raise BaselineError(
                f"the baseline has version {version!r}, but versions {OLDEST} to {VERSION} are"
                " read; run `smachac check` with `--write-baseline` to write it again"
            )
        entries = {
            tuple(str(row[field]) for field in FIELDS): int(row["count"])
            for row in data["findings"]
        }
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        raise BaselineError("the file was not written by --write-baseline") from error
    return Baseline(Counter(entries), version)


def compare(report: Report, known: Baseline) -> tuple[Report, int, int]:
    """The findings that are not in a baseline, the number that are, and the number of its entries
    that no longer occur.

    Of several equal findings the first ones count as known. A finding may have another fingerprint
    than in a baseline of an older version: there, an entry that would no longer occur stands for a
    finding with its code in its file. An unsuppressible error is always new.
    """
    left = Counter(known.entries)
    new = _without(report, left, _entry_of)
    if known.version < VERSION:
        by_code = Counter[Entry]()
        for entry, count in left.items():
            by_code[entry[:2]] += count
        left = by_code
        new = _without(new, left, lambda item: _entry_of(item)[:2])
    unknown = {id(item) for item in new}
    found = [item for item in report if id(item) in unknown or is_firm(item)]
    return found, len(report) - len(found), left.total()


Renamed = Callable[[str], str]
"""A text with the names that it has after a change of a script."""


def successors(
    before: Report, after: Report, renamed: Renamed, *, same_behaviour: bool
) -> dict[Entry, list[Diagnostic]]:
    """The findings after a change of a script in place of those before it, by the entries of those;
    only for entries that no longer occur.

    A successor has the code, the state and the arguments of its predecessor, with other names. If
    the change keeps the behaviour, one with the code and the state is enough, or one with the code:
    a container that was added is part of its arguments.
    """
    lost = _without(before, Counter(map(_entry_of, after)), _entry_of)
    gained = _without(after, Counter(map(_entry_of, before)), _entry_of)

    def state(item: Diagnostic, name: Renamed) -> str:
        return name((item.finding.node or "").rpartition("/")[2])

    marks: list[Callable[[Diagnostic, Renamed], object]] = [
        lambda item, name: (item.code, state(item, name), *map(name, item.finding.arguments))
    ]
    if same_behaviour:
        marks += [lambda item, name: (item.code, state(item, name)), lambda item, _: item.code]
    found: dict[Entry, list[Diagnostic]] = {}
    for mark in marks:
        waiting: dict[object, list[Diagnostic]] = {}
        for item in reversed(gained):
            waiting.setdefault(mark(item, str), []).append(item)
        left = []
        for item in lost:
            if others := waiting.get(mark(item, renamed)):
                found.setdefault(_entry_of(item), []).append(others.pop())
            else:
                left.append(item)
        taken = {id(other) for others in found.values() for other in others}
        lost, gained = left, [item for item in gained if id(item) not in taken]
    return found


def followed(text: str, found: Mapping[Entry, Sequence[Diagnostic]]) -> str:
    """A baseline, which `read` accepts, with findings replaced by their successors; the same text
    if it has none of them, or another version."""
    data = json.loads(text)
    if data["version"] != VERSION:
        return text
    rows = {
        tuple(str(row[field]) for field in FIELDS): {**row, "count": int(row["count"])}
        for row in data["findings"]
    }
    changed = False
    for entry, others in found.items():
        for other in others:
            if entry not in rows:
                break
            changed = True
            rows[entry]["count"] -= 1
            if rows[entry]["count"] <= 0:
                del rows[entry]
            row = rows.setdefault(_entry_of(other), _row(other, 0))
            row["count"] += 1
    return _text(rows.values()) if changed else text


def _without(
    report: Report, left: Counter[Entry], entry_of: Callable[[Diagnostic], Entry]
) -> Report:
    """The findings that have no entry left; each of the others takes one."""
    new = []
    for item in report:
        entry = entry_of(item)
        if left[entry] > 0:
            left[entry] -= 1
        else:
            new.append(item)
    return new


def _entry_of(item: Diagnostic) -> Entry:
    return item.span.source.file_name, item.code, fingerprint(item)
