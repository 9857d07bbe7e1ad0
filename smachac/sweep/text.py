"""The summary of a sweep as text and as JUnit XML."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any
from xml.etree import ElementTree as ET

from smachac.report.junit import xml_text
from smachac.report.terminal import on_one_line
from smachac.sweep.summary import Difference, Summary
from smachac.sweep.task import Run
from smachac.verify.statistics_report import percent, seconds, table
from smachac.verify.trace_statistics import rounds_in_words

MOST_LINES = 10
"""Limit on the groups of failures and on the missing transitions in the text; JSON has all."""

EXCEPTION = "an exception"
"""What stands in place of an outcome where an exception ended the run."""

MOST_SEEDS = 8
"""Limit on the seeds of a group of failures in the text."""


def points(difference: float) -> str:
    """A difference of shares in percentage points: `+3.5`."""
    return f"{100 * difference:+.1f}"


def summary_text(summary: Summary, differences: Sequence[Difference] = ()) -> str:
    """The summary for a terminal; `differences` are those from an earlier sweep."""
    runs, planned = summary["runs"], summary["planned"]
    left = f" of {planned}" if runs < planned else ""
    lines = [f"{runs}{left} run{'s' * (planned != 1)} of {summary['machine']}"]
    if runs:
        names = ", ".join(summary["success"]["outcomes"])
        lines.append(
            f"success: {_share(summary['success'])} ({names})"
            if names
            else "success: no outcome has a name of success; --expect names one"
        )
        lines += table([("outcome", "runs", "share", "95 % interval"), *_outcomes(summary)])
        lines += _times(summary)
        lines += _coverage(summary)
        lines += _states(summary)
        lines += _varied(summary)
        lines += [f"fault {text}: {count}" for text, count in summary["faults"].items()]
        lines += _failures(summary)
        lines += _differences(differences)
    return "".join(f"{on_one_line(line)}\n" for line in lines)


def _share(part: dict[str, Any]) -> str:
    low, high = part["interval"]
    return f"{percent(part['share'])}, 95 % interval {percent(low)} to {percent(high)}"


def _outcomes(summary: Summary) -> Iterator[tuple[str, ...]]:
    for outcome in summary["outcomes"]:
        low, high = outcome["interval"]
        name = "failed run" if outcome["outcome"] is None else outcome["outcome"]
        interval = f"{percent(low)} to {percent(high)}"
        yield name, str(outcome["count"]), percent(outcome["share"]), interval


def _times(summary: Summary) -> Iterator[str]:
    times = summary["seconds"]
    if times["mean"] is not None:
        yield (
            f"duration: mean {seconds(times['mean'])}, median {seconds(times['median'])},"
            f" longest {seconds(times['longest'])}"
        )


def _coverage(summary: Summary) -> Iterator[str]:
    states, transitions = summary["coverage"]["states"], summary["coverage"]["transitions"]
    yield (
        f"{states['visited']} of {states['total']} states visited,"
        f" {transitions['taken']} of {transitions['total']} transitions taken"
    )
    yield from _some([f"  not visited: {path}" for path in states["missing"]])
    yield from _some(
        [
            f"  not taken: {item['path']}: {item['outcome']} -> {item['to']}  ({item['src']})"
            for item in transitions["missing"]
        ]
    )


def _some(lines: Sequence[str]) -> Iterator[str]:
    yield from lines[:MOST_LINES]
    if (more := len(lines) - MOST_LINES) > 0:
        yield f"  ... and {more} more: --format json has all of them"


def _states(summary: Summary) -> Iterator[str]:
    rows = [("state", "visits", "mean", "longest", "outcomes")]
    for state in summary["states"]:
        total = sum(state["outcomes"].values())
        shares = [f"{name} {percent(n / total)}" for name, n in state["outcomes"].items()]
        unfinished = [f"{state['unfinished']} not ended"] if state["unfinished"] else []
        name = f"{'  ' * state['path'].count('/')}{state['path'].rpartition('/')[2]}"
        mean, longest = seconds(state["mean"]), seconds(state["longest"])
        rounds = [words] if (words := rounds_in_words(state["rounds"])) else []
        shares += [*unfinished, *rounds]
        rows.append((name, str(state["visits"]), mean, longest, ", ".join(shares)))
    yield from table(rows)


def _varied(summary: Summary) -> Iterator[str]:
    for item in summary["varied"]:
        yield f"success by {item['name']}:"
        rows = []
        for part in item["parts"]:
            if not part["runs"]:
                continue
            what = (
                f"{part['low']:.4g} to {part['high']:.4g}" if "low" in part else str(part["value"])
            )
            low, high = part["interval"]
            rows.append(
                (f"  {what}", percent(part["share"]), f"({percent(low)} to {percent(high)})",
                 f"{part['runs']} runs")
            )  # fmt: skip
        yield from table(rows)


def step_text(step: dict[str, Any]) -> str:
    """The end of a state in words: `GO_HOME: exhausted (3 tries)`."""
    name = step["path"].rpartition("/")[2]
    badge = f" ({step['badge']})" if step["badge"] else ""
    return f"{name}: {step['outcome']}{badge}" if step["outcome"] else f"{name}: {EXCEPTION}"


def end_text(group: dict[str, Any]) -> str:
    """How the runs of a group of failures ended."""
    return f"failed run: {group['error']}" if group["outcome"] is None else group["outcome"]


def first_text(group: dict[str, Any]) -> str:
    """What failed first in a group of failures."""
    return step_text(group["steps"][group["first"]]) if group["steps"] else end_text(group)


def count_text(part: dict[str, Any]) -> str:
    """A number of runs and its share, with the interval."""
    count = part["count"]
    return f"{count} run{'s' * (count != 1)}, {_share(part)}"


def _failures(summary: Summary) -> Iterator[str]:
    groups = summary["failures"]
    if groups:
        yield "failures, by the state that failed first:"
    for group in groups[:MOST_LINES]:
        yield f"  {first_text(group)}: {count_text(group)}"
        steps = [*map(step_text, group["steps"]), *(["..."] if group["left_out"] else [])]
        yield f"    {' -> '.join([*steps, end_text(group)])}"
        seeds = ", ".join(map(str, group["seeds"][:MOST_SEEDS]))
        more = len(group["seeds"]) - MOST_SEEDS
        word = "seed" if len(group["seeds"]) == 1 else "seeds"
        yield f"    {word} {seeds}" + (f" and {more} more" if more > 0 else "")
        yield f"    {group['replay']}"
    if (more := len(groups) - MOST_LINES) > 0:
        yield f"  ... and {more} more groups: --format json has all of them"


def _differences(differences: Sequence[Difference]) -> Iterator[str]:
    if not differences:
        return
    yield "compared with the earlier sweep:"
    rows = [("  share of runs", "before", "now", "points", "95 % interval")]
    for difference in differences:
        low, high = difference.interval
        rows.append(
            (
                f"  {difference.what or 'success'}",
                percent(difference.before),
                percent(difference.after),
                points(difference.difference),
                f"{points(low)} to {points(high)}",
            )
        )
    yield from table(rows)


def junit_text(machine: str, runs: Iterable[tuple[Run, bool, str]]) -> str:
    """One test for each run, which is good or not, with the command that repeats it."""
    name = "smachac sweep"
    suite = ET.Element("testsuite", name=name)
    count = failed = 0
    for run, good, again in runs:
        count += 1
        test = ET.SubElement(
            suite, "testcase", name=f"seed {run.seed}", classname=xml_text(machine)
        )
        if not good:
            failed += 1
            message = run.error.partition("\n")[0] if run.outcome is None else run.outcome
            failure = ET.SubElement(test, "failure", message=xml_text(message))
            failure.set("type", "error" if run.outcome is None else "outcome")
            failure.text = "\n" + xml_text(f"{run.error}\n{again}\n".lstrip())
    for key, value in (("tests", count), ("failures", failed), ("errors", 0)):
        suite.set(key, str(value))
    whole = ET.Element("testsuites", dict(suite.items()))
    whole.set("name", "smachac")
    suite.set("skipped", "0")
    whole.append(suite)
    ET.indent(whole)
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ET.tostring(whole, "unicode") + "\n"
