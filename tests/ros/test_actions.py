"""SimpleActionState: servers that succeed, abort, stop, are deaf, crash, are not there."""

from __future__ import annotations

import signal

import pytest

from tests.ros.ros_graph import Graph

pytestmark = pytest.mark.ros

CLIENT = """
import client
import rospy
from smachac.runtime import smach, smach_ros
from actionlib.msg import TestAction, TestGoal

client.node()
machine = smach.StateMachine(["succeeded", "aborted", "preempted", "odd"])
with machine:
    smach.StateMachine.add("WORK", smach_ros.SimpleActionState("work", TestAction{arguments}))
machine.userdata.goal = 1
client.run(machine{keys})
"""

LONG = "preempt_timeout=1e6"
SHORT = "server_wait_timeout=rospy.Duration(0.2)"


def client(arguments: str = "", *keys: str) -> str:
    """A machine that sends one goal; `goal: 1` is in its userdata."""
    return CLIENT.format(
        arguments=arguments and f", {arguments}", keys="".join(f", {key!r}" for key in keys)
    )


def work(number: int) -> str:
    return f"TestGoal(goal={number})"


def test_slots_go_from_userdata_into_the_goal_and_back_from_the_result(graph: Graph) -> None:
    graph.node("action_server")
    slots = 'goal_slots=["goal"], result_slots=["result"], exec_timeout=rospy.Duration(0)'
    output = graph.run(client(slots, "result"))
    assert "result: 42\noutcome: succeeded\n" in output


def test_callbacks_change_the_goal_and_choose_the_outcome(graph: Graph) -> None:
    server = graph.node("action_server")
    callbacks = (
        'input_keys=["goal"], outcomes=["odd"], result_key="all", '
        "goal_cb=lambda ud, goal, more: TestGoal(goal=ud.goal * more), goal_cb_args=[1], "
        "result_cb=lambda ud, *given, word: word if given[::2] == (3, 'last') else None, "
        "result_cb_args=['last'], result_cb_kwargs={'word': 'odd'}"
    )
    output = graph.run(client(callbacks, "all"))
    assert "all: result: 42\noutcome: odd\n" in output
    server.expect("goal 1")


def test_feedback_goes_to_its_callback(graph: Graph) -> None:
    graph.node("action_server")
    arguments = "feedback_cb=lambda ud, feedback: client.say(f'feedback {feedback.feedback}')"
    program = graph.start(client(f"{work(3)}, {arguments}"))
    program.expect("feedback 41")
    program.say("preempt")
    assert program.end() == 0


def test_a_goal_callback_that_raises_aborts_with_nothing_sent(graph: Graph) -> None:
    server = graph.node("action_server")
    output = graph.run(client("goal_cb=lambda ud, goal: 1 / 0"))
    assert "ZeroDivisionError" in output
    assert "outcome: aborted\n" in output
    assert "goal" not in server.output


def test_an_outcome_of_a_callback_that_is_not_registered_aborts(graph: Graph) -> None:
    graph.node("action_server")
    output = graph.run(client(f"{work(1)}, result_cb=lambda ud, status, result: 'even'"))
    assert "a callback returned 'even'" in output
    assert "outcome: aborted\n" in output


def test_a_goal_that_the_server_aborts(graph: Graph) -> None:
    graph.node("action_server")
    output = graph.run(client(f"{work(2)}, result_slots=['result']", "result"))
    assert "result: 7\noutcome: aborted\n" in output


def test_a_goal_that_the_server_gives_up_unasked_is_aborted(graph: Graph) -> None:
    graph.node("action_server")
    assert "outcome: aborted\n" in graph.run(client(work(6)))


def test_a_preempt_request_cancels_the_goal(graph: Graph) -> None:
    server = graph.node("action_server")
    program = graph.start(client(work(3)))
    server.expect("goal 3")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output
    server.expect("cancelled")


