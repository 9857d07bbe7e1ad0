"""What any state or container may have beside its own variables: a time limit, retries, a loop.

`timeout: 20s`, `retry: {on: [aborted], max: 3, delay: 1s}`, `for_each: {item: wp, in: waypoints}`
are read here; desugar.py makes containers of them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from smachac.diagnostics.diagnostic import Report, did_you_mean
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.wording import listed
from smachac.frontend import field_shapes
from smachac.frontend.errors.script import missing_variable, unknown_variable, wrong_shape
from smachac.frontend.state_types import StateType
from smachac.frontend.yaml_tree import Entry, Map, Scalar, Tree
from smachac.ir.outcome_names import GOOD_OUTCOMES

NAMES = ("timeout", "retry", "for_each")
"""The variables; a state type that declares one of them, or that is open, has it for itself."""

TIMEOUT, EXHAUSTED = "timeout", "exhausted"
"""The outcomes that a time limit and retries add."""

ERROR = "error"
"""The outcome that stands for an exception, where a state has no such outcome itself."""

MOST_TRIES = 10_000
"""The most tries of a `retry`: each is an item of an iterator."""

SECONDS = {"": 1.0, "ms": 0.001, "s": 1.0, "min": 60.0, "h": 3600.0}
_DURATION = re.compile(r"(\d+(?:\.\d+)?|\.\d+)\s*([a-z]*)")


@dataclass(frozen=True, slots=True, kw_only=True)
class Timeout:
    """A limit in seconds."""

    seconds: float
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Retry:
    """At most `most` tries, with a pause of `delay` seconds between them, while a try ends `on`."""

    on: tuple[Word, ...]
    most: int
    delay: float
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class ForEach:
    """Once for each item of `items`, under the key `item`, as long as it ends `on`."""

    item: str
    items: Tree
    on: tuple[Word, ...]
    span: Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Sugar:
    """What one state has of these; all None for most."""

    timeout: Timeout | None = None
    retry: Retry | None = None
    for_each: ForEach | None = None


def has_sugar(fields: Mapping[str, Entry], type_: StateType) -> bool:
    return any(name in fields and not is_own(name, type_) for name in NAMES)


def is_own(name: str, type_: StateType) -> bool:
    """Whether a variable of this name is the state type's."""
    return name in type_.variables or (type_.open and type_.name != "")


def read_sugar(fields: Mapping[str, Entry], type_: StateType, report: Report) -> Sugar:
    """The sugar among the variables of a state; what is wrong with it is reported (SM004)."""
    fields = {name: fields[name] for name in NAMES if name in fields and not is_own(name, type_)}
    timeout = retry = for_each = None
    if "timeout" in fields:
        seconds = duration(fields["timeout"].value, report)
        if seconds:
            timeout = Timeout(seconds=seconds, span=fields["timeout"].key.span)
        elif seconds == 0:
            span = fields["timeout"].value.span
            message = "a time limit of nothing is over before the state begins"
            report.append(wrong_shape(span, message, "write it as `20s`, or leave it out"))
    if "retry" in fields:
        retry = _retry(fields["retry"], report)
    if "for_each" in fields:
        for_each = _for_each(fields["for_each"], report)
    return Sugar(timeout=timeout, retry=retry, for_each=for_each)


def duration(tree: Tree, report: Report) -> float | None:
    """A duration in seconds: `20s`, `500ms`, `1.5 min`, `1h`, or a number of seconds."""
    if isinstance(tree, Scalar) and isinstance(tree.value, str | int | float):
        found = _DURATION.fullmatch(str(tree.value).strip())
        if found is not None and found.group(2) in SECONDS and not isinstance(tree.value, bool):
            return float(found.group(1)) * SECONDS[found.group(2)]
    field_shapes.wrong(tree, "a duration", report, "write it as `20s`, `500ms`, `1.5min` or `1h`")
    return None


def _parts(
    entry: Entry, known: tuple[str, ...], required: tuple[str, ...], report: Report
) -> dict[str, Tree] | None:
    """The entries of a mapping with known keys; None where a required one is missing."""
    if not isinstance(entry.value, Map):
        field_shapes.wrong(entry.value, "a mapping", report, f"it has {listed(known)}")
        return None
    parts: dict[str, Tree] = {}
    for each in entry.value.entries:
        word = Word(str(each.key.value), each.key.span)  # `on` is fine here, unlike in names
        if word.text not in known:
            report.append(unknown_variable(word, f"`{entry.key.value}`", known))
        parts[word.text] = each.value
    for name in required:
        if name not in parts:
            whose = f"`{entry.key.value}`"
            report.append(missing_variable(entry.key.span, name, whose))
    return parts if all(name in parts for name in required) else None


def _retry(entry: Entry, report: Report) -> Retry | None:
    parts = _parts(entry, ("on", "max", "delay"), ("on", "max"), report)
    if parts is None:
        return None
    on = field_shapes.as_names(parts["on"], report)
    most = parts["max"]
    delay = duration(parts["delay"], report) if "delay" in parts else 0.0
    whole = isinstance(most, Scalar) and type(most.value) is int
    if not whole or not 1 <= int(str(most.value)) <= MOST_TRIES:  # type: ignore[union-attr]
        message = f"`max` is how often it is tried: a whole number from 1 to {MOST_TRIES:,}"
        report.append(wrong_shape(most.span, message, "leave `retry` out for one try"))
        return None
    number = int(str(most.value))  # type: ignore[union-attr]
    return Retry(on=on, most=number, delay=delay or 0.0, span=entry.key.span)


def _for_each(entry: Entry, report: Report) -> ForEach | None:
    parts = _parts(entry, ("item", "in", "on"), ("item", "in"), report)
    if parts is None:
        return None
    item = field_shapes.as_name(parts["item"], report)
    on = field_shapes.as_names(parts["on"], report) if "on" in parts else ()
    if item is None:
        return None
    return ForEach(item=item.text, items=parts["in"], on=on, span=entry.key.span)


def check_sugar(fields: Mapping[str, Entry], type_: StateType, report: Report) -> None:
    """What is wrong with the sugar of a state: SM004, also for outcomes that it does not have."""
    if not has_sugar(fields, type_):
        return
    sugar = read_sugar(fields, type_, report)
    own = tuple(outcome.name for outcome in type_.outcomes)
    if "outcomes" in fields and (type_.kind != "state" or "outcomes" in type_.given):
        own += tuple(word.text for word in field_shapes.as_names(fields["outcomes"].value, []))
    first = (*own, TIMEOUT) if sugar.timeout else own
    second = (*first, EXHAUSTED) if sugar.retry else first
    for part, outcomes in ((sugar.retry, first), (sugar.for_each, second)):
        for word in part.on if part is not None else ():
            if word.text not in (*outcomes, ERROR):
                message = f"this state has no outcome `{word.text}`"
                help = did_you_mean(word.text, outcomes)
                help = help or f"its outcomes are {listed(outcomes)}"
                report.append(wrong_shape(word.span, message, help))
    if sugar.for_each and not sugar.for_each.on and not set(second) & set(GOOD_OUTCOMES):
        message = "nothing says after which outcome of this state the next item comes"
        help = f"add `on: [...]`; the outcomes are {listed(second)}"
        report.append(wrong_shape(sugar.for_each.span, message, help))
