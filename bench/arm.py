"""The generated programs of the examples for simulated arms over many seeds: how often they
succeed, judged by looking at the world, and how far from their goals the blocks lie.

    python bench/arm.py [seeds [part of a name]]
"""

from __future__ import annotations

import contextlib
import io
import math
import sys
import time
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.support.arm_examples import (
    BAXTER_STACKING,
    DUAL_ARM,
    PICK_AND_PLACE,
    STACKING,
    Run,
    carry,
    run,
)

PANDA_LIMIT, BAXTER_LIMIT = 0.002, 0.001
"""The largest placing errors (m)."""
EXAMPLES = (
    (*PICK_AND_PLACE, PANDA_LIMIT),
    (*STACKING, PANDA_LIMIT),
    (*BAXTER_STACKING, BAXTER_LIMIT),
    (*DUAL_ARM, BAXTER_LIMIT),
)
ARMS = (
    ("baxter", "left", BAXTER_LIMIT),
    ("baxter", "right", BAXTER_LIMIT),
    ("iiwa", "arm", PANDA_LIMIT),
)
"""Arms that carry a block between two random poses."""


def one(job: tuple[str, dict[str, str], int]) -> Run:
    with contextlib.redirect_stdout(io.StringIO()):
        return run(*job)


def carry_one(job: tuple[str, str, int]) -> float:
    with contextlib.redirect_stdout(io.StringIO()):
        return carry(*job)


def main() -> None:
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    wanted = sys.argv[2] if len(sys.argv) > 2 else ""
    with ProcessPoolExecutor(max_workers=2) as pool:
        for example, goals, limit in EXAMPLES:
            if wanted not in example:
                continue
            began = time.perf_counter()
            runs = list(pool.map(one, [(example, goals, seed) for seed in range(seeds)]))
            good = [
                found.outcome == "succeeded"
                and found.at_rest
                and len(found.errors) == len(goals)
                and max(found.errors.values()) < limit
                for found in runs
            ]
            print_count(example, good)
            for name in goals:
                print_errors(name, [found.errors.get(name, math.nan) for found in runs])
            print(f"  {(time.perf_counter() - began) / seeds:.2f} s of wall time a run", flush=True)
        for robot, limb, limit in ARMS:
            name = f"{robot}, {limb}"
            if wanted not in name:
                continue
            errors = list(pool.map(carry_one, [(robot, limb, seed) for seed in range(seeds)]))
            print_count(name, [error < limit for error in errors])
            print_errors("block", errors)


def print_count(name: str, good: Sequence[bool]) -> None:
    bad = [seed for seed, fine in enumerate(good) if not fine]
    print(f"{name}: {sum(good)} of {len(good)} seeds" + (f", not {bad}" if bad else ""))


def print_errors(name: str, errors: Sequence[float]) -> None:
    """The largest and the mean error, of metres."""
    largest, mean = 1000 * max(errors), 1000 * sum(errors) / len(errors)
    print(f"  {name}: error at most {largest:.2f} mm, {mean:.2f} mm on average", flush=True)


if __name__ == "__main__":
    main()
