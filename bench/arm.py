"""The generated programs of the examples for simulated arms over many seeds: how often they
succeed, judged by looking at the world, and how far from their goals the blocks lie.

    python bench/arm.py [seeds]
"""

from __future__ import annotations

import contextlib
import io
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.support.arm_examples import (
    BAXTER_STACKING,
    DUAL_ARM,
    PICK_AND_PLACE,
    STACKING,
    Run,
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


def one(job: tuple[str, dict[str, str], int]) -> Run:
    with contextlib.redirect_stdout(io.StringIO()):
        return run(*job)


def main() -> None:
    seeds = int(sys.argv[1]) if len(sys.argv) > 1 else 100
    with ProcessPoolExecutor(max_workers=2) as pool:
        for example, goals, limit in EXAMPLES:
            began = time.perf_counter()
            runs = list(pool.map(one, [(example, goals, seed) for seed in range(seeds)]))
            good = [
                found.outcome == "succeeded"
                and found.at_rest
                and len(found.errors) == len(goals)
                and max(found.errors.values()) < limit
                for found in runs
            ]
            bad = [seed for seed, fine in enumerate(good) if not fine]
            print(f"{example}: {sum(good)} of {seeds} seeds" + (f", not {bad}" if bad else ""))
            for name in goals:
                errors = [1000 * found.errors.get(name, float("nan")) for found in runs]
                mean = sum(errors) / seeds
                print(f"  {name}: error at most {max(errors):.2f} mm, {mean:.2f} mm on average")
            print(f"  {(time.perf_counter() - began) / seeds:.2f} s of wall time a run")


if __name__ == "__main__":
    main()
