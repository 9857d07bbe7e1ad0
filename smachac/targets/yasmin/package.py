"""The files that make a module for YASMIN a package of ROS 2 (ament_python) for colcon."""

from __future__ import annotations

from smachac.ir.nodes import Machine
from smachac.targets import Files, made_by, stem
from smachac.targets.package_xml import package_xml
from smachac.targets.python.package import SETTINGS, message_packages, setup_file


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
        "setup.py": setup_file(machine, name, f"{stem(machine)}_yasmin:start"),
        "setup.cfg": SETTINGS.format(mark=mark, name=name),
        f"resource/{name}": f"# {mark}\n",
    }
