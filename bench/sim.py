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

TABLE: Pose = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
HOVER: Pose = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]
EDGE = 0.05
GOOD = 0.002


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One task: which steps failed, how far (m) each block lies from its goal, the time it took."""

    seed: int
    failures: tuple[str, ...]
    errors: tuple[float, ...]
    resting: bool
    simulated: float
    wall: float

    @property
    def good(self) -> bool:
        """Every step succeeded and every block lies still within 2 mm of its goal."""
        return not self.failures and self.resting and max(self.errors) < GOOD


def spot(draw: random.Random, away: tuple[Pose, ...] = ()) -> Pose:
    """A random pose of a block on the table, at least 12 cm from the others."""
    while True:
        x, y = draw.uniform(0.35, 0.65), draw.uniform(-0.3, 0.3)
        if all(math.dist((x, y), other[0][:2]) > 0.12 for other in away):
            break
    yaw = draw.uniform(-math.pi, math.pi)
    return [[x, y, EDGE / 2], [0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)]]


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


def pick_and_place(world: sim.World) -> dict[str, Pose]:
    """One block, one goal."""
    start = spot(world.random)
    world.load("block", start, "block")
    return {"block": above(spot(world.random, (start,)), 0.0)}


def stacking(world: sim.World) -> dict[str, Pose]:
    """Two blocks, one on the other at a goal."""
    first = spot(world.random)
    second = spot(world.random, (first,))
    world.load("block", first, "lower")
    world.load("block", second, "upper")
    goal = spot(world.random, (first, second))
    return {"lower": above(goal, 0.0), "upper": above(goal, EDGE)}


def run(task: Callable[[sim.World], dict[str, Pose]], seed: int, record: str | None = None) -> Run:
    """Do a task once."""
    begun = time.perf_counter()
    with sim.World(seed=seed, record=record) as world:
        world.load("table", [[0.6, 0.0, 0.0], [0, 0, 0, 1]], frame="world")
        goals, failures = task(world), []
        if record:
            x, y, _ = next(iter(goals.values()))[0]
            world.load("goal", [[x, y, EDGE / 2], [0, 0, 0, 1]])
        for name, goal in goals.items():
            for step, succeeded in carry(world.arm(), name, goal):
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
        )


def report(name: str, runs: list[Run]) -> bool:
    """Print the figures of a task; true when every run was good."""
    errors = [1000 * each for run in runs for each in run.errors]
    good = sum(run.good for run in runs)
    print(
        f"{name:15} {good}/{len(runs)}   error max {max(errors):.2f} mm, mean "
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
    """Run both tasks over the seeds; 0 when every run was good."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-n", type=int, default=100, help="seeds per task (default 100)")
    parser.add_argument("--record", help="film seed 0 of stacking into this .gif or .mp4, no more")
    chosen = parser.parse_args()
    if chosen.record:
        return 0 if run(stacking, 0, chosen.record).good else 1
    tasks: dict[str, Any] = {"pick and place": pick_and_place, "stacking": stacking}
    good = [
        report(name, [run(task, seed) for seed in range(chosen.n)]) for name, task in tasks.items()
    ]
    return 0 if all(good) else 1


if __name__ == "__main__":
    raise SystemExit(main())
