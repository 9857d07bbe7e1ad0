"""The files beside a program that make it a package of ROS 2 (ament_python) for colcon."""

from __future__ import annotations

import ast
import re

from smachac.ir.nodes import Data, Machine
from smachac.ir.python_code import parse_module
from smachac.targets import Files, OptionError, made_by, stem
from smachac.targets.package_xml import package_xml, summary
from smachac.targets.python.formatter import flat, literal, string
from smachac.targets.python.parameters import RosParameter

MESSAGE_MODULES = ("msg", "srv", "action")


def package_name(value: str, machine: Machine) -> str:
    """The name of the package that the option gives: `true` means that of the program. Raises
    OptionError."""
    name = stem(machine).lower() if value == "true" else value
    if re.fullmatch(r"[a-z][a-z0-9_]*", name) is None:
        raise OptionError(f"`package` must be `true` or match `[a-z][a-z0-9_]*`, not `{name}`")
    return name


def package_files(
    machine: Machine, name: str, text: str, parameters: tuple[RosParameter, ...]
) -> Files:
    """The files of a package: the program `text` first."""
    program, mark = stem(machine), made_by(machine)
    needed = ["rclpy", *message_packages(text)]
    depends = "".join(f"  <exec_depend>{text}</exec_depend>\n" for text in needed)
    return {
        f"{name}/{program}.py": text,
        f"{name}/__init__.py": f"# {mark}\n",
        "package.xml": package_xml(machine, name, depends, "ament_python"),
        "setup.py": setup_file(
            machine,
            name,
            f"{program}:run_node",
            f'        ("share/{name}/launch", ["launch/{program}.launch.py"]),\n',
        ),
        "setup.cfg": SETTINGS.format(mark=mark, name=name),
        f"resource/{name}": f"# {mark}\n",
        f"launch/{program}.launch.py": _launch(machine, name, program, parameters),
    }


def message_packages(text: str) -> list[str]:
    """The packages of the messages that a program imports."""
    found = set()
    for node in parse_module(text).body:
        if isinstance(node, ast.ImportFrom) and node.module is not None:
            package, _, module = node.module.partition(".")
            if module in MESSAGE_MODULES:
                found.add(package)
    return sorted(found)


SETTINGS = """\
# {mark}
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""


def setup_file(machine: Machine, name: str, start: str = "", more: str = "") -> str:
    """The file setup.py of a package. `start` is the function that runs the program, as
    `module:function`, if there is one; `more` are further lines of `data_files`."""
    command = f'"console_scripts": ["{stem(machine)} = {name}.{start}"]'
    entry_points = f"    entry_points={{{command}}},\n" if start else ""
    return f"""\
# {made_by(machine)}
from setuptools import setup

setup(
    name="{name}",
    version="0.0.0",
    packages=["{name}"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/{name}"]),
        ("share/{name}", ["package.xml"]),
{more}    ],
    install_requires=["setuptools", "smachac"],
    zip_safe=True,
    maintainer="TODO: who keeps it",
    maintainer_email="todo@example.com",
    description={string(summary(machine))},
    license="TODO: its license",
{entry_points})
"""


def _launch(machine: Machine, name: str, program: str, parameters: tuple[RosParameter, ...]) -> str:
    """The launch file: each parameter of the node is an argument."""
    declared = "".join(
        f"\n            DeclareLaunchArgument({string(parameter.name)},"
        f" default_value={string(_yaml(parameter.default))}),"
        for parameter in parameters
    )
    given = "".join(
        f"\n                        {string(parameter.name)}: ParameterValue(\n"
        f"                            LaunchConfiguration({string(parameter.name)}),"
        f" value_type={_type(parameter.default)}\n                        ),"
        for parameter in parameters
    )
    lists = "from typing import List\n\n" if "List[" in given else ""
    imports = LAUNCH_IMPORTS if parameters else ""
    values = (
        f"\n                parameters=[\n                    {{{given}\n                    }}\n"
    )
    values += "                ],"
    return f"""\
# {made_by(machine)}
{lists}from launch import LaunchDescription
{imports}from launch_ros.actions import Node
{PARAMETER_IMPORTS if parameters else ""}

def generate_launch_description():
    return LaunchDescription(
        [{declared}
            Node(
                package="{name}",
                executable="{program}",
                name="{program}",
                output="screen",{values if parameters else ""}
            ),
        ]
    )
"""


LAUNCH_IMPORTS = """\
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
"""

PARAMETER_IMPORTS = "from launch_ros.parameter_descriptions import ParameterValue\n"


def _yaml(data: Data) -> str:
    """A value as the text of a launch argument, which is YAML."""
    if isinstance(data, bool):
        return "true" if data else "false"
    return data if isinstance(data, str) else flat(literal(data))


def _type(data: Data) -> str:
    """The type of a parameter in a launch file."""
    if isinstance(data, tuple):
        return f"List[{_type(data[0])}]"
    return type(data).__name__
