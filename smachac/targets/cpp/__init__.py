"""C++: one header of C++17 over the headers of smachac, as typed as the script is.

The containers become functions with a switch over their states (containers.py), their userdata
structs (header.py); what C++ cannot say is refused at its place in the script (plan.py). Options
add what builds and runs the header (project.py).
"""

from __future__ import annotations

from smachac.diagnostics import Report, in_order
from smachac.ir.nodes import Checked
from smachac.targets import Context, Files, Target, stem
from smachac.targets.cpp.declared import declared
from smachac.targets.cpp.header import header_of
from smachac.targets.cpp.plan import plan
from smachac.targets.cpp.project import OPTIONS, project, project_files, runtime


def emit(machine: Checked, context: Context, report: Report) -> Files:
    """The header of a machine, `<name>.hpp`, and what options add."""
    wanted = project(context.options)
    planned = plan(machine)
    header = header_of(planned, context.library)
    report.extend(in_order(planned.report))
    if planned.report:
        return {}
    files = {wanted.path(f"{stem(machine)}.hpp"): header.text}
    return files | project_files(machine, wanted, header)


TARGET = Target(
    name="cpp",
    description="a C++17 header, with typed userdata",
    emit=emit,
    options=OPTIONS,
    runtime=runtime,
    declared=declared,
)
