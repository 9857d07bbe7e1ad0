"""Runs of the arm examples, with the state of the simulated world at their end."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from smachac import sim
from smachac.driver import analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.runtime.tracing import trace
from smachac.sim import transforms
from smachac.targets.python import TARGET
from tests.support.silent_smach import silent_smach

EXAMPLES = Path(__file__).parents[2] / "examples"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """What came of a run: the outcome, placing errors (m) and rest of the blocks by name, the
    trace without times, the hash of the world."""

    outcome: str | None
    errors: Mapping[str, float]
    at_rest: bool
    events: list[dict[str, Any]] = field(repr=False)
    hash: str


@cache
def program(example: str, replaced: tuple[tuple[str, str], ...] = ()) -> Callable[[], Any]:
    """The `build` function of an example's generated module, its script changed by `replaced`."""
    path = EXAMPLES / example / "main.yml"
    report: list[Any] = []
    source = read_source(path, report)
    assert source is not None
    text = source.text
    for old, new in replaced:
        assert old in text
        text = text.replace(old, new)
    library = disk_library(path, report)
    analysis = analyse(type(source)(source.name, text), library, report)
    assert analysis.checked is not None, analysis.report
    ((name, code),) = build(analysis.checked, TARGET, library, report).items()
    module: dict[str, Any] = {"__name__": "generated"}
    exec(compile(code, name, "exec"), module)
    made: Callable[[], Any] = module["build"]
    return made


def run(
    example: str,
    goals: Mapping[str, str],
    seed: int,
    *,
    faults: tuple[Any, ...] = (),
    replaced: tuple[tuple[str, str], ...] = (),
) -> Run:
    """Run an example; `goals` are the blocks to be judged and the keys of where they belong."""
    events: list[dict[str, Any]] = []

    def observe(event: dict[str, Any]) -> None:
        events.append({key: value for key, value in event.items() if key != "t"})

    robot, scene = ROBOTS.get(example, (None, None))
    with silent_smach(), sim.World(robot=robot, scene=scene, seed=seed, faults=faults) as world:
        machine = program(example, replaced)()
        trace.attach(machine, "sm", observe)
        world.attach(machine, "sm")
        outcome = machine.execute()
        poses = machine.userdata
        return Run(
            outcome=outcome,
            errors={
                name: world.error(name, poses[key])
                for name, key in goals.items()
                if name in world.bodies and key in poses
            },
            at_rest=all(world.at_rest(name) for name in goals if name in world.bodies),
            events=events,
            hash=world.hash(),
        )


ROBOTS: Mapping[str, tuple[str, Path | None]] = {
    "10_baxter_pick_and_place": ("baxter", None),
    "11_baxter_stacking": ("baxter", None),
    "12_dual_arm_stacking": ("baxter", EXAMPLES / "12_dual_arm_stacking" / "table.yml"),
    "13_recovery": ("baxter", EXAMPLES / "13_recovery" / "table.yml"),
}
"""The robot and the scene of each example that has no Panda."""

PICK_AND_PLACE = ("08_pick_and_place", {"block": "goal_pose"})
STACKING = ("09_stacking", {"first": "goal_pose", "second": "top_pose"})
BAXTER_STACKING = ("11_baxter_stacking", {"first": "goal_pose", "second": "top_pose"})
DUAL_ARM = ("12_dual_arm_stacking", {"first": "goal_pose", "second": "top_pose"})
RECOVERY = ("13_recovery", {"block": "goal_pose"})


GROUND = {"baxter": (-0.13, "cafe_table", 1.0), "iiwa": (0.025, "table", 0.55)}
"""Height of a block in the base frame, table, and where it stands (x)."""


def carry(robot: str, limb: str, seed: int) -> float:
    """Carry a block between two random poses: its distance from the goal at the end (m).

    NaN if a movement fails or the block does not come to rest.
    """
    z, table, x = GROUND[robot]
    sign = -1 if limb == "right" else 1
    with sim.World(robot=robot, seed=seed) as world:
        world.load(table, [x, 0, 0], frame="world")

        def pose() -> list[list[float]]:
            place = [world.random.uniform(0.58, 0.72), sign * world.random.uniform(0.0, 0.3), z]
            return [place, list(transforms.about_z(world.random.uniform(-math.pi, math.pi)))]

        start, goal = pose(), pose()
        while math.dist(start[0], goal[0]) < 0.12:
            goal = pose()
        world.load("block", start)
        arm, hover = world.arm(limb), [[0, 0, 0.12], [0, 0, 0, 1]]
        outcomes = [arm.grip("open").outcome]
        for where, command in ((arm.grasp_pose(start), "close"), (arm.grasp_pose(goal), "open")):
            moves = [
                arm.move_to_joints(arm.solve_ik(where, hover) or []),
                arm.move_along(where),
                arm.grip(command),
                arm.move_along(where, hover),
            ]
            outcomes += [move.outcome for move in moves]
        fine = set(outcomes) == {"succeeded"} and world.at_rest("block")
        return world.error("block", goal) if fine else math.nan
