"""The summary of a sweep as one HTML page with plots, without other files, for light and dark."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

from smachac.report.terminal import visible
from smachac.sweep.summary import Summary
from smachac.sweep.text import how_often
from smachac.verify.statistics_report import percent, seconds

STYLE = """
:root { color-scheme: light dark; --text: #1d2126; --dim: #67707b; --page: #fff; --line: #dfe3e8;
  --good: #2f7d4f; --bad: #b3423a; --bar: #3a6ea5; }
@media (prefers-color-scheme: dark) { :root { --text: #e4e7eb; --dim: #98a2ad; --page: #16191d;
  --line: #343a41; --good: #58b07d; --bad: #dd7a70; --bar: #79a9dc; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--text); background: var(--page);
  max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
table { border-collapse: collapse; } td, th { text-align: left; padding: .15rem 1rem .15rem 0;
  border-bottom: 1px solid var(--line); vertical-align: top; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; }
code { font-size: .9em; overflow-wrap: anywhere; }
.dim, svg text.dim { color: var(--dim); fill: var(--dim); }
svg { display: block; max-width: 100%; height: auto; }
svg text { fill: var(--text); font-size: 13px; }
.bar { fill: var(--bar); } .good { fill: var(--good); } .bad { fill: var(--bad); }
.line { stroke: var(--text); stroke-width: 1.5; } .axis { stroke: var(--line); }
"""

LABELS, BARS, ROW = 260, 420, 24
"""The widths of labels and bars in a plot, and the height of a row, in pixels."""

MOST_SEEDS = 50
"""Limit on the seeds of a group of failures on the page."""


def summary_html(summary: Summary) -> str:
    """The page."""
    title = f"Sweep of {summary['machine']}"
    parts = [
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">',
        '<meta name="viewport" content="width=device-width, initial-scale=1">',
        f"<title>{_text(title)}</title><style>{STYLE}</style></head><body>",
        f"<h1>{_text(title)}</h1>",
        f"<p>{_text(_first_line(summary))}</p>",
    ]
    if summary["runs"]:
        for name, body in (
            ("Outcomes", _outcomes(summary)),
            ("Duration", _durations(summary)),
            ("Varied values", "".join(map(_varied, summary["varied"]))),
            ("Failures", _failures(summary)),
            ("States", _states(summary)),
            ("Coverage", _coverage(summary)),
            ("Faults", _faults(summary)),
        ):
            if body:
                parts.append(f"<h2>{name}</h2>\n{body}")
    return "\n".join(parts) + "\n</body></html>\n"


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


def _svg(rows: Sequence[str], width: int = LABELS + BARS + 160) -> str:
    height = ROW * len(rows) + 4
    body = "".join(
        f'<g transform="translate(0,{ROW * number})">{row}</g>' for number, row in enumerate(rows)
    )
    return f'<svg viewBox="0 0 {width} {height}" width="{width}" role="img">{body}</svg>'


def _row(label: str, part: float, shown: str, kind: str, interval: Sequence[float] = ()) -> str:
    """A bar of a share of the width, with a line from one end of its interval to the other."""
    row = (
        f'<text x="{LABELS - 8}" y="16" text-anchor="end">{_text(_shortened(label))}</text>'
        f'<rect class="{kind}" x="{LABELS}" y="5" width="{BARS * part:.1f}" height="14" rx="2"/>'
    )
    if interval:
        low, high = (LABELS + BARS * each for each in interval)
        row += (
            f'<path class="line" fill="none" d="M{low:.1f} 8v8M{low:.1f} 12H{high:.1f}'
            f'M{high:.1f} 8v8"/>'
        )
    end = LABELS + BARS * max(part, *interval) + 8 if interval else LABELS + BARS * part + 8
    return row + f'<text class="dim" x="{end:.1f}" y="16">{_text(shown)}</text>'


def _shortened(label: str) -> str:
    """The end of a label that is too long for a plot."""
    most = 36
    return label if len(label) <= most else f"\N{HORIZONTAL ELLIPSIS}{label[-most:]}"


def _outcomes(summary: Summary) -> str:
    good = summary["success"]["outcomes"]
    rows = []
    for each in summary["outcomes"]:
        name = "failed run" if each["outcome"] is None else each["outcome"]
        kind = "good" if name in good else "bad" if good or each["outcome"] is None else "bar"
        shown = f"{percent(each['share'])} ({each['count']})"
        rows.append(_row(name, each["share"], shown, kind, each["interval"]))
    return _svg(rows)


def _durations(summary: Summary) -> str:
    times = summary["seconds"]
    bins = times["histogram"]
    if len(bins) < 2:
        return ""
    most = max(each["count"] for each in bins)
    width, height = 640, 120
    step = width / len(bins)
    bars = "".join(
        f'<rect class="bar" x="{step * k + 1:.1f}" width="{step - 2:.1f}"'
        f' y="{height * (1 - each["count"] / most) + 5:.1f}"'
        f' height="{height * each["count"] / most:.1f}">'
        f"<title>{_text(_range(each))}: {each['count']} runs</title></rect>"
        for k, each in enumerate(bins)
    )
    return (
        f'<svg viewBox="0 0 {width} {height + 30}" width="{width}" role="img">{bars}'
        f'<path class="axis" d="M0 {height + 5}H{width}"/>'
        f'<text class="dim" x="0" y="{height + 22}">{_text(seconds(bins[0]["low"]))}</text>'
        f'<text class="dim" x="{width}" y="{height + 22}" text-anchor="end">'
        f"{_text(seconds(bins[-1]['high']))}</text></svg>"
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
    return f"<p>Success by <code>{_text(each['name'])}</code></p>{_svg(rows)}"


def _states(summary: Summary) -> str:
    """The time of all runs by state, and a table."""
    leaves = [each for each in summary["states"] if each["leaf"] and each["seconds"] > 0]
    most = max((each["seconds"] for each in leaves), default=0.0)
    total = sum(each["seconds"] for each in leaves)
    plot = ""
    if most > 0:
        ordered = sorted(leaves, key=lambda each: -float(each["seconds"]))[:20]
        rows = [
            _row(each["path"].partition("/")[2] or each["path"], each["seconds"] / most,
                 f"{percent(each['seconds'] / total)}, mean {seconds(each['mean'])}", "bar")
            for each in ordered
        ]  # fmt: skip
        plot = f"<p>Time by state</p>{_svg(rows)}"
    body = "".join(
        f"<tr><td>{_text(each['path'])}</td><td class=n>{each['visits']}</td>"
        f"<td class=n>{_text(seconds(each['mean']))}</td>"
        f"<td class=n>{_text(seconds(each['longest']))}</td>"
        f"<td>{_text(', '.join(f'{name} {n}' for name, n in each['outcomes'].items()))}</td></tr>"
        for each in summary["states"]
    )
    head = "<th>state</th><th class=n>visits</th><th class=n>mean</th><th class=n>longest</th>"
    return f"{plot}<table><tr>{head}<th>outcomes</th></tr>{body}</table>"


def _failures(summary: Summary) -> str:
    return "".join(_failure(group) for group in summary["failures"])


def _failure(group: dict[str, Any]) -> str:
    what = group["error"] if group["outcome"] is None else group["outcome"]
    end = "".join(
        f"<li>{_text(each['path'])}: {_text(each['outcome'])}</li>" for each in group["end"]
    )
    seeds = ", ".join(map(str, group["seeds"][:MOST_SEEDS]))
    more = len(group["seeds"]) - MOST_SEEDS
    seeds += f" and {more} more" if more > 0 else ""
    return (
        f"<p><b>{how_often(group['count'])} {_text(what)}</b> after</p><ol>{end}</ol>"
        f'<p class="dim">seeds {seeds}<br><code>{_text(group["replay"])}</code></p>'
    )


def _coverage(summary: Summary) -> str:
    states, transitions = summary["coverage"]["states"], summary["coverage"]["transitions"]
    missing = [f"not visited: {path}" for path in states["missing"]]
    missing += [
        f"not taken: {each['path']}: {each['outcome']} \N{RIGHTWARDS ARROW} {each['to']}"
        f" ({each['src']})"
        for each in transitions["missing"]
    ]
    return (
        f"<p>{states['visited']} of {states['total']} states visited, {transitions['taken']} of"
        f" {transitions['total']} transitions taken</p>"
        f"<ul>{''.join(f'<li>{_text(line)}</li>' for line in missing)}</ul>"
    )


def _faults(summary: Summary) -> str:
    rows = [f"<li>{_text(name)}: {count}</li>" for name, count in summary["faults"].items()]
    return f"<ul>{''.join(rows)}</ul>" if rows else ""
