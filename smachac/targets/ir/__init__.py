"""IR: the complete state graph as text."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.ir.nodes import Checked
from smachac.targets import BuildContext, Files, Target, made_by, stem


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """One text in the notation of grammars/ir.lark, named after the machine."""
    from smachac.analysis.type_inference import infer
    from smachac.ir.printer import print_machine

    text = print_machine(machine, infer(machine))
    return {f"{stem(machine)}.smir": f"# {made_by(machine)}\n{text}"}


TARGET = Target(name="ir", description="the state graph as text", emit=emit)
