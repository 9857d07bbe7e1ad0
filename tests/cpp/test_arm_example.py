"""The pick-and-place example in C++: on a fake arm it does what it does on the simulated one."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path

import pytest

from smachac.commands import cli
from tests.cpp.compilers import BARE, COMPILERS, SANITIZED, Compiler, compilers, last_with
from tests.support.arm_examples import PICK_AND_PLACE, run

FOLDER = Path(__file__).parents[2] / "examples" / "08_pick_and_place"
FAULTS = (Path(__file__).with_name("arm_faults.cpp")).read_text("utf-8")
MAIN = (FOLDER / "cpp" / "main.cpp").read_text("utf-8")


Event = tuple[object, ...]


@pytest.fixture(scope="module")
def header(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder with what `smachac build` wrote."""
    folder = tmp_path_factory.mktemp("header")
    assert cli.main(["build", str(FOLDER / "main.yml"), "--target", "cpp", "-o", str(folder)]) == 0
    return folder


def made(text: str, compiler: Compiler, header: Path, *flags: str) -> Path:
    """The program of a text over the header and the fake arm."""
    flags = ("-pthread", *flags, f"-I{header}", f"-I{FOLDER / 'cpp'}")
    return compiler.compile(text, header, *flags)


def told(lines: str) -> list[Mapping[str, object]]:
    return [json.loads(line) for line in lines.splitlines()]


def compared(events: Sequence[Mapping[str, object]]) -> list[Event]:
    """What two arms have in common: the events without values and times."""
    names = ("event", "path", "outcome", "to", "key")
    return [tuple(_unrooted(event.get(name)) for name in names) for event in events]


def _unrooted(text: object) -> object:
    """Paths without the name of the machine, which tests/support/arm_examples.py calls `sm`."""
    if isinstance(text, str):
        for root in ("sm", "pick_and_place"):
            if text == root or text.startswith((f"{root}/", f"{root}:")):
                return text.removeprefix(root)
    return text


def visited(events: list[Mapping[str, object]]) -> list[str]:
    return [str(event["path"]) for event in events if event["event"] == "enter"]


@COMPILERS
@pytest.mark.slow
def test_both_arms_are_driven_alike(compiler: Compiler, header: Path, tmp_path: Path) -> None:
    program = made(MAIN, compiler, header)
    simulated = run(*PICK_AND_PLACE, 0)
    assert simulated.outcome == "succeeded"
    for seed in range(20):
        trace = tmp_path / f"{seed}.jsonl"
        call = [str(program), str(seed), str(trace)]
        ended = subprocess.run(call, capture_output=True, text=True, timeout=60, check=False)
        assert ended.returncode == 0, ended.stdout
        assert ended.stdout.endswith("succeeded\n")
        assert compared(told(trace.read_text("utf-8"))) == compared(simulated.events)


@pytest.mark.parametrize("flags", [BARE, SANITIZED], ids=["bare", "sanitized"])
@pytest.mark.slow
def test_other_ways_to_compile_it(flags: tuple[str, ...], header: Path) -> None:
    program = made(MAIN, last_with(*flags), header, *flags)
    ended = subprocess.run([str(program)], capture_output=True, text=True, timeout=60, check=False)
    assert (ended.returncode, ended.stderr) == (0, "")


@pytest.mark.parametrize(
    ("fault", "path"),
    [
        ("far", "PICK_BLOCK/PLAN_HOVER"),
        ("vanished", "PICK_BLOCK/CLOSE_GRIPPER"),
        ("displaced", "PICK_BLOCK/CLOSE_GRIPPER"),
        ("nudged", "PLACE_BLOCK/CHECK_PLACED"),
    ],
)
@pytest.mark.slow
def test_what_goes_wrong_ends_in_the_recovery(fault: str, path: str, header: Path) -> None:
    events = faulty(fault, header)
    assert events[-1]["outcome"] == "aborted"
    root = "pick_and_place"
    assert visited(events)[-3:] == [f"{root}/{path}", f"{root}/LET_GO", f"{root}/RETREAT"]


@pytest.mark.slow
def test_a_request_to_stop_holds_the_arm(header: Path) -> None:
    events = faulty("stopped", header)
    assert [event["path"] for event in events if event.get("outcome") == "preempted"] == 2 * [
        "pick_and_place/PICK_BLOCK/MOVE_DOWN"
    ]
    assert events[-1]["outcome"] == "aborted"


def faulty(fault: str, header: Path) -> list[Mapping[str, object]]:
    """The trace of the machine with a fault."""
    program = made(FAULTS, compilers()[0], header)
    call = [str(program), fault]
    return told(subprocess.run(call, capture_output=True, text=True, timeout=60, check=True).stdout)
