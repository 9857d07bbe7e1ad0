"""How well and how fast the simulated arm picks, places and stacks: `python bench/sim.py`.

Random block and goal poses, one per seed, the same as in a script: inverse kinematics to above the
block, move, straight down, close, look, straight up, and the same again to put it down.
"""

import argparse
import math
import random
import statistics
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from smachac import sim

Pose = list[list[float]]

HOVER: Pose = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
EDGE = 0.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """Where an arm of a robot works: the ranges of x and y (m, base frame), the height of a block
    on the table, the table and its x in the world, and the largest placing error (m)."""

    robot: str
    limb: str
    x: tuple[float, float]
    y: tuple[float, float]
    z: float = EDGE / 2
    table: tuple[str, float] = ("table", 0.6)
    limit: float = 0.002


BAXTER_TABLE = ("cafe_table", 1.0)
PLACES = {
    "panda": Place(robot="panda", limb="arm", x=(0.35, 0.65), y=(-0.3, 0.3)),
    "iiwa": Place(robot="iiwa", limb="arm", x=(0.47, 0.72), y=(-0.28, 0.28)),
    "baxter left": Place(
        robot="baxter", limb="left", x=(0.58, 0.75), y=(-0.05, 0.35), z=-0.13,
        table=BAXTER_TABLE, limit=0.001,
    ),
    "baxter right": Place(
        robot="baxter", limb="right", x=(0.58, 0.75), y=(-0.35, 0.05), z=-0.13,
        table=BAXTER_TABLE, limit=0.001,
    ),
}  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One task: which steps failed, how far (m) each block lies from its goal, the time it took."""

    seed: int
    failures: tuple[str, ...]
    errors: tuple[float, ...]
    resting: bool
    simulated: float
    wall: float
    limit: float

    @property
    def good(self) -> bool:
        """Every step succeeded and every block lies still within the limit of its goal."""
        return not self.failures and self.resting and max(self.errors) < self.limit


def spot(place: Place, draw: random.Random, away: tuple[Pose, ...] = ()) -> Pose:
    """A random pose of a block on the table, at least 12 cm from the others."""
    while True:
        x, y = draw.uniform(*place.x), draw.uniform(*place.y)
        if all(math.dist((x, y), other[0][:2]) > 0.12 for other in away):
            break
    yaw = draw.uniform(-math.pi, math.pi)
    return [[x, y, place.z], [0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)]]


def above(pose: Pose, height: float) -> Pose:
    """The same pose, upright with yaw 0, `height` (m) higher."""
    x, y, z = pose[0]
    return [[x, y, z + height], [0.0, 0.0, 0.0, 1.0]]


def carry(arm: sim.Arm, name: str, goal: Pose) -> Iterator[tuple[str, bool]]:
    """Pick a block where it is and put it down at `goal`: each step and whether it succeeded."""
    pick, place = arm.grasp_pose(arm.world.pose(name)), arm.grasp_pose(goal)
    yield "open", ok(arm.grip("open"))
    for pose, command in ((pick, "close"), (place, "open")):
        joints = arm.solve_ik(pose, HOVER)
        yield "ik", joints is not None
        yield "move", ok(arm.move_to_joints(joints or []))
        yield "down", ok(arm.move_along(pose))
        yield command, ok(arm.grip(command))
        if command == "close":
            yield "check", ok(arm.check_grasp(name))
        yield "up", ok(arm.move_along(pose, HOVER))


def ok(result: sim.Result) -> bool:
    """Whether a skill succeeded."""
    return result.outcome == "succeeded"


def pick_and_place(world: sim.World, place: Place) -> dict[str, Pose]:
    """One block, one goal."""
    start = spot(place, world.random)
    world.load("block", start, "block")
    return {"block": above(spot(place, world.random, (start,)), 0.0)}


def stacking(world: sim.World, place: Place) -> dict[str, Pose]:
    """Two blocks, one on the other at a goal."""
    first = spot(place, world.random)
    second = spot(place, world.random, (first,))
    world.load("block", first, "lower")
    world.load("block", second, "upper")
    goal = spot(place, world.random, (first, second))
    return {"lower": above(goal, 0.0), "upper": above(goal, EDGE)}


Task = Callable[[sim.World, Place], dict[str, Pose]]


def run(task: Task, place: Place, seed: int, record: str | None = None) -> Run:
    """Do a task once."""
    begun = time.perf_counter()
    with sim.World(robot=place.robot, seed=seed, record=record) as world:
        world.load(place.table[0], [place.table[1], 0.0, 0.0], frame="world")
        goals, failures = task(world, place), []
        if record:
            x, y, _ = next(iter(goals.values()))[0]
            world.load("goal", [x, y, place.z])
        for name, goal in goals.items():
            for step, succeeded in carry(world.arm(place.limb), name, goal):
                world.caption = f"sm/{name.upper()}/{step.upper()}"
                if not succeeded:
                    failures.append(f"{name} {step}")
        world.sleep(0.5)
        return Run(
            seed=seed,
            failures=tuple(failures),
            errors=tuple(world.error(name, goal) for name, goal in goals.items()),
            resting=all(world.at_rest(name) for name in goals),
            simulated=world.time,
            wall=time.perf_counter() - begun,
            limit=place.limit,
        )


def report(name: str, runs: list[Run]) -> bool:
    """Print the figures of a task; true when every run was good."""
    errors = [1000 * error for run in runs for error in run.errors]
    good = sum(run.good for run in runs)
    print(
        f"{name:30} {good}/{len(runs)}   error max {max(errors):.2f} mm, mean "
        f"{statistics.mean(errors):.2f} mm   simulated {mean(runs, 'simulated'):.1f} s, "
        f"wall {mean(runs, 'wall'):.2f} s each"
    )
    for run in runs:
        if not run.good:
            print(f"  seed {run.seed}: {', '.join(run.failures) or 'no step failed'}; {run.errors}")
    return good == len(runs)


def mean(runs: list[Run], field: str) -> float:
    """The mean of one figure."""
    figures: list[float] = [getattr(run, field) for run in runs]
    return statistics.mean(figures)


def main() -> int:
    """Run both tasks with every robot over the seeds; 0 when every run was good."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=100, help="seeds per task (default 100)")
    parser.add_argument("--robot", choices=PLACES, help="one of them (default: all)")
    parser.add_argument("--record", help="film seed 0 of stacking into this .gif or .mp4, no more")
    chosen = parser.parse_args()
    if chosen.record:
        place = PLACES[chosen.robot or "panda"]
        return 0 if run(stacking, place, 0, chosen.record).good else 1
    tasks: dict[str, Any] = {"pick and place": pick_and_place, "stacking": stacking}
    good = [
        report(f"{robot}, {name}", [run(task, place, seed) for seed in range(chosen.n)])
        for robot, place in PLACES.items()
        if chosen.robot in (None, robot)
        for name, task in tasks.items()
    ]
    return 0 if all(good) else 1


if __name__ == "__main__":
    raise SystemExit(main())
