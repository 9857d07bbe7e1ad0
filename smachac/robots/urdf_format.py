"""The elements and attributes of URDF 1.0, 1.1 and 1.2 as data, and the check of a file with them.

Where a file has something that no version of URDF has, it is left out, as ROS does: other programs
add elements of their own. A name that is close to one of URDF is a mistake.
"""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Mapping
from difflib import get_close_matches
from typing import NamedTuple

from smachac.robots.xml_tree import FIRST_TAG, Element, XmlError

XACRO = "this is a macro of xacro: save the file as `.urdf.xacro`, and name that file"

TEXT = 0
"""The attribute is a text, not a row of numbers."""


class Tag(NamedTuple):
    """An element: its attributes with the count of their numbers (TEXT for a text), those it needs,
    its child elements, those it needs, and those that it may have several times. `choice`: it has
    exactly one child element. `lengths`: attributes with numbers that are not negative."""

    attributes: Mapping[str, int] = {}
    required: tuple[str, ...] = ()
    children: Mapping[str, Tag] = {}
    needed: tuple[str, ...] = ()
    several: tuple[str, ...] = ()
    choice: bool = False
    lengths: tuple[str, ...] = ()


def _value(count: int = 1) -> Tag:
    return Tag({"value": count}, required=("value",))


ORIGIN = Tag({"xyz": 3, "rpy": 3, "quat_xyzw": 4})
_ROUND = ("radius", "length")
GEOMETRY = Tag(
    children={
        "box": Tag({"size": 3}, required=("size",), lengths=("size",)),
        "sphere": Tag({"radius": 1}, required=("radius",), lengths=("radius",)),
        "cylinder": Tag(dict.fromkeys(_ROUND, 1), required=_ROUND, lengths=_ROUND),
        "capsule": Tag(dict.fromkeys(_ROUND, 1), required=_ROUND, lengths=_ROUND),
        "mesh": Tag({"filename": TEXT, "scale": 3}, required=("filename",)),
    },
    choice=True,
)
MATERIAL = Tag(
    {"name": TEXT},
    children={
        "color": Tag({"rgba": 4}, required=("rgba",)),
        "texture": Tag({"filename": TEXT}),
    },
)
_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
INERTIAL = Tag(
    children={
        "origin": ORIGIN,
        "mass": _value(),
        "inertia": Tag(dict.fromkeys(_MOMENTS, 1), required=("ixx", "iyy", "izz")),
    },
    needed=("mass", "inertia"),
)
CONTACT = Tag(
    children={
        **dict.fromkeys(
            ("lateral_friction", "rolling_friction", "spinning_friction", "restitution"), _value()
        ),
        **dict.fromkeys(
            ("stiffness", "damping", "contact_cfm", "contact_erp", "inertia_scaling"), _value()
        ),
        "friction_anchor": Tag(),
    }
)
"""The properties of contacts that PyBullet adds to a link."""
LINK = Tag(
    {"name": TEXT, "type": TEXT, "concave": TEXT},
    children={
        "inertial": INERTIAL,
        "visual": Tag(
            {"name": TEXT},
            children={
                "origin": ORIGIN,
                "geometry": GEOMETRY,
                "material": MATERIAL._replace(required=("name",)),
            },
            needed=("geometry",),
        ),
        "collision": Tag(
            {"name": TEXT, "concave": TEXT, "group": TEXT, "mask": TEXT},
            children={"origin": ORIGIN, "geometry": GEOMETRY, "verbose": Tag({"value": TEXT})},
            needed=("geometry",),
        ),
        "contact": CONTACT,
    },
    several=("visual", "collision"),
)
_END = Tag({"link": TEXT}, required=("link",))
_LIMITS = ("lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk")
_SAFETY = ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity")
JOINT = Tag(
    {"name": TEXT, "type": TEXT},
    children={
        "origin": ORIGIN,
        "parent": _END,
        "child": _END,
        "axis": Tag({"xyz": 3}),
        "limit": Tag(dict.fromkeys(_LIMITS, 1)),
        "dynamics": Tag({"damping": 1, "friction": 1}),
        "mimic": Tag({"joint": TEXT, "multiplier": 1, "offset": 1}, required=("joint",)),
        "calibration": Tag({"rising": 1, "falling": 1, "reference_position": 1}),
        "safety_controller": Tag(dict.fromkeys(_SAFETY, 1)),
    },
    needed=("parent", "child"),
)
HARMLESS = ("gazebo", "transmission", "sensor", "ros2_control")
"""Elements of a robot that are no part of its links and joints: nothing in them is read."""
ROBOT = Tag(
    {"name": TEXT, "version": TEXT},
    children={
        "link": LINK,
        "joint": JOINT,
        "material": MATERIAL,
        **dict.fromkeys(HARMLESS, Tag()),
    },
    several=("link", "joint", "material", *HARMLESS),
)
LONGEST_TEXT = 900
"""In characters: a line of the text for the engine has at most 1,000."""
MEASURED = ("mass", "inertia", "origin", "box", "sphere", "cylinder", "capsule", "mesh")
"""Elements whose numbers are lengths, angles, masses and inertias."""
LARGEST = 1e6
"""The largest number in them: with larger ones physics has no numbers as its result."""
_SLIP = 2
"""The most letters by which the length of a misspelt name differs."""
FIRST_COUNTS = ("material",)
"""Elements of which the first one counts, where one is expected."""
NOWHERE_ELSE = ("link", "joint")
"""Elements that may stand in `<robot>` alone: elsewhere they would be left out in silence."""

