"""The files that make a behavior and its states packages of ROS 2 (ament_python) for colcon."""

from __future__ import annotations

from smachac.ir.nodes import Machine
from smachac.targets import Files, made_by, stem
from smachac.targets.flexbe.behavior import Behavior, attribute, class_name
from smachac.targets.package_xml import escaped, package_xml, summary
from smachac.targets.python.formatter import flat, literal
from smachac.targets.python.package import SETTINGS, message_packages, setup_file
from smachac.targets.python.parameters import RosParameter


def behavior_package(
    machine: Machine, name: str, states: str, behavior: str, manifest: str
) -> Files:
    """The package `name` with the behavior, whose text is first. `states` is the other package."""
    file = f"manifest/{stem(machine)}.xml"
    return {
        f"{name}/{name}/{stem(machine)}_sm.py": behavior,
        f"{name}/{file}": manifest,
        **_package(
            machine,
            name,
            ["rclpy", "flexbe_core", states],
            "flexbe_behaviors",
            f'        ("lib/{name}/manifest", ["{file}"]),\n',
        ),
    }


def state_package(machine: Machine, name: str, modules: Files, program: str) -> Files:
    """The package `name` with the modules of the states; `program` is the text of the SMACH
    program."""
    return {
        **{f"{name}/{name}/{file}": text for file, text in modules.items()},
        **_package(
            machine, name, ["rclpy", "flexbe_core", *message_packages(program)], "flexbe_states"
        ),
    }


def _package(
    machine: Machine, name: str, needed: list[str], export: str, data_files: str = ""
) -> Files:
    mark = made_by(machine)
    depends = "".join(f"  <exec_depend>{text}</exec_depend>\n" for text in needed)
    return {
        f"{name}/{name}/__init__.py": f"# {mark}\n",
        f"{name}/package.xml": package_xml(
            machine, name, depends, "ament_python", f"    <{export} />\n"
        ),
        f"{name}/setup.py": setup_file(machine, name, more=data_files),
        f"{name}/setup.cfg": SETTINGS.format(mark=mark, name=name),
        f"{name}/resource/{name}": f"# {mark}\n",
    }


def manifest(machine: Machine, package: str, behavior: Behavior) -> str:
    """The manifest, from which FlexBE's library and App know the behavior."""
    parameters = "".join(map(_parameter, behavior.parameters))
    params = f"\n    <params>\n{parameters}    </params>\n" if parameters else "\n"
    return f"""\
<?xml version="1.0" encoding="UTF-8"?>
<!-- {made_by(machine)} -->

<behavior name="{escaped(machine.root.name)}">

    <executable package_path="{package}.{stem(machine)}_sm" class="{class_name(machine)}" />
    <tagstring></tagstring>
    <author>smachac</author>
    <date></date>
    <description>
        {escaped(summary(machine))}
    </description>

    <!-- Contained Behaviors -->

    <!-- Available Parameters -->{params}
</behavior>
"""


def _parameter(parameter: RosParameter) -> str:
    """A parameter. FlexBE has text, numbers and truth values; a list or mapping is text in YAML."""
    value, name = parameter.default, attribute(parameter)
    match value:
        case bool():
            kind, inside = "boolean", ""
        case int() | float():
            limit = max(abs(value) * 10, 1)
            inside = f'\n            <min value="{-limit}" />\n            <max value="{limit}" />'
            kind, inside = "numeric", f"{inside}\n        "
        case _:
            kind, inside = "text", ""
    text = value if isinstance(value, str) else flat(literal(value))
    return (
        f'        <param type="{kind}" name="{name}" default="{escaped(str(text))}"'
        f' label="{name}" hint="">{inside}</param>\n'
    )
