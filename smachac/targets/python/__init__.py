"""Python: one module for SMACH, with or without ROS.

The containers and transitions come from the state graph (structure.py); functions.py plans which
containers are functions of the module, stop_requests.py has what SMACH lacks for requests to stop.
The classes of the states and the rest of the module come from templates, which users can replace or
extend (module.py, states.py). SMACHA's templates print states and containers themselves;
smacha_context.py has their variables.
"""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report
from smachac.frontend.loader import Library
from smachac.ir.nodes import Checked, Machine, StateType
from smachac.pysource.modules.ros_names import Ros
from smachac.pysource.modules.user_code import Declared
from smachac.targets import BuildContext, Files, OptionError, Target, stem
from smachac.targets.errors import unsupported_by_target
from smachac.targets.python import ros

OPTIONS = {
    "comments": "yes: print the comment blocks of templates (default: no)",
    "introspection": "yes: print the introspection server of ROS programs (default: no)",
    "action": "TYPE: offer the machine as an action of that type; ROS 2 only",
    "lifecycle": "true: a managed node (configure, activate, deactivate); ROS 2 only",
    "package": "true, or NAME: a package for colcon (ament_python); ROS 2 only",
    "standalone": "true: a program without smachac, with SMACH only (default: true for ROS 1)",
    "ros": "1 or 2: the version of ROS (default: that of the project file, else 2)",
}


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The module of a machine: `<name>.py`, see `_program_name`."""
    from smachac.targets.python.module import module_text
    from smachac.targets.python.package import package_files
    from smachac.targets.python.parameters import RESERVED, fixed_uses, ros_parameters

    for name in ("comments", "introspection"):
        value = context.options.get(name, "no")
        if value not in ("yes", "no"):
            raise OptionError(f"`{name}` must be `yes` or `no`, not `{value}`")
    version = ros.version(context)
    _check_lifecycle(machine, context, version)
    package = _package(machine, context, version)
    if _moves_another_arm(machine, report):
        return {}
    found = [*ros.unsupported(machine, version)]
    report.extend(found)
    text = None if found else module_text(machine, context, report)
    if text is None:
        return {}
    if not ros.is_node(machine, context.library, version):
        return {f"{_program_name(machine)}.py": text}
    parameters = ros_parameters(machine, RESERVED)
    report.extend(fixed_uses(parameters))
    if package:
        return package_files(machine, package, text, parameters.declared)
    return {f"{_program_name(machine)}.py": text}


def _program_name(machine: Machine) -> str:
    """The name of the program's module: that of the machine, unless a module of the user that the
    program imports has it. Python would import the program in place of that module."""
    codes = (type_.code.get("python", "") for type_ in machine.state_types.values())
    modules = {code.partition(":")[0].partition(".")[0] for code in codes if ":" in code}
    name = stem(machine)
    while name in modules:
        name += "_program"
    return name


def _check_lifecycle(machine: Machine, context: BuildContext, version: Ros) -> None:
    """Raises OptionError if the option `lifecycle` is wrong or fits neither script nor options."""
    value = context.options.get("lifecycle", "false")
    if value not in ("true", "false"):
        raise OptionError(f"`lifecycle` must be `true` or `false`, not `{value}`")
    if value == "false":
        return
    if not ros.is_node(machine, context.library, version):
        raise OptionError("`lifecycle` needs a node of ROS 2: a script with the base `ROSBase`")
    for other in ("action", "introspection"):
        if context.options.get(other, "no") != "no":
            raise OptionError(f"`lifecycle` and `{other}` exclude each other: choose one")


def _package(machine: Machine, context: BuildContext, version: Ros) -> str:
    """The name of the package of the options; empty if there is none. Raises OptionError."""
    value = context.options.get("package", "false")
    if value == "false":
        return ""
    if not ros.is_node(machine, context.library, version):
        raise OptionError("`package` needs a node of ROS 2: a script with the base `ROSBase`")
    from smachac.targets.python.package import package_name

    return package_name(value, machine)


def _moves_another_arm(machine: Checked, report: Report) -> bool:
    """Whether the script names a robot that the simulation cannot move, which is reported."""
    robot = machine.robot
    if robot is None or robot.description:
        return False
    if not any(type_.simulation for type_ in machine.state_types.values()):
        return False
    message = f"the robot `{robot.name}` has no description of its arms: it cannot be"
    help = "describe its arms in a YAML file, and name that file: `robot: arm.yml`"
    report.append(
        unsupported_by_target(robot.span, "Python", f"{message} simulated", help, (robot.name,))
    )
    return True


def has_code(type_: StateType, library: Library) -> bool:
    """Whether a module can contain states of a type: there is a class of the user or a template."""
    code = type_.code.get("python", f"{type_.name}.tpl.py")
    in_language = type_.kind == "container" and "python" not in type_.code
    return in_language or ":" in code or library.template(code) is not None


def declared(type_: StateType, library: Library) -> Declared | None:
    """The interface that the class of a state type declares; None where nothing is known."""
    if type_.class_facts is None:
        return None
    from smachac.targets.python import declared_interface

    return declared_interface.declared(type_, type_.class_facts, library)


TARGET = Target(
    name="python",
    description="a Python module for SMACH, with or without ROS",
    emit=emit,
    options=OPTIONS,
    has_code=has_code,
    declared=declared,
)
