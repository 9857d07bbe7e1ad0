"""The manifest of a package of ROS 2, package.xml in format 3 (REP 149)."""

from __future__ import annotations

from smachac.ir.nodes import Machine
from smachac.targets import made_by


def package_xml(
    machine: Machine, name: str, depends: str, build_type: str, exports: str = ""
) -> str:
    """The text of package.xml. `depends` are its lines of dependencies, `exports` further lines of
    its exports, each with a line break."""
    return f"""\
<?xml version="1.0"?>
<!-- {made_by(machine)} -->
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>{escaped(summary(machine))}</description>
  <maintainer email="todo@example.com">TODO: who keeps it</maintainer>
  <license>TODO: its license</license>
{depends}\
  <export>
    <build_type>{build_type}</build_type>
{exports}  </export>
</package>
"""


def summary(machine: Machine) -> str:
    """One line about a machine: the first one of its `doc`, or its name."""
    lines = machine.root.doc.split("\n")
    return lines[0] or f"The state machine {machine.root.name}."


_ENTITIES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})


def escaped(text: str) -> str:
    """A text in XML, also in an attribute."""
    return text.translate(_ENTITIES)
