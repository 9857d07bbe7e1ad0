"""`smachac view --attach ros:NAME`: the page of a node that runs in a process of its own."""

from __future__ import annotations

import signal
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import smachac
from tests.ros.ros_graph import Program
from tests.ros2.ros2_graph import PYTHON, Graph
from tests.support.viewed import Viewed, starter

pytestmark = pytest.mark.ros2

SCRIPT = """\
name: patrol
template: ROSBase
outcomes: [succeeded, aborted, preempted]
states:
  - LISTEN:
      template: WaitForMsgState
      topic: first
      msg_type: std_msgs/String
      timeout: 1000.0
      transitions: {succeeded: BOTH, aborted: aborted, preempted: preempted}
  - BOTH:
      template: Concurrence
      outcomes: [fine, bad]
      default_outcome: bad
      outcome_map: {fine: {LEFT: succeeded, RIGHT: succeeded}}
      transitions: {fine: succeeded, bad: preempted}
      states:
        - LEFT:
            template: WaitForMsgState
            topic: second
            msg_type: std_msgs/String
            timeout: 1000.0
        - RIGHT:
            template: WaitForMsgState
            topic: third
            msg_type: std_msgs/String
            timeout: 1000.0
"""

SPEAKER = """
import sys, time, rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("speaker")
topics = {name: node.create_publisher(String, name, 1) for name in ("first", "second", "third")}
print("ready", flush=True)
for line in sys.stdin:
    topic = topics[line.strip()]
    while not topic.get_subscription_count():
        time.sleep(0.02)
    while topic.get_subscription_count():  # a state that has received a message leaves the topic
        topic.publish(String(data="go"))
        time.sleep(0.02)
"""

START = Callable[..., Viewed]


@pytest.fixture
def start() -> Iterator[START]:
    with starter() as start:
        yield start


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "patrol.yml"
    path.write_text(SCRIPT, encoding="utf-8")
    return path


def node(graph: Graph, script: Path) -> Program:
    (text,) = smachac.compile(script, "python", options={"introspection": "yes"}).values()
    return graph.start(text)


class Run:
    """The events that a page receives, and the states that run after them."""

    def __init__(self, view: Viewed) -> None:
        self._view = view
        self.events: list[dict[str, Any]] = []

    @property
    def active(self) -> set[str]:
        found: set[str] = set()
        for event in self.events:
            if event["event"] in ("start", "enter"):
                found.add(event["path"])
            elif event["event"] in ("exit", "finish"):
                found.discard(event["path"])
        return found

    def until(self, *active: str) -> None:
        """Receive events until these states run."""
        while self.active != set(active):
            message = self._view.until(lambda each: each["kind"] == "trace")
            self.events += message["events"]


def test_a_view_that_waits_shows_the_run_of_a_node(
    graph2: Graph, script: Path, start: START
) -> None:
    words = ("view", script, "--attach", "ros:/patrol", "--no-browser")
    view = start(*words, python=PYTHON, environment=graph2.environment)
    waits = view.until(lambda each: each["kind"] == "source")["waits"]
    assert waits.startswith("waits for the ROS topic /patrol/smach/container_status_json")
    program, speaker = node(graph2, script), graph2.start(SPEAKER)
    speaker.expect("ready")
    run = Run(view)
    run.until("patrol", "patrol/LISTEN")
    speaker.say("first")
    run.until("patrol", "patrol/BOTH", "patrol/BOTH/LEFT", "patrol/BOTH/RIGHT")
    speaker.say("third")
    run.until("patrol", "patrol/BOTH", "patrol/BOTH/LEFT")
    speaker.say("second")
    run.until()
    assert program.end() == 0, program.output
    lines = {(event["event"], event["path"], event.get("outcome")): event for event in run.events}
    assert ("transition", "patrol/LISTEN", "succeeded") in lines
    assert ("exit", "patrol/BOTH/RIGHT", "succeeded") in lines
    assert lines["transition", "patrol/BOTH", "fine"]["to"] == "patrol:succeeded"
    assert ("finish", "patrol", "succeeded") in lines
    view.process.send_signal(signal.SIGINT)
    code, _, errors = view.end()
    assert code == 130, errors
    assert errors == "shows the ROS topic /patrol/smach/container_status_json\ninterrupted\n"


def test_a_view_that_comes_late_finds_the_states_that_run(
    graph2: Graph, script: Path, start: START
) -> None:
    program, speaker = node(graph2, script), graph2.start(SPEAKER)
    speaker.expect("ready")
    speaker.say("first")
    speaker.say("second")
    program.expect("branch 'LEFT' ended")
    name = "ros:/patrol/smach/container_status_json"
    view = start(
        "view", script, "--attach", name, "--no-browser",
        python=PYTHON, environment=graph2.environment,
    )  # fmt: skip
    run = Run(view)
    run.until("patrol", "patrol/BOTH", "patrol/BOTH/RIGHT")
    program.send(signal.SIGINT)
    run.until()
    assert run.events[-1]["outcome"] == "preempted"
    assert program.end() == 130, program.output
