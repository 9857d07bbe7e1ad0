"""The result of `smachac verify`, as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.diagnostics.source import Span
from smachac.interpreter.scenario import PlainStep
from smachac.verify.coverage import CoverageItem, Reason

Event = Mapping[str, Any]

SHOWN_BEFORE, SHOWN_AFTER = 4, 3
"""Number of events shown before and after the first difference."""

WIDEST = 60
"""Width of one trace in characters, two traces side by side."""

MOST_MISSING = 20
"""Limit on the uncovered transitions in the text; JSON contains all of them."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Disagreement:
    """The first path on which a target differs from the interpreter: both traces in comparable
    order, the number of the first different event, and the scenario."""

    target: str
    path: int
    expected: Sequence[Event]
    found: Sequence[Event]
    at: int
    rows: Mapping[str, Sequence[PlainStep]]
    live: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """The result of the comparison: paths by kind, covered and total transitions, uncovered ones
    with their reasons, what was not explored, and the differences."""

    script: str
    targets: tuple[str, ...]
    paths: Mapping[str, int]
    taken: int
    total: int
    missing: Sequence[tuple[CoverageItem, Span, Reason]]
    left_out: Sequence[str]
    disagreements: Sequence[Disagreement]


def scenario_text(rows: Mapping[str, Sequence[PlainStep]]) -> str:
    """A scenario as a file for `smachac run --mock`."""
    lines = ["states:"]
    for path, row in rows.items():
        lines.append(f"  {_quoted(path)}:")
        lines += [f"    - {_quoted(step)}" for step in map(_step, row)]
    return "\n".join(lines) + "\n"


def _step(row: PlainStep) -> dict[str, object]:
    step: dict[str, object] = {"stop": True} if row.stop else {}
    if row.error:
        return step | {"error": row.error}
    step |= {"wait": True} if row.wait else {}
    return step | {"outcome": row.outcome} | ({"set": row.writes} if row.writes else {})


def _quoted(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def render_json(verdict: Verdict) -> str:
    """One JSON object; differences contain both traces and the scenario."""
    data = {
        "script": verdict.script,
        "targets": list(verdict.targets),
        "agree": not verdict.disagreements,
        "paths": dict(verdict.paths),
        "coverage": {
            "taken": verdict.taken,
            "total": verdict.total,
            "missing": [
                {"path": item.path, "outcome": item.outcome, "to": item.target, "kind": item.kind,
                 "src": _place(span), "reason": why.text, "never": why.never}
                for item, span, why in verdict.missing
            ],
        },
        "left_out": list(verdict.left_out),
        "differences": [
            {"target": each.target, "path": each.path, "event": each.at + 1,
             "expected": list(each.expected), "found": list(each.found),
             "scenario": scenario_text(each.rows)}
            for each in verdict.disagreements
        ],
    }  # fmt: skip
    return json.dumps(data, indent=2, ensure_ascii=False) + "\n"


def render_text(verdict: Verdict) -> str:
    """Differences first, then paths and coverage."""
    lines: list[str] = []
    for each in verdict.disagreements:
        lines += [*_difference(each), ""]
    known = ", ".join(f"{count} {kind}" for kind, count in verdict.paths.items() if count)
    total = sum(verdict.paths.values())
    lines.append(f"{total} path{'s' * (total != 1)} ({known})")
    never = sum(why.never for _, _, why in verdict.missing)
    can = verdict.total - never
    percent = f" ({100 * verdict.taken // can} %)" if can else ""
    lines.append(f"{verdict.taken} of {can} transitions taken{percent}")
    lines += [f"{never} more cannot be taken"] if never else []
    for item, span, why in verdict.missing[:MOST_MISSING]:
        lines.append(f"  not taken: {_item_text(item)}  ({_place(span)}): {why.text}")
    if (more := len(verdict.missing) - MOST_MISSING) > 0:
        lines.append(f"  and {more} more; --format json has them all")
    lines += [f"left out: {each}" for each in verdict.left_out]
    different = {each.target for each in verdict.disagreements}
    for target in verdict.targets:
        lines.append(f"{target}: {'differs' if target in different else 'agrees'}")
    return "\n".join(lines) + "\n"


def _item_text(item: CoverageItem) -> str:
    if item.kind == "rule":
        which = "default" if item.rule < 0 else f"rule {item.rule + 1}"
        return f"{item.path}: {which} -> {item.outcome}"
    to = f"{item.target} ({item.kind})" if item.kind != "transition" else item.target
    return f"{item.path}: {item.outcome} -> {to}"


def _place(span: Span) -> str:
    name = span.source.name.replace("\\", "/").rpartition("/")[2]
    return f"{name}:{span.line}"


def _difference(each: Disagreement) -> Iterator[str]:
    """Both traces around the first difference, and the scenario."""
    begin, end = max(each.at - SHOWN_BEFORE, 0), each.at + SHOWN_AFTER + 1
    ours = [_event(event) for event in each.expected[begin:end]]
    theirs = [_event(event) for event in each.found[begin:end]]
    width = max(map(len, ["interpreter", *ours]))
    yield f"path {each.path}: {each.target} differs from the interpreter"
    yield ""
    yield f"    {'interpreter':<{width}} | {each.target}"
    for at in range(max(len(ours), len(theirs))):
        left = ours[at] if at < len(ours) else "(nothing)" if at == len(ours) else ""
        right = theirs[at] if at < len(theirs) else "(nothing)" if at == len(theirs) else ""
        mark = "->" if begin + at == each.at else "  "
        yield f" {mark} {left:<{width}} | {right}".rstrip()
    yield ""
    yield "The scenario of that path, for `smachac run --mock`:"
    if each.live:
        yield "# states that are not in it evaluate their expressions"
    yield ""
    yield from scenario_text(each.rows).splitlines()


def _event(event: Event) -> str:
    """An event on one line, with its place in the script."""
    words = [str(event["event"]), str(event["path"])]
    if "outcome" in event and event["event"] != "finish":
        words.append(str(event["outcome"]))
    if "to" in event:
        words.append(f"-> {event['to']}")
    if "key" in event:
        words.append(f"{event['key']} = {_quoted(event.get('value'))}")
    if event["event"] == "finish":
        words.append(str(event.get("outcome")))
    text = " ".join(words)
    text = text if len(text) <= WIDEST else text[: WIDEST - 3] + "..."
    return f"{text}  {event['src']}" if "src" in event else text
