"""HTML: a page with the picture of a machine, which a browser shows without a server or network."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Checked
from smachac.targets import GENERATED, BuildContext, Files, Target, stem, view_of
from smachac.targets.html.model import machine_model
from smachac.targets.html.page import TRACE_ID, render_page
from smachac.targets.html.trace import read_trace


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One page, named after the machine. Raises OptionError if `trace` is not one of it, or for an
    invalid value of `generated`."""
    text = context.options.get("trace")
    data = None if text is None else {TRACE_ID: read_trace(machine, text)}
    view = view_of(machine, context.options)
    page = render_page(machine, machine_model(machine, context.findings, view=view), data)
    return {f"{stem(machine)}.html": page}


TARGET = Target(
    name="html",
    description="a picture to explore in a browser: one file, no network",
    emit=emit,
    is_picture=True,
    options={
        "trace": "a trace of a run: the page replays it (a file of `run --trace`)",
        "generated": GENERATED,
    },
    file_options=frozenset({"trace"}),
)