def test_a_goal_that_is_recalled_on_request_is_preempted(graph: Graph) -> None:
    server = graph.node("slow_server", "pending")
    program = graph.start(client(work(1)))
    server.expect("goal")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_a_goal_that_the_server_does_not_know_is_lost(graph: Graph) -> None:
    graph.node("slow_server", "deaf")
    impatient = client(work(1)).replace(
        "client.node()", "smach_ros.server_watch.ACKNOWLEDGE_LIMIT = 0.2\nclient.node()"
    )
    output = graph.run(impatient)
    assert "the goal of action 'work' is lost: the server does not know it" in output
    assert "outcome: aborted\n" in output


def test_each_goal_starts_from_what_was_given(graph: Graph) -> None:
    server = graph.node("action_server")
    once = client("goal_cb=lambda ud, goal: setattr(goal, 'goal', goal.goal + 1)")
    output = graph.run(f"{once}\nclient.again(machine)")
    assert output.count("outcome: succeeded\n") == 2
    server.expect("goal 1")
    server.expect("goal 1")


NEXT = """
with machine:
    smach.StateMachine.add(
        "NEXT", smach_ros.SimpleActionState("work", TestAction, TestGoal(goal=1))
    )
"""


def test_a_request_that_the_server_does_not_heed_goes_on_to_the_next_state(graph: Graph) -> None:
    server = graph.node("action_server")
    text = client(work(7)).replace("))\nmachine.", f"), {{'succeeded': 'NEXT'}})\n{NEXT}machine.")
    program = graph.start(text)
    server.expect("goal 7")
    program.say("preempt")
    assert program.end() == 0
    assert "transition 'WORK':'succeeded'-->'NEXT'" in program.output
    assert "outcome: preempted\n" in program.output
    assert "goal 1" not in server.output


def test_exec_timeout_is_ros_time_after_which_the_goal_is_cancelled(graph: Graph) -> None:
    server = graph.node("action_server")
    graph.simulate()
    program = graph.start(client(f"{work(3)}, exec_timeout=rospy.Duration(1000), {LONG}"))
    server.expect("goal 3")
    graph.node("clock")
    server.expect("cancelled")
    assert program.end() == 0
    assert "action 'work' is cancelled after 1000.0 s" in program.output
    assert "has not ended" not in program.output
    assert "outcome: aborted\n" in program.output


def test_an_action_goes_on_without_the_master(graph: Graph) -> None:
    server = graph.node("action_server")
    program = graph.start(client(work(3)))
    server.expect("goal 3")
    graph.master.kill()
    program.say("preempt")
    program.expect("outcome: preempted")
    assert "lost" not in program.output


def test_a_server_that_is_deaf_to_its_cancelling_is_left(graph: Graph) -> None:
    server = graph.node("action_server")
    graph.simulate()
    program = graph.start(client(f"{work(4)}, exec_timeout=1000, preempt_timeout=1000"))
    server.expect("goal 4")
    graph.node("clock")
    server.expect("cancelled")
    assert program.end() == 0
    assert "action 'work' was cancelled and has not ended" in program.output
    assert "outcome: aborted\n" in program.output


def test_no_server_in_time_aborts(graph: Graph) -> None:
    output = graph.run(client(f"{work(1)}, {SHORT}"))
    assert "there is no server for action 'work'" in output
    assert "outcome: aborted\n" in output


def test_the_wait_for_a_server_is_preempted(graph: Graph) -> None:
    program = graph.start(client(work(1)))
    program.expect("starting in 'WORK'")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


def test_a_server_that_comes_late_is_waited_for(graph: Graph) -> None:
    program = graph.start(client(work(1)))
    program.expect("starting in 'WORK'")
    graph.node("action_server")
    assert program.end() == 0
    assert "outcome: succeeded\n" in program.output


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGINT])
def test_a_server_that_ends_in_mid_work_aborts(graph: Graph, number: signal.Signals) -> None:
    server = graph.node("action_server")
    program = graph.start(client(work(3)))
    server.expect("goal 3")
    server.send(number)
    assert program.end() == 0
    assert "the goal of action 'work' is lost: the server is gone" in program.output
    assert "outcome: aborted\n" in program.output


