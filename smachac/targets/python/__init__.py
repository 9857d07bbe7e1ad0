"""Python: one module that a SMACH user would have written by hand.

The structure is printed from the IR (body.py, layout.py, containers.py); the classes of the states
and the frame of the module come from templates, which users may replace or add to (module.py).
Templates of SMACHA's kind print states, containers and the frame themselves (smacha.py).
"""

from __future__ import annotations

from smachac.diagnostics import Report
from smachac.ir.nodes import Checked
from smachac.targets import Context, Files, OptionError, Target, stem
from smachac.targets.python.declared import declared

OPTIONS = {
    "comments": "yes: print the comment blocks of templates (default: no)",
    "introspection": "yes: print the introspection server of ROS programs (default: no)",
}


def emit(machine: Checked, context: Context, report: Report) -> Files:
    """The module of a machine: `<name>.py`."""
    from smachac.targets.python.module import module_text

    for name, value in context.options.items():
        if value not in ("yes", "no"):
            raise OptionError(f"{name}: `yes` or `no`, not `{value}`")
    text = module_text(machine, context, report)
    return {} if text is None else {f"{stem(machine)}.py": text}


TARGET = Target(
    name="python",
    description="a Python module for SMACH, with or without ROS",
    emit=emit,
    options=OPTIONS,
    declared=declared,
)
