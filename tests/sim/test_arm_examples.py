"""The generated programs move the arm; success is judged by looking at the world."""

from __future__ import annotations

import pytest

from tests.support.arm_examples import PICK_AND_PLACE, STACKING, run

LIMIT = 0.002
"""The largest placing error, in metres."""


@pytest.mark.parametrize("seed", range(5))
def test_pick_and_place(seed: int) -> None:
    found = run(*PICK_AND_PLACE, seed)
    assert found.outcome == "succeeded"
    assert found.at_rest
    assert found.errors["block"] < LIMIT


@pytest.mark.parametrize("seed", range(3))
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
