"""Notebooks: a machine as a picture and findings as a table, with IPython's rich display."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from html import escape

from smachac.diagnostics.diagnostic import Diagnostic
from smachac.ir.nodes import Container, Machine
from smachac.ir.written import written
from smachac.report.terminal import visible
from smachac.report.text import render_text, summary

COLUMNS = ("severity", "code", "place", "message", "effect", "help")

MOST_SECONDS = 20
"""Limit on the time of Graphviz; a machine of 1,000 states takes about a tenth of it."""


class Findings(list[Diagnostic]):
    """All findings in a script, in order; a notebook shows them as a table."""

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in COLUMNS)
        rows = "".join(f"<tr>{''.join(_cells(item))}</tr>" for item in self)
        table = (
            f"<table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>" if self else ""
        )
        return f"{table}<p>{escape(summary(self))}</p>"

    def _repr_pretty_(self, printer: object, cycle: bool) -> None:
        printer.text(f"{render_text(self)}{summary(self)}")  # type: ignore[attr-defined]


def _cells(item: Diagnostic) -> Iterator[str]:
    place, help = str(item.span), item.help or ""
    texts = (item.severity.value, item.code, place, item.message, item.effect, help)
    for text in texts:
        shown = escape(visible(text)).replace("\n", "<br>")
        yield f'<td style="text-align: left">{shown}</td>'


def show_machines() -> None:
    """Make IPython, if this process is one of its shells, show machines with `bundle`."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    if shell is not None:
        shell.display_formatter.mimebundle_formatter.for_type(Machine, bundle)


def bundle(machine: Machine, include: object = None, exclude: object = None) -> dict[str, str]:
    """A machine by MIME type: its picture, or without Graphviz a table of its states."""
    svg = _svg(machine)
    shown = {"image/svg+xml": svg} if svg else {"text/markdown": _table(machine)}
    outcomes = ", ".join(outcome.name for outcome in machine.root.outcomes)
    return {"text/plain": f"machine {machine.root.name} with the outcomes {outcomes}", **shown}


def _svg(machine: Machine) -> str:
    """The picture of a machine; empty where Graphviz is not installed or does not end in time."""
    import shutil
    import subprocess

    from smachac.targets.dot.graph import picture

    program = shutil.which("dot")
    if program is None:
        return ""
    view = written(machine)
    text = "\n".join(picture(machine, view, depth=view.fitting_depth()))
    try:
        done = subprocess.run(
            [program, "-Tsvg"],
            input=text.encode(),
            capture_output=True,
            timeout=MOST_SECONDS,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    svg = done.stdout.decode()
    return svg[svg.index("<svg") :]


def _table(machine: Machine) -> str:
    """The states with their types and transitions, in Markdown."""
    lines = ["| state | type | transitions |", "| --- | --- | --- |"]
    for path, state in written(machine).states.items():
        node = state.node
        kind = type(node).__name__ if isinstance(node, Container) else node.type
        kind = ", ".join([kind, *(badge.text for badge in state.badges)])
        edges = ", ".join(f"{edge.outcome} → {edge.target}" for edge in state.outer.transitions)
        cells = (escape(visible(text)).replace("|", "&#124;") for text in (path, kind, edges))
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
