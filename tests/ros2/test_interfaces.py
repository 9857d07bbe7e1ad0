"""smach_ros2 with interfaces that are no standard ones: nested messages, arrays, smach_msgs."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

SERVER = """
import rclpy
from rclpy.action import ActionServer
from smachac_test_interfaces.action import Drive
from smachac_test_interfaces.srv import Place

rclpy.init()
node = rclpy.create_node("server")

def place(request, response):
    print("part", request.parts[1].name, request.parts[1].position.tolist(), request.thing.i64)
    response.success, response.placed = True, request.parts[1]
    return response

def drive(handle):
    handle.succeed()
    x = handle.request.target.pose.position.x
    return Drive.Result(arrived=True, message=f"at {x} over {len(handle.request.over)}")

node.create_service(Place, "place", place)
server = ActionServer(node, Drive, "drive", drive)
print("ready", flush=True)
rclpy.spin(node)
"""

START = """
from machine_node import *
from geometry_msgs.msg import Point, Pose, PoseStamped
from smachac_test_interfaces.action import Drive
from smachac_test_interfaces.msg import AllFields, Part
from smachac_test_interfaces.srv import Place
"""


def test_nested_messages_and_arrays_pass_through_states(graph2: Graph) -> None:
    graph2.use_interfaces()
    server = graph2.start(SERVER)
    server.expect("ready")
    output = graph2.run(
        START
        + """
ud = smach.UserData()
ud.parts = [Part(name="a"), Part(name="b", position=[1.0, 2.0, 3.0])]
ud.thing = AllFields(i64=2**40)
state = smach_ros.ServiceState(
    node, "place", Place, request_slots=["parts", "thing"], response_slots=["placed"]
)
report("placed", state.execute(ud), ud.placed.name, type(ud.placed).__name__)
ud.over = ud.parts
ud.target = PoseStamped(pose=Pose(position=Point(x=2.5)))
state = smach_ros.SimpleActionState(
    node, "drive", Drive, goal_slots=["target", "over"], result_slots=["arrived", "message"]
)
report("driven", state.execute(ud), ud.arrived, ud.message)
ud.parts = ["no part"]
report("refused", smach_ros.ServiceState(node, "place", Place, request_slots=["parts"]).execute(ud))
ud.goal = 4
report("no goal", smach_ros.SimpleActionState(node, "drive", Drive, goal_key="goal").execute(ud))
"""
    )
    server.expect("part b [1.0, 2.0, 3.0] 1099511627776")
    assert "placed: succeeded b Part" in output
    assert "driven: succeeded True at 2.5 over 2" in output
    assert "refused: aborted" in output
    assert "no goal: aborted" in output


CALLER = """
import rclpy, threading
from rclpy.action import ActionClient
from smachac_test_interfaces.action import Drive

rclpy.init()
node = rclpy.create_node("caller")
client = ActionClient(node, Drive, "machine")
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
client.wait_for_server()
response = client.send_goal(
    Drive.Goal(speed=0.5),
    feedback_callback=lambda each: print("state", each.feedback.state, flush=True),
)
print("result", response.result.message)
rclpy.shutdown()
"""


def test_the_feedback_of_a_machine_is_the_path_of_its_active_state(graph2: Graph) -> None:
    graph2.use_interfaces()
    program = graph2.start(
        START
        + """
import sys, threading
ends = ["succeeded", "preempted"]
ends_of_states = threading.Semaphore(0)

def wait(ud):
    ends_of_states.acquire()
    return "succeeded"

inner = smach.StateMachine(ends)
with inner:
    smach.StateMachine.add("GO", smach.CBState(wait, outcomes=ends))
machine = smach.StateMachine(ends, input_keys=["speed"], output_keys=["message"])
with machine:
    smach.StateMachine.add("NAVIGATE", inner, {"succeeded": "DOCK"})
    smach.StateMachine.add("DOCK", smach.CBState(wait, outcomes=ends))
machine.userdata.message = "docked"
smach_ros.ActionServerWrapper(
    node, "machine", Drive, machine, ["succeeded"], [], ["preempted"],
    expand_goal_slots=True, pack_result_slots=True, path_slot="state",
)
while sys.stdin.readline() != "end\\n":
    ends_of_states.release()
report("speed", machine.userdata.speed)
"""
    )
    caller = graph2.start(CALLER)
    for state in ("/NAVIGATE", "/NAVIGATE/GO", "/DOCK"):
        assert caller.expect("state") == f"state {state}"
        if state != "/NAVIGATE":
            program.say("end of the state")
    caller.expect("result docked")
    program.say("end")
    assert program.end() == 0, program.output
    assert "speed: 0.5" in program.output


VIEWER = """
import base64, pickle, rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from smach_msgs.msg import SmachContainerStatus, SmachContainerStructure

rclpy.init()
node = rclpy.create_node("viewer")

def show_status(message):
    data = pickle.loads(message.local_data)
    # The client of smach_ros decodes it so.
    same = pickle.loads(base64.b64decode(message.local_data)) == data
    print("status", message.path, list(message.active_states), data, same, flush=True)

def show_structure(message):
    print("structure", message.path, list(message.children), flush=True)

