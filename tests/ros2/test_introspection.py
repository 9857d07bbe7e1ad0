"""IntrospectionServer of smach_ros2 without smach_msgs: JSON texts on latched topics."""

from __future__ import annotations

import json

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

PROGRAM = """
import json, time
from machine_node import *
from smachac.runtime.smach_ros2.topics import wait_for_message

def machine():
    ends = ["succeeded", "preempted"]
    inner = smach.StateMachine(ends)
    with inner:
        smach.StateMachine.add("FIRST", smach.CBState(lambda ud: "succeeded", outcomes=ends))
    outer = smach.StateMachine(ends)
    with outer:
        smach.StateMachine.add("INNER", inner, {"succeeded": "LAST"})
        smach.StateMachine.add("LAST", smach.CBState(lambda ud: "succeeded", outcomes=ends))
    return outer

outer = machine()
server = smach_ros.IntrospectionServer("viewed", outer, "/ROOT")
server.start()
received = {}
for name in "container_structure", "container_status":
    def keep(message, name=name):
        fields = json.loads(message.data)
        received.setdefault(name, {}).setdefault(fields["path"], []).append(fields)
    node.create_subscription(
        String, f"viewed/smach/{name}_json", keep,
        smach_ros.introspection.latched(20),
    )
"""


def test_a_late_subscriber_gets_structure_and_status_of_all_containers(graph2: Graph) -> None:
    output = graph2.run(
        PROGRAM
        + """
while len(received) < 2 or min(map(len, received.values())) < 2:
    time.sleep(0.02)
outer.userdata.key = 1
report("outcome", outer.execute())
reports = received["container_status"]["/ROOT"]
while not any("succeeded" in each["info"] for each in reports):
    time.sleep(0.02)
report("structure", json.dumps(received["container_structure"]["/ROOT"][0]))
states = [each["active_states"] for each in reports]
report("last", "LAST" in sum(states, []))
server.stop()
"""
    )
    line = next(item for item in output.splitlines() if item.startswith("structure: "))
    structure = json.loads(line.removeprefix("structure: "))
    assert structure["children"] == ["INNER", "LAST"]
    assert structure["container_outcomes"] == ["succeeded", "preempted"]
    assert ["succeeded", "INNER", "LAST"] in [
        list(edge)
        for edge in zip(
            structure["internal_outcomes"],
            structure["outcomes_from"],
            structure["outcomes_to"],
            strict=True,
        )
    ]
    assert "last: True" in output
    assert "outcome: succeeded" in output


def test_a_client_finds_servers_and_sets_the_initial_state(graph2: Graph) -> None:
    output = graph2.run(
        PROGRAM
        + """
client = smach_ros.IntrospectionClient()
while "/viewed" not in client.get_servers():
    time.sleep(0.02)
userdata = smach.UserData()
userdata.key = 1
limit = Duration(seconds=20)
done = client.set_initial_state("/viewed", "/ROOT", ["LAST"], userdata, timeout=limit)
report("set", done, outer.get_initial_states(), "key" in outer.userdata)
server.stop()
"""
    )
    assert "set: True ['LAST'] True" in output


def test_a_client_and_a_server_are_spun_from_their_construction(graph2: Graph) -> None:
    output = graph2.run(
        PROGRAM
        + """
client = smach_ros.IntrospectionClient()
waiting = smach_ros.IntrospectionServer("waiting", machine(), "/ROOT")
for each in client, waiting:
    rate = each.create_rate(10)
    rate.sleep()
    report("slept", each.get_name())
client.destroy_node()
waiting.stop()
server.stop()
"""
    )
    assert "slept: introspection_client" in output
    assert "slept: waiting_introspection" in output


def test_commands_that_cannot_be_read_are_logged(graph2: Graph) -> None:
    output = graph2.run(
        PROGRAM
        + """
commands = node.create_publisher(String, "viewed/smach/container_init_json", 10)
while not commands.get_subscription_count():
    time.sleep(0.02)
command = {"path": "/ROOT", "initial_states": ["LAST"], "local_data": ""}
for data in "", "[]", "{}", "1", json.dumps({**command, "local_data": "a"}), "[" * 99999:
    commands.publish(String(data=data))
commands.publish(String(data=json.dumps({**command, "initial_states": 1})))
commands.publish(String(data=json.dumps(command)))
while outer.get_initial_states() != ["LAST"]:
    time.sleep(0.02)
server.stop()
"""
    )
    assert output.count("a command to a container cannot be read: ") == 2 * 7  # of each container
    assert "Traceback" not in output
