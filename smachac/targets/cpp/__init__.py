"""C++: one header of C++17 over the headers of smachac, as typed as the script is.

The containers become functions with a switch over their states (containers.py), their userdata
structs (header.py); what C++ cannot say is refused at its place in the script (plan.py). Options
add what builds and runs the header (project.py).
"""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report, in_order
from smachac.frontend.loader import Library
from smachac.frontend.state_types import StateType
from smachac.ir.nodes import Checked
from smachac.targets import BuildContext, Files, Target, stem
from smachac.targets.cpp.builtin_states import is_built_in
from smachac.targets.cpp.class_reader import declared
from smachac.targets.cpp.header import header_of
from smachac.targets.cpp.plan import plan
from smachac.targets.cpp.project import OPTIONS, project, project_files, runtime
from smachac.targets.cpp.user_classes import class_code, left_to_scripts


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The header of a machine, `<name>.hpp`, and what options add."""
    wanted = project(context.options)
    planned = plan(machine)
    header = header_of(planned, context.library)
    report.extend(in_order(planned.report))
    if planned.report:
        return {}
    files = {wanted.path(f"{stem(machine)}.hpp"): header.text}
    return files | project_files(machine, wanted, header)


def has_code(type_: StateType, _: Library) -> bool:
    """Whether a header can have states of a type; containers are printed whatever they hold."""
    if type_.kind != "state":
        return type_.kind == "container"
    if is_built_in(type_.name):
        return True
    return class_code(type_) is not None and not left_to_scripts(type_)


TARGET = Target(
    name="cpp",
    description="a C++17 header, with typed userdata",
    emit=emit,
    options=OPTIONS,
    runtime=runtime,
    has_code=has_code,
    declared=declared,
)
