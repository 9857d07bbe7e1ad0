"""The file that a trace is written to: the same events, each there as soon as it has happened."""

from __future__ import annotations

import contextlib
import io
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from smachac.interpreter.userdata import trace_value as interpreted_value
from smachac.ir.nodes import Machine, StateMachine
from smachac.runtime import smach
from smachac.runtime.tracing.trace import attach, script
from smachac.runtime.tracing.values import shown_value
from smachac.runtime.tracing.writer import Event, TraceWriter, trace_value
from tests.support.ir_machines import concurrence, iterator, leaf, machine
from tests.support.smach_machines import Steps, built

ROOT = Path(__file__).parents[2]


pytestmark = pytest.mark.usefixtures("silent_smach")


def stepping() -> float:
    """A clock that goes on by a third of a second at every look."""
    stepping.time = getattr(stepping, "time", 0.0) + 1 / 3  # type: ignore[attr-defined]
    return float(stepping.time)  # type: ignore[attr-defined]


def events_and_lines(root: StateMachine, steps: Steps) -> tuple[list[Event], list[Event]]:
    """What an observer hears in three runs, and what the file says."""
    told: list[Event] = []
    stream = io.BytesIO()
    for observe in (told.append, TraceWriter(stream.write)):
        stepping.time = 0.0  # type: ignore[attr-defined]
        made = built(Machine(root=root))
        script(made, root.name, steps)
        sources = {f"{root.name}/A": "100%d.yml:1", f"{root.name}/I/ONE": "é.yml:2"}
        attach(made, root.name, observe, sources, clock=stepping)
        for _ in range(3):
            with contextlib.suppress(smach.exceptions.SmachError):
                made.execute()
    return told, [json.loads(line) for line in stream.getvalue().splitlines()]


def test_the_file_says_what_an_observer_hears() -> None:
    root = machine(
        "sm",
        "done",
        leaf("A", {"x": "I", "%": "A"}, outs="k"),
        iterator(
            "I",
            "exhausted found",
            leaf("ONE", outcomes="x"),
            items=[1, 2],
            loop="x",
            to={"exhausted": "C", "found": "C"},
        ),
        concurrence("C", "x", machine("M", "x", leaf("B", {"x": "x"})), default="x", to={"x": "D"}),
        leaf("D", {"x": "done"}),
    )
    values: list[Any] = [1, True, None, 2.5, float("nan"), "%s é", [1, {"a": ()}], {1}, 10**5000]
    steps: Steps = {
        "sm/A": [*(("%", {"k": value, "undeclared": 1}) for value in values), ("x", {})],
        "sm/I/ONE": [("x", {})],
        "sm/C/M/B": [("x", {})],
        "sm/D": [("done?", {}), ("x", {})],
    }  # fmt: skip
    told, lines = events_and_lines(root, steps)
    assert lines == told
    assert [list(line) for line in lines] == [list(event) for event in told]
    assert [line["seq"] for line in lines] == list(range(1, len(told) + 1))
    assert {line["event"] for line in lines} == {
        *("start", "enter", "exit", "transition", "write", "error", "finish"),
    }


def test_errors_are_kept_for_who_wants_them() -> None:
    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "nowhere"}))))
    writer = TraceWriter(io.BytesIO().write)
    attach(made, "sm", writer)
    made.execute()
    assert [event["message"] for event in writer.errors] == ["ended without an outcome"]


def test_the_writer_writes_a_line_at_once() -> None:
    stream = io.BytesIO()
    writer = TraceWriter(stream.write)
    writer({"seq": 7, "event": "start", "path": "größe"})
    writer({"event": "write", "value": {1, 2}.__class__})
    lines = stream.getvalue().decode().splitlines()
    assert json.loads(lines[0]) == {"seq": 7, "event": "start", "path": "größe"}
    assert json.loads(lines[1])["seq"] == 2
    assert lines[0].isascii()


