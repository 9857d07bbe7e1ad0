"""IntrospectionServer, heard and ordered about by another node."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ros.ros_graph import Graph, Program

pytestmark = pytest.mark.ros

PROGRAM = """
import threading
import client
from smachac.runtime import smach, smach_ros

class Step(smach.State):
    def __init__(self):
        super().__init__(["done"], input_keys=["seen"])

    def execute(self, userdata):
        client.say("at " + userdata.seen)
        client.wait_for_line()
        return "done"

client.node()
top = smach.StateMachine(["finished"])
inner = smach.StateMachine(["done"], input_keys=["seen"])
both = smach.Concurrence(["done"], "done", input_keys=["seen"])
top.userdata.seen = "first"
top.userdata.odd = threading.Lock()
with top:
    smach.StateMachine.add("ONE", Step(), {{"done": "INNER"}})
    with inner:
        smach.StateMachine.add("TWO", Step())
        smach.StateMachine.add("THREE", Step())
    smach.StateMachine.add("INNER", inner, {{"done": "BOTH"}})
    with both:
        smach.Concurrence.add("LEFT", Step())
    smach.StateMachine.add("BOTH", both, {{"done": "finished"}})
server = smach_ros.IntrospectionServer("sis", top, "/ROOT"{arguments})
server.start()
client.again(top)
client.wait_for_line()
server.stop()
client.again(top)
"""


def started(graph: Graph, arguments: str = "") -> Program:
    """The program in its first state."""
    program = graph.start(PROGRAM.format(arguments=arguments))
    program.expect("at first")
    return program


def test_a_late_subscriber_is_told_the_structure_of_all_containers(graph: Graph) -> None:
    started(graph)
    observer = graph.node("observer")
    assert observer.expect("structure /ROOT ") == (
        "structure /ROOT ['ONE', 'INNER', 'BOTH'] [('done', 'ONE', 'INNER'), "
        "('done', 'INNER', 'BOTH'), ('done', 'BOTH', 'finished')] ['finished']"
    )
    assert observer.expect("structure /ROOT/INNER ") == (
        "structure /ROOT/INNER ['TWO', 'THREE'] [('done', 'TWO', 'None'), "
        "('done', 'THREE', 'None')] ['done']"
    )
    assert observer.expect("structure /ROOT/BOTH ") == ("structure /ROOT/BOTH ['LEFT'] [] ['done']")


def test_starts_transitions_and_ends_are_told(graph: Graph) -> None:
    program = started(graph)
    observer = graph.node("observer")
    told = observer.expect("status /ROOT ")
    assert told.startswith("status /ROOT ['ONE'] ['ONE'] {'seen': 'first', 'odd': '<unlocked _th")
    program.say("on")
    assert "['ONE'] ['INNER']" in observer.expect("status /ROOT ['ONE'] ['INNER']")
    observer.expect("status /ROOT/INNER ['TWO'] ['TWO'] {'seen': 'first'}")
    program.expect("at first")
    program.say("on")
    observer.expect("status /ROOT/INNER ['TWO'] ['None']")
    observer.expect("status /ROOT ['ONE'] ['BOTH']")
    observer.expect("status /ROOT/BOTH ['LEFT'] ['LEFT']")
    program.expect("at first")
    program.say("on")
    observer.expect("status /ROOT/BOTH ['LEFT'] []")
    observer.expect("status /ROOT ['ONE'] ['None']")
    program.expect("outcome: finished")


def test_an_order_moves_the_start_but_what_came_pickled_is_dropped(
    graph: Graph, tmp_path: Path
) -> None:
    program = started(graph)
    trap = tmp_path / "trap"
    observer = graph.node("observer", str(trap))
    observer.expect("status /ROOT ")
    observer.say("/ROOT/INNER THREE bomb")
    program.expect("is dropped: it has more than plain values")
    observer.expect("REMOTE_INIT")
    program.say("on")
    observer.expect("status /ROOT/INNER ['THREE'] ['THREE'] {'seen': 'first'}")
    assert not trap.exists()


def test_an_order_to_start_in_no_state_of_the_container_is_refused(graph: Graph) -> None:
    program = started(graph)
    observer = graph.node("observer")
    observer.say("/ROOT/INNER ONE data")
    program.expect("container '/ROOT/INNER' has no states ['ONE'] to start in")
    program.say("on")
    assert observer.expect("['ONE'] ['INNER']")
    assert observer.expect("status /ROOT/INNER ['TWO'] ['TWO']")


CLIENT = """
import sys
import client
from smachac.runtime import smach_ros

