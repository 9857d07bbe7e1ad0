"""C++: one header of C++17 over the headers of smachac, as typed as the script is.

The containers become functions with a switch over their states (containers.py), their userdata
structs (header.py); what C++ cannot say is refused at its place in the script (plan.py).
"""

from __future__ import annotations

from smachac.diagnostics import Report, in_order
from smachac.ir.nodes import Checked
from smachac.targets import Context, Files, Target, stem
from smachac.targets.cpp.header import header_text
from smachac.targets.cpp.plan import plan


def emit(machine: Checked, context: Context, report: Report) -> Files:
    """The header of a machine: `<name>.hpp`."""
    planned = plan(machine)
    text = header_text(planned, context.library)
    report.extend(in_order(planned.report))
    return {} if planned.report else {f"{stem(machine)}.hpp": text}


TARGET = Target(
    name="cpp",
    description="a C++17 header, with typed userdata",
    emit=emit,
    runtime="cpp",
)
