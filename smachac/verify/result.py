"""What `smachac verify` found, for people and for programs."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from smachac.diagnostics.source import Span
from smachac.interpreter.scenario import Row
from smachac.verify.coverage import Reason, Way

Event = Mapping[str, Any]

SHOWN_BEFORE, SHOWN_AFTER = 4, 3
"""Events shown around the first one that differs."""

WIDEST = 60
"""Characters of one side of two traces side by side."""

MOST_MISSING = 20
"""Transitions not taken that are listed for people; programs get them all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Disagreement:
    """The first path on which a target does something else than the interpreter: both traces in
    comparable order, the number of the event at which they part, and the scenario."""

    target: str
    path: int
    expected: Sequence[Event]
    found: Sequence[Event]
    at: int
    rows: Mapping[str, Sequence[Row]]
    live: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """How targets compare with the interpreter: the paths gone through by kind, the ways taken of
    all there are, those that were not with the reason, and what was left out."""

    script: str
    targets: tuple[str, ...]
    paths: Mapping[str, int]
    taken: int
    total: int
    missing: Sequence[tuple[Way, Span, Reason]]
    left_out: Sequence[str]
    disagreements: Sequence[Disagreement]


def scenario_text(rows: Mapping[str, Sequence[Row]]) -> str:
    """A scenario as the file that `smachac run --mock` reads."""
    lines = ["states:"]
    for path, row in rows.items():
        lines.append(f"  {_quoted(path)}:")
        lines += [f"    - {_quoted(step)}" for step in map(_step, row)]
    return "\n".join(lines) + "\n"


def _step(row: Row) -> dict[str, object]:
    step: dict[str, object] = {"stop": True} if row.stop else {}
    if row.error:
        return step | {"error": row.error}
    step |= {"wait": True} if row.wait else {}
    return step | {"outcome": row.outcome} | ({"set": row.writes} if row.writes else {})


def _quoted(value: object) -> str:
    return json.dumps(value, ensure_ascii=False)


def render_json(verdict: Verdict) -> str:
    """One JSON object; differences with both traces and the scenario."""
    told = {
        "script": verdict.script,
        "targets": list(verdict.targets),
        "agree": not verdict.disagreements,
        "paths": dict(verdict.paths),
        "coverage": {
            "taken": verdict.taken,
            "total": verdict.total,
            "missing": [
                {"path": way.path, "outcome": way.outcome, "to": way.target, "kind": way.kind,
                 "src": _place(span), "reason": why.words, "never": why.never}
                for way, span, why in verdict.missing
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
    return json.dumps(told, indent=2, ensure_ascii=False) + "\n"


def render_text(verdict: Verdict) -> str:
    """Differences first, then what was gone through."""
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
    for way, span, why in verdict.missing[:MOST_MISSING]:
        lines.append(f"  not taken: {_way(way)}  ({_place(span)}): {why.words}")
    if (more := len(verdict.missing) - MOST_MISSING) > 0:
        lines.append(f"  and {more} more; --format json has them all")
    lines += [f"left out: {each}" for each in verdict.left_out]
    differ = {each.target for each in verdict.disagreements}
    for target in verdict.targets:
        lines.append(f"{target}: {'differs' if target in differ else 'does the same'}")
    return "\n".join(lines) + "\n"


def _way(way: Way) -> str:
    if way.kind == "rule":
        which = "default" if way.rule < 0 else f"rule {way.rule + 1}"
        return f"{way.path}: {which} -> {way.outcome}"
    to = f"{way.target} ({way.kind})" if way.kind != "transition" else way.target
    return f"{way.path}: {way.outcome} -> {to}"


def _place(span: Span) -> str:
    name = span.source.name.replace("\\", "/").rpartition("/")[2]
    return f"{name}:{span.line}"


def _difference(each: Disagreement) -> Iterator[str]:
    begin, end = max(each.at - SHOWN_BEFORE, 0), each.at + SHOWN_AFTER + 1
    ours = [_event(event) for event in each.expected[begin:end]]
    theirs = [_event(event) for event in each.found[begin:end]]
    width = max(map(len, ["interpreter", *ours]))
    yield f"path {each.path}: {each.target} does something else than the interpreter"
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
        yield "# states that are not in it do what their expressions say"
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
