"""A small, honest world in PyBullet: arms with skills, one clock, faults, films.

    with sim.World(seed=1) as world:
        world.load("table", [[0.6, 0, 0], [0, 0, 0, 1]], frame="world")
        world.load("block", [[0.5, 0.1, 0.025], [0, 0, 0, 1]])
        arm = world.arm()
        arm.move_to_joints(arm.solve_ik([[0.5, 0.1, 0.025], [1, 0, 0, 0]]))

It needs `pip install 'smachac[sim]'` and knows nothing of the compiler or of SMACH.
"""

from . import robots
from .arm import Arm
from .engine import SimUnavailable, UnknownNameError
from .faults import Fault
from .geometry import grasp_pose
from .models import MODELS
from .placing import check_placed, scattered
from .scene import Event, World
from .settings import close, configure, world
from .skills import Result

__all__ = [
    "MODELS",
    "Arm",
    "Event",
    "Fault",
    "Result",
    "SimUnavailable",
    "UnknownNameError",
    "World",
    "check_placed",
    "close",
    "configure",
    "grasp_pose",
    "robots",
    "scattered",
    "world",
]
