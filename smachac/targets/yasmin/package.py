"""The files that make a module for YASMIN a package of ROS 2 (ament_python) for colcon."""

from __future__ import annotations

from smachac.ir.nodes import Machine
from smachac.targets import Files, made_by, stem
from smachac.targets.package_xml import package_xml, summary
from smachac.targets.python.formatter import string
from smachac.targets.python.package import SETTINGS, message_packages


def package_files(machine: Machine, name: str, modules: Files, program: str) -> Files:
    """The files of the package `name`: its modules, that for YASMIN first. `program` is the text of
    the SMACH program."""
    mark = made_by(machine)
    needed = ["yasmin", "rclpy", *message_packages(program)]
    depends = "".join(f"  <exec_depend>{text}</exec_depend>\n" for text in needed)
    return {
        **{f"{name}/{file}": text for file, text in modules.items()},
        f"{name}/__init__.py": f"# {mark}\n",
        "package.xml": package_xml(machine, name, depends, "ament_python"),
        "setup.py": _setup(machine, name),
        "setup.cfg": SETTINGS.format(mark=mark, name=name),
        f"resource/{name}": f"# {mark}\n",
    }


def _setup(machine: Machine, name: str) -> str:
    program = stem(machine)
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
    ],
    install_requires=["setuptools", "smachac"],
    zip_safe=True,
    maintainer="TODO: who keeps it",
    maintainer_email="todo@example.com",
    description={string(summary(machine))},
    license="TODO: its license",
    entry_points={{"console_scripts": ["{program} = {name}.{program}_yasmin:start"]}},
)
"""
