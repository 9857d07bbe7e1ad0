"""HTML: a page with the picture of a machine, which a browser shows without a server or network."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Checked
from smachac.targets import BuildContext, Files, Target, stem
from smachac.targets.html.model import machine_model
from smachac.targets.html.page import render_page


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One page, named after the machine."""
    page = render_page(machine, machine_model(machine, context.findings))
    return {f"{stem(machine)}.html": page}


TARGET = Target(
    name="html",
    description="a picture to explore in a browser: one file, no network",
    emit=emit,
)
