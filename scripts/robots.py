"""Writes the URDF files of the built-in robots that are made of boxes and cylinders.

    python scripts/robots.py        # smachac/robots/baxter.urdf and iiwa.urdf

Figures of Baxter: baxter_common of Rethink Robotics (BSD-3, commit 6c4b0f37), the files
baxter_description/urdf/baxter_base/baxter_base.urdf.xacro and
rethink_ee_description/urdf/electric_gripper (finger extended_narrow, slot 2, paddle_tip). The
torque of s1 is 100 N m, as in the older baxter.urdf: springs in the shoulder of the real arm carry
its weight. Figures of the iiwa: data sheet of the KUKA LBR iiwa 14 R820 (lengths 360, 420, 400 mm;
ranges, speeds, torques), with the frames of kuka_iiwa/model.urdf in PyBullet's data.

Lengths in m, angles in rad, masses in kg. The shapes are our own. PyBullet computes the inertia
from them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

H = math.pi / 2
ROOM = Path(__file__).parents[1] / "smachac" / "robots"

RED, DARK, LIGHT, STEEL, ORANGE = (
    "0.70 0.16 0.14 1",
    "0.20 0.21 0.24 1",
    "0.78 0.79 0.80 1",
    "0.55 0.57 0.60 1",
    "0.93 0.46 0.10 1",
)

Numbers = tuple[float, ...]
Shape = tuple[str, Numbers, Numbers, Numbers]


def cylinder(radius: float, length: float, at: Numbers, turned: Numbers = (0, 0, 0)) -> Shape:
    return "cylinder", (radius, length), at, turned


def box(x: float, y: float, z: float, at: Numbers) -> Shape:
    return "box", (x, y, z), at, (0, 0, 0)


def text(numbers: Numbers) -> str:
    return " ".join(f"{number:.12g}" for number in numbers)


def link(
    name: str,
    mass: float,
    centre: Numbers,
    colour: str,
    shapes: tuple[Shape, ...] = (),
    *,
    solid: bool = True,
    pad: bool = False,
) -> Iterator[str]:
    """A link; a `pad` has the contact values with which a grasp holds."""
    yield f'  <link name="{name}">'
    yield (
        f'    <inertial><origin xyz="{text(centre)}"/><mass value="{mass:g}"/>'
        '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>'
    )
    if pad:
        yield (
            '    <contact><lateral_friction value="1.0"/><spinning_friction value="0.001"/>'
            '<friction_anchor/><stiffness value="30000"/><damping value="1000"/></contact>'
        )
    for kind, sizes, at, turned in shapes:
        form = f'<box size="{text(sizes)}"/>'
        if kind == "cylinder":
            form = f'<cylinder radius="{sizes[0]:g}" length="{sizes[1]:g}"/>'
        place = f'<origin xyz="{text(at)}" rpy="{text(turned)}"/><geometry>{form}</geometry>'
        paint = f'<material name="{colour.replace(" ", "_")}"><color rgba="{colour}"/></material>'
        yield f"    <visual>{place}{paint}</visual>"
        if solid:
            yield f"    <collision>{place}</collision>"
    yield "  </link>"


def joint(
    name: str,
    kind: str,
    ends: tuple[str, str],
    at: Numbers,
    turned: Numbers = (0, 0, 0),
    axis: Numbers = (0, 0, 1),
    limits: Numbers = (),
) -> Iterator[str]:
    """A joint; `limits` are lower, upper, effort and speed."""
    yield f'  <joint name="{name}" type="{kind}">'
    yield f'    <parent link="{ends[0]}"/><child link="{ends[1]}"/>'
    yield f'    <origin xyz="{text(at)}" rpy="{text(turned)}"/>'
    if kind != "fixed":
        lower, upper, effort, speed = (f"{limit:.12g}" for limit in limits)
        yield f'    <axis xyz="{text(axis)}"/>'
        yield f'    <limit lower="{lower}" upper="{upper}" effort="{effort}" velocity="{speed}"/>'
        yield '    <dynamics damping="0.7" friction="0"/>'
    yield "  </joint>"


# Baxter

ARM: tuple[tuple[str, str, str, Numbers, Numbers, Numbers], ...] = (
    ("s0", "arm_mount", "upper_shoulder", (0.055695, 0, 0.011038), (0, 0, 0),
     (-1.70168, 1.70168, 50, 1.5)),
    ("s1", "upper_shoulder", "lower_shoulder", (0.069, 0, 0.27035), (-H, 0, 0),
     (-2.147, 1.047, 100, 1.5)),
    ("e0", "lower_shoulder", "upper_elbow", (0.102, 0, 0), (H, 0, H),
     (-3.05418, 3.05418, 50, 1.5)),
    ("e1", "upper_elbow", "lower_elbow", (0.069, 0, 0.26242), (-H, -H, 0),
     (-0.05, 2.618, 50, 1.5)),
    ("w0", "lower_elbow", "upper_forearm", (0.10359, 0, 0), (H, 0, H),
     (-3.059, 3.059, 15, 4.0)),
    ("w1", "upper_forearm", "lower_forearm", (0.01, 0, 0.2707), (-H, -H, 0),
     (-1.5708, 2.094, 15, 4.0)),
    ("w2", "lower_forearm", "wrist", (0.115975, 0, 0), (H, 0, H),
     (-3.059, 3.059, 15, 4.0)),
)  # fmt: skip
"""Joint, parent, child, origin, rpy, and limits: lower, upper, effort, speed."""

LINKS: dict[str, tuple[float, Numbers, str, tuple[Shape, ...]]] = {
    "upper_shoulder": (5.70, (0.018, 0.001, 0.191), DARK, (cylinder(0.06, 0.27, (0, 0, 0.136)),)),
    "lower_shoulder": (
        3.23, (0.068, 0.003, -0.005), RED,
        (cylinder(0.06, 0.12, (0, 0, 0)), cylinder(0.052, 0.10, (0.05, 0, 0), (0, H, 0))),
    ),
    "upper_elbow": (4.31, (-0.003, 0.001, 0.181), DARK, (cylinder(0.055, 0.36, (0, 0, 0.08)),)),
    "lower_elbow": (
        2.07, (0.026, 0.002, -0.011), RED,
        (cylinder(0.06, 0.10, (0, 0, 0)), cylinder(0.048, 0.104, (0.052, 0, 0), (0, H, 0))),
    ),
    "upper_forearm": (2.25, (-0.002, 0.005, 0.140), DARK, (cylinder(0.05, 0.34, (0, 0, 0.09)),)),
    "lower_forearm": (
        1.61, (0.060, 0.007, 0.006), RED,
        (cylinder(0.055, 0.10, (0, 0, 0)), cylinder(0.043, 0.116, (0.058, 0, 0), (0, H, 0))),
    ),
    "wrist": (
        0.84, (0.003, 0.001, 0.07), DARK,
        (cylinder(0.045, 0.11, (0, 0, 0.055)), box(0.06, 0.09, 0.05, (0, 0, 0.1345))),
    ),
}  # fmt: skip
"""Mass, centre of mass, colour and shapes; the wrist includes the hand and the gripper's base."""


