"""Programs that smachac prints, run as nodes: the built-in state types that speak ROS."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

import smachac
from tests.ros.ros_graph import ROOT, Graph

pytestmark = pytest.mark.ros

HEAD = """
name: sis
template: ROSBase
outcomes: [succeeded, aborted, preempted]
states:
"""

CALL = """
  - CALL:
      template: ServiceState
      service_namespace: {service}
      service: std_srvs/SetBool
      userdata: {{data: true}}
      request_slots: [data]
      response_slots: [success, message]
      transitions: {{succeeded: SHOW, aborted: aborted, preempted: preempted}}
  - SHOW:
      template: PrintUserdataState
      input_keys: [success, message]
      transitions: {{succeeded: succeeded}}
"""

WORK = """
  - WORK:
      template: SimpleActionState
      action_server_namespace: work
      action: actionlib/TestAction
      goal: TestGoal(goal={goal})
      {more}
      transitions: {{succeeded: succeeded, aborted: aborted, preempted: preempted}}
"""

SLEEPER = """
  - FIRST:
      template: SleepState
      time: 0
      transitions: {succeeded: LONG, preempted: preempted}
  - LONG:
      template: SleepState
      time: 1000
      transitions: {succeeded: succeeded, preempted: preempted}
"""


def built(folder: Path, states: str, **options: str) -> str:
    """The program of a script with these states."""
    path = folder / "main.yml"
    path.write_text(HEAD + states, encoding="utf-8")
    (text,) = smachac.compile(path, "python", options=options).values()
    return text


def outcome(graph: Graph, folder: Path, states: str) -> str:
    """The outcome of a script with these states.

    It is not always the last line: `rosbag record` writes its buffered lines when it exits, and
    that can be after the program has printed its outcome.
    """
    lines = graph.run(built(folder, states)).splitlines()
    (found,) = (line for line in lines if line.startswith("outcome: "))
    return found.removeprefix("outcome: ")


def test_the_script_of_the_docs_runs(graph: Graph, tmp_path: Path) -> None:
    text = (ROOT / "docs/ros.md").read_text("utf-8")
    path = tmp_path / "fetch.yml"
    path.write_text("# fetch" + text.split("# fetch")[1].split("```")[0], encoding="utf-8")
    (program,) = smachac.compile(path, "python").values()
    graph.node("action_server")
    graph.node("service_server")
    assert graph.run(program).endswith("outcome: succeeded\n")


def test_a_service_gets_its_request_from_userdata_and_gives_its_response(
    graph: Graph, tmp_path: Path
) -> None:
    graph.node("service_server")
    output = graph.run(built(tmp_path, CALL.format(service="answer")))
    assert "yes" in output
    assert output.endswith("outcome: succeeded\n")


def test_a_request_is_a_mapping_of_fields(graph: Graph, tmp_path: Path) -> None:
    graph.node("service_server")
    states = CALL.format(service="answer").replace("request_slots: [data]", "request: {data: true}")
    output = graph.run(built(tmp_path, states))
    assert "yes" in output
    assert output.endswith("outcome: succeeded\n")


def test_a_service_that_crashes_in_mid_call_aborts(graph: Graph, tmp_path: Path) -> None:
    graph.node("service_server")
    assert outcome(graph, tmp_path, CALL.format(service="crash")) == "aborted"


@pytest.mark.parametrize(("goal", "expected"), [(1, "succeeded"), (2, "aborted"), (5, "aborted")])
def test_an_action_that_succeeds_aborts_or_crashes(
    graph: Graph, tmp_path: Path, goal: int, expected: str
) -> None:
    server = graph.node("action_server")
    assert outcome(graph, tmp_path, WORK.format(goal=goal, more="")) == expected
    server.expect(f"goal {goal}")


def test_an_action_that_takes_too_long_is_cancelled(graph: Graph, tmp_path: Path) -> None:
    server = graph.node("action_server")
    graph.simulate()
    program = graph.start(built(tmp_path, WORK.format(goal=3, more="exec_timeout: 1000")))
    server.expect("goal 3")
    graph.node("clock")
    server.expect("cancelled")
    assert program.end() == 0
    assert program.output.endswith("outcome: aborted\n")


def test_an_action_without_a_server_aborts(graph: Graph, tmp_path: Path) -> None:
    states = WORK.format(goal=1, more="server_wait_timeout: 0.2")
    assert outcome(graph, tmp_path, states) == "aborted"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_cancels_the_goal_of_an_action(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    server = graph.node("action_server")
    program = graph.start(built(tmp_path, WORK.format(goal=3, more="")))
    server.expect("goal 3")
    program.send(number)
    server.expect("cancelled")
    assert program.end() == 128 + number
    assert program.output.endswith("outcome: preempted\n")


BOTH = """
  - BOTH:
      template: Concurrence
      outcomes: [done, aborted]
      default_outcome: aborted
      outcome_map:
        done: {CALL: succeeded, WORK: preempted}
      join: any
      states:
        - CALL:
            template: ServiceState
            service_namespace: answer
            service: std_srvs/SetBool
        - WORK:
            template: SimpleActionState
            action_server_namespace: work
            action: actionlib/TestAction
            goal: TestGoal(goal=3)
      transitions: {done: succeeded, aborted: aborted}