client.node("viewer")
viewer = smach_ros.IntrospectionClient()
client.say(f"servers: {viewer.get_servers()}")
client.say(f"obeyed: {viewer.set_initial_state('/sis', '/ROOT/INNER', ['THREE'], None, 60)}")
client.say(f"obeyed: {viewer.set_initial_state('/sis', '/ROOT/INNER', ['ONE'], None, 0.1)}")
"""


def test_a_client_finds_the_server_and_is_told_whether_it_obeys(graph: Graph) -> None:
    program = started(graph)
    output = graph.run(CLIENT)
    assert "servers: ['/sis']\nobeyed: True\nobeyed: False\n" in output
    program.say("on")
    assert program.expect("starting in 'THREE'")


@pytest.mark.parametrize("more", ["", ", unpickle=True"])
def test_plain_userdata_of_an_order_is_taken(more: str, graph: Graph) -> None:
    program = started(graph, more)
    observer = graph.node("observer")
    observer.say("/ROOT INNER data")
    observer.expect("status /ROOT ['INNER']")
    program.say("on")
    assert program.expect("at told")


def test_a_server_that_is_stopped_is_silent_and_the_machine_runs_on(graph: Graph) -> None:
    program = started(graph)
    for _ in range(3):
        program.say("on")
        program.expect("at first" if _ < 2 else "outcome: finished")
    program.say("stop")
    program.expect("at first")
    assert not [name for name, _ in graph.ask("getSystemState")[0] if name.startswith("/sis")]
    for _ in range(3):
        program.say("on")
        program.expect("at first" if _ < 2 else "outcome: finished")
    assert program.end() == 0


MESSAGES = """
import client
from smachac.runtime.smach_ros import messages

for make in (
    messages.container_status, messages.container_structure, messages.initial_status_command
):
    print(make()._type, make()._md5sum, make()._has_header)
"""


def test_messages_are_those_of_smach_msgs(graph: Graph) -> None:
    output = graph.run(MESSAGES)
    assert "smach_msgs/SmachContainerStatus 5ba2bb79ac19e3842d562a191f2a675b True\n" in output
    assert "smach_msgs/SmachContainerStructure 3d3d1e0d0f99779ee9e58101a5dcf7ea True\n" in output
    command = "smach_msgs/SmachContainerInitialStatusCmd 45f8cf31fc29b829db77f23001f788d6 False\n"
    assert command in output


def test_a_leaf_has_nothing_to_look_into(graph: Graph) -> None:
    text = "from smachac.runtime import smach, smach_ros\n"
    text += "smach_ros.IntrospectionServer('sis', smach.State(['done']), '/ROOT').start()\n"
    program = graph.start(text)
    assert program.end() == 1
    assert "InvalidStateError: a State has nothing to look into" in program.output


VIEW = """
import time
from smachac.view.ros_topic import open_topic
from smachac.view.statuses import StatusEvents, report_of

topic, statuses = open_topic("sis"), StatusEvents()
print("awaits", topic.awaited, flush=True)
outcome = None
while outcome is None:
    reports = filter(None, map(report_of, topic.read()))
    for event in statuses.events(reports):
        print(event["event"], event["path"], event.get("outcome"), flush=True)
        if event["event"] == "finish":
            outcome = event["outcome"]
    time.sleep(0.02)
topic.close()
"""


def test_a_view_shows_the_run(graph: Graph) -> None:
    """`smachac view --attach ros:sis`, without the page: the events of the statuses."""
    view = graph.start(VIEW)
    view.expect("awaits /sis/smach/container_status")
    program = started(graph)
    view.expect("enter ROOT/ONE")
    program.say("on")
    view.expect("exit ROOT/ONE")
    view.expect("enter ROOT/INNER None")
    view.expect("enter ROOT/INNER/TWO")
    program.say("on")
    view.expect("exit ROOT/INNER done")
    view.expect("enter ROOT/BOTH/LEFT")
    program.say("on")
    view.expect("exit ROOT/BOTH done")
    view.expect("finish ROOT finished")
    assert view.end() == 0, view.output
