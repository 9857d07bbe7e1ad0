"""ServiceState of smach_ros2 against live services."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = "from machine_node import *\n"


def test_the_log_names_a_service_that_is_waited_for(graph2: Graph) -> None:
    output = graph2.run(
        """
from machine_node import *
from smachac.runtime.smach_ros2 import ros_state

ros_state.SILENCE_LIMIT = 0.1
state = smach_ros.ServiceState(node, "dock", Trigger, server_wait_timeout=0.3)
report("outcome", state.execute(smach.UserData()))
"""
    )
    assert "there is no server for service '/dock' yet: it is waited for, up to 0.3 s" in output
    assert "service '/dock' is not available" in output
    assert "outcome: aborted" in output


def test_a_call_passes_request_and_response(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
ud = smach.UserData()
ud.data = True
fixed = SetBool.Request(data=False)
state = smach_ros.ServiceState(node, "invert", SetBool, fixed, response_slots=["success"])
report("fixed", state.execute(ud), ud.success)
state = smach_ros.ServiceState(
    node, "invert", SetBool, fixed, request_slots=["data"], response_key="response"
)
report("slots", state.execute(ud), ud.response.success, fixed.data)

@smach.cb_interface(output_keys=["text"], outcomes=["chosen"])
def keep(ud, response):
    ud.text = response.message
    return "chosen"

def fill(ud, request):
    request.data = True

state = smach_ros.ServiceState(node, "invert", SetBool, request_cb=fill, response_cb=keep)
report("callbacks", state.execute(ud), ud.text)
state = smach_ros.ServiceState(node, "invert", SetBool, request_key="nothing")
report("absent", state.execute(ud))
ud.data = "text"
state = smach_ros.ServiceState(node, "invert", SetBool, request_slots=["data"])
report("wrong type", state.execute(ud))
"""
    )
    assert "fixed: succeeded True" in output
    assert "slots: succeeded False False" in output, "a fixed request is not changed by a run"
    assert "callbacks: chosen True" in output
    assert "absent: aborted" in output
    assert "wrong type: aborted" in output


def test_every_wait_for_a_service_ends(graph2: Graph) -> None:
    server = graph2.node("server")
    output = graph2.run(
        START
        + """
def state(name, **arguments):
    return smach_ros.ServiceState(node, name, Trigger, **arguments)

ud = smach.UserData()
report("absent", state("nothing", server_wait_timeout=0.2).execute(ud))
waiting = state("nothing")
after(0.2, waiting.request_preempt)
report("preempted", waiting.execute(ud))
report("slow", state("hang", response_timeout=Duration(seconds=0.2)).execute(ud))
hanging = state("hang", preempt_timeout=0.2)
after(0.2, hanging.request_preempt)
report("hanging", hanging.execute(ud))
"""
    )
    server.expect("called")
    assert "absent: aborted" in output
    assert "preempted: preempted" in output
    assert "slow: aborted" in output
    assert "hanging: preempted" in output


def test_a_call_that_ends_in_time_after_a_preempt_request_is_used(graph2: Graph) -> None:
    server = graph2.node("server")
    program = graph2.start(
        START
        + """
state = smach_ros.ServiceState(node, "hang", Trigger, response_slots=["message"])
ud = smach.UserData()
on_line(state.request_preempt)
report("late", state.execute(ud), ud.message, state.preempt_requested())
"""
    )
    server.expect("called")
    program.say("preempt")
    program.expect("requested")
    server.say("release")
    assert program.end() == 0, program.output
    assert "late: succeeded late True" in program.output


def test_a_server_that_dies_during_the_call_ends_the_state(graph2: Graph) -> None:
    graph2.node("server")
    output = graph2.run(
        START
        + """
state = smach_ros.ServiceState(node, "die", Trigger)
report("died", state.execute(smach.UserData()))
"""
    )
    assert "died: aborted" in output
    assert "its server has ended" in output
