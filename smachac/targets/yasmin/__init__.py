"""YASMIN: a Python module that builds the machine of YASMIN around the states of the SMACH program.

The Python target prints the program with the classes of the states; `<name>_yasmin.py` builds the
containers over `runtime/yasmin/smachac_yasmin.py`. structure.py prints them.
"""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report, has_errors, in_order
from smachac.ir.nodes import Checked
from smachac.targets import BuildContext, Files, Target, made_by, stem
from smachac.targets.python import TARGET as PYTHON
from smachac.targets.python.formatter import WIDTH, docstring_lines, string
from smachac.targets.yasmin.structure import CLASSES, built, refused

RUNTIME = "smachac_yasmin.py"


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The module for YASMIN, and the program with the classes of the states."""
    found: Report = [*refused(machine)]
    files = PYTHON.emit(machine, context, found)
    report.extend(in_order(found))
    if has_errors(found):
        return {}
    (program,) = files
    module = program.removesuffix(".py")
    return {f"{stem(machine)}_yasmin.py": module_text(machine, module), **files}


def module_text(machine: Checked, program: str) -> str:
    """The text of the module; `program` is the name of that with the states."""
    body = "\n".join(f"    {line}".rstrip() for line in built(machine))
    used = {name for name in CLASSES if f"{name}(" in body}
    names = ", ".join(sorted({*used, "Machine", "Parts", "Run", "Skill", "main"}))
    doc = docstring_lines(machine.root.doc or f"The state machine `{machine.root.name}`.", WIDTH)
    return f"""\
#!/usr/bin/env python3
# {made_by(machine)}
{doc}

import {program}
from smachac_yasmin import {names}

smach_machine = {program}.build


def build(parts):
    \"""Build the machine of YASMIN around the states of the SMACH program.\"""
{body}


def run(*arguments, **values):
    \"""The machine with its blackboard; the arguments are those of `{program}.build`.\"""
    parts = Parts(smach_machine(*arguments, **values), {string(machine.root.name)})
    return Run(build(parts))


if __name__ == "__main__":
    raise SystemExit(main({program}, run))
"""


TARGET = Target(
    name="yasmin",
    description="a Python module for YASMIN 6.1 on ROS 2",
    emit=emit,
    runtime=lambda machine, context: {RUNTIME: f"yasmin/{RUNTIME}"},
    has_code=PYTHON.has_code,
    declared=PYTHON.declared,
    options={},
    lacks=("machines and states without outcomes",),
)
