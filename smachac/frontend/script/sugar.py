"""Sugar of a state or container: a time limit, retries, a loop over items.

`timeout: 20s`, `retry: {on: [aborted], max: 3, delay: 1s}`, `for_each: {item: wp, in: waypoints}`
are read here; desugar.py makes containers of them.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Related, Report, did_you_mean
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.diagnostics.wording import both, either, listed
from smachac.frontend.errors.script import (
    Choice,
    Owner,
    missing_variable,
    unknown_variable,
    wrong_shape,
)
from smachac.frontend.resolved_script import (
    ERROR,
    EXHAUSTED,
    TIMEOUT,
    ForEach,
    Retry,
    Sugar,
    Timeout,
)
from smachac.frontend.text.fields import as_items, as_name, as_names, pairs_of, wrong
from smachac.frontend.text.values import UNKNOWN
from smachac.frontend.text.yaml_tree import Entry, Map, Scalar, Seq, Tree, is_known_wrong
from smachac.ir import durations
from smachac.ir.durations import DURATION, SECONDS
from smachac.ir.nodes import Expression, Outcome, StateType, Value
from smachac.ir.outcome_names import GOOD_OUTCOMES, PREEMPTED, is_failure
from smachac.records import replace

NAMES = frozenset(["timeout", "retry", "for_each"])
"""The fields of sugar, except those that are variables of the state type."""

MOST_TRIES = 10_000
"""The most tries of a `retry`; each is an item of an iterator."""

UNKNOWN_SECONDS = 86_400.0
"""The time limit in place of a wrong one, which was reported."""

UNKNOWN_TRIES = 2
"""The number of tries in place of a wrong one, which was reported."""

NO_OUTCOMES = "add `outcomes: [...]` to this state"

SUGGESTED_PARTS: Mapping[str, str] = {
    word: part
    for part, words in {
        "max": "attempts count limit max_attempts max_retries max_tries retries times tries",
        "on": "outcome outcomes when",
        "delay": "interval pause sleep wait",
        "item": "as label name var variable",
        "in": "it items list over",
    }.items()
    for word in words.split()
}
"""Other words for a part of sugar, which are not its misspelt names."""

_SENTENCE = r"(?:for )?([A-Za-z_]\w*) in ([A-Za-z_]\w*)"
_PARTS = r"(\d+(?:\.\d+)?)\s*([a-z]+)"


def is_own(name: str, type_: StateType) -> bool:
    """Whether a field of this name is a variable of the state type."""
    return name in type_.variables or (type_.open and type_.any_variable and type_.name != "")


def read_sugar(
    entries: Mapping[str, Entry],
    type_: StateType,
    outcomes: tuple[Outcome, ...],
    inputs: tuple[str, ...],
    report: Report,
) -> Sugar:
    """The sugar among the fields of a state, which declares these outcomes and input keys.

    Errors in it are reported (SM004), also outcomes that the state does not have; they are
    corrected then, so that nothing follows from them.
    """
    fields = {name: entries[name] for name in NAMES if name in entries and not is_own(name, type_)}
    if not fields:
        return Sugar()
    _move_limit(fields, report)
    before = len(report)
    timeout = _timeout(fields["timeout"], report) if "timeout" in fields else None
    wrong_timeout, before = len(report) > before, len(report)
    own = tuple(outcome.name for outcome in type_.outcomes)
    if type_.kind != "state" or "outcomes" in type_.given:
        own += tuple(outcome.name for outcome in outcomes)
    retry = _retry(fields["retry"], own, report) if "retry" in fields else None
    wrong_retry, before = len(report) > before, len(report)
    for_each = _for_each(fields["for_each"], inputs, report) if "for_each" in fields else None
    wrong_loop = len(report) > before
    pairs = pairs_of(entries["transitions"].value) if "transitions" in entries else ()
    led = {word.text for word, _ in pairs}
    # The outcomes that wrong sugar adds are kept only where the script uses one of them: otherwise
    # they would be reported because they have no transition.
    used = led.union(word.text for part in (retry, for_each) if part for word in part.on)
    if wrong_timeout and used.isdisjoint({TIMEOUT, PREEMPTED}.difference(own)):
        timeout = None
    if wrong_retry and used.isdisjoint({EXHAUSTED, PREEMPTED}.difference(own)):
        retry = None
    if for_each is not None and wrong_loop and PREEMPTED not in {*own, *used}:
        for_each = replace(for_each, preempted=False)
    sugar = Sugar(timeout=timeout, retry=retry, for_each=for_each)
    failing = [
        outcome.name
        for outcome in (*type_.outcomes, *outcomes)
        if (is_failure(outcome.name) if outcome.failure is None else outcome.failure)
    ]
    return _with_known_outcomes(sugar, own, _Uses(led, failing), report)


def _move_limit(fields: dict[str, Entry], report: Report) -> None:
    """Move a `timeout` that is written as a part of `retry` or `for_each` beside it; it is
    reported there."""
    for name in ("retry", "for_each"):
        entry = fields.get(name)
        inner = entry.value.entries if entry is not None and isinstance(entry.value, Map) else ()
        inside = [entry for entry in inner if entry.key.value == "timeout"]
        if entry is None or len(inside) != 1 or "timeout" in fields:
            continue
        limit = inside[0]
        owner = Owner(name, f"`{name}`", "part")
        help = f"write `timeout: {limit.value.span.text}` beside `{name}`"
        report.append(unknown_variable(Word("timeout", limit.key.span), owner, (), help=help))
        rest = tuple(entry for entry in inner if entry is not limit)
        fields |= {name: replace(entry, value=Map(rest, entry.value.span)), "timeout": limit}


class _Uses(NamedTuple):
    """The outcomes of a state that have transitions, and those of failure."""

    led: Collection[str]
    failing: Collection[str]


def _with_known_outcomes(sugar: Sugar, own: tuple[str, ...], uses: _Uses, report: Report) -> Sugar:
    """The sugar, in which retries and loops name only outcomes of the state and its sugar."""
    led = uses.led
    first = (*own, TIMEOUT) if sugar.timeout else own
    second = (*first, EXHAUSTED) if sugar.retry else first
    retry = sugar.retry
    if retry is not None:
        on = _known(retry.on, first, uses, "retry", report)
        lost = [word for word in retry.on if word.text == TIMEOUT and TIMEOUT not in first]
        left = [name for name in first if name not in led]
        if lost and (len(retry.on) > 1 or len(left) != 1):
            # It was reported; with a time limit nothing follows from it.
            place = lost[0].span
            limit = Timeout(seconds=UNKNOWN_SECONDS, span=place, value_span=place)
            others = tuple(word for word in retry.on if word.text != TIMEOUT)
            on = _known(others, first, uses, "retry", [])
            on = on if on and TIMEOUT in led else (*on, lost[0])
            sugar = replace(sugar, timeout=limit)
        sugar = replace(sugar, retry=replace(retry, on=on))
    if sugar.for_each is not None:
        on = _known(sugar.for_each.on, second, uses, "for_each", report)
        sugar = replace(sugar, for_each=replace(sugar.for_each, on=on))
    loop = sugar.for_each
    if loop and loop.item and not loop.on and not set(second) & set(GOOD_OUTCOMES):
        message = "`for_each` needs `on` here: no outcome of this state has the name of a success"
        help = f"add `on: [...]` with one or more of {listed(second)}" if second else NO_OUTCOMES
        report.append(wrong_shape(loop.span, message, help, arguments=("on",)))
    return sugar


def _known(
    on: tuple[Word, ...],
    outcomes: tuple[str, ...],
    uses: _Uses,
    field: str,
    report: Report,
) -> tuple[Word, ...]:
    """The words that name outcomes. A word that names none is reported; in its place the result has
    the outcome with the most similar name, or else an outcome without a transition."""
    found: list[Word] = []
    for word in on:
        if word.text in (*outcomes, ERROR):
            found.append(word)
            continue
        given = {word.text for word in on}
        left = [name for name in outcomes if name not in given]
        fitting = _fitting(outcomes, uses.failing, field)
        others = [name for name in left if name not in uses.led]
        others = others or [name for name in left if name in fitting] or list(outcomes[-1:])
        if not word.text:  # it is missing, which was reported
            found += [Word(name, word.span) for name in others[:1]]
            continue
        message = f"this state has no outcome `{word.text}`"
        help = _other_outcome(word.text, [word.text for word in on], outcomes, uses, field)
        effect = f"its outcomes are {listed(outcomes)}" if outcomes else None
        arguments = ("outcome", word.text)
        report.append(wrong_shape(word.span, message, help, arguments=arguments, effect=effect))
        meant = guesser(outcomes)(word.text) or next(iter(others), "")
        found += [Word(meant, word.span)] if meant else []
    return tuple(found)


_ADDED_BY = {TIMEOUT: ("timeout", "SECONDS"), EXHAUSTED: ("retry", "{on: [OUTCOME], max: 3}")}
"""The outcomes that a field adds, each with the field and an example of its value."""


def _other_outcome(
    word: str, given: Sequence[str], outcomes: tuple[str, ...], uses: _Uses, field: str
) -> str:
    """The help for a word in `on` of a field that is no outcome of its state."""
    kept = [name for name in given if name in outcomes]
    left = [name for name in outcomes if name not in uses.led and name not in given]
    fitting = _fitting(outcomes, uses.failing, field)
    kept = kept or (left if len(left) == 1 else fitting)
    shorter = f"write `on: [{', '.join(kept)}]`" if kept else ""
    if word == EXHAUSTED and field == "retry":
        return f"the state ends with `{word}` after the last try: {shorter or 'remove `retry`'}"
    if word in _ADDED_BY:
        name, value = _ADDED_BY[word]
        why = f"a state has the outcome `{word}` only with the field `{name}`"
        return f"{why}: add `{name}: {value}`, or {shorter or f'remove `{field}`'}"
    if word == PREEMPTED and shorter:
        return f"{shorter}: a state that a stop request ends does not run again"
    if len(left) == 1:
        return did_you_mean(word, outcomes) or f"write `{left[0]}`, which has no transition"
    near = did_you_mean(word, outcomes)
    if near is None and len(fitting) == 1 and fitting[0] not in given:
        near = f"write `{fitting[0]}` in place of `{word}`"
    return near or (f"use one of its outcomes: {listed(outcomes)}" if outcomes else NO_OUTCOMES)


def _fitting(outcomes: tuple[str, ...], failing: Collection[str], field: str) -> list[str]:
    """The outcomes after which a field makes its state run again: those of failure for `retry`,
    those of success for `for_each`, or those that are no failure."""
    if field == "retry":
        return [name for name in outcomes if name in failing]
    good = [name for name in outcomes if name in GOOD_OUTCOMES]
    other = {*failing, PREEMPTED, TIMEOUT, EXHAUSTED}
    return good or [name for name in outcomes if name not in other]


UNITS = {
    **dict.fromkeys(("millisecond", "milliseconds", "msec"), "ms"),
    **dict.fromkeys(("sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("m", "mins", "minute", "minutes"), "min"),
    **dict.fromkeys(("hr", "hrs", "hour", "hours"), "h"),
}
"""Other words for the units of durations."""


def duration(tree: Tree, report: Report) -> float | None:
    """A duration in seconds: `20s`, `500ms`, `1.5 min`, `1h`, or a number of seconds."""
    found = durations.seconds(tree.value) if isinstance(tree, Scalar) else None
    if found is not None:
        return found
    wrong(tree, "duration", report, _suggested_duration(tree))
    return None


def _suggested_duration(tree: Tree) -> str | None:
    """The help for a duration with another word for its unit, such as `20 sec`, and for one of
    several parts, such as `1m30s`."""
    if isinstance(tree, Seq | Map):
        return _duration_inside(tree)
    number, arrow, target = tree.span.text.partition("->")
    if arrow and DURATION.fullmatch(number.strip()) is not None and target.strip():
        return (
            f"write `timeout: {number.strip()}`, and `timeout: {target.strip()}` in `transitions`"
        )
    parts = re.findall(_PARTS, tree.span.text)
    if len(parts) > 1 and "".join(map("".join, parts)) == "".join(tree.span.text.split()):
        units = [unit if unit in SECONDS else UNITS.get(unit, "") for _, unit in parts]
        if all(units):
            seconds = sum(float(number) * SECONDS[unit]
                          for (number, _), unit in zip(parts, units, strict=True))  # fmt: skip
            return f"write it with one unit: `{seconds:g}s`"
    found = DURATION.fullmatch(tree.span.text)
    unit = UNITS.get(found.group(2)) if found is not None else None
    return f"write it as `{found.group(1)}{unit}`" if found is not None and unit else None


def _duration_inside(tree: Seq | Map) -> str | None:
    """The help for a list or a mapping with one duration, such as `{seconds: 5}`."""
    if isinstance(tree, Seq):
        values = [("", item) for item in tree.items]
    else:
        values = [(str(entry.key.value), entry.value) for entry in tree.entries]
    if len(values) != 1 or not isinstance(values[0][1], Scalar):
        return None
    name, text = values[0][0], values[0][1].span.text
    limit = DURATION.fullmatch(name)
    if limit is not None and limit[2] in SECONDS:
        return f"write `timeout: {name}`, and `timeout: {text}` in `transitions`"
    found = DURATION.fullmatch(text)
    if found is None:
        return None
    unit = found[2] or UNITS.get(name, name if name in SECONDS else "") or "s"
    return f"write it as `{found[1]}{unit}`"


def _timeout(entry: Entry, report: Report) -> Timeout:
    """The time limit. A wrong one is reported and kept with the limit `UNKNOWN_SECONDS`, so that
    no outcome is missing because of it."""
    seconds = duration(entry.value, report)
    if seconds == 0:
        message = "the time limit must be longer than zero"
        help = "write it as `20s`, or remove it"
        report.append(wrong_shape(entry.value.span, message, help, arguments=("zero",)))
    return Timeout(
        seconds=seconds or UNKNOWN_SECONDS, span=entry.key.span, value_span=entry.value.span
    )


def _parts(
    entry: Entry,
    known: tuple[str, ...],
    required: Mapping[str, str],
    report: Report,
    own: tuple[str, ...] = (),
) -> dict[str, Tree] | None:
    """The entries of a mapping with known keys, without those that are missing; None for other
    values. All errors are reported. `required`: keys that must be there, with example values.
    `own` are the outcomes of the state."""
    if not isinstance(entry.value, Map):
        wrong(entry.value, "map", report, _mapping_for(entry, required, own))
        return None
    pair = _pair_for(entry) or _tries_for(entry, own)
    if pair is not None:
        message = "`for_each` has two parts, the name of its item and its list"
        if "on" in known and "max" in known:
            message = "`retry` has two parts, the outcomes `on` and the number of tries `max`"
        report.append(wrong_shape(entry.value.span, message, pair, arguments=("pair",)))
        return None
    owner = Owner(str(entry.key.value), f"`{entry.key.value}`", "part")
    parts: dict[str, Tree] = {}
    entries = entry.value.entries
    written = {str(entry.key.value) for entry in entries}
    paired = _paired(
        [entry for entry in entries if entry.key.value not in known], written, required
    )
    found: Report = []
    for item in entries:
        word = Word(str(item.key.value), item.key.span)  # `on` is fine here, unlike in names
        if word.text in known:
            parts[word.text] = item.value
            continue
        others = tuple(name for name in known if name not in written)
        meant = _suggested_part(word.text, others)
        if meant is None and paired:
            report.append(
                unknown_variable(word, owner, others, Choice(likely=paired, required=paired))
            )
            parts[paired] = item.value
            continue
        if meant is None:
            report.append(unknown_variable(word, owner, others))
            continue
        lost = meant if meant in required and meant not in written else None
        found.append(unknown_variable(word, owner, known, Choice(meant=meant, required=lost)))
        parts.setdefault(meant, item.value)
    report += _as_one(entry, found, required)
    for name, example in required.items():
        if name not in parts:
            report.append(missing_variable(entry.key.span, name, owner, example=example))
    return parts


def _as_one(entry: Entry, found: Report, required: Mapping[str, str]) -> Report:
    """One finding for several other words for different parts, with the mapping as it is meant."""
    edits = sorted((edit for diagnostic in found for edit in diagnostic.finding.edits),
                   key=lambda edit: edit.span.start)  # fmt: skip
    parts = {edit.text: None for edit in edits}
    value = entry.value.span
    if len(found) < 2 or len(parts) != len(found) or "\n" in value.text:
        return found
    text, at = "", value.start
    for edit in edits:
        text += value.source.text[at : edit.span.start] + edit.text
        at = edit.span.end
    text += value.source.text[at : value.end]
    first, *others = [diagnostic.finding for diagnostic in found]
    lost = [part for part in parts if part in required]
    missing = f"; {both(lost)}, which are required, are missing" if len(lost) > 1 else ""
    one = replace(
        first,
        message=f"{both(diagnostic.span.text for diagnostic in found)} are not parts of"
        f" `{entry.key.value}`",
        help=f"write `{entry.key.value}: {text}`",
        effect=f"no code reads fields of these names{missing}",
        edits=tuple(edits),
        related=tuple(Related(span=other.span, message="and here") for other in others),
    )
    return [replace(found[0], finding=one)]


def _paired(unknown: list[Entry], written: set[str], required: Mapping[str, str]) -> str:
    """The only required part that is missing, if there is one unknown part, which it then means;
    empty otherwise."""
    missing = [name for name in required if name not in written]
    if len(unknown) != 1 or len(missing) != 1:
        return ""
    value, name = unknown[0].value, missing[0]
    is_number = isinstance(value, Scalar) and type(value.value) is int
    return name if is_number == (name == "max") else ""


def _suggested_part(word: str, parts: tuple[str, ...]) -> str | None:
    """The part of sugar that a word is meant for: another word for it, its misspelt name, or a
    misspelt other word; None if it is none of these."""
    meant = SUGGESTED_PARTS.get(word)
    if meant in parts:
        return meant
    near = guesser(parts)(word)
    if near is None:
        words = [other for other, part in SUGGESTED_PARTS.items() if part in parts]
        near = SUGGESTED_PARTS.get(guesser(words)(word) or "")
    return near


def _pair_for(entry: Entry) -> str | None:
    """How a loop is written whose mapping is `{wp: waypoints}`, with other words after the pair;
    None for other mappings."""
    entries = entry.value.entries if isinstance(entry.value, Map) else ()
    if entry.key.value != "for_each" or not entries:
        return None
    sentence = re.fullmatch(_SENTENCE, str(entries[0].key.value))
    if sentence is not None and len(entries) == 1:
        return f"write `for_each: {{item: {sentence[1]}, in: {sentence[2]}}}`"
    (word, *others), items = [str(entry.key.value) for entry in entries], entries[0].value.span.text
    parts = ("in", "item", "on")
    if any(name in parts or _suggested_part(name, parts) for name in (word, *others)):
        return None
    if "\n" in items:
        return None
    help = f"write `for_each: {{item: {word}, in: {items}}}`"
    return f"{help}; there is no part {either(others)}" if others else help


def _tries_for(entry: Entry, own: tuple[str, ...]) -> str | None:
    """How tries are written whose mapping is `{outcome: 3}`; None for other mappings."""
    entries = entry.value.entries if isinstance(entry.value, Map) else ()
    if entry.key.value != "retry" or len(entries) != 1:
        return None
    name, value = entries[0].key.value, entries[0].value
    if name not in own or not isinstance(value, Scalar) or type(value.value) is not int:
        return None
    return f"write `retry: {{on: [{name}], max: {value.value}}}`"


def _mapping_for(entry: Entry, required: Mapping[str, str], own: tuple[str, ...]) -> str:
    """How a field is written whose value is no mapping, with the user's value where it belongs.
    `own` are the outcomes of the state."""
    value, text = entry.value, entry.value.span.text
    if entry.key.value == "for_each":
        items = text if isinstance(value, (Seq, Scalar)) and "\n" not in text and text else "KEY"
        sentence = re.fullmatch(_SENTENCE, text.strip("'\""))
        meant = required["item"], items
        item, items = (sentence[1], sentence[2]) if sentence is not None else meant
        return f"write `for_each: {{item: {item}, in: {items}}}`"
    numbers = re.findall(r"(?<![\w.])\d+(?![\w.])", text)
    named = [name for name in own if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", text)]
    on = f"[{', '.join(named)}]" if named else required["on"]
    help = f"write `retry: {{on: {on}, max: {numbers[0] if numbers else 3}}}`"
    return help if named else f"{help}, with the outcomes to try again after"


def _retry(entry: Entry, own: tuple[str, ...], report: Report) -> Retry:
    """The tries. Wrong or missing parts are reported and replaced, so that no outcome is missing
    because of them. `own` are the outcomes of the state."""
    failures = [name for name in own if is_failure(name)] or ["OUTCOME"]
    required = {"on": f"[{', '.join(failures)}]", "max": "3"}
    parts = _parts(entry, ("on", "max", "delay"), required, report, own) or {}
    on: tuple[Word, ...] = (Word("", entry.key.span),)
    if "on" in parts and not is_known_wrong(parts["on"]):
        on = as_names(parts["on"], report)
    most = _tries(parts["max"], report) if "max" in parts else UNKNOWN_TRIES
    delay = duration(parts["delay"], report) if "delay" in parts else 0.0
    return Retry(on=on, most=most, delay=delay or 0.0, span=entry.key.span)


def _tries(tree: Tree, report: Report) -> int:
    """The number of tries; a wrong one is reported."""
    if is_known_wrong(tree):
        return UNKNOWN_TRIES  # SM015
    number = tree.value if isinstance(tree, Scalar) and type(tree.value) is int else None
    if number is not None and 1 <= number <= MOST_TRIES:
        return number
    if is_known_wrong(tree):
        return UNKNOWN_TRIES
    message = f"`max`, the number of tries, must be a whole number from 1 to {MOST_TRIES:,}"
    help = "write a whole number, such as `3`"
    if isinstance(tree, Scalar) and isinstance(tree.value, str) and tree.value.isdecimal():
        help = f"quotes make it a text: write the number `{tree.value}`"
    if number is not None and number < 1:
        help = "write `max: 1` or more, or remove `retry` if one try is enough"
    report.append(wrong_shape(tree.span, message, help, arguments=("max",)))
    return UNKNOWN_TRIES


def _for_each(entry: Entry, inputs: tuple[str, ...], report: Report) -> ForEach:
    """The loop. Wrong or missing parts are reported; the item has no name then, so that nothing
    follows from it. `inputs` are the input keys of the state."""
    value = entry.value
    given = [entry.value for entry in value.entries] if isinstance(value, Map) else [value]
    used = {scalar.value for scalar in given if isinstance(scalar, Scalar)}
    names = [key for key in inputs if key not in used]
    required = {"item": names[0] if len(names) == 1 else "NAME", "in": "KEY"}
    before = len(report)
    parts = _parts(entry, ("item", "in", "on"), required, report) or {}
    unknown = Value(data=Expression(text=UNKNOWN, span=value.span), span=value.span)
    name = as_name(parts["item"], report) if "item" in parts else None
    items = as_items(parts["in"], report) if "in" in parts else unknown
    given_items = parts.get("in")
    sentence = re.fullmatch(_SENTENCE, given_items.span.text) if given_items is not None else None
    if sentence is not None and given_items is not None:
        message = f"`in` has the list alone: `{sentence[1]} in` is one word too many"
        help = f"write `in: {sentence[2]}`"
        report.append(wrong_shape(given_items.span, message, help, arguments=("sentence",)))
    item = name.text if name is not None and len(report) == before else ""
    on = as_names(parts["on"], report) if "on" in parts else ()
    return ForEach(
        item=item,
        item_span=name.span if name is not None else entry.key.span,
        items=items if item else unknown,
        on=on,
        span=entry.key.span,
    )
