"""A simulated world in PyBullet: robot arms with skills, one clock, injected faults, films.

    with sim.World(seed=1) as world:
        world.load("table", [[0.6, 0, 0], [0, 0, 0, 1]], frame="world")
        world.load("block", [[0.5, 0.1, 0.025], [0, 0, 0, 1]])
        arm = world.arm()
        arm.move_to_joints(arm.solve_ik([[0.5, 0.1, 0.025], [1, 0, 0, 0]]))

It needs `pip install 'smachac[sim]'` and imports nothing of the compiler or of SMACH. Each module
imports only modules before it: transforms, physics, outcome, clock; robot_file, loading; models,
robots; inverse_kinematics; joint_control, skills, scene; arm; faults, video, tasks; world.

The settings of `configure` and the open worlds are process-wide state; see `world`.
"""

from smachac.sim import robots
from smachac.sim.arm import Arm
from smachac.sim.faults import Fault
from smachac.sim.models import MODELS
from smachac.sim.outcome import Result
from smachac.sim.physics import SimUnavailable, UnknownNameError
from smachac.sim.robot_file import LoadError
from smachac.sim.scene import Event
from smachac.sim.tasks import check_placed, scattered
from smachac.sim.transforms import as_pose, grasp_pose
from smachac.sim.world import World, close, configure, open_world, world

__all__ = [
    "MODELS",
    "Arm",
    "Event",
    "Fault",
    "LoadError",
    "Result",
    "SimUnavailable",
    "UnknownNameError",
    "World",
    "as_pose",
    "check_placed",
    "close",
    "configure",
    "grasp_pose",
    "open_world",
    "robots",
    "scattered",
    "world",
]
