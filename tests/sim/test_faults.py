"""Faults: each strikes when it is to, is named, and is found by the skill that can find it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac import sim
from smachac.commands.cli import main
from smachac.commands.run import read_fault_file
from smachac.sim import faults
from smachac.sim.faults import Fault, FaultSchedule

pytest.importorskip("pybullet")

TABLE = [[0.6, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
BLOCK = [[0.5, 0.1, 0.025], [0.0, 0.0, 0.0, 1.0]]
HOVER = [[0.0, 0.0, 0.15], [0.0, 0.0, 0.0, 1.0]]


def pick(world: sim.World) -> list[str]:
    """Pick up a block, naming the steps as states: those steps that did not succeed."""
    arm = world.arm()
    pose = arm.grasp_pose(BLOCK)
    steps: dict[str, Callable[[], sim.Result]] = {
        "OPEN": lambda: arm.grip("open"),
        "MOVE": lambda: arm.move_to_joints(arm.solve_ik(pose, HOVER) or []),
        "DOWN": lambda: arm.move_along(pose),
        "CLOSE": lambda: arm.grip("close"),
        "UP": lambda: arm.move_along(pose, HOVER),
        "CHECK": lambda: arm.check_grasp("block"),
    }
    failed = []
    for name, step in steps.items():
        world.enter([f"sm/PICK/{name}"])
        if step().outcome != "succeeded":
            failed.append(name)
    return failed


@pytest.mark.parametrize(
    ("fault", "found"),
    [
        ({"kind": "remove_body", "target": "block", "state": "MOVE"}, ["CLOSE", "CHECK"]),
        (
            {"kind": "move_body", "target": "block", "value": [0, 0.3, 0], "state": "PICK/DOWN"},
            ["CLOSE", "CHECK"],
        ),
        ({"kind": "gripper_dead", "state": "sm/PICK/CLOSE"}, ["CLOSE", "CHECK"]),
        ({"kind": "grip_force", "value": 0.0, "state": "UP"}, ["CHECK"]),
    ],
)
def test_what_goes_wrong_is_found(fault: dict[str, Any], found: list[str]) -> None:
    with sim.World(seed=0, faults=[fault]) as world:
        world.load("table", TABLE, frame="world")
        world.load("block", BLOCK)
        assert pick(world) == found
        struck = [event for event in world.events if event.name == "fault"]
        assert [event.text.split()[0] for event in struck] == [fault["kind"]]
        assert struck[0].time > 0.0


def test_a_locked_joint_is_found_on_the_way() -> None:
    fault = Fault(kind="lock_joint", target="panda_joint1", at=0.2)
    with sim.World(seed=0, faults=[fault]) as world:
        arm = world.arm()
        result = arm.move_to_joints(arm.solve_ik([[0.4, 0.4, 0.1], [1, 0, 0, 0]]) or [])
        assert result == sim.Result("aborted", "panda_joint1 does not follow")
        assert world.events[0] == sim.Event(48 / 240, "fault", "lock_joint panda_joint1")
        assert world.time < 1.5


def test_a_fault_on_what_is_not_there_is_said_and_changes_nothing() -> None:
    wrong = [
        {"kind": "remove_body", "target": "spoon", "at": 0.1},
        {"kind": "lock_joint", "target": "elbow", "at": 0.1},
    ]
    with sim.World(seed=0, faults=wrong) as world:
        assert world.sleep(0.2).outcome == "succeeded"
        texts = [event.text for event in world.events]
        assert texts[0] == "remove_body did not happen: no body `spoon`; known: none"
        assert texts[1].startswith("lock_joint did not happen: no joint `elbow`; known: `panda_j")


def test_configured_faults_come_to_every_world() -> None:
    sim.configure(faults=[Fault(kind="gripper_dead", at=0.0)])
    try:
        with sim.World() as world:
            world.arm().grip("close")
            assert world.events[0].text == "gripper_dead"
    finally:
        sim.configure()


def test_a_probability_is_drawn_from_the_seed() -> None:
    fault = Fault(kind="gripper_dead", at=0.0, probability=0.3)
    drawn = [len(FaultSchedule([fault], seed)._pending) for seed in range(300)]
    assert drawn == [len(FaultSchedule([fault], seed)._pending) for seed in range(300)]
    assert 60 < sum(drawn) < 120
    one, two = FaultSchedule([fault], 0), FaultSchedule([fault, fault], 0)
    assert len(one._pending) == len(two._pending[:1])


@pytest.mark.parametrize(
    ("fault", "reason"),
    [
        ({"kind": "meteor", "at": 1.0}, "no fault kind `meteor`"),
        ({"kind": "gripper_dead"}, "needs either `at` or `state`"),
        ({"kind": "gripper_dead", "at": 1.0, "state": "X"}, "needs either `at` or `state`"),
        ({"kind": "gripper_dead", "when": 1.0}, "the key `when` is unknown"),
    ],
)
def test_what_is_no_fault_is_refused(fault: dict[str, Any], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        faults.read([fault])


def test_no_pose_is_solved_once() -> None:
    with sim.World(seed=0, faults=[Fault(kind="no_ik", state="PLAN")]) as world:
        world.enter(["sm/PLAN"])
        assert world.arm().solve_ik([BLOCK[0], [1.0, 0.0, 0.0, 0.0]]) is None
        assert world.arm().solve_ik([BLOCK[0], [1.0, 0.0, 0.0, 0.0]]) is not None
        assert [event.text for event in world.events if event.name == "fault"] == ["no_ik"]


def test_a_weak_joint_does_not_follow() -> None:
    fault = Fault(kind="weak_joint", target="panda_joint2", value=2.0, at=0.0)
    with sim.World(seed=0, faults=[fault]) as world:
        arm = world.arm()
        result = arm.move_to_joints(arm.solve_ik([[0.6, 0.0, 0.1], [1, 0, 0, 0]]) or [])
        assert result == sim.Result("aborted", "panda_joint2 does not follow")


def test_measured_poses_have_noise_of_the_seed() -> None:
    def measured(seed: int) -> list[list[float]]:
        with sim.World(seed=seed, faults=[Fault(kind="sensor_noise", value=0.01, at=0)]) as world:
            world.load("block", BLOCK)
            world.sleep(0.01)
            assert world.measured_pose("block") != world.pose("block")
            return world.measured_pose("block")

    assert measured(1) == measured(1) != measured(2)


def test_a_skill_that_never_returns_can_be_preempted() -> None:
    with sim.World(seed=0, faults=[Fault(kind="never_returns", state="MOVE")]) as world:
        world.enter(["sm/MOVE"])
        arm = world.arm()
        result = arm.move_to_joints(arm.limb.home, preempted=lambda: world.time > 3.0)
        assert result.outcome == "preempted"
        assert arm.move_to_joints(arm.limb.home).outcome == "succeeded"


def test_a_slip_is_drawn_at_each_visit() -> None:
    slips = Fault(kind="gripper_slips", state="CLOSE", probability=0.5, each_time=True)
    with sim.World(seed=1, faults=[slips]) as world:
        for _ in range(40):
            world.enter(["sm/OPEN"])
            world.enter(["sm/CLOSE", "sm/OTHER"], began="sm/CLOSE")
            world.enter(["sm/CLOSE", "sm/OTHER"], began="sm/OTHER")
            world.sleep(0.01)
        assert 10 < len(world.events) < 30


FILE = """
faults:
  - {{kind: gripper_slips, state: CLOSE, {entry}}}
