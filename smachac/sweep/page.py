"""The summary of a sweep as one HTML page with plots, without other files, for light and dark."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from smachac.report.terminal import visible
from smachac.sweep.summary import Difference, Summary
from smachac.sweep.text import EXCEPTION, count_text, end_text, first_text, points
from smachac.verify.statistics_report import percent, seconds
from smachac.verify.trace_statistics import rounds_in_words

STYLE = """
:root { color-scheme: light dark; --text: #1d2126; --dim: #5b6470; --page: #fff; --line: #dfe3e8;
  --good: #2f7d4f; --bad: #b3423a; --bar: #3a6ea5; --soft: #fdecea; --box: #f4f6f9; }
@media (prefers-color-scheme: dark) { :root { --text: #e4e7eb; --dim: #98a2ad; --page: #16191d;
  --line: #343a41; --good: #58b07d; --bad: #dd7a70; --bar: #79a9dc; --soft: #3b1b1a;
  --box: #222a34; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); background: var(--page);
  max-width: 76rem; margin: 1.5rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin-top: 1.6rem; }
h3 { font-size: 1rem; margin: .9rem 0 .2rem; } h3 .dim { font-weight: 400; margin-left: .6rem; }
.again { display: flex; flex-wrap: wrap; gap: 0 1rem; }
table { border-collapse: collapse; } td, th { text-align: left; padding: .15rem 1rem .15rem 0;
  border-bottom: 1px solid var(--line); vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
code { font-size: .9em; overflow-wrap: anywhere; }
.dim, svg text { color: var(--dim); fill: var(--dim); }
.columns { display: grid; grid-template-columns: repeat(auto-fit, minmax(26rem, 1fr));
  gap: 0 3rem; }
.bars { display: grid; grid-template-columns: fit-content(50%) minmax(6rem, 1fr) auto;
  gap: .2rem .7rem; align-items: center; }
.bars .label { overflow-wrap: anywhere; text-align: right; }
.track { position: relative; height: 14px; background: var(--box); border-radius: 2px; }
.track i { position: absolute; top: 0; bottom: 0; left: 0; border-radius: 2px; }
.track .interval { top: 6px; bottom: 6px; background: var(--text); }
.bar { background: var(--bar); fill: var(--bar); } .good { background: var(--good); }
.bad { background: var(--bad); }
svg { display: block; max-width: 100%; height: auto; } svg text { font-size: 12px; }
.axis { stroke: var(--dim); fill: none; } .grid { stroke: var(--line); }
ol.way { list-style: none; display: flex; flex-wrap: wrap; align-items: center; gap: .3rem 1.5rem;
  padding: 0; margin: .3rem 0; }
ol.way li { position: relative; border: 1px solid var(--line); border-radius: 7px;
  background: var(--box); padding: .1rem .6rem; font-weight: 600; font-size: .9rem; }
ol.way li + li::before { content: "\\2192"; position: absolute; left: -1.25rem; top: 50%;
  translate: 0 -50%; color: var(--dim); }
ol.way small { display: block; font-weight: 400; color: var(--dim); }
ol.way li.failed { border-color: var(--bad); background: var(--soft); }
ol.way li.failed small, ol.way li.end { color: var(--bad); }
ol.way li.end { border-radius: 1rem; }
iframe { border: 1px solid var(--line); border-radius: 8px; width: 100%; height: 36rem; }
summary { cursor: pointer; }
tr.better td { color: var(--good); } tr.worse td { color: var(--bad); }
"""

MOST_SEEDS = 50
"""Limit on the seeds of a group of failures on the page."""

MOST_GROUPS = 5
"""Limit on the groups of failures that are shown without a click."""


def summary_html(summary: Summary, graph: str = "", differences: Sequence[Difference] = ()) -> str:
    """The page. `graph` is the page of the viewer with the coverage of the states, `differences`
    are those from an earlier sweep."""
    title = f"Sweep of {summary['machine']}"
    parts = [
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{_text(title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{_text(title)}</h1>",
        f"<p>{_text(_first_line(summary))}</p>",
    ]
    if summary["runs"]:
        parts += [
            _section("Compared with the earlier sweep", _differences(differences)),
            _section("Failures", _failures(summary)),
            f'<div class="columns">{_section("Outcomes", _outcomes(summary))}'
            f"{_section('Duration', _durations(summary))}"
            f"{_section('Varied values', ''.join(map(_varied, summary['varied'])))}"
            f"{_section('Faults', _faults(summary))}</div>",
            _section("Coverage", _coverage(summary, graph)),
            _section("States", _states(summary)),
        ]
    return "\n".join(filter(None, parts)) + "\n</body></html>\n"


def _section(name: str, body: str) -> str:
    return f"<section><h2>{name}</h2>\n{body}</section>" if body else ""


def _text(text: object) -> str:
    """A text of the user for HTML, without control characters."""
    return escape(visible(str(text)))


def _first_line(summary: Summary) -> str:
    runs, success = summary["runs"], summary["success"]
    last = summary["first_seed"] + summary["planned"] - 1
    line = f"{runs} of {summary['planned']} runs, seeds {summary['first_seed']} to {last}."
    if not runs or not success["outcomes"]:
        return line
    low, high = success["interval"]
    names = ", ".join(success["outcomes"])
    return (
        f"{line} {percent(success['share'])} ended with {names}"
        f" (95 % interval {percent(low)} to {percent(high)})."
    )


def _bars(rows: Sequence[str]) -> str:
    return f'<div class="bars">{"".join(rows)}</div>'


def _row(label: str, part: float, shown: str, kind: str, interval: Sequence[float] = ()) -> str:
    """A bar of a share of the width, with a line from one end of its interval to the other."""
    line = ""
    if interval:
        low, high = interval
        place = f"left:{100 * low:.2f}%;width:{100 * (high - low):.2f}%"
        line = f'<i class="interval" style="{place}"></i>'
    return (
        f'<span class="label">{_text(label)}</span>'
        f'<span class="track"><i class="{kind}" style="width:{100 * part:.2f}%"></i>{line}</span>'
        f'<span class="dim">{_text(shown)}</span>'
    )


def _outcomes(summary: Summary) -> str:
    good = summary["success"]["outcomes"]
    rows = []
    for outcome in summary["outcomes"]:
        name = "failed run" if outcome["outcome"] is None else outcome["outcome"]
        kind = "good" if name in good else "bad" if good or outcome["outcome"] is None else "bar"
        low, high = outcome["interval"]
        shown = (
            f"{percent(outcome['share'])} ({outcome['count']}), {percent(low)} to {percent(high)}"
        )
        rows.append(_row(name, outcome["share"], shown, kind, outcome["interval"]))
    return f'{_bars(rows)}<p class="dim">share of the runs (count), with its 95 % interval</p>'


WIDTH, HEIGHT, LEFT, TOP = 560, 150, 48, 10
"""The size of a histogram and its margins for the axes, in pixels."""

TICKS = 4
"""The number of parts into which ticks divide the time axis of a histogram."""


def _durations(summary: Summary) -> str:
    """A histogram of the durations: the number of runs by time."""
    times = summary["seconds"]
    bins = times["histogram"]
    if len(bins) < 2:
        return ""
    most = max(bin_["count"] for bin_ in bins)
    step = (WIDTH - LEFT) / len(bins)
    bars = "".join(
        f'<rect class="bar" x="{LEFT + step * k + 1:.1f}" width="{step - 2:.1f}"'
        f' y="{TOP + HEIGHT * (1 - bin_["count"] / most):.1f}"'
        f' height="{HEIGHT * bin_["count"] / most:.1f}">'
        f"<title>{_text(_range(bin_))} s: {bin_['count']} runs</title></rect>"
        for k, bin_ in enumerate(bins)
    )
    low, high = bins[0]["low"], bins[-1]["high"]
    bottom = TOP + HEIGHT
    ticks = "".join(
        f'<path class="axis" d="M{x:.1f} {bottom}v5"/><text x="{x:.1f}" y="{bottom + 18}"'
        f' text-anchor="{"end" if k == TICKS else "middle"}">'
        f"{_text(seconds(low + (high - low) * k / TICKS))}</text>"
        for k in range(TICKS + 1)
        for x in [LEFT + (WIDTH - LEFT) * k / TICKS]
    )
    levels = "".join(
        f'<path class="grid" d="M{LEFT} {y:.1f}H{WIDTH}"/>'
        f'<text x="{LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{count}</text>'
        for count in sorted({0, most // 2, most})
        for y in [bottom - HEIGHT * count / most]
    )
    return (
        f'<svg viewBox="0 0 {WIDTH} {bottom + 40}" width="{WIDTH}" role="img"'
        f' aria-label="Histogram of durations">{levels}{bars}'
        f'<path class="axis" d="M{LEFT} {TOP}V{bottom}H{WIDTH}"/>{ticks}'
        f'<text x="12" y="{TOP + HEIGHT / 2}" text-anchor="middle"'
        f' transform="rotate(-90 12 {TOP + HEIGHT / 2})">runs</text>'
        f'<text x="{(LEFT + WIDTH) / 2}" y="{bottom + 35}" text-anchor="middle">duration</text>'
        "</svg>"
        f"<p>mean {_text(seconds(times['mean']))}, median {_text(seconds(times['median']))},"
        f" longest {_text(seconds(times['longest']))}</p>"
    )


def _range(part: dict[str, Any]) -> str:
    return f"{part['low']:.4g} to {part['high']:.4g}"


def _varied(each: dict[str, Any]) -> str:
    """The share of successes by value, with intervals."""
    rows = []
    for part in each["parts"]:
        if part["runs"]:
            label = _range(part) if "low" in part else str(part["value"])
            shown = f"{percent(part['share'])} of {part['runs']}"
            rows.append(_row(label, part["share"], shown, "good", part["interval"]))
    return f"<p>Success by <code>{_text(each['name'])}</code></p>{_bars(rows)}"


def _states(summary: Summary) -> str:
    """The time of all runs by state, and a table."""
    leaves = [state for state in summary["states"] if state["leaf"] and state["seconds"] > 0]
    most = max((leaf["seconds"] for leaf in leaves), default=0.0)
    total = sum(leaf["seconds"] for leaf in leaves)
    plot = ""
    if most > 0:
        ordered = sorted(leaves, key=lambda leaf: -float(leaf["seconds"]))[:MOST_BARS]
        rows = [
            _row(item["path"].partition("/")[2] or item["path"], item["seconds"] / total,
                 f"{percent(item['seconds'] / total)}, mean {seconds(item['mean'])}", "bar")
            for item in ordered
        ]  # fmt: skip
        plot = f'{_bars(rows)}<p class="dim">share of the time of all runs</p>'
    body = "".join(
        f"<tr><td>{_text(state['path'])}</td><td class=n>{state['visits']}</td>"
        f"<td class=n>{_text(seconds(state['mean']))}</td>"
        f"<td class=n>{_text(seconds(state['longest']))}</td>"
        f"<td>{_text(_ends(state))}</td></tr>"
        for state in summary["states"]
    )
    head = "<th>state</th><th class=n>visits</th><th class=n>mean</th><th class=n>longest</th>"
    table = f"<table><tr>{head}<th>outcomes</th></tr>{body}</table>"
    return f"{plot}<details><summary>all states</summary>{table}</details>"


MOST_BARS = 8
"""The states in the plot of times."""


def _ends(state: dict[str, Any]) -> str:
    words = [f"{name} {count}" for name, count in state["outcomes"].items()]
    return ", ".join(filter(None, [*words, rounds_in_words(state["rounds"])]))


def _differences(differences: Sequence[Difference]) -> str:
    """A table of the differences; those that are no chance are marked."""
    if not differences:
        return ""
    rows = []
    for difference in differences:
        better = (difference.difference > 0) == (not difference.what)
        look = f' class="{"better" if better else "worse"}"' if difference.is_clear else ""
        rows.append(
            f"<tr{look}><td>{_text(difference.what or 'success')}</td>"
            f"<td class=n>{percent(difference.before)}</td>"
            f"<td class=n>{percent(difference.after)}</td>"
            f"<td class=n>{_text(points(difference.difference))}</td>"
            f"<td>{_text(points(difference.interval[0]))} to"
            f" {_text(points(difference.interval[1]))}</td></tr>"
        )
    head = "<th class=n>before</th><th class=n>now</th><th class=n>difference (points)</th>"
    return (
        f"<table><tr><th></th>{head}<th>95 % interval</th></tr>{''.join(rows)}</table>"
        '<p class="dim">shares of the runs, their differences in percentage points; in colour where'
        " the interval does not contain 0</p>"
    )


def _failures(summary: Summary) -> str:
    groups = [_failure(group) for group in summary["failures"]]
    rest = "".join(groups[MOST_GROUPS:])
    if rest:
        words = f"{len(groups) - MOST_GROUPS} more"
        rest = f"<details><summary>{words}</summary>{rest}</details>"
    return "".join(groups[:MOST_GROUPS]) + rest


def _failure(group: dict[str, Any]) -> str:
    seeds = ", ".join(map(str, group["seeds"][:MOST_SEEDS]))
    more = len(group["seeds"]) - MOST_SEEDS
    seeds += f" and {more} more" if more > 0 else ""
    return (
        f'<h3>{_text(first_text(group))} <span class="dim">{_text(count_text(group))}</span></h3>'
        f'{_way(group)}<div class="again"><code>{_text(group["replay"])}</code>'
        f'<details class="dim"><summary>seeds</summary>{seeds}</details></div>'
    )


def _way(group: dict[str, Any]) -> str:
    """The ends of states as boxes in a row: the first failure to the turning point is red."""
    items = []
    for place, step in enumerate(group["steps"]):
        name = step["path"].rpartition("/")[2]
        failed = group["first"] <= place <= group["turning"]
        look = ' class="failed"' if failed else ""
        outcome = step["outcome"] or EXCEPTION
        badge = f" ({step['badge']})" if step["badge"] else ""
        items.append(
            f'<li{look} title="{_text(step["path"])}">{_text(name)}'
            f"<small>{_text(outcome + badge)}</small></li>"
        )
    if group["left_out"]:
        items.append(f"<li>{group['left_out']} more</li>")
    items.append(f'<li class="end">{_text(end_text(group))}</li>')
    return f'<ol class="way" aria-label="The way to the failure">{"".join(items)}</ol>'


def _coverage(summary: Summary, graph: str) -> str:
    states, transitions = summary["coverage"]["states"], summary["coverage"]["transitions"]
    missing = [f"not visited: {path}" for path in states["missing"]]
    missing += [
        f"not taken: {item['path']}: {item['outcome']} \N{RIGHTWARDS ARROW} {item['to']}"
        f" ({item['src']})"
        for item in transitions["missing"]
    ]
    words = (
        f"<p>{states['visited']} of {states['total']} states visited, {transitions['taken']} of"
        f" {transitions['total']} transitions taken</p>"
    )
    if graph:
        words += f'<iframe title="State graph with coverage" srcdoc="{escape(graph)}"></iframe>'
    if not missing:
        return words
    items = "".join(f"<li>{_text(line)}</li>" for line in missing)
    return f"{words}<details><summary>what no run did</summary><ul>{items}</ul></details>"


def _faults(summary: Summary) -> str:
    rows = [f"<li>{_text(name)}: {count}</li>" for name, count in summary["faults"].items()]
    return f"<ul>{''.join(rows)}</ul>" if rows else ""
