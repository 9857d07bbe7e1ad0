"""The robot of a script, for rules: its joints, limbs and frames."""

from __future__ import annotations

import math

from smachac.diagnostics.source import NOWHERE, Span, Word
from smachac.records import dataclass, field
from smachac.robots.fields import IDENTITY, Pose

TYPE_CHECKING = False  # annotations only: most scripts have no robot
if TYPE_CHECKING:
    from smachac.robots.description import Limb


@dataclass(frozen=True, slots=True, kw_only=True)
class Joint:
    """A joint and its limits (rad, or m if it does not turn); those of a continuous joint are
    infinite.

    `velocity` is its largest speed (rad/s or m/s); infinite if it is not known. `span` is its place
    in the robot's file, if there is one.
    """

    name: str
    lower: float = -math.inf
    upper: float = math.inf
    velocity: float = math.inf
    turns: bool = True
    span: Span = field(default=NOWHERE, compare=False, repr=False)

    @property
    def unit(self) -> str:
        """The unit of its position."""
        return "rad" if self.turns else "m"


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """An arm of a described robot: its name for states, its description, its joints with their
    limits, and the pose of the base of its robot (world frame)."""

    name: str
    limb: Limb
    joints: tuple[Joint, ...]
    base: Pose


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot:
    """A robot: its joints, its limbs, the names of its frames.

    A limb is a chain of joints from the base to the hand, to which lists of joint positions refer.
    `arms` are the described limbs; empty where the robot has no description of its own. `base` is
    the frame in which poses are given (world frame).
    `description` is what the simulation loads: the name of a built-in robot or the file of a
    description; empty for a robot that cannot be simulated. `scene` has the names of the bodies and
    of the single robots that are in the world from the start, `bodies` the places of those in the
    file of the scene. `frames` are the names of its links,
    empty if unknown; `added` are frames that the script declares. `span` is the place where the
    script names the robot, NOWHERE if its base does.
    """

    name: str
    joints: tuple[Joint, ...]
    limbs: tuple[tuple[Joint, ...], ...]
    arms: tuple[Arm, ...] = ()
    base: Pose = IDENTITY
    description: str = ""
    scene: frozenset[str] = frozenset()
    frames: frozenset[str] = frozenset()
    added: frozenset[str] = frozenset()
    span: Span = field(default=NOWHERE, compare=False, repr=False)
    bodies: tuple[Word, ...] = field(default=(), compare=False, repr=False)

    @property
    def limb_names(self) -> tuple[str, ...]:
        """The names of the arms for states."""
        return tuple(arm.name for arm in self.arms)


MODELS = ("block", "brick", "cafe_table", "corner_block", "goal", "table", "wall")
"""The models of the simulation, by name (sim/models.py)."""
