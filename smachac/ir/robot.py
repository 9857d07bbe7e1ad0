"""The robot of a script, for rules: its joints, limbs and frames."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from smachac.diagnostics.source import NOWHERE, Span


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A revolute joint and its limits (rad); the limits of a continuous joint are infinite.

    `velocity` is its largest speed (rad/s); infinite if it is not known. `span` is its place in the
    robot's file, if there is one.
    """

    name: str
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    span: Span = field(default=NOWHERE, compare=False, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """A robot: its joints, its limbs, the names of its frames.

    A limb is a chain of joints from the base to the hand, to which lists of joint positions refer.
    `limb_names` are the names of the limbs for states; empty where the robot has no description.
    `description` is what the simulation loads: the name of a built-in robot or the file of a
    description; empty for a robot that cannot be simulated. `scene` has the names of the bodies and
    of the single robots that are in the world from the start. `frames` are the names of its links,
    empty if unknown; `added` are frames that the script declares. `span` is the place where the
    script names the robot, NOWHERE if its base does.
    """

    name: str
    joints: tuple[Joint, ...]
    limbs: tuple[tuple[Joint, ...], ...]
    limb_names: tuple[str, ...] = ()
    description: str = ""
    scene: frozenset[str] = frozenset()
    frames: frozenset[str] = frozenset()
    added: frozenset[str] = frozenset()
    span: Span = field(default=NOWHERE, compare=False, repr=False)


MODELS = ("block", "brick", "cafe_table", "corner_block", "goal", "table", "wall")
"""The models of the simulation, by name (sim/models.py)."""
