"""The generated programs move the arm; success is judged by looking at the world."""

from __future__ import annotations

import math

import pytest

from smachac.robots.faults import Fault
from tests.support.arm_examples import (
    BAXTER_STACKING,
    DUAL_ARM,
    PICK_AND_PLACE,
    RECOVERY,
    STACKING,
    run,
)
from tests.support.examples import seeds

LIMIT = 0.002
"""The largest placing error, in metres."""


@pytest.mark.parametrize("seed", seeds(1, 2, 4))
def test_pick_and_place(seed: int) -> None:
    found = run(*PICK_AND_PLACE, seed)
    assert found.outcome == "succeeded"
    assert found.at_rest
    assert found.errors["block"] < LIMIT


@pytest.mark.parametrize("seed", seeds(1, 2, 3))
def test_stacking(seed: int) -> None:
    found = run(*STACKING, seed)
    assert found.outcome == "succeeded"
    assert found.at_rest
    assert len(found.errors) == 2
    assert max(found.errors.values()) < LIMIT


def test_same_seed_same_trace_same_world() -> None:
    first, second, other = (run(*PICK_AND_PLACE, seed) for seed in (3, 3, 4))
    assert first.events == second.events
    assert first.hash == second.hash != other.hash


def visited(events: list[dict[str, object]]) -> list[str]:
    return [str(event["path"]) for event in events if event["event"] == "enter"]


def test_a_pose_out_of_reach_ends_in_the_recovery() -> None:
    far = ("spread: [0.14, 0.28, 3.1416]", "spread: [0.0, 0.0, 0.0]")
    far_pose = ("block_pose: [[0.5, 0.0, 0.025]", "block_pose: [[1.5, 0.0, 0.025]")
    found = run(*PICK_AND_PLACE, 0, replaced=(far, far_pose))
    assert found.outcome == "aborted"
    assert visited(found.events)[-2:] == ["sm/LET_GO", "sm/RETREAT"]
    assert "sm/PICK_BLOCK/PLAN_HOVER" in visited(found.events)


def test_a_block_that_vanishes_is_noticed() -> None:
    found = run(
        *PICK_AND_PLACE,
        0,
        faults=({"kind": "remove_body", "target": "block", "state": "PICK_BLOCK/CLOSE_GRIPPER"},),
    )
    assert found.outcome == "aborted"
    assert "sm/PLACE_BLOCK" not in visited(found.events)
    assert visited(found.events)[-1] == "sm/RETREAT"


@pytest.mark.parametrize("way", [(0.02, 0.0, 0.0), (0.0, 0.02, 0.0)])
def test_a_displaced_block_never_counts_as_placed(way: tuple[float, ...]) -> None:
    found = run(
        *PICK_AND_PLACE,
        0,
        faults=(
            {"kind": "move_body", "target": "block", "value": list(way), "state": "MOVE_TO_START"},
        ),
    )
    assert found.outcome == "aborted"


@pytest.mark.parametrize("seed", seeds(1, 2, 5))
@pytest.mark.parametrize("example", [BAXTER_STACKING, DUAL_ARM], ids=["one arm", "both arms"])
def test_baxter_stacks_within_1_mm(example: tuple[str, dict[str, str]], seed: int) -> None:
    found = run(*example, seed)
    assert found.outcome == "succeeded"
    assert found.at_rest
    assert len(found.errors) == 2
    assert max(found.errors.values()) < 0.001


@pytest.mark.slow
def test_both_arms_move_at_once_and_always_the_same_way() -> None:
    first, second = (run(*DUAL_ARM, 3) for _ in range(2))
    assert first.events == second.events
    assert first.hash == second.hash
    paths = visited(first.events)
    entered = [path.split("/")[2] for path in paths if path.startswith("sm/PICK_BLOCKS/")]
    assert entered != sorted(entered)  # the two arms alternate


def test_the_script_as_printed_places_the_block() -> None:
    found = run("10_baxter_pick_and_place", {}, 0)
    assert found.outcome == "succeeded"
    with_goal = run("10_baxter_pick_and_place", {"block": "block_model_place_pose"}, 0)
    # The origin of the block is a corner, and the pick pose is 1 to 3 mm beside its centre.
    assert with_goal.errors["block"] == pytest.approx(math.dist([0.025] * 3, [0] * 3), abs=0.003)


SLIP = Fault(kind="gripper_slips", target="left", state="PICK_BLOCK/LIFT")
HANG = Fault(kind="never_returns", target="left", state="PLACE_BLOCK/MOVE_TO_HOVER")
LOCK = Fault(kind="lock_joint", target="left_e1", at=0.5)


@pytest.mark.parametrize(
    ("fault", "tries"), [(SLIP, 2), (HANG, 2), (LOCK, 4)], ids=["slip", "hang", "lock"]
)
@pytest.mark.slow
def test_the_machine_recovers(fault: Fault, tries: int) -> None:
    found = run(*RECOVERY, 1, faults=(fault,))
    assert found.outcome == "succeeded"
    assert found.errors["block"] < 0.001
    assert sum(path.endswith("/FIND_BLOCK") for path in visited(found.events)) == tries


def test_a_crash_of_the_world_is_an_exception() -> None:
    crash = Fault(kind="crash", state="PICK_BLOCK/LIFT")
    with pytest.raises(Exception, match="crashed"):
        run(*RECOVERY, 1, faults=(crash,))
