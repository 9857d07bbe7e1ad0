"""The judgement of recorded traces by a machine: files of JSON lines, as text and as JSON."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import NamedTuple

from smachac.diagnostics.source import Span
from smachac.diagnostics.wording import quote
from smachac.interpreter.result import Event
from smachac.ir.nodes import Machine
from smachac.ir.written import Written
from smachac.records import dataclass
from smachac.report.json import json_text
from smachac.report.terminal import on_one_line
from smachac.runtime.tracing.writer import LONGEST_LINE, LONGEST_NAME
from smachac.verify.coverage import CoverageItem, ScriptCoverage
from smachac.verify.result import MOST_MISSING, item_text, place
from smachac.verify.trace_conformance import Acceptor

FIELDS = {
    "start": (),
    "enter": (),
    "exit": ("outcome",),
    "transition": ("outcome", "to"),
    "write": ("key",),
    "preempt": (),
    "error": (),
    "finish": ("outcome",),
    "fault": ("fault",),
}
"""By the kind of an event, the fields that it has beside `event` and `path`, all of them texts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class JudgedTrace:
    """One trace: its number of events, and the outcome of its last run, or None if that has not
    ended. `fault` is the first line that is not allowed or not an event, counted from 1, with the
    reason and the place of the state in the script."""

    name: str
    events: int
    outcome: str | None
    fault: tuple[int, str, Span | None] | None


MOST_TRACES = 20
"""Limit on the traces in the text; JSON contains all of them."""


class _BadLineError(Exception):
    """A line is no event of a trace; the message gives the reason."""


def read_event(line: str) -> Event:
    """The event in a line of a trace. Raises _BadLineError."""
    if len(line) > LONGEST_LINE:
        raise _BadLineError(f"this line has more than {LONGEST_LINE:,} characters")
    try:
        event = json.loads(line)
    except ValueError:
        raise _BadLineError("this line is not JSON") from None
    except RecursionError:
        raise _BadLineError("this line has too many brackets in brackets") from None
    if not isinstance(event, dict) or not isinstance(event.get("event"), str):
        raise _BadLineError("this line is not an event of a trace")
    kind = event["event"]
    if kind not in FIELDS:
        raise _BadLineError(f"{quote(kind)} is not a kind of event: {', '.join(FIELDS)}")
    for name in ("path", *FIELDS[kind]):
        if not isinstance(event.get(name), str):
            raise _BadLineError(f"the event `{kind}` has no text `{name}`")
        if len(event[name]) > LONGEST_NAME:
            raise _BadLineError(f"its `{name}` has more than {LONGEST_NAME:,} characters")
    return event


def judge_trace(
    machine: Machine,
    name: str,
    lines: Iterable[str],
    record: Callable[[Event], None],
    view: Written,
) -> JudgedTrace:
    """Judge one trace; `record` receives its allowed events, with full paths, `view` has the states
    that messages name.

    A last line without a line break is the rest of a write that was interrupted; it may be torn. Of
    a line that is too long, `lines` may have only the first `LONGEST_LINE + 1` characters.
    """
    acceptor = Acceptor(machine, view)
    events = 0
    fault: tuple[int, str, Span | None] | None = None
    for number, line in enumerate(lines, 1):
        if not line.strip():
            continue
        try:
            event = acceptor.full(read_event(line))
        except _BadLineError as error:
            if line.endswith("\n") or len(line) > LONGEST_LINE:
                fault = number, str(error), None
            break
        violation = acceptor.accept(events, event)
        if violation is not None:
            fault = number, violation.message, violation.span
            break
        events += 1
        record(event)
    return JudgedTrace(name=name, events=events, outcome=acceptor.outcome, fault=fault)


class UntakenTransition(NamedTuple):
    """A transition that no trace takes, with paths of the script, and its place."""

    item: CoverageItem
    span: Span


def untaken(taken: ScriptCoverage) -> list[UntakenTransition]:
    """The transitions that no trace takes, in the order of the script."""
    return [UntakenTransition(item, taken.items[item]) for item in taken.missing()]


def trace_text(
    traces: Sequence[JudgedTrace], missing: Sequence[UntakenTransition], total: int
) -> str:
    """The traces, those that are not allowed first, then the missing ones of all `total`
    transitions."""
    lines = refusals(traces)
    bad = sum(trace.fault is not None for trace in traces)
    allowed = [trace for trace in traces if trace.fault is None]
    lines += [_trace_line(trace) for trace in allowed[:MOST_TRACES]]
    if (more := len(allowed) - MOST_TRACES) > 0:
        lines.append(f"... and {more} more")
    count = f"{len(traces)} trace{'s' * (len(traces) != 1)}"
    lines.append(f"{count}, {bad} not allowed" if bad else f"{count}, all allowed")
    percent = f" ({100 * (total - len(missing)) // total} %)" if total else ""
    lines.append(f"{total - len(missing)} of {total} transitions taken{percent}")
    lines += [
        f"  not taken: {item_text(item)}  ({place(span)})" for item, span in missing[:MOST_MISSING]
    ]
    if (more := len(missing) - MOST_MISSING) > 0:
        lines.append(f"  ... and {more} more: --format json has all of them")
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def refusals(traces: Sequence[JudgedTrace]) -> list[str]:
    """A line for each trace that is not allowed."""
    bad = [trace for trace in traces if trace.fault is not None]
    lines = [_trace_line(trace) for trace in bad[:MOST_TRACES]]
    if (more := len(bad) - MOST_TRACES) > 0:
        lines.append(f"... and {more} more that are not allowed")
    return lines


def _trace_line(trace: JudgedTrace) -> str:
    if trace.fault is not None:
        number, message, span = trace.fault
        where = "" if span is None else f" ({place(span)})"
        return f"{trace.name}:{number}: {message}{where}"
    end = "has not ended" if trace.outcome is None else f"ended with `{trace.outcome}`"
    return f"{trace.name}: {trace.events} events, {end}"


def trace_json(
    traces: Sequence[JudgedTrace], missing: Sequence[UntakenTransition], total: int
) -> str:
    """One JSON object with every trace and the missing ones of all `total` transitions."""
    data = {
        "traces": [dict(_fields(trace)) for trace in traces],
        "coverage": {
            "taken": total - len(missing),
            "total": total,
            "missing": [
                {"path": item.path, "outcome": item.outcome, "to": item.target, "kind": item.kind,
                 "src": place(span)}
                for item, span in missing
            ],
        },
    }  # fmt: skip
    return json_text(data)


def _fields(trace: JudgedTrace) -> Iterator[tuple[str, object]]:
    yield "name", trace.name
    yield "events", trace.events
    yield "outcome", trace.outcome
    yield "allowed", trace.fault is None
    if trace.fault is not None:
        number, message, span = trace.fault
        yield "line", number
        yield "message", message
        yield "src", None if span is None else place(span)