"""


def test_the_branch_that_ends_first_preempts_the_action_of_the_other(
    graph: Graph, tmp_path: Path
) -> None:
    actions = graph.node("action_server")
    program = graph.start(built(tmp_path, BOTH))
    actions.expect("goal 3")
    graph.node("service_server")
    actions.expect("cancelled")
    assert program.end() == 0
    assert program.output.endswith("outcome: succeeded\n")


FRAME = """
  - FIND:
      template: TF2ListenerState
      userdata: {{target: base, source: {source}}}
      timeout: {timeout}
      transitions: {{succeeded: MOVE, aborted: aborted, preempted: preempted}}
  - MOVE:
      template: TransformMsgState
      userdata: {{msg: [[1, 2, 3], [0, 0, 0, 1]]}}
      input_keys: [msg, source, target]
      output_keys: [output_msg]
      transitions: {{succeeded: SHOW, aborted: aborted, preempted: preempted}}
  - SHOW:
      template: PrintUserdataState
      input_keys: [output_msg]
      transitions: {{succeeded: succeeded}}
"""


def test_a_frame_of_tf_is_found_and_used(graph: Graph, tmp_path: Path) -> None:
    graph.node("frames")
    output = graph.run(built(tmp_path, FRAME.format(source="tool", timeout=60)))
    assert output.endswith("outcome: succeeded\n")
    assert "x: 2.0" in output


def test_a_frame_that_does_not_exist_aborts_in_time(graph: Graph, tmp_path: Path) -> None:
    graph.node("frames")
    output = graph.run(built(tmp_path, FRAME.format(source="nowhere", timeout=0.3)))
    assert "no transform from nowhere to base in 0.3 s" in output
    assert output.endswith("outcome: aborted\n")


def test_a_signal_ends_the_wait_for_a_frame(graph: Graph, tmp_path: Path) -> None:
    program = graph.start(
        built(tmp_path, FRAME.format(source="nowhere", timeout=1000), introspection="yes")
    )
    graph.node("observer").expect("status /sis ['FIND'] ['FIND']")
    program.send(signal.SIGTERM)
    assert program.end() == 143
    assert program.output.endswith("outcome: preempted\n")


BAG = """
  - RECORD:
      template: RecordROSBagState
      action: start
      recorder: {recorder}
      userdata: {{file: {bag}, topics: [number]}}
      input_keys: [file, topics]
      transitions: {{succeeded: READ, aborted: aborted}}
  - READ:
      template: WaitForMsgState
      topic: number
      msg_type: std_msgs/Int32
      msg_cb: "`lambda msg, userdata: msg.data == 0`"
      timeout: 60
      transitions: {{succeeded: MORE, aborted: READ, preempted: preempted}}
  - MORE:
      template: WaitForMsgState
      topic: number
      msg_type: std_msgs/Int32
      msg_cb: "`lambda msg, userdata: msg.data == 9`"
      timeout: 60
      transitions: {{succeeded: STOP, aborted: MORE, preempted: preempted}}
  - STOP:
      template: RecordROSBagState
      action: stop
      recorder: {recorder}
      input_keys: [file]
      transitions: {{succeeded: succeeded, aborted: aborted}}
"""

READER = """
import sys
import rosbag

