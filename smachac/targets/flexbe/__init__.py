"""FlexBE: a behavior, its manifest and its states, in two packages of ROS 2.

The Python target prints the SMACH program with the classes of the states. behavior.py prints the
behavior over `runtime/flexbe/smachac_flexbe.py`, states.py the classes that make states of FlexBE
of them, package.py the other files of the packages, and names.py has the names that FlexBE refuses.
"""

from __future__ import annotations

import re

from smachac.diagnostics.diagnostic import Report, has_errors, in_order
from smachac.ir.nodes import Checked, Machine
from smachac.records import replace
from smachac.targets import BuildContext, Files, Target, stem
from smachac.targets.errors import unsupported_by_target
from smachac.targets.flexbe.behavior import Behavior, behavior_text
from smachac.targets.flexbe.names import names_of, refused
from smachac.targets.flexbe.package import behavior_package, manifest, state_package
from smachac.targets.flexbe.states import state_classes, state_text
from smachac.targets.native import WRAPPER, as_python, native_types
from smachac.targets.python import TARGET as PYTHON
from smachac.targets.python import ros
from smachac.targets.python.package import package_name
from smachac.targets.python.parameters import RESERVED, RosParameters, ros_parameters

RUNTIME = "smachac_flexbe.py"


def emit(machine: Checked, context: BuildContext, report: Report) -> Files:
    """The files of both packages, the behavior first.

    Raises OptionError for an invalid value of an option.
    """
    package = _package(machine, context)
    options = {name: value for name, value in context.options.items() if name != "package"}
    options["standalone"] = "true"
    found: Report = [*refused(machine)]
    native = native_types(machine, "flexbe")
    inside = replace(context, options=options, wrappers=dict.fromkeys(native, WRAPPER))
    files = PYTHON.emit(as_python(machine, native), inside, found)
    report.extend(in_order(found))
    if has_errors(found):
        return {}
    ((_, program),) = files.items()
    if "\ndef build(" not in program:
        message = "a program whose templates add code around its run has no function `build`"
        report.append(unsupported_by_target(machine.root.span, "FlexBE", message))
        return {}
    is_node = ros.is_node(machine, context.library, ros.version(context))
    parameters = ros_parameters(machine, RESERVED) if is_node else RosParameters()
    classes = state_classes(machine)
    behavior = Behavior(
        states=f"{package}_flexbe_states",
        program=f"{stem(machine)}_smach",
        is_node=is_node,
        parameters=parameters.declared,
        settable=frozenset(parameters.uses),
        classes=classes,
        names=names_of(machine),
    )
    behaviors = f"{package}_flexbe_behaviors"
    modules = {
        f"{behavior.program}.py": program,
        **{
            f"{known.module}.py": state_text(machine, known, behavior.states)
            for known in dict.fromkeys(classes.values())
        },
    }
    return {
        **behavior_package(
            machine,
            behaviors,
            behavior.states,
            behavior_text(machine, behavior),
            manifest(machine, behaviors, behavior),
        ),
        **state_package(machine, behavior.states, modules, program),
    }


def _package(machine: Machine, context: BuildContext) -> str:
    """The beginning of the names of both packages. Raises OptionError."""
    value = context.options.get("package", "true")
    if value != "true":
        return package_name(value, machine)
    word = re.sub(r"[^a-z0-9_]", "_", stem(machine).lower())
    return word.lstrip("_0123456789") or "machine"


def _runtime(machine: Checked, context: BuildContext) -> dict[str, str]:
    name = f"{_package(machine, context)}_flexbe_states"
    return {f"{name}/{name}/{RUNTIME}": f"flexbe/{RUNTIME}"}


TARGET = Target(
    name="flexbe",
    description="a behavior, its manifest and its states for FlexBE 2.3 on ROS 2",
    emit=emit,
    runtime=_runtime,
    options={"package": "NAME: NAME_flexbe_behaviors and NAME_flexbe_states (default: the script)"},
    lacks=(
        "machines without states",
        "outcomes named `preempted_` and `None_`, which stand for `preempted` and `None`",
        "items of an Iterator whose code uses modules or names of the program",
        "templates that add code around the run of the program, as SMACHA's do",
    ),
)
