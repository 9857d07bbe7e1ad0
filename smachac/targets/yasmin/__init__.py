"""YASMIN: a Python module that builds the machine of YASMIN around the states of the SMACH program.

The Python target prints the program with the classes of the states, those of YASMIN too;
`<name>_yasmin.py` builds the containers over `runtime/yasmin/smachac_yasmin.py`. structure.py
prints them, package.py the files of a package of ROS 2.
"""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report, has_errors, in_order
from smachac.ir.nodes import Checked
from smachac.records import replace
from smachac.targets import BuildContext, Files, Target, made_by, stem
from smachac.targets.errors import hiding_file, unsupported_by_target
from smachac.targets.native import WRAPPER, as_python, native_types
from smachac.targets.python import TARGET as PYTHON
from smachac.targets.python.formatter import WIDTH, docstring_lines, string
from smachac.targets.python.package import package_name
from smachac.targets.yasmin.package import package_files
from smachac.targets.yasmin.structure import CLASSES, built, refused

RUNTIME = "smachac_yasmin.py"

HIDDEN = ("yasmin.py", RUNTIME)
"""The files that the module imports by these names: no program has one of them."""


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The module for YASMIN, and the program with the classes of the states.

    Raises OptionError for an invalid value of an option.
    """
    package = _package(machine, context)
    options = {name: value for name, value in context.options.items() if name != "package"}
    options["standalone"] = "true"
    found: Report = [*refused(machine)]
    native = native_types(machine, "yasmin")
    inside = replace(context, options=options, wrappers=dict.fromkeys(native, WRAPPER))
    files = PYTHON.emit(as_python(machine, native), inside, found)
    report.extend(in_order(found))
    if has_errors(found):
        return {}
    ((program, text),) = files.items()
    if "\ndef build(" not in text:
        message = "a program whose templates add code around its run has no function `build`"
        report.append(unsupported_by_target(machine.root.span, "YASMIN", message))
        return {}
    if program in HIDDEN and not package:
        hidden = program.removesuffix(".py")
        report.append(hiding_file(machine.root.span, program, hidden, stem(machine)))
        return {}
    module = module_text(machine, program.removesuffix(".py"), package)
    modules = {f"{stem(machine)}_yasmin.py": module, **files}
    return package_files(machine, package, modules, text) if package else modules


def _package(machine: Checked, context: BuildContext) -> str:
    value = context.options.get("package", "false")
    return "" if value == "false" else package_name(value, machine)


def module_text(machine: Checked, program: str, package: str = "") -> str:
    """The text of the module; `program` is the name of that with the states."""
    body = "\n".join(f"    {line}".rstrip() for line in built(machine))
    used = {name for name in CLASSES if f"{name}(" in body}
    names = ", ".join(sorted({*used, "Machine", "Program", "Skill"}))
    doc = docstring_lines(machine.root.doc or f"The state machine `{machine.root.name}`.", WIDTH)
    imported = f"from {package} import {program}" if package else f"import {program}"
    imported += " as smach_program"
    runtime = f"{package}.smachac_yasmin" if package else "smachac_yasmin"
    return f"""\
#!/usr/bin/env python3
# {made_by(machine)}
{doc}

{imported}
from {runtime} import {names}


def build(parts):
    \"""Build the machine of YASMIN around the states of the SMACH program.\"""
{body}


program = Program(smach_program, {string(machine.root.name)}, build)
run, start = program.run, program.start

if __name__ == "__main__":
    raise SystemExit(start())
"""


def _runtime(machine: Checked, context: BuildContext) -> dict[str, str]:
    package = _package(machine, context)
    return {f"{package}/{RUNTIME}" if package else RUNTIME: f"yasmin/{RUNTIME}"}


TARGET = Target(
    name="yasmin",
    description="a Python module for YASMIN 6.1",
    emit=emit,
    runtime=_runtime,
    options={"package": "true, or NAME: a package for colcon (ament_python)"},
    lacks=(
        "states and machines without outcomes, machines without states",
        "items of an Iterator whose code uses modules or names of the program",
        "templates that add code around the run of the program, as SMACHA's do",
    ),
)