VERSIONS = ("1.0", "1.1", "1.2")
"""The versions of the format; a file without a version has the first one."""
_NEWER = {"quat_xyzw": "1.1", "capsule": "1.1"}
"""Attributes and elements with the version that added them. (The limits that 1.2 added are not
used: they are harmless in every version.)"""


def check_format(robot: Element, text: str) -> None:
    """Check all elements of a text against the format. Raises XmlError for the first mistake."""
    if robot.tag != "robot":
        message = f"the outermost element is `<{robot.tag}>`, not `<robot>`"
        raise XmlError(message, robot.place(text), FIRST_TAG)
    version = robot.attributes.get("version", VERSIONS[0])
    if version not in VERSIONS:
        message = f"the URDF version `{version}` is not known"
        help = f"the versions are {', '.join(VERSIONS)}; without `version` it is {VERSIONS[0]}"
        raise XmlError(message, robot.place(text, "version"), help)
    todo = [(robot, ROBOT)]
    while todo:
        element, tag = todo.pop()
        _check_element(element, tag, text, version)
        # The last one first: `pop` follows the order of the file.
        for child in reversed(element.children):
            if child.tag in HARMLESS:
                continue
            if child.tag in tag.children:
                todo.append((child, tag.children[child.tag]))
            elif child.tag in NOWHERE_ELSE:
                message = f"`<{child.tag}>` is inside `<{element.tag}>`"
                help = f"move it out: the place of a {child.tag} is in `<robot>` itself"
                raise XmlError(message, child.place(text), help)


def _check_element(element: Element, tag: Tag, text: str, version: str) -> None:
    for name in element.attributes:
        if name in tag.attributes:
            _check_attribute(element, name, tag, text, version)
        elif ":" not in name:
            _no_slip(element, name, [*tag.attributes], element.attributes, text, name)
    for name in tag.required:
        if name not in element.attributes:
            message = f"`<{element.tag}>` has no `{name}`"
            raise XmlError(message, element.place(text), f'write `<{element.tag} {name}="..."/>`')
    seen: dict[str, Element] = {}
    present = {child.tag for child in element.children}
    for child in element.children:
        if child.tag.startswith("xacro:"):
            message = f"`<{child.tag}>` is not an element of URDF"
            raise XmlError(message, child.place(text), XACRO)
        if child.tag not in tag.children:
            _no_slip(child, "", [*tag.children], present, text, child.tag)
            continue
        if child.tag in seen and child.tag not in (*tag.several, *FIRST_COUNTS):
            message = f"`<{element.tag}>` has two elements `<{child.tag}>`"
            message += f", in line {seen[child.tag].line} and here"
            raise XmlError(message, child.place(text), "remove one of them")
        seen[child.tag] = child
        _check_version(child, child.tag, f"<{child.tag}>", text, version)
    if tag.choice and len(seen) != 1:
        known = ", ".join(f"`<{name}>`" for name in tag.children)
        found = " and ".join(f"`<{name}>`" for name in seen) or "no shape that is known"
        message = f"`<{element.tag}>` has {found}"
        raise XmlError(message, element.place(text), f"write one of {known} in it")
    for name in tag.needed:
        if name not in seen:
            owner = element.attributes.get("name")
            what = f"{element.tag} `{owner}`" if owner else f"`<{element.tag}>`"
            message = f"{what} has no `<{name}>`"
            raise XmlError(message, element.place(text), f"add `<{name} .../>` to it")