def test_a_pipe_that_takes_a_few_bytes_gets_all() -> None:
    taken: list[bytes] = []

    def write(data: bytes) -> int:
        taken.append(data[:10])
        return len(taken[-1])

    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "x"}))))
    script(made, "sm", {"sm/A": [("x", {})]})
    attach(made, "sm", TraceWriter(write))
    made.execute()
    assert len([json.loads(line) for line in b"".join(taken).splitlines()]) == 5


def test_an_event_in_the_middle_of_another_comes_after_it() -> None:
    """As a signal handler that asks for a stop while a line is being written."""
    made = built(Machine(root=machine("sm", "x", leaf("A", {"x": "x"}))))
    script(made, "sm", {"sm/A": [("x", {})]})
    lines: list[bytes] = []

    def write(data: bytes) -> int:
        if b"enter" in data:
            made.request_preempt()
        lines.append(data)
        return len(data)

    attach(made, "sm", TraceWriter(write))
    made.execute()
    told = [json.loads(line) for line in b"".join(lines).splitlines()]
    assert [(event["seq"], event["event"]) for event in told[:4]] == [
        (1, "start"),
        (2, "enter"),
        (3, "preempt"),
        (4, "preempt"),
    ]


class Unspeakable:
    def __repr__(self) -> str:
        raise RuntimeError


def test_a_value_that_cannot_be_shown_is_told_by_its_type() -> None:
    assert trace_value(Unspeakable()) == "<Unspeakable>"


@pytest.mark.parametrize(
    "value", [None, 1, 1.5, float("inf"), "é", [1, (2,)], {"a": {1: 2}}, object(), {1}, print]
)
def test_values_are_shown_as_the_interpreter_shows_them(value: object) -> None:
    assert trace_value(value) == interpreted_value(value)


KILLED = """
import functools, os, sys
from smachac.runtime import smach
from smachac.runtime.tracing.trace import TraceWriter, attach

class Step(smach.State):
    def execute(self, ud):
        self.n = getattr(self, "n", 0) + 1
        if self.n == 3:
            print("in the middle", flush=True)
            sys.stdin.read()
        ud.k = self.n
        return "next"

with (machine := smach.StateMachine(["done"])):
    smach.StateMachine.add("A", Step(["next"], output_keys=["k"]), {"next": "B"})
    smach.StateMachine.add("B", smach.CBState(lambda ud: "next", outcomes=["next"]), {"next": "A"})
attach(machine, "sm", TraceWriter(functools.partial(os.write, int(sys.argv[1]))))
machine.execute()
"""


def test_a_killed_run_leaves_a_whole_file(tmp_path: Path) -> None:
    path = tmp_path / "t.jsonl"
    with path.open("wb") as stream:
        process = subprocess.Popen(
            [sys.executable, "-c", KILLED, str(stream.fileno())],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=[stream.fileno()],
            env={**os.environ, "PYTHONPATH": str(ROOT)},
        )
    with process:
        assert process.stdout is not None
        while process.stdout.readline().strip() != b"in the middle":
            assert process.poll() is None
        process.send_signal(signal.SIGKILL)
    text = path.read_text()
    assert text.endswith("\n")
    events = [json.loads(line) for line in text.splitlines()]
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert (events[-1]["event"], events[-1]["path"]) == ("enter", "sm/A")
    assert [event["value"] for event in events if event["event"] == "write"] == [1, 2]


@pytest.mark.parametrize(
    "value", ["x" * 5_000_000, [[0.5] * 1000] * 1000, {"scan": list(range(10**6))}], ids=type
)
def test_a_line_is_never_longer_than_a_reader_accepts(value: object) -> None:
    stream = io.BytesIO()
    writer = TraceWriter(stream.write)
    event = {"seq": 0, "event": "write", "path": "sm/A", "key": "k", "value": None, "t": 0.0}
    writer.put(writer.prepare([event]), 1, 0.5, value)
    line = stream.getvalue()
    assert len(line) < 50_000
    assert json.loads(line)["value"] == shown_value(value)