with rosbag.Bag(sys.argv[1]) as bag:
    said = {message.data for _, message, _ in bag.read_messages()}
    print("bag:", said >= set(range(1, 9)))
"""


@pytest.mark.parametrize(
    ("recorder", "listeners"),  # the states of a node share one connection
    [("ROSBagCLIProcessRecorder", "2"), ("ROSBagAPIThreadRecorder", "1")],
)
def test_a_bag_holds_what_was_said_meanwhile(
    graph: Graph, tmp_path: Path, recorder: str, listeners: str
) -> None:
    bag = tmp_path / "said.bag"
    graph.node("counting", listeners)
    assert outcome(graph, tmp_path, BAG.format(recorder=recorder, bag=bag)) == "succeeded"
    reader = graph.start(READER, str(bag))
    assert reader.end() == 0
    assert reader.output == "bag: True\n"


TOPICS = """
  - READ:
      template: ReadTopicState
      userdata: {{topic: number, msg_type: std_msgs/Int32}}
      input_keys: [topic, msg_type]
      output_keys: [msg]
      timeout: {timeout}
      transitions: {{succeeded: PUBLISH, aborted: aborted}}
  - PUBLISH:
      template: PublishMsgState
      action: start
      userdata: {{to: heard, often: 20.0}}
      remapping: {{topic: to, rate: often}}
      input_keys: [msg, topic, rate]
      transitions: {{succeeded: HEAR, aborted: aborted}}
  - HEAR:
      template: WaitForMsgState
      topic: heard
      msg_type: std_msgs/Int32
      msg_cb: "`lambda msg, userdata: msg.data == 7`"
      timeout: 60
      transitions: {{succeeded: SILENCE, aborted: aborted, preempted: preempted}}
  - SILENCE:
      template: PublishMsgState
      action: stop
      remapping: {{topic: to}}
      input_keys: [topic]
      transitions: {{succeeded: succeeded, aborted: aborted}}
"""


def test_a_message_is_read_published_and_heard(graph: Graph, tmp_path: Path) -> None:
    graph.node("topics", "7")
    assert outcome(graph, tmp_path, TOPICS.format(timeout=60)) == "succeeded"


def test_no_message_in_time_aborts(graph: Graph, tmp_path: Path) -> None:
    assert outcome(graph, tmp_path, TOPICS.format(timeout=0.2)) == "aborted"


PUBLISHED = """
  - PUBLISH:
      template: PublishMsgState
      action: start
      userdata: {{msg: "`{code}`"}}
      input_keys: [msg]
      transitions: {{succeeded: succeeded, aborted: aborted}}
"""


@pytest.mark.parametrize(
    ("code", "reason"),
    [
        ("std_msgs.msg.Float64(*['far'])", "std_msgs/Float64: field data must be float type"),
        ("std_msgs.msg.Float32(*[1e39])", "std_msgs/Float32: float too large"),
        ("std_msgs.msg.Float64(data=1)", ""),
    ],
)
def test_a_message_that_cannot_be_sent_aborts(
    graph: Graph, tmp_path: Path, code: str, reason: str
) -> None:
    output = graph.run(built(tmp_path, PUBLISHED.format(code=code)))
    assert f"outcome: {'aborted' if reason else 'succeeded'}\n" in output
    assert (f"the message is invalid: {reason}" in output) == bool(reason)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_a_state_that_does_not_know_of_ros(
    graph: Graph, tmp_path: Path, number: signal.Signals
) -> None:
    program = graph.start(built(tmp_path, SLEEPER, introspection="yes"))
    graph.node("observer").expect("status /sis ['FIRST'] ['LONG']")
    program.send(number)
    assert program.end() == 128 + number
    assert program.output.endswith("outcome: preempted\n")


def test_introspection_shows_the_machine(graph: Graph, tmp_path: Path) -> None:
    graph.start(built(tmp_path, SLEEPER, introspection="yes"))
    observer = graph.node("observer")
    assert observer.expect("structure") == (
        "structure /sis ['FIRST', 'LONG'] [('succeeded', 'FIRST', 'LONG'), "
        "('preempted', 'FIRST', 'preempted'), ('succeeded', 'LONG', 'succeeded'), "
        "('preempted', 'LONG', 'preempted')] ['succeeded', 'aborted', 'preempted']"
    )