def baxter() -> Iterator[str]:
    column = (
        cylinder(0.14, 0.87, (0, 0, -0.495)),
        box(0.80, 0.76, 0.05, (-0.04, 0, -0.905)),
    )
    yield '<robot name="baxter">'
    yield from link("base", 60, (0, 0, -0.5), DARK, column)
    yield from link("torso", 35, (-0.03, 0, 0.3), RED, (box(0.26, 0.34, 0.74, (-0.03, 0, 0.30)),))
    yield from joint("torso_t0", "fixed", ("base", "torso"), (0, 0, 0))
    yield from link(
        "head", 1, (0.12, 0, 0.02), DARK, (box(0.05, 0.28, 0.18, (0.12, 0, 0.02)),), solid=False
    )
    yield from joint(
        "head_pan", "revolute", ("torso", "head"), (0.06, 0, 0.686),
        limits=(-1.3963, 1.3963, 50, 1.0),
    )  # fmt: skip
    for side, sign in (("left", 1), ("right", -1)):
        yield from baxter_arm(side, sign)
    yield "</robot>"


def baxter_arm(side: str, sign: int) -> Iterator[str]:
    mount = (box(0.10, 0.10, 0.06, (0, 0, -0.03)),)
    yield from link(f"{side}_arm_mount", 0.01, (0, 0, 0), DARK, mount)
    yield from joint(
        f"{side}_torso_arm_mount", "fixed", ("torso", f"{side}_arm_mount"),
        (0.024645, sign * 0.219645, 0.118588), (0, 0, sign * 0.7854),
    )  # fmt: skip
    for name, parent, child, at, turned, limits in ARM:
        mass, centre, colour, shapes = LINKS[child]
        yield from link(f"{side}_{child}", mass, centre, colour, shapes)
        ends = f"{side}_{parent}", f"{side}_{child}"
        yield from joint(f"{side}_{name}", "revolute", ends, at, turned, limits=limits)
    hand, base, tip = f"{side}_hand", f"{side}_gripper_base", f"{side}_gripper"
    for name in (hand, base, tip):
        yield from link(name, 0.001, (0, 0, 0), STEEL)
    yield from joint(hand, "fixed", (f"{side}_wrist", hand), (0, 0, 0.11355))
    yield from joint(base, "fixed", (hand, base), (0, 0, 0.025))
    yield from joint(f"{side}_endpoint", "fixed", (base, tip), (0, 0, 0.1327))
    short = side[0]
    for finger, way, limits in (("l", 1, (0, 0.020833)), ("r", -1, (-0.020833, 0))):
        name = f"{short}_gripper_{finger}_finger"
        shapes = (
            box(0.012, 0.0135, 0.112, (0, way * 0.01725, 0.056)),
            box(0.042, 0.0065, 0.037, (0, way * 0.01275, 0.0977)),
        )
        yield from link(name, 0.1, (0, way * 0.015, 0.07), STEEL, shapes, pad=True)
        yield from joint(
            f"{name}_joint", "prismatic", (base, name), (0, -way * 0.0015, 0.02),
            axis=(0, 1, 0), limits=(*limits, 20, 5),
        )  # fmt: skip