def test_a_server_that_crashes_and_comes_back_takes_the_next_goal(graph: Graph) -> None:
    crashing = graph.node("action_server")
    once = client("input_keys=['goal'], goal_cb=lambda ud, goal: TestGoal(goal=ud.goal)")
    twice = once.replace(
        "client.run(machine)",
        "for machine.userdata.goal in (5, 1):\n"
        "    client.again(machine)\n"
        "    client.wait_for_line()",
    )
    program = graph.start(twice)
    crashing.expect("goal 5")
    program.expect("outcome: aborted")
    graph.node("action_server")
    program.say("go on")
    program.expect("outcome: succeeded")
    program.say("go on")
    assert program.end() == 0
    assert "outcome: succeeded\n" in program.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_stops_the_robot_too(graph: Graph, number: signal.Signals) -> None:
    server = graph.node("action_server")
    program = graph.start(client(work(3)))
    server.expect("goal 3")
    program.send(number)
    server.expect("cancelled")
    assert program.end() == 0
    assert "outcome: aborted\n" in program.output


def test_a_state_preempted_once_runs_again(graph: Graph) -> None:
    server = graph.node("action_server")
    once = client("goal_slots=['goal']").replace("goal = 1", "goal = 3")
    program = graph.start(f"{once}\nmachine.userdata.goal = 1\nclient.again(machine)")
    server.expect("goal 3")
    program.say("preempt")
    program.expect("outcome: preempted")
    assert program.end() == 0
    assert "outcome: succeeded\n" in program.output


CONCURRENCE = """
import client
from smachac.runtime import smach, smach_ros
from actionlib.msg import TestAction, TestGoal
from std_srvs.srv import SetBool

client.node()
both = smach.Concurrence(
    ["done"], "done", outcome_cb=lambda ended: client.say(sorted(ended.items())),
    child_termination_cb=lambda ended: True,
)
with both:
    smach.Concurrence.add("WORK", smach_ros.SimpleActionState("work", TestAction, TestGoal(goal=3)))
    smach.Concurrence.add("ASK", smach_ros.ServiceState("answer", SetBool))
client.run(both)
"""


def test_the_first_branch_to_end_cancels_the_goal_of_the_other(graph: Graph) -> None:
    actions = graph.node("action_server")
    program = graph.start(CONCURRENCE)
    actions.expect("goal 3")
    graph.node("service_server")
    actions.expect("cancelled")
    assert program.end() == 0
    assert "[('ASK', 'succeeded'), ('WORK', 'preempted')]\n" in program.output


WRONG = """
import client
from smachac.runtime import smach_ros
from actionlib.msg import TestAction

client.node()
for arguments in (
    {"goal_slots": ["speed"]}, {"result_slots": ["speed"]}, {"goal": print}, {"goal_cb": 3}
):
    try:
        smach_ros.SimpleActionState("work", TestAction, **arguments)
    except Exception as error:
        client.say(f"{type(error).__name__}: {error}")
"""


def test_wrong_arguments_are_found_when_the_state_is_made(graph: Graph) -> None:
    faults = [line for line in graph.run(WRONG).splitlines() if line.startswith("Invalid")]
    assert faults == [
        "InvalidStateError: the goal has no slots ['speed']; it has ['goal']",
        "InvalidStateError: the result has no slots ['speed']; it has ['result']",
        "InvalidStateError: a goal is a message, no function: see goal_cb",
        "InvalidStateError: the goal callback 3 of a state cannot be called",
    ]


def test_a_goal_whose_value_does_not_fit_its_field_aborts_with_the_path(graph: Graph) -> None:
    graph.node("action_server")
    for arguments, reason in (
        ('TestGoal(goal="one")', "field goal.goal must be an integer type"),
        ("TestGoal(goal=2**40)", "field goal.goal exceeds specified width [int32]"),
        ("goal_cb=lambda ud, goal: 5", "goal"),
    ):
        output = graph.run(client(arguments))
        assert "no goal is sent to action 'work'" in output
        assert reason in output
        assert "outcome: aborted\n" in output
