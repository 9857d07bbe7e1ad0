"""URDF texts of small robots for the simulation."""

from __future__ import annotations

from pathlib import Path

from smachac import sim

INERTIAL = (
    '<inertial><mass value="{mass}"/><inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0"'
    ' izz="0.01"/></inertial>'
)
LIMIT = '<limit lower="-2" upper="2" effort="100" velocity="1"/>'


def link(name: str, inside: str = "", mass: float = 0.5) -> str:
    """A link with a mass (kg)."""
    return f'<link name="{name}">{INERTIAL.format(mass=mass)}{inside}</link>\n'


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    inside: str = LIMIT,
    *,
    axis: str = "0 0 1",
    xyz: str = "0 0 0.1",
) -> str:
    """A joint at `xyz` (m) of its parent link."""
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/>'
        f'<child link="{child}"/><axis xyz="{axis}"/>{inside}</joint>\n'
    )


def robot(folder: Path, *parts: str) -> Path:
    """The file of a robot of links and joints."""
    path = folder / "robot.urdf"
    path.write_text(f'<robot name="robot">\n{"".join(parts)}</robot>\n', encoding="utf-8")
    return path


def one_joint(folder: Path, kind: str, limit: str = LIMIT) -> sim.robots.Robot:
    """A robot with one joint `j` and the arm `arm`."""
    path = robot(folder, link("base"), link("hand"), joint("j", kind, "base", "hand", limit))
    limb = sim.robots.Limb(name="arm", joints=("j",), tip="hand", home=(0.0,))
    return sim.robots.from_urdf(path, limbs=(limb,))
