"""SimpleActionState of smach_ros2 against a live action server."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = "from machine_node import *\n"


def test_ends_of_a_goal_become_outcomes(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
ud = smach.UserData()
report("succeeded", goal_state(1, result_slots=["sequence"]).execute(ud), list(ud.sequence))
report("aborted", goal_state(2, result_key="result").execute(ud), list(ud.result.sequence))
report("rejected", goal_state(3).execute(ud))
report("timed out", goal_state(4, exec_timeout=Duration(seconds=0.2)).execute(ud))
chosen = goal_state(1, result_cb=lambda ud, status, result: "chosen", outcomes=["chosen"])
report("chosen", chosen.execute(ud))
failing = goal_state(1, result_cb=lambda ud, status, result: 1 / 0)
report("failing", failing.execute(ud))
got = []
client = node.create_client(Trigger, "trigger")

def on_feedback(ud, feedback):
    got.append(feedback.sequence[0])
    if len(got) == 3:
        client.call_async(Trigger.Request())

state = goal_state(9, feedback_cb=on_feedback)
report("feedback", state.execute(ud), got)
"""
    )
    assert "succeeded: succeeded [1, 10]" in output
    assert "aborted: aborted [2, 10]" in output
    assert "rejected: aborted" in output
    assert "timed out: aborted" in output
    assert "is cancelled after 0.2 s" in output
    assert "chosen: chosen" in output
    assert "failing: aborted" in output
    assert "feedback: succeeded [0, 1, 2]" in output


def test_goals_come_from_keys_slots_and_callbacks(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
def state(**arguments):
    return smach_ros.SimpleActionState(
        node, "work", Fibonacci, result_slots=["sequence"], **arguments
    )

@smach.cb_interface(input_keys=["number"])
def from_key(ud, goal, plus=0):
    goal.order = ud.number + plus

fixed = Fibonacci.Goal(order=2)
sequence = smach.Sequence(["succeeded", "aborted", "preempted"], "succeeded")
sequence.userdata.number = 1
sequence.userdata.goal = Fibonacci.Goal(order=1)
sequence.userdata.order = 1
with sequence:
    smach.Sequence.add("KEY", state(goal_key="goal"))
    smach.Sequence.add("SLOT", state(goal=fixed, goal_slots=["order"]))
    smach.Sequence.add("REMAPPED", state(goal_slots=["order"]), remapping={"order": "number"})
    smach.Sequence.add("CHANGED", state(goal=fixed, goal_cb=from_key))
    smach.Sequence.add("ARGUMENTS", state(goal_cb=from_key, goal_cb_kwargs={"plus": 0}))
    smach.Sequence.add("NEW", state(goal_cb=lambda ud, goal: Fibonacci.Goal(order=1)))
    smach.Sequence.add("BY_PLACE", smach_ros.SimpleActionState(node, "work", Fibonacci, fixed))
report("sequence", sequence.execute(), fixed.order)
report("absent", state(goal_key="nothing").execute(smach.UserData()))
report("failing", state(goal_cb=lambda ud, goal: 1 / 0).execute(smach.UserData()))
try:
    state(goal_slots=["wrong"])
except smach.InvalidStateError as error:
    report("slots", error)
"""
    )
    assert "sequence: aborted 2" in output, "a fixed goal is not changed by a run"
    assert "absent: aborted" in output
    assert "failing: aborted" in output
    assert "slots: the goal has no slots ['wrong']; it has ['order']" in output


def test_a_preempt_request_cancels_the_goal_and_waits_for_its_end(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        START
        + """
state = goal_state(4, result_slots=["sequence"])
on_line(state.request_preempt)
ud = smach.UserData()
report("preempted", state.execute(ud), list(ud.sequence))
report("again", goal_state(1).execute(ud))
state.request_preempt()
report("before", state.execute(ud))
"""
    )
    server.expect("goal 4")
    program.say("preempt")
    server.expect("cancel 4")
    server.expect("goal 1")
    assert program.end() == 0, program.output
    assert "preempted: preempted [4]" in program.output
    assert "again: succeeded" in program.output
    assert "before: preempted" in program.output
    assert "threads left: []" in program.output
    assert server.output.count("goal 4") == 1, "a request before the goal sends nothing"


@pytest.mark.parametrize(("order", "cause"), [(5, "refuses"), (6, "ignores")])
def test_a_goal_that_does_not_end_is_given_up(graph2: Graph, order: int, cause: str) -> None:
    server = graph2.node("server")
    output = graph2.run(
        START
        + f"""
state = goal_state({order}, exec_timeout=0.1, preempt_timeout=Duration(seconds=0.3))
report({cause!r}, state.execute(smach.UserData()))
"""
    )
    server.expect(f"cancel {order}")
    assert f"{cause}: aborted" in output
    assert "was cancelled and has not ended" in output
    is_rejected = "rejected the cancel request: the end of the goal is waited for, up to 0.3 s"
    assert (is_rejected in output) == (cause == "refuses")


def test_a_server_that_is_absent_ends_the_state(graph2: Graph) -> None:
    output = graph2.run(
        START
        + """
state = goal_state(1, server_wait_timeout=Duration(seconds=0.3))
report("absent", state.execute(smach.UserData()))
state = goal_state(1)
after(0.3, state.request_preempt)
report("preempted", state.execute(smach.UserData()))
"""
    )
    assert "absent: aborted" in output
    assert "there is no server for action '/work'" in output
    assert "preempted: preempted" in output


def test_a_server_that_starts_late_is_waited_for(graph2: Graph) -> None:
    program = graph2.start(START + 'report("late", goal_state(1).execute(smach.UserData()))\n')
    graph2.node("server")
    assert program.end() == 0, program.output
    assert "late: succeeded" in program.output


def test_a_server_that_dies_during_the_goal_ends_the_state(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(START + 'report("died", goal_state(7).execute(smach.UserData()))\n')
    assert "died: aborted" in output
    assert "the server of action 'work' has ended" in output


def test_a_server_that_is_started_again_has_lost_the_goal(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        START
        + """
report("lost", goal_state(4).execute(smach.UserData()))
report("next", goal_state(1).execute(smach.UserData()))
"""
    )
    server.expect("goal 4")
    server.kill()
    graph2.node("server")
    assert program.end() == 0, program.output
    assert "lost: aborted" in program.output
    assert "next: succeeded" in program.output


def test_two_machines_use_one_server_and_two_states_one_node(graph2: Graph) -> None:
    graph2.node("server")
    text = (
        START
        + """
both = smach.Concurrence(
    outcomes=["done", "failed"],
    default_outcome="failed",
    outcome_map={"done": {"A": "succeeded", "B": "succeeded", "C": "preempted"}},
    child_termination_cb=lambda ended: ended["A"] and ended["B"],
)
with both:
    smach.Concurrence.add("A", goal_state(8))
    smach.Concurrence.add("B", smach_ros.ServiceState(node, "trigger", Trigger))
    smach.Concurrence.add("C", goal_state(4))
for _ in range(3):
    report("both", both.execute())
"""
    )
    programs = [graph2.start(text), graph2.start(text)]
    for program in programs:
        assert program.end() == 0, program.output
        assert program.output.count("both: done") == 3
        assert "threads left: []" in program.output
