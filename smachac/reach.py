"""Asks the simulation whether its arm can reach what a script gives it (`check --sim`)."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.checks.reach import Reach, out_of_reach, poses_to_reach
from smachac.diagnostics import Report
from smachac.ir.nodes import Machine


class NoSimulationError(Exception):
    """The simulation is not installed; the words say how to get it."""


def unreachable(machine: Machine) -> Report:
    """SM506 for the poses of a machine; one solution is looked for, for each different one.

    Raises NoSimulationError. The simulation starts only if there is a pose to ask.
    """
    wanted = list(poses_to_reach(machine))
    if not wanted:
        return []
    from smachac.sim import SimUnavailable

    try:
        return _asked(wanted)
    except SimUnavailable as error:
        raise NoSimulationError(str(error)) from error


def _asked(wanted: Iterable[Reach]) -> Report:
    from smachac.sim import robots
    from smachac.sim.geometry import IDENTITY, Pose, as_pose, grasp_pose, shifted
    from smachac.sim.ik import Shadow

    robot = robots.panda()
    (limb,) = robot.limbs
    known: dict[Pose, bool] = {}

    def goal(each: Reach) -> Pose | None:
        try:
            pose = as_pose(grasp_pose(each.pose, limb.turn) if each.grasp else each.pose)
            return shifted(pose, IDENTITY if each.offset is None else as_pose(each.offset))
        except ValueError:
            return None

    found: Report = []
    shadow = Shadow(robot)
    try:
        for each in wanted:
            pose = goal(each)
            if pose is None:
                continue
            if pose not in known:
                known[pose] = shadow.solve(limb, pose) is not None
            if not known[pose]:
                place = ", ".join(f"{number:.3f}" for number in pose[0])
                found.append(out_of_reach(each.flow, f"({place})"))
    finally:
        shadow.close()
    return found