"""


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        ("probability: 30", "a probability from 0 to 1 is expected, not 30"),
        ("value: 1", "fault `gripper_slips` has no `value`"),
        ("at: 1", "needs either `at` or `state`"),
        ("each_time: often", "`true` or `false` is expected"),
    ],
)
def test_a_wrong_file_is_a_diagnostic_with_its_place(
    entry: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "faults.yml").write_text(FILE.format(entry=entry))
    example = Path(__file__).parents[2] / "examples" / "13_recovery" / "main.yml"
    assert main(["run", str(example), "--faults", str(tmp_path / "faults.yml"), "-q"]) == 1
    printed = capsys.readouterr().err
    assert message in printed
    assert "faults.yml:3:" in printed


def test_faults_are_events_of_the_trace(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = Path(__file__).parents[2] / "examples" / "13_recovery"
    arguments = ["run", str(folder / "main.yml"), "--faults", str(folder / "locked.yml"), "-q"]
    trace = tmp_path / "trace.jsonl"
    assert main([*arguments, "--trace", str(trace), "--expect", "succeeded"]) == 0
    events = [json.loads(line) for line in trace.read_text().splitlines()]
    (found,) = [event for event in events if event["event"] == "fault"]
    assert found["fault"] == "lock_joint left_e1"
    assert found["sim_time"] == 0.5
    assert found["during"][0].endswith("PICK_BLOCK/OPEN_GRIPPER")
    assert capsys.readouterr().out.endswith("outcome: succeeded\n")


RECOVERY = Path(__file__).parents[2] / "examples" / "13_recovery" / "main.yml"


@pytest.mark.parametrize(
    ("state", "message", "help"),
    [
        ("FIND_BLOK", "there is no state `FIND_BLOK`", "did you mean `FIND_BLOCK`?"),
        ("LEFT/TRY/LIFT", "there is no state `LEFT/TRY/LIFT`", None),
        ("recovery/LEFT", "`recovery/LEFT` is a container", "name one of its states"),
        ("TRY", "`TRY` is a container", "name one of its states"),
    ],
)
@pytest.mark.parametrize("command", ["run", "sweep --runs 1 --jobs 1"])
def test_a_fault_for_a_state_that_does_not_exist(
    state: str,
    message: str,
    help: str | None,
    command: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = f"faults:\n  - {{kind: crash, at: 1}}\n  - {{kind: crash, state: {state}}}\n"
    (tmp_path / "faults.yml").write_text(text)
    name, *options = command.split()
    assert main([name, str(RECOVERY), *options, "--faults", str(tmp_path / "faults.yml")]) == 1
    printed = capsys.readouterr().err
    assert message in printed
    assert "faults.yml:3:26" in printed
    assert help is None or help in printed
    assert "so nothing is run" in printed


@pytest.mark.parametrize(
    ("state", "full"),
    [
        ("recovery/LEFT/TRY/FIND_BLOCK", "recovery/LEFT/TRY/TRY/FIND_BLOCK"),
        ("LEFT/TRY/FIND_BLOCK", "recovery/LEFT/TRY/TRY/FIND_BLOCK"),
        ("FIND_MARK", "recovery/FIND_MARK"),
        ("FIND_BLOCK", "FIND_BLOCK"),  # two states: the fault happens at the first that begins
    ],
)
def test_the_state_of_a_fault_is_named_as_in_the_script(
    state: str, full: str, tmp_path: Path
) -> None:
    path = tmp_path / "faults.yml"
    path.write_text(f"faults: [{{kind: crash, state: {state}}}]\n")
    assert read_fault_file(path, smachac.load(RECOVERY), []) == (Fault(kind="crash", state=full),)
