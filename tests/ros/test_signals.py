"""Stop signals to programs that smachac prints, whatever the state in which they are does."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

import smachac
from tests.ros.ros_graph import Graph, wait_for

pytestmark = pytest.mark.ros

SCRIPT = """
name: deeds
template: ROSBase
outcomes: [succeeded, preempted]
states:
  - DO:
      template: Deed
      deed: {deed}
      transitions: {{succeeded: NEXT}}
  - NEXT:
      template: SleepState
      time: 0
      transitions: {{succeeded: succeeded, preempted: preempted}}
"""

TYPE = """
name: Deed
variables: {deed: {type: str}}
outcomes: {succeeded: {}}
code: {python: "deeds:Deed"}
"""

SLEEPER = """
name: sleeper
template: ROSBase
outcomes: [succeeded, preempted]
states:
  - FIRST: {template: SleepState, time: 0, transitions: {succeeded: LONG, preempted: preempted}}
  - LONG:
      template: SleepState
      time: 1000
      transitions: {succeeded: succeeded, preempted: preempted}
"""

SIGNALS = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])


def deed(folder: Path, name: str) -> str:
    """A program whose first state does this deed, and whose second can be preempted."""
    (folder / "templates").mkdir()
    (folder / "templates/Deed.yml").write_text(TYPE, encoding="utf-8")
    path = folder / "main.yml"
    path.write_text(SCRIPT.format(deed=name), encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    return text


def wait_for_end(graph: Graph, node: str) -> None:
    """Wait until the node has taken its leave of the master."""
    wait_for(lambda: "" if node in str(graph.ask("getSystemState")) else "gone")


@SIGNALS
def test_a_signal_while_the_master_is_asked(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    program = graph.start(deed(tmp_path, "ask"))
    program.expect("begins to ask")
    graph.master.halt()
    program.say("go")
    program.expect("asked")
    program.send(number)
    graph.master.send(signal.SIGCONT)
    assert program.end() == 128 + number
    assert program.output.endswith("outcome: preempted\n")


@SIGNALS
def test_a_signal_that_does_not_wake_the_main_thread(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    path = tmp_path / "main.yml"
    path.write_text(SLEEPER, encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    program = graph.start(text)
    program.expect("-->'LONG'")
    program.send_aside(number)
    assert program.end() == 128 + number
    assert program.output.endswith("outcome: preempted\n")


@SIGNALS
def test_a_signal_in_a_state_that_looks_only_for_a_shutdown(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    program = graph.start(deed(tmp_path, "listen"))
    program.expect("begins to listen")
    program.send(number)
    assert program.end() == 128 + number
    assert "the state machine did not end within 5 s" in program.output
    assert program.output.endswith("outcome: preempted\n")


@SIGNALS
def test_a_second_signal_in_a_state_that_looks_at_nothing(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    program = graph.start(deed(tmp_path, "wait"))
    program.expect("begins to wait")
    program.send(signal.SIGINT)
    wait_for_end(graph, "/deeds")
    program.send(number)
    assert program.end() == 128 + number
    assert "Traceback" not in program.output