# KUKA LBR iiwa 14 R820, with a gripper of two sliding fingers

IIWA: tuple[tuple[Numbers, Numbers, float, float, float], ...] = (
    ((0, 0, 0.1575), (0, 0, 0), 170, 320, 85),
    ((0, 0, 0.2025), (H, 0, math.pi), 120, 320, 85),
    ((0, 0.2045, 0), (H, 0, math.pi), 170, 176, 100),
    ((0, 0, 0.2155), (H, 0, 0), 120, 176, 75),
    ((0, 0.1845, 0), (-H, math.pi, 0), 170, 110, 130),
    ((0, 0, 0.2155), (H, 0, 0), 120, 40, 135),
    ((0, 0.081, 0), (-H, math.pi, 0), 175, 40, 135),
)
"""Origin, rpy, range (+- degrees), torque (N m), speed (degrees/s) of each joint."""

IIWA_LINKS: tuple[tuple[float, Numbers, tuple[Shape, ...]], ...] = (
    (4, (0, -0.03, 0.12), (cylinder(0.065, 0.20, (0, 0, 0.10)),)),
    (
        4, (0, 0.059, 0.042),
        (cylinder(0.065, 0.15, (0, 0, 0)), cylinder(0.06, 0.16, (0, 0.1, 0), (H, 0, 0))),
    ),
    (3, (0, 0.03, 0.13), (cylinder(0.062, 0.19, (0, 0, 0.11)),)),
    (
        2.7, (0, 0.067, 0.034),
        (cylinder(0.062, 0.14, (0, 0, 0)), cylinder(0.055, 0.14, (0, 0.09, 0), (H, 0, 0))),
    ),
    (1.7, (0, 0.021, 0.076), (cylinder(0.055, 0.18, (0, 0, 0.11)),)),
    (1.8, (0, 0.001, 0), (cylinder(0.055, 0.13, (0, 0, 0)),)),
    (0.3, (0, 0, 0.02), (cylinder(0.045, 0.05, (0, 0, 0.02)),)),
)  # fmt: skip
"""Mass, centre of mass and shapes of each link; masses as in PyBullet's model."""


def iiwa() -> Iterator[str]:
    yield '<robot name="iiwa">'
    foot = (cylinder(0.09, 0.15, (0, 0, 0.075)),)
    yield from link("iiwa_link_0", 5, (0, 0, 0.07), DARK, foot)
    rows = enumerate(zip(IIWA, IIWA_LINKS, strict=True), 1)
    for k, ((at, turned, reach, effort, speed), (mass, centre, shapes)) in rows:
        colour = ORANGE if k % 2 == 0 else LIGHT
        yield from link(f"iiwa_link_{k}", mass, centre, colour, shapes)
        limit = math.radians(reach)
        yield from joint(
            f"iiwa_joint_{k}", "revolute", (f"iiwa_link_{k - 1}", f"iiwa_link_{k}"), at, turned,
            limits=(-limit, limit, effort, math.radians(speed)),
        )  # fmt: skip
    palm = (box(0.06, 0.16, 0.05, (0, 0, 0.025)),)
    yield from link("iiwa_hand", 0.6, (0, 0, 0.02), DARK, palm)
    yield from joint("iiwa_flange", "fixed", ("iiwa_link_7", "iiwa_hand"), (0, 0, 0.045))
    yield from link("iiwa_tool", 0.001, (0, 0, 0), STEEL)
    yield from joint("iiwa_tool", "fixed", ("iiwa_hand", "iiwa_tool"), (0, 0, 0.145))
    for side, way in (("left", 1), ("right", -1)):
        name = f"iiwa_{side}_finger"
        shapes = (
            box(0.016, 0.012, 0.09, (0, way * 0.014, 0.045)),
            box(0.036, 0.008, 0.038, (0, way * 0.004, 0.078)),
        )
        yield from link(name, 0.1, (0, way * 0.01, 0.05), STEEL, shapes, pad=True)
        yield from joint(
            f"{name}_joint", "prismatic", ("iiwa_hand", name), (0, 0, 0.052),
            axis=(0, way, 0), limits=(0, 0.045, 40, 1),
        )  # fmt: skip
    yield "</robot>"


FILES = {"baxter.urdf": baxter, "iiwa.urdf": iiwa}
HEAD = '<?xml version="1.0"?>\n<!-- Written by scripts/robots.py, which cites the source. -->\n'


def contents() -> dict[str, str]:
    """The texts of the files, by name."""
    return {name: HEAD + "\n".join(lines()) + "\n" for name, lines in FILES.items()}


if __name__ == "__main__":
    for name, content in contents().items():
        (ROOM / name).write_text(content, encoding="utf-8")
