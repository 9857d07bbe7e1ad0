"""Python: one module that a SMACH user would have written by hand.

The structure is printed from the IR (body.py, layout.py) and laid out by the templates State,
StateMachine, ...; the classes of the states and the frame of the module come from templates too,
which users may replace or add to (module.py).
"""

from __future__ import annotations

from smachac.diagnostics import Report
from smachac.ir.nodes import Checked
from smachac.targets import Context, Files, Target, stem
from smachac.targets.blocks import BlockError
from smachac.targets.python.module import module_text


def emit(machine: Checked, context: Context, report: Report) -> Files:
    """The module of a machine: `<name>.py`."""
    try:
        return {f"{stem(machine)}.py": module_text(machine, context)}
    except BlockError as error:
        report.append(error.diagnostic)
        return {}


TARGET = Target(
    name="python",
    description="a Python module for SMACH, with or without ROS",
    emit=emit,
)