def _check_attribute(element: Element, name: str, tag: Tag, text: str, version: str) -> None:
    _check_version(element, name, name, text, version)
    count = tag.attributes[name]
    if count == TEXT and len(element.attributes[name]) > LONGEST_TEXT:
        message = f"`{name}` of `<{element.tag}>` has more than {LONGEST_TEXT} characters"
        raise XmlError(message, element.place(text, name), "write a shorter one")
    if count == TEXT:
        return
    found = numbers(element, text, name, count)
    if name in tag.lengths and min(found) < 0.0:
        message = f"`{name}` of `<{element.tag}>` is `{element.attributes[name]}`: no length is"
        message += " negative"
        raise XmlError(message, element.place(text, name), "write the length in metres")
    if element.tag in MEASURED and max(map(abs, found)) > LARGEST:
        message = f"`{name}` of `<{element.tag}>` is `{element.attributes[name]}`: it is too large"
        raise XmlError(message, element.place(text, name), "write it in metres and kilograms")
    if name == "quat_xyzw":
        if "rpy" in element.attributes:
            message = "`<origin>` has `rpy` and `quat_xyzw`"
            raise XmlError(message, element.place(text, name), "remove one of the two")
        if math.hypot(*found) < 1e-6:
            message = "the quaternion is zero: it is no rotation"
            help = 'write `quat_xyzw="0 0 0 1"` for no rotation'
            raise XmlError(message, element.place(text, name), help)
    if element.tag == "mass" and found[0] < 0.0:
        message = f"the mass is {found[0]:g} kg: a mass is not negative"
        raise XmlError(message, element.place(text, name), "write the mass in kilograms")


def _check_version(element: Element, name: str, shown: str, text: str, version: str) -> None:
    if version < _NEWER.get(name, ""):
        message = f"`{shown}` needs URDF {_NEWER[name]}, but the file has the version {version}"
        help = f'write `version="{_NEWER[name]}"` in `<robot>`'
        raise XmlError(message, element.place(text, name), help)


def _no_slip(
    element: Element,
    attribute: str,
    known: list[str],
    present: Collection[str],
    text: str,
    name: str,
) -> None:
    """Raise XmlError if an unknown name is close to a known one that is absent."""
    absent = [
        other for other in known if other not in present and abs(len(other) - len(name)) <= _SLIP
    ]
    near = get_close_matches(name, absent, n=1, cutoff=0.8)
    near += [other for other in absent if len(name) < 4 and sorted(other) == sorted(name)]
    if near:
        what = f"the attribute `{name}` of `<{element.tag}>`" if attribute else f"`<{name}>`"
        message = f"{what} is not one of URDF"
        raise XmlError(message, element.place(text, attribute), f"did you mean `{near[0]}`?")


_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)


def numbers(element: Element, text: str, attribute: str, count: int) -> tuple[float, ...]:
    """The numbers of an attribute, with spaces between them. Raises XmlError."""
    words = element.attributes[attribute].split()
    found = tuple(float(word) for word in words if _NUMBER.fullmatch(word))
    if len(words) == len(found) == count and all(map(math.isfinite, found)):
        return found
    value = element.attributes[attribute]
    message = f"`{attribute}` of `<{element.tag}>` is `{value}`, not "
    message += "a number" if count == 1 else f"{count} numbers with spaces between them"
    example = " ".join(["0.5", "0", "0", "1"][:count])
    help = XACRO if "${" in value else f'write it as `{attribute}="{example}"`'
    raise XmlError(message, element.place(text, attribute), help)


def number(element: Element, text: str, attribute: str, default: float) -> float:
    """The number of an attribute; the default without it. Raises XmlError."""
    if attribute not in element.attributes:
        return default
    return numbers(element, text, attribute, 1)[0]
