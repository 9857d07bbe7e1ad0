"""ServiceState against services that answer, raise, crash, hang and are not there."""

from __future__ import annotations

import signal

import pytest

from tests.ros.ros_graph import Graph

pytestmark = pytest.mark.ros

CLIENT = """
import client
from smachac.runtime import smach, smach_ros
from std_srvs.srv import SetBool, SetBoolRequest

client.node()
machine = smach.StateMachine(["succeeded", "aborted", "preempted", "odd"])
with machine:
    smach.StateMachine.add("CALL", smach_ros.ServiceState("{service}", SetBool{arguments}))
machine.userdata.data = True
client.run(machine{keys})
"""


def client(service: str, arguments: str = "", *keys: str) -> str:
    """A machine that calls one service; `data: True` is in its userdata."""
    return CLIENT.format(
        service=service,
        arguments=arguments and f", {arguments}",
        keys="".join(f", {key!r}" for key in keys),
    )


def test_slots_go_from_userdata_into_the_request_and_back_from_the_response(graph: Graph) -> None:
    graph.node("service_server")
    slots = 'request_slots=["data"], response_slots=["success", "message"]'
    output = graph.run(client("answer", slots, "success", "message"))
    assert "success: True\nmessage: yes\noutcome: succeeded\n" in output


def test_a_fixed_request_and_a_response_key(graph: Graph) -> None:
    graph.node("service_server")
    output = graph.run(
        client("answer", 'SetBoolRequest(data=False), response_key="response"', "response")
    )
    assert 'message: "no"\noutcome: succeeded\n' in output


def test_slots_that_a_service_does_not_have_are_found_when_the_state_is_made(graph: Graph) -> None:
    for arguments, fault in (
        ("request_slots=['speed']", "the request has no slots ['speed']; it has ['data']"),
        ("response_slots=['data']", "the response has no slots ['data']; it has ['success', "),
    ):
        program = graph.start(client("answer", arguments))
        assert program.end() == 1
        assert f"InvalidStateError: {fault}" in program.output


def test_callbacks_change_the_request_and_choose_the_outcome(graph: Graph) -> None:
    graph.node("service_server")
    callbacks = (
        'input_keys=["data"], outcomes=["odd"], '
        "request_cb=lambda ud, request, value: SetBoolRequest(data=ud.data and value), "
        "request_cb_args=[True], "
        'response_cb=lambda ud, response: "odd" if response.success else None'
    )
    assert "outcome: odd\n" in graph.run(client("answer", callbacks))


def test_an_outcome_of_a_callback_that_is_not_registered_aborts(graph: Graph) -> None:
    graph.node("service_server")
    output = graph.run(client("answer", 'response_cb=lambda ud, response: "even"'))
    assert "a callback returned 'even'" in output
    assert "outcome: aborted\n" in output


def test_a_callback_that_raises_and_a_key_that_is_absent_abort_without_a_call(
    graph: Graph,
) -> None:
    server = graph.node("service_server")
    output = graph.run(client("crash", "request_cb=lambda ud, request: 1 / 0"))
    assert "ZeroDivisionError" in output
    assert "outcome: aborted\n" in output
    output = graph.run(client("crash", 'request_key="nothing"'))
    assert "keys ['nothing'] are absent" in output
    assert "outcome: aborted\n" in output
    assert "called" not in server.output


def test_a_service_that_raises_aborts(graph: Graph) -> None:
    graph.node("service_server")
    output = graph.run(client("fail"))
    assert "not today" in output
    assert "outcome: aborted\n" in output


def test_a_server_that_crashes_in_mid_call_aborts(graph: Graph) -> None:
    server = graph.node("service_server")
    output = graph.run(client("crash"))
    assert "the call of service 'crash' failed" in output
    assert "outcome: aborted\n" in output
    server.expect("called")


def test_a_service_that_is_not_there_is_waited_for(graph: Graph) -> None:
    program = graph.start(client("answer"))
    program.expect("waiting for service 'answer'")
    graph.node("service_server")
    assert program.end() == 0
    assert "outcome: succeeded\n" in program.output


def test_the_wait_for_a_service_is_preempted(graph: Graph) -> None:
    program = graph.start(client("answer"))
    program.expect("waiting for service 'answer'")
    program.say("preempt")
    assert program.end() == 0
    assert "outcome: preempted\n" in program.output


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_ends_the_wait_for_a_service(graph: Graph, number: signal.Signals) -> None:
    program = graph.start(client("answer"))
    program.expect("waiting for service 'answer'")
    program.send(number)
    assert program.end() == 0
    assert "outcome: aborted\n" in program.output


def test_ctrl_c_ends_a_call_that_hangs(graph: Graph) -> None:
    server = graph.node("service_server")
    program = graph.start(client("hang"))
    server.expect("called")
    program.send(signal.SIGINT)
    assert program.end() == 0
    assert "outcome: aborted\n" in program.output


def test_a_request_whose_value_does_not_fit_its_field_aborts_with_the_path(graph: Graph) -> None:
    graph.node("service_server")
    for arguments, reason in (
        ('SetBoolRequest(data="yes")', "field data is not a bool"),
        (
            'request_cb=lambda ud, request: setattr(request, "data", None)',
            "field data is not a bool",
        ),
        ('request_cb=lambda ud, request: "yes"', "field data is not a bool"),
    ):
        output = graph.run(client("answer", arguments))
        assert "the call of service 'answer' failed" in output
        assert reason in output
        assert "outcome: aborted\n" in output
