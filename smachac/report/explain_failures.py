"""Explanation of failures: the failures of a machine as text, as a table in Markdown or CSV, or as
JSON."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from smachac.analysis.failure_paths import Answer, Failure
from smachac.report.json import json_text
from smachac.report.markdown import cell, table
from smachac.report.outline import alternatives, at
from smachac.report.terminal import on_one_line
from smachac.report.text import steps

HEADINGS = ("state", "failure", "place", "path", "caught by", "the machine ends with")

_COUNTED: dict[Answer, str] = {
    "caught": "caught",
    "repeated": "run again",
    "ignored": "ignored",
    "not caught": "not caught",
    "lost": "without a transition",
}


def render_failures(name: str, found: Sequence[Failure], form: str) -> str:
    """The failures of the machine `name`; `form` is `text`, `json`, `md` or `csv`."""
    match form:
        case "json":
            return _json(found)
        case "csv":
            return _csv(found)
        case "md":
            return _markdown(name, found)
    return _text(name, found)


def _text(name: str, found: Sequence[Failure]) -> str:
    parts = [f"{on_one_line(name)}: {_summary(found)}"]
    for failure in found:
        head = f"{failure.path} fails with {failure.outcome} ({failure.span})"
        way = "".join(steps(failure.way))
        parts.append(
            "\n".join(
                on_one_line(line) for line in (head, f"  {way}", f"  {_consequence(failure)}")
            )
        )
    return "\n\n".join(parts) + "\n"


def _summary(found: Sequence[Failure]) -> str:
    if not found:
        return (
            "no outcome of a state means a failure;"
            " `outcomes: {NAME: {failure: true}}` at a state, or in its interface, declares one"
        )
    answers = Counter(failure.answer for failure in found)
    count = len({(failure.path, failure.outcome) for failure in found})
    paths = f" on {len(found)} paths" if len(found) > count else ""
    counts = [f"{answers[key]} {words}" for key, words in _COUNTED.items() if key in answers]
    return f"{count} {'failure' if count == 1 else 'failures'}{paths}: {', '.join(counts)}"


def _consequence(failure: Failure) -> str:
    """The consequence of a failure, in words."""
    next = failure.next.rpartition("/")[2]
    match failure.answer:
        case "caught":
            return f"caught by {next}; then {_end(failure)}"
        case "repeated":
            return f"{next} runs again; then {_end(failure)}"
        case "ignored":
            what = f"{next} runs; then {_end(failure)}" if next else _end(failure)
            return f"ignored: as after a success, {what}"
        case "not caught":
            success = ", which is a success" if failure.good else ""
            return f"not caught: {_end(failure)}{success}"
    return "the outcome has no transition"


def _end(failure: Failure) -> str:
    if not failure.ends:
        return "the machine never ends"
    return f"the machine ends with {alternatives(failure.ends)}"


def _caught_by(failure: Failure) -> str:
    match failure.answer:
        case "caught":
            return failure.next
        case "repeated":
            return f"{failure.next} (again)"
        case "ignored":
            return "nothing (ignored)"
    return "nothing"


def _rows(found: Iterable[Failure]) -> Iterator[tuple[str, ...]]:
    for failure in found:
        ends = alternatives(failure.ends) or "never"
        way = "".join(steps(failure.way))
        yield failure.path, failure.outcome, str(failure.span), way, _caught_by(failure), ends


def _json(found: Iterable[Failure]) -> str:
    rows = [
        {
            "state": failure.path,
            "failure": failure.outcome,
            "at": at(failure.span),
            "way": list(failure.way),
            "answer": failure.answer,
            "next": failure.next,
            "ends": list(failure.ends),
        }
        for failure in found
    ]
    return json_text({"failures": rows})


def _csv(found: Iterable[Failure]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerows([HEADINGS, *_rows(found)])
    return text.getvalue()


def _markdown(name: str, found: Sequence[Failure]) -> str:
    lines = [f"Failures of {cell(name)}: {_summary(found)}.", "", *table(HEADINGS, _rows(found))]
    return "\n".join(lines) + "\n"
