"""The robot of a URDF file, for rules: its joints and limbs, with their places in the file."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.diagnostics.source import Source, Span
from smachac.ir.robot import Joint, Robot
from smachac.robots.urdf import Urdf, UrdfJoint

JointChain = tuple[Joint, ...]
"""Consecutive joints, each a child of the previous one."""


def checked_joint(joint: UrdfJoint, source: Source) -> Joint:
    """A joint with its place in its file."""
    return Joint(
        name=joint.name,
        lower=joint.lower,
        upper=joint.upper,
        velocity=joint.velocity,
        turns=joint.turns,
        span=Span(source, *joint.place),
    )


def robot_of_urdf(urdf: Urdf, source: Source) -> Robot:
    """The robot that a file describes: a limb is each part of the tree without a fork."""
    return Robot(
        name=urdf.name,
        joints=tuple(checked_joint(joint, source) for joint in urdf.joints.values() if joint.turns),
        limbs=_limbs(urdf, source),
        frames=frozenset(urdf.links),
    )


def _limbs(urdf: Urdf, source: Source) -> tuple[JointChain, ...]:
    """The groups of joints that a list of angles may command: each part of the tree without a fork,
    alone or with the joints from the base to it. Joints that follow others are left out.
    """
    below: dict[str, list[UrdfJoint]] = {}
    for joint in urdf.joints.values():
        below.setdefault(joint.parent, []).append(joint)
    moving = _moving(urdf.joints.values())
    found: dict[JointChain, None] = {}
    todo: list[tuple[str, JointChain, JointChain]] = [(urdf.root, (), ())]
    while todo:
        link, chain, before = todo.pop()
        ways = [joint for joint in below.get(link, ()) if joint.child in moving]
        if len(ways) == 1:
            todo.append((ways[0].child, chain + _commanded(ways[0], source), before))
            continue
        if chain:
            found |= {chain: None, (*before, *chain): None}
        rows = reversed(ways)
        todo += [(joint.child, _commanded(joint, source), (*before, *chain)) for joint in rows]
    return tuple(found)


def _commanded(joint: UrdfJoint, source: Source) -> JointChain:
    return (checked_joint(joint, source),) if joint.turns and joint.mimic is None else ()


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