node.create_subscription(SmachContainerStatus, "viewed/smach/container_status", show_status, 10)
node.create_subscription(
    SmachContainerStructure, "viewed/smach/container_structure", show_structure, 10
)
print("ready", flush=True)
rclpy.spin(node)
"""


def test_a_viewer_reads_the_messages_of_smach(graph2: Graph) -> None:
    graph2.use_interfaces()
    viewer = graph2.start(VIEWER)
    viewer.expect("ready")
    program = graph2.start(
        START
        + """
import sys
machine = smach.StateMachine(["succeeded"])
with machine:
    smach.StateMachine.add("ONLY", smach.CBState(lambda ud: "succeeded", outcomes=["succeeded"]))
machine.userdata.key = 4
server = smach_ros.IntrospectionServer("viewed", machine, "/ROOT")
server.start()
sys.stdin.readline()
report("outcome", machine.execute())
server.stop()
"""
    )
    viewer.expect("structure /ROOT ['ONLY']")
    viewer.expect("status /ROOT")
    program.say("run")
    viewer.expect("status /ROOT ['ONLY'] {'key': 4} True")
    assert program.end() == 0, program.output


COMMANDER = """
import pickle, sys
import rclpy
from smach_msgs.msg import SmachContainerInitialStatusCmd, SmachContainerStatus

class Trap:
    def __reduce__(self):
        return open, ("trap", "w")

rclpy.init()
node = rclpy.create_node("commander")

def show_status(message):
    states, userdata = list(message.initial_states), pickle.loads(message.local_data)
    print("status", states, userdata, flush=True)

node.create_subscription(SmachContainerStatus, "viewed/smach/container_status", show_status, 10)
commands = node.create_publisher(
    SmachContainerInitialStatusCmd, "viewed/smach/container_init", 10
)
while not commands.get_subscription_count():
    rclpy.spin_once(node, timeout_sec=0.02)
for state, data in [
    ("LAST", pickle.dumps({"key": 5, "pose": [1.0, (2.0, None)], "same": "LAST"}, 2)),
    ("FIRST", pickle.dumps({"key": Trap()}, 2)),
    ("LAST", b"gAJ9cQAu"),
    ("FIRST", b""),
    ("NONE", pickle.dumps({"key": 6}, 2)),
]:
    commands.publish(SmachContainerInitialStatusCmd(
        path="/ROOT", initial_states=[state], local_data=data
    ))
rclpy.spin(node)
"""

COMMANDED = (
    START
    + """
import sys
machine = smach.StateMachine(["succeeded"])
with machine:
    for name in "FIRST", "LAST":
        state = smach.CBState(lambda ud: "succeeded", outcomes=["succeeded"])
        smach.StateMachine.add(name, state)
machine.set_initial_state(["FIRST"], smach.UserData())
server = smach_ros.IntrospectionServer("viewed", machine, "/ROOT"%s)
server.start()
sys.stdin.readline()
report("userdata", {key: machine.userdata[key] for key in machine.userdata.keys()})
server.stop()
"""
)


def test_a_command_of_smach_ros_sets_the_state_and_plain_userdata(
    graph2: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    graph2.use_interfaces()
    program = graph2.start(COMMANDED % "")
    commander = graph2.start(COMMANDER)
    values = "{'key': 5, 'pose': [1.0, (2.0, None)], 'same': 'LAST'}"
    commander.expect(f"status ['LAST'] {values}")
    commander.expect(f"status ['FIRST'] {values}")
    commander.expect(f"status ['LAST'] {values}")
    commander.expect(f"status ['FIRST'] {values}")
    program.expect("container '/ROOT' has no states ['NONE'] to start in")
    program.say("end")
    assert program.end() == 0, program.output
    assert f"userdata: {values}" in program.output
    dropped = "the userdata of a command to container '/ROOT' is dropped: it "
    assert f"{dropped}has more than plain values (opcode GLOBAL)" in program.output
    assert program.output.count("is dropped: ") == 2
    assert "Traceback" not in program.output
    assert not (tmp_path / "trap").exists()


SMACH_SERVER = """
import pickle
import rclpy
from smach_msgs.msg import SmachContainerInitialStatusCmd, SmachContainerStatus

rclpy.init()
node = rclpy.create_node("server")
statuses = node.create_publisher(SmachContainerStatus, "viewed/smach/container_status", 1)

def obey(message):
    userdata = pickle.loads(message.local_data)
    print("userdata", userdata, flush=True)
    status = SmachContainerStatus(path=message.path, initial_states=message.initial_states)
    status.local_data = bytearray(pickle.dumps(userdata, 2))
    statuses.publish(status)

node.create_subscription(SmachContainerInitialStatusCmd, "viewed/smach/container_init", obey, 1)
print("ready", flush=True)
rclpy.spin(node)
"""


def test_a_client_commands_a_server_of_smach_ros(graph2: Graph) -> None:
    graph2.use_interfaces()
    server = graph2.start(SMACH_SERVER)
    server.expect("ready")
    output = graph2.run(
        START
        + """
client = smach_ros.IntrospectionClient()
userdata = smach.UserData()
userdata.key, userdata.more = [1, (2.5, None)], {"a": b"b"}
report("set", client.set_initial_state("viewed", "/ROOT", ["LAST"], userdata, timeout=60.0))
client.destroy_node()
"""
    )
    server.expect("userdata {'key': [1, (2.5, None)], 'more': {'a': b'b'}}")
    assert "set: True" in output
