"""States that wait for what does not come: a signal ends them, and so does another branch."""

from __future__ import annotations

import signal
from pathlib import Path

import pytest

from tests.ros.ros_graph import Graph
from tests.ros.test_generated import built, outcome

pytestmark = pytest.mark.ros

WAITS = {
    "service": """
      template: ServiceState
      service_namespace: absent
      service: std_srvs/SetBool
      transitions: ENDS
""",
    "action": """
      template: SimpleActionState
      action_server_namespace: absent
      action: actionlib/TestAction
      goal: TestGoal(goal=1)
      transitions: ENDS
""",
    "topic": """
      template: WaitForMsgState
      topic: silent
      msg_type: std_msgs/Int32
      transitions: ENDS
""",
    "topic of the userdata": """
      template: ReadTopicState
      userdata: {topic: silent, msg_type: std_msgs/Int32}
      input_keys: [topic, msg_type]
      output_keys: [msg]
      transitions: ENDS
""",
    "frame": """
      template: TF2ListenerState
      userdata: {target: base, source: nowhere}
      timeout: 1000
      transitions: ENDS
""",
}

ENDS = "{succeeded: succeeded, aborted: aborted, preempted: preempted}"

EACH = pytest.mark.parametrize("what", WAITS)

BOTH = """
  - BOTH:
      template: Concurrence
      outcomes: [done, aborted]
      default_outcome: aborted
      outcome_map:
        done: {CALL: succeeded, WAIT: preempted}
      join: any
      userdata: {topic: silent, msg_type: std_msgs/Int32, target: base, source: nowhere}
      states:
        - CALL:
            template: ServiceState
            service_namespace: answer
            service: std_srvs/SetBool
        - WAIT:WAITING
      transitions: {done: succeeded, aborted: aborted}
"""


@EACH
def test_a_signal_ends_a_wait(graph: Graph, tmp_path: Path, what: str) -> None:
    waiting = WAITS[what].replace("ENDS", ENDS)
    program = graph.start(built(tmp_path, f"  - WAIT:{waiting}"))
    program.expect("starting in 'WAIT'")
    program.send(signal.SIGINT)
    assert program.end() == 130
    assert program.output.endswith("outcome: preempted\n")
    assert "/sis" not in str(graph.ask("getSystemState"))


@EACH
def test_another_branch_ends_a_wait(graph: Graph, tmp_path: Path, what: str) -> None:
    lines = [line for line in WAITS[what].splitlines() if "transitions" not in line]
    waiting = "\n      ".join(line for line in lines if "userdata" not in line)
    program = graph.start(built(tmp_path, BOTH.replace("WAITING", waiting)))
    program.expect("waiting for service 'answer'")
    graph.node("service_server")
    assert program.end() == 0
    assert program.output.endswith("outcome: succeeded\n")


@pytest.mark.parametrize("what", ["service", "action"])
def test_a_time_limit_of_the_script_ends_a_wait(graph: Graph, tmp_path: Path, what: str) -> None:
    ends = "{succeeded: aborted, aborted: aborted, preempted: preempted, timeout: succeeded}"
    waiting = WAITS[what].replace("ENDS", f"{ends}\n      timeout: 300ms")
    assert outcome(graph, tmp_path, f"  - WAIT:{waiting}") == "succeeded"


def test_a_time_limit_of_the_state_ends_its_wait(graph: Graph, tmp_path: Path) -> None:
    waiting = WAITS["topic"].replace("ENDS", f"{ENDS}\n      timeout: 0.3")
    assert outcome(graph, tmp_path, f"  - WAIT:{waiting}") == "aborted"


CALL = """
  - CALL:
      template: ServiceState
      service_namespace: {service}
      service: std_srvs/SetBool
      transitions: {{succeeded: NEXT, aborted: aborted, preempted: preempted}}
  - NEXT:
      template: SleepState
      time: 1000
      transitions: {{succeeded: succeeded, preempted: preempted}}
"""


def test_a_signal_ends_a_call_that_hangs(graph: Graph, tmp_path: Path) -> None:
    server = graph.node("service_server")
    program = graph.start(built(tmp_path, CALL.format(service="hang")))
    server.expect("called")
    program.send(signal.SIGINT)
    assert program.end() == 130
    assert program.output.endswith("outcome: aborted\n")


def test_a_signal_in_mid_call_takes_the_answer_and_goes_on_to_the_next_state(
    graph: Graph, tmp_path: Path
) -> None:
    server = graph.node("service_server")
    program = graph.start(built(tmp_path, CALL.format(service="ponder")))
    server.expect("called")
    program.send(signal.SIGINT)
    server.say("answer")
    assert program.end() == 130
    assert "transition 'CALL':'succeeded'-->'NEXT'" in program.output
    assert program.output.endswith("outcome: preempted\n")


TIDY = """
  - WORK:
      template: SimpleActionState
      action_server_namespace: work
      action: actionlib/TestAction
      goal: TestGoal(goal=3)
      transitions: {succeeded: succeeded, aborted: aborted, preempted: TIDY}
  - TIDY:
      template: CallbacksState
      callbacks: {word: "lambda ud: rospy.get_param('/word')"}
      output_keys: [word]
      transitions: {succeeded: SHOW}
  - SHOW:
      template: PrintUserdataState
      input_keys: [word]
      transitions: {succeeded: aborted}
"""


def test_after_a_signal_the_machine_ends_as_it_will_while_the_node_works(
    graph: Graph, tmp_path: Path
) -> None:
    graph.ask("setParam", "/word", "tidied up")
    server = graph.node("action_server")
    program = graph.start(built(tmp_path, TIDY))
    server.expect("goal 3")
    program.send(signal.SIGTERM)
    assert program.end() == 143
    assert "tidied up" in program.output
    assert program.output.endswith("outcome: aborted\n")
