"""The robot of a URDF file, for rules: its joints and limbs, with their places in the file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.ir.robot import Joint, Robot
from smachac.robots.urdf import Urdf, UrdfJoint

JointChain = tuple[Joint, ...]
"""Consecutive joints, each a child of the previous one."""


def checked_joint(joint: UrdfJoint, urdf: Urdf, source: Source) -> Joint:
    """A joint with its place in its file; in a macro file, that of its name if it is written there
    once."""
    span = NOWHERE
    written = f'"{joint.name}"'
    if urdf.text == source.text:
        span = Span(source, *joint.place)
    elif source.text.count(written) == 1:
        start = source.text.index(written) + 1
        span = Span(source, start, start + len(joint.name))
    return Joint(
        name=joint.name,
        lower=joint.lower,
        upper=joint.upper,
        velocity=joint.velocity,
        turns=joint.turns,
        span=span,
    )


def robot_of_urdf(urdf: Urdf, source: Source) -> Robot:
    """The robot that a file describes: a limb is each part of the tree without a fork."""
    joints = {
        joint.name: checked_joint(joint, urdf, source)
        for joint in urdf.joints.values()
        if joint.turns
    }
    return Robot(
        name=urdf.name,
        joints=tuple(joints.values()),
        limbs=_limbs(urdf, joints),
        frames=frozenset(urdf.links),
    )


def _limbs(urdf: Urdf, joints: Mapping[str, Joint]) -> tuple[JointChain, ...]:
    """The groups of joints that a list of angles may command: each part of the tree without a fork,
    alone or with the joints from the base to it. Joints that follow others are left out.
    """
    below: dict[str, list[UrdfJoint]] = {}
    for joint in urdf.joints.values():
        below.setdefault(joint.parent, []).append(joint)
    moving = _moving(urdf.joints.values())

    def commanded(joint: UrdfJoint) -> JointChain:
        return (joints[joint.name],) if joint.turns and joint.mimic is None else ()

    found: dict[JointChain, None] = {}
    todo: list[tuple[str, JointChain, JointChain]] = [(urdf.root, (), ())]
    while todo:
        link, chain, before = todo.pop()
        ways = [joint for joint in below.get(link, ()) if joint.child in moving]
        if len(ways) == 1:
            todo.append((ways[0].child, chain + commanded(ways[0]), before))
            continue
        if chain:
            found |= {chain: None, (*before, *chain): None}
        todo += [(joint.child, commanded(joint), (*before, *chain)) for joint in reversed(ways)]
    return tuple(found)


def _moving(joints: Iterable[UrdfJoint]) -> set[str]:
    """The links that move relative to their parent, or that have such links below them."""
    above = {joint.child: joint for joint in joints}
    found: set[str] = set()
    for joint in above.values():
        up = joint if joint.kind != "fixed" else None
        while up is not None and up.child not in found:
            found.add(up.child)
            up = above.get(up.parent)
    return found
