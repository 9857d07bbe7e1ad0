"""Programs that smachac prints, run as nodes."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest
from live import Graph

import smachac

pytestmark = pytest.mark.ros

SLEEPER = """
name: sis
template: ROSBase
outcomes: [succeeded, preempted]
states:
  - FIRST:
      template: SleepState
      time: 0
      transitions: {succeeded: LONG, preempted: preempted}
  - LONG:
      template: SleepState
      time: 1000
      transitions: {succeeded: succeeded, preempted: preempted}
"""


def built(folder: Path, script: str, **options: str) -> str:
    """The program of a script."""
    path = folder / "main.yml"
    path.write_text(script, encoding="utf-8")
    (text,) = smachac.build(path, "python", options=options).values()
    return text


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_state_that_does_not_know_of_ros(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    program = graph.start(built(tmp_path, SLEEPER, introspection="yes"))
    observer = graph.node("observer")
    observer.expect("status /sis ['FIRST'] ['LONG']")
    program.send(number)
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_introspection_shows_the_machine(graph: Graph, tmp_path: Path) -> None:
    graph.start(built(tmp_path, SLEEPER, introspection="yes"))
    observer = graph.node("observer")
    assert observer.expect("structure") == (
        "structure /sis ['FIRST', 'LONG'] [('succeeded', 'FIRST', 'LONG'), "
        "('preempted', 'FIRST', 'preempted'), ('succeeded', 'LONG', 'succeeded'), "
        "('preempted', 'LONG', 'preempted')] ['succeeded', 'preempted']"
    )
