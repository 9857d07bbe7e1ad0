"""The poses of the simulated arm that a script gives as numbers, and a solver that checks them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import TypeAlias

from smachac.analysis.context import Context
from smachac.analysis.type_inference import Cell, TypeFlow, Types
from smachac.checks.findings.literals import literal_finding, reader
from smachac.diagnostics.diagnostic import Finding, Problem, Report, Severity, problem
from smachac.ir.leaf import key_names, variable_of
from smachac.ir.nodes import Data, Leaf, Machine, Node, is_number
from smachac.ir.traversal import remapping
from smachac.records import dataclass

Numbers: TypeAlias = "list[Numbers] | float"


@dataclass(frozen=True, slots=True, kw_only=True)
class Reach:
    """A goal pose of the tool in the frame of the base; `flow` is its literal.

    `limb` is the name of the arm, None for the only one. `grasp`: it is the pose of a body that is
    grasped from above.
    """

    flow: TypeFlow
    limb: str | None
    pose: Numbers
    offset: Numbers | None
    grasp: bool


@problem(
    "SM506",
    "out-of-reach",
    Severity.WARNING,
    effect="the state ends with `aborted`, and the arm does not move there",
)
def out_of_reach(flow: TypeFlow, point: str) -> Finding:
    """The simulated arm cannot move its tool to a pose.

    The state ends with `aborted`, and the arm stays where it was.

    Exactly: `smachac check --sim` runs the solver of the simulation for each pose that the script
    gives as numbers to a state that moves the arm, with the offset of the state if that is given as
    numbers too. A pose without this finding can still be behind an obstacle.

    Wrong:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {goal: [[1.9, 0.0, 0.1], [1.0, 0.0, 0.0, 0.0]]}
        states:
          - GO:
              template: MoveAlongState
              remapping: {pose: goal}
              transitions: {succeeded: done, aborted: failed, preempted: failed}

    Right:
        name: sm
        template: PyBulletBase
        outcomes: [done, failed]
        userdata: {goal: [[0.5, 0.0, 0.1], [1.0, 0.0, 0.0, 0.0]]}
        states:
          - GO:
              template: MoveAlongState
              remapping: {pose: goal}
              transitions: {succeeded: done, aborted: failed, preempted: failed}
    """
    message = f"{reader(flow)} cannot reach {point}: no joint positions bring the tool to this pose"
    help = "move the pose closer to the base of the robot (in metres), or change its rotation"
    return literal_finding(flow, message, help, (reader(flow).strip("`"), point))


def poses_to_reach(context: Context) -> Iterator[Reach]:
    """The poses that states certainly command to the simulated arm."""
    robot = context.machine.robot
    base = context.machine.state_types.get(context.machine.base)
    simulated = base is not None and base.simulation
    if not simulated or robot is None or not robot.description:
        return
    types = context.types
    literals: dict[Cell, list[TypeFlow]] = {}
    for flow in types.constants:
        literals.setdefault(flow.cell, []).append(flow)
    for path, container in context.containers:
        for leaf in container.children:
            for key in leaf.inputs if isinstance(leaf, Leaf) else ():
                if key.role == "goal_pose":
                    yield from _reaches(types, literals, path, leaf, key.name)


def _reaches(
    types: Types, literals: Mapping[Cell, list[TypeFlow]], path: str, leaf: Node, goal: str
) -> Iterator[Reach]:
    """The poses that the input `goal` of a leaf brings it to."""
    assert isinstance(leaf, Leaf)
    cell = types.cells.get((f"{path}/{leaf.name}", goal))
    offsets = _offsets(types, path, leaf)
    limb, grasp = variable_of(leaf, "limb"), variable_of(leaf, "grasp")
    if cell is None or len(offsets) != 1:
        return
    name = limb.value.data if limb is not None else None
    if not isinstance(name, str | None):
        return
    for flow in literals.get(cell, ()):
        pose = _numbers(flow.value)
        if pose is not None:
            held = grasp is not None and grasp.value.data is True
            yield Reach(flow=flow, limb=name, pose=pose, offset=offsets[0], grasp=held)


def _offsets(types: Types, path: str, leaf: Leaf) -> list[Numbers | None]:
    """The possible offsets of a state (None: the key is absent); empty if they are unknown."""
    names, cell = remapping(leaf), None
    for key in key_names(leaf.inputs, "goal_offset"):
        cell = types.cells.get((path, names[key]))
    flows = [flow for alike in cell.flows.values() for flow in alike] if cell is not None else []
    found: list[Numbers | None] = []
    for flow in flows:
        offset = _numbers(flow.value)
        if flow.how != "value" or (offset is None and flow.value is not None):
            return []
        if offset not in found:
            found.append(offset)
    return found or [None]


def _numbers(data: Data) -> Numbers | None:
    """A literal as numbers; None where it holds anything else."""
    if isinstance(data, tuple):
        inner = [_numbers(item) for item in data]
        kept = [item for item in inner if item is not None]
        return kept if len(kept) == len(inner) else None
    return float(data) if is_number(data) and abs(data) < 1e300 else None


class NoSimulationError(Exception):
    """The simulation is not installed; the message describes how to install it."""


def unreachable(machine: Machine) -> Report:
    """SM506 for the poses of a machine; the solver runs once for each different pose.

    Raises NoSimulationError. The simulation starts only if there is a pose to check.
    """
    wanted = list(poses_to_reach(Context(machine)))
    if not wanted:
        return []
    from smachac.sim import SimUnavailable

    robot = machine.robot
    assert robot is not None
    folder = Path(robot.span.source.name).parent
    try:
        return _solved(wanted, robot.description, folder)
    except SimUnavailable as error:
        raise NoSimulationError(str(error)) from error


def _solved(wanted: Iterable[Reach], name: str, folder: Path) -> Report:
    """SM506 for the poses out of reach of the robot `name`, whose files are in `folder`."""
    from smachac.sim import robots
    from smachac.sim.inverse_kinematics import Kinematics
    from smachac.sim.transforms import (
        IDENTITY,
        Pose,
        as_pose,
        compose,
        grasp_pose,
        inverse,
        shifted,
    )

    robot = robots.load(name, folders=[folder])
    arms = [(part, limb) for part in robot.parts for limb in part.limbs]
    solvers: dict[str, Kinematics] = {}
    known: dict[tuple[str, Pose], bool] = {}
    found: Report = []
    for reach in wanted:
        named = [arm for arm in arms if arm[1].name == reach.limb]
        part, limb = (named or arms)[0]
        if not named and (reach.limb is not None or len(arms) > 1):
            continue
        try:
            pose = as_pose(grasp_pose(reach.pose, limb.grasp) if reach.grasp else reach.pose)
            pose = shifted(pose, IDENTITY if reach.offset is None else as_pose(reach.offset))
        except ValueError:
            continue
        key = limb.name, pose
        if key not in known:
            if part.name not in solvers:
                solvers[part.name] = Kinematics(part)
            goal = compose(inverse(part.base), compose(robot.base, pose))
            known[key] = solvers[part.name].solve(limb, goal) is not None
        if not known[key]:
            point = ", ".join(f"{number:.3f}" for number in pose[0])
            found.append(out_of_reach(reach.flow, f"({point})"))
    return found


PROBLEMS: tuple[Problem[...], ...] = (out_of_reach,)
"""The problems of this module, in the order of their codes."""
