"""A small, honest world in PyBullet: arms with skills, one clock, faults, films.

    with sim.World(seed=1) as world:
        world.load("table", [[0.6, 0, 0], [0, 0, 0, 1]], frame="world")
        world.load("block", [[0.5, 0.1, 0.025], [0, 0, 0, 1]])
        arm = world.arm()
        arm.move_to_joints(arm.solve_ik([[0.5, 0.1, 0.025], [1, 0, 0, 0]]))

It needs `pip install 'smachac[sim]'` and knows nothing of the compiler or of SMACH.
"""

from smachac.sim import robots
from smachac.sim.arm import Arm
from smachac.sim.faults import Fault
from smachac.sim.models import MODELS
from smachac.sim.physics import SimUnavailable, UnknownNameError
from smachac.sim.skills import Result
from smachac.sim.tasks import check_placed, scattered
from smachac.sim.transforms import grasp_pose
from smachac.sim.world import Event, World, close, configure, world

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
