"""C++: one C++17 header for a machine, with typed userdata, over the headers in runtime/cpp.

plan.py resolves the types of all keys and refuses what C++ cannot express, at its place in the
script. header.py makes the header: each container is a namespace with its outcomes, its userdata,
its states and the function that runs it (containers.py), or makes one step of it
(step_containers.py). Leaves are structs made from the script
(builtin_states.py) or classes of the user (user_classes.py). robot_header.py makes the header of
the robot. project.py makes the files of the options.
"""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report, in_order
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, StateType
from smachac.targets import BuildContext, Files, Target, stem
from smachac.targets.cpp.builtin_states import is_built_in
from smachac.targets.cpp.declared_interface import declared
from smachac.targets.cpp.header import header_of
from smachac.targets.cpp.identifiers import member_identifier
from smachac.targets.cpp.plan import Plan, plan
from smachac.targets.cpp.project import OPTIONS, Project, project, project_files, runtime
from smachac.targets.cpp.records import project_header, record_names, same_members
from smachac.targets.cpp.robot_header import robot_file, robot_header
from smachac.targets.cpp.step_classes import refuse_other_methods
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import class_code, left_to_scripts
from smachac.version import __version__


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The header of a machine, `<name>.hpp`, that of its robot, and the files of the options."""
    wanted = project(context.options, context.library.bounds)
    names = record_names(machine, context.library, stepped=wanted.bounds is not None)
    planned = plan(machine, wanted.bounds, names)
    for name, one, other in same_members(planned.names):
        text = f"the fields `{one}` and `{other}` of `{name}` would both be named"
        text += f" `{member_identifier(one)}`"
        planned.refuse(machine.root.span, UnportableError(text), name, one, other)
    refuse_other_methods(planned, context.library)
    header = header_of(planned)
    robot = _robot_files(planned, wanted)
    report.extend(in_order(planned.report))
    if planned.report:
        return {}
    files = {wanted.path(f"{stem(machine)}.hpp"): header.text}
    if planned.names.project:
        made = f"Made by smachac {__version__} from the types of smachac.toml: do not edit."
        text = project_header(planned.names, wanted.bounds, made)
        files[wanted.path(planned.names.header)] = text
    return files | robot | project_files(machine, wanted, header)


def _robot_files(plan: Plan, wanted: Project) -> Files:
    """The header of the robot, if its arms are described."""
    robot = plan.machine.robot
    if robot is None or not robot.arms:
        return {}
    try:
        return {wanted.path(robot_file(robot)): robot_header(robot)}
    except UnportableError as error:
        plan.refuse(robot.span, error)
        return {}


def has_code(type_: StateType, _: Library) -> bool:
    """Whether a header can contain states of a type; it can contain every container."""
    if type_.kind != "state":
        return type_.kind == "container"
    if is_built_in(type_):
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
