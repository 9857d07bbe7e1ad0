"""Values of messages: what every sender of smach_ros2 sends, and what it refuses, with its path."""

from __future__ import annotations

import json
from typing import Any

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

SERVER = """
import json
import rclpy
from smachac_test_interfaces.msg import AllFields
from smachac_test_interfaces.srv import Place
from test_msgs.srv import Arrays, BasicTypes

def plain(value):
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, bytes):
        return list(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    return [plain(each) for each in value] if isinstance(value, list) else value

def show(request, response):
    print("got", json.dumps(plain(request)), flush=True)
    return response

rclpy.init()
node = rclpy.create_node("server")
for kind in (Arrays, BasicTypes, Place):
    node.create_service(kind, kind.__name__.lower(), show)
print("ready", flush=True)
rclpy.spin(node)
"""

CALLS = """
import array, decimal, fractions
import numpy
from machine_node import *
from geometry_msgs.msg import Point, Pose
from smachac_test_interfaces.msg import AllFields, Part
from smachac_test_interfaces.srv import Place
from test_msgs.srv import Arrays, BasicTypes

def call(kind, request):
    '''Call a service with a request of a key.'''
    ud = smach.UserData()
    ud.request = request
    state = smach_ros.ServiceState(
        node, kind.__name__.lower(), kind, request_key="request", server_wait_timeout=20.0
    )
    report("outcome", state.execute(ud))
"""

SENT: dict[str, tuple[str, Any]] = {
    "bool_value=1": ("bool_value", True),
    "bool_value=0": ("bool_value", False),
    "bool_value=numpy.bool_(True)": ("bool_value", True),
    "byte_value=200": ("byte_value", [200]),
    "char_value=numpy.uint8(65)": ("char_value", 65),
    "float32_value=3": ("float32_value", 3.0),
    "float32_value=numpy.float64(0.5)": ("float32_value", 0.5),
    "float64_value=1": ("float64_value", 1.0),
    "float64_value=-(2**53)": ("float64_value", -(2.0**53)),
    "float64_value=numpy.float32(1.5)": ("float64_value", 1.5),
    "float64_value=numpy.int16(-7)": ("float64_value", -7.0),
    "float64_value=fractions.Fraction(1, 4)": ("float64_value", 0.25),
    "float64_value=float('inf')": ("float64_value", float("inf")),
    "float32_value=float('-inf')": ("float32_value", float("-inf")),
    "int8_value=-128": ("int8_value", -128),
    "uint8_value=numpy.int64(255)": ("uint8_value", 255),
    "int16_value=numpy.int8(-3)": ("int16_value", -3),
    "uint16_value=65535": ("uint16_value", 65535),
    "int32_value=-(2**31)": ("int32_value", -(2**31)),
    "uint32_value=2**32 - 1": ("uint32_value", 2**32 - 1),
    "int64_value=2**63 - 1": ("int64_value", 2**63 - 1),
    "uint64_value=2**64 - 1": ("uint64_value", 2**64 - 1),
    "string_value='\u00fc'": ("string_value", "\u00fc"),
}
"""Values of the fields of test_msgs/srv/BasicTypes, and what the server gets."""

REFUSED = {
    "bool_value=2": "`request.bool_value` is bool, not 2",
    "bool_value='true'": "`request.bool_value` is bool, not 'true'",
    "bool_value=1.0": "`request.bool_value` is bool, not 1.0",
    "byte_value=256": "`request.byte_value` is byte, not 256",
    "byte_value=b'ab'": "`request.byte_value` is byte, not b'ab'",
    "char_value='a'": "`request.char_value` is uint8, not 'a'",
    "float32_value=1e39": "`request.float32_value` is float32, not 1e+39",
    "float32_value=10**400": "`request.float32_value` is float32, not 1000",
    "float64_value='1.0'": "`request.float64_value` is float64, not '1.0'",
    "float64_value=True": "`request.float64_value` is float64, not True",
    "float64_value=None": "`request.float64_value` is float64, not None",
    "float64_value=decimal.Decimal(1)": "`request.float64_value` is float64, not Decimal('1')",
    "int8_value=128": "`request.int8_value` is int8, not 128",
    "uint8_value=-1": "`request.uint8_value` is uint8, not -1",
    "int16_value=2.0": "`request.int16_value` is int16, not 2.0",
    "uint16_value=2**16": "`request.uint16_value` is uint16, not 65536",
    "int32_value=2**31": "`request.int32_value` is int32, not 2147483648",
    "uint32_value=numpy.int64(-1)": "`request.uint32_value` is uint32, not",
    "int64_value=2**63": "`request.int64_value` is int64, not 9223372036854775808",
    "uint64_value=2**64": "`request.uint64_value` is uint64, not 18446744073709551616",
    "string_value=5": "`request.string_value` is string, not 5",
    "string_value=b'text'": "`request.string_value` is string, not b'text'",
    "string_value='a' + chr(0)": "`request.string_value` is string, which cannot contain the null",
    "string_value=chr(0xDC80)": "`request.string_value` is string, and the character '\\udc80' is",
}
"""Values that do not fit the fields of test_msgs/srv/BasicTypes, and what the log contains."""


def test_every_primitive_type_is_sent_as_it_was_meant_or_refused(graph2: Graph) -> None:
    graph2.use_interfaces()
    server = graph2.start(SERVER)
    server.expect("ready")
    calls = [f"call(BasicTypes, BasicTypes.Request({item}))" for item in (*SENT, *REFUSED)]
    output = graph2.run("\n".join([CALLS, *calls]))
    outcomes = [line for line in output.splitlines() if line.startswith("outcome")]
    assert outcomes == [
        *["outcome: succeeded"] * len(SENT),
        *["outcome: aborted"] * len(REFUSED),
    ]
    for field, wanted in SENT.values():
        got = json.loads(server.expect("got").removeprefix("got"))[field]
        assert (type(got), got) == (type(wanted), wanted), field
    for reason in REFUSED.values():
        assert f"nothing is sent to 'basictypes': {reason}" in output


SENT_LISTS = {
    "bool_values=[1, False, numpy.bool_(True)]": ("bool_values", [True, False, True]),
    "byte_values=[1, b'a', 255]": ("byte_values", [[1], [97], [255]]),
    "byte_values=b'abc'": ("byte_values", [[97], [98], [99]]),
    "float64_values=[1, 2, 3]": ("float64_values", [1.0, 2.0, 3.0]),
    "float64_values=numpy.arange(3)": ("float64_values", [0.0, 1.0, 2.0]),
    "float32_values=numpy.array([1.5, 2, 3])[::-1]": ("float32_values", [3.0, 2.0, 1.5]),
    "float64_values=numpy.arange(6.0)[::2]": ("float64_values", [0.0, 2.0, 4.0]),
    "uint8_values=b'abc'": ("uint8_values", [97, 98, 99]),
    "int16_values=array.array('q', [1, 2, 3])": ("int16_values", [1, 2, 3]),
    "string_values=('a', 'b', 'c')": ("string_values", ["a", "b", "c"]),
}

REFUSED_LISTS = {
    "bool_values=[True, False, 2]": "`request.bool_values[2]` is bool, not 2",
    "byte_values=['a', 'b', 'c']": "`request.byte_values[0]` is byte, not 'a'",
    "float64_values=[1.0]": "`request.float64_values` is float64[3], and the list has 1 values",
    "float64_values=numpy.ma.array([1.0, 2.0, 3.0], mask=[0, 1, 0])": (
        "`request.float64_values[1]` is float64, not None"
    ),
    "float64_values=numpy.eye(3)": "`request.float64_values` is float64[3], and the array has the",
    "string_values='abc'": "`request.string_values` is string[3], not 'abc'",
    "string_values=['a', 'b', 3]": "`request.string_values[2]` is string, not 3",
    "basic_types_values=[{'int8_value': 1}, {}, {'int8': 1}]": (
        "`request.basic_types_values[2].int8` does not exist: the fields of"
    ),
    "basic_types_values=[Point(), Point(), Point()]": (
        "`request.basic_types_values[0]` is test_msgs/msg/BasicTypes, not geometry_msgs/msg/Point"
    ),
}


def test_lists_are_sent_as_they_were_meant_or_refused(graph2: Graph) -> None:
    graph2.use_interfaces()
    server = graph2.start(SERVER)
    server.expect("ready")
    calls = [f"call(Arrays, dict({list_}))" for list_ in (*SENT_LISTS, *REFUSED_LISTS)]
    output = graph2.run("\n".join([CALLS, *calls]))
    outcomes = [line for line in output.splitlines() if line.startswith("outcome")]
    assert outcomes == [
        *["outcome: succeeded"] * len(SENT_LISTS),
        *["outcome: aborted"] * len(REFUSED_LISTS),
    ]
    for field, wanted in SENT_LISTS.values():
        assert json.loads(server.expect("got").removeprefix("got"))[field] == wanted, field
    for reason in REFUSED_LISTS.values():
        assert f"nothing is sent to 'arrays': {reason}" in output


def test_nested_messages_are_checked_whoever_built_them(graph2: Graph) -> None:
    graph2.use_interfaces()
    server = graph2.start(SERVER)
    server.expect("ready")
    output = graph2.run(
        CALLS
        + """
from smachac.runtime.smach_ros2.message_fields import checking

call(Place, {"thing": {"stamp": 2.01, "length": -0.5, "few": (1, 2), "wide": "a" + chr(0)}})
call(Place, Place.Request(parts=[Part(pose=Pose(position=Point(x=1, y=numpy.float32(2))))]))
call(Place, Place.Request(parts=[Part(), Part(name=7)]))
call(Place, Place.Request(thing=AllFields(short_text="123456789")))
call(Place, Place.Request(thing=AllFields(few=[1, 2, 3, 4, 5])))
call(Place, Place.Request(thing=Part()))
call(Place, Part())
call(Place, None)
ud = smach.UserData()
ud.parts = [Part(position=[1.0])]

def place(**arguments):
    state = smach_ros.ServiceState(node, "place", Place, **arguments)
    report("outcome", state.execute(ud))

def wrong(ud, request):
    request.thing.part.pose.position.x = "far"

def converted(ud, request):
    request.thing.part.pose.position.x = 4

place(request_slots=["parts"])
place(request_cb=wrong)
place(request_cb=checking(Place.Request, wrong))
place(request_cb=converted)
place(request_cb=lambda ud, request: {"parts": [{"name": "by a mapping"}]})
"""
    )
    words = [line.partition(" ")[2] for line in output.splitlines() if line.startswith("outcome")]
    assert words == ["succeeded"] * 2 + ["aborted"] * 9 + ["succeeded"] * 2
    thing = json.loads(server.expect("got").removeprefix("got"))["thing"]
    assert thing["stamp"] == {"sec": 2, "nanosec": 10_000_000}
    assert thing["length"] == {"sec": -1, "nanosec": 500_000_000}
    assert (thing["few"], thing["wide"]) == ([1, 2], "a\0")
    parts = json.loads(server.expect("got")[4:])["parts"]
    assert parts[0]["pose"]["position"] == {"x": 1, "y": 2, "z": 0}
    thing = json.loads(server.expect("got")[4:])["thing"]
    assert thing["part"]["pose"]["position"]["x"] == 4.0
    assert json.loads(server.expect("got")[4:])["parts"][0]["name"] == "by a mapping"
    for reason in (
        "`request.parts[1].name` is string, not 7",
        "`request.thing.short_text` is string<=8, and the text has 9 characters",
        "`request.thing.few` is int32[<=4], and the list has 5 values",
        "`request.thing` is smachac_test_interfaces/msg/AllFields, not smachac_test_interfaces/msg",
        "`request` is smachac_test_interfaces/srv/Place_Request, not smachac_test_interfaces/msg",
        "Place_Request (a mapping or a list of thing, parts), not None",
        "`request.parts[0].position` is float64[3], and the list has 1 values",
        "`request.thing.part.pose.position.x` is float64, not 'far'",
    ):
        assert reason in output


def test_published_messages_are_checked_each_time(graph2: Graph) -> None:
    output = graph2.run(
        """
from machine_node import *
from std_msgs.msg import Bool, Float64, Header
from geometry_msgs.msg import PointStamped
from smachac.runtime.smach_ros2.publish_states import PublishMsgState, PublishObserverMsgState
from smachac.runtime.smach_ros2.topics import wait_for_message

def publish(action="start", **keys):
    ud = smach.UserData()
    for name, value in keys.items():
        ud[name] = value
    state = PublishMsgState(node, action, "values", input_keys=list(keys), qos="latched")
    report("publish", state.execute(ud))

publish(msg=Float64(data=1), topic="whole")
report("whole", wait_for_message(node, "whole", Float64, qos="latched").data)
publish(msg={"data": 1}, msg_type="std_msgs/Bool", topic="truth")
report("truth", wait_for_message(node, "truth", Bool, qos="latched").data)
publish(msg=String(data=5), topic="text")
publish("once", msg=Bool(data="yes"), topic="text")
publish(msg=Bool(), msg_type="std_msgs/Float64", topic="text")
publish(msg=PointStamped(), frame_id=7, topic="text")
publish(msg=Float64(), callback=lambda message: Float64(data="x"), topic="number")
report("silent", wait_for_message(node, "text", Float64, timeout=0.1))
publish("stop_all")

source = node.create_publisher(Int32, "source", 1)
ud = smach.UserData()
ud.msg, ud.topic = Float64(data=2), "echo"
observer = PublishObserverMsgState(node, "add", "echo", sub_topic="source")
report("observer", observer.execute(ud))
ud.msg = Float64(data="text")
report("observer", observer.execute(ud))
"""
    )
    words = [line for line in output.splitlines() if line.startswith("publish:")]
    assert words == [
        *["publish: succeeded"] * 2,
        *["publish: aborted"] * 5,
        "publish: succeeded",
    ]
    assert "silent: None" in output
    assert "whole: 1.0" in output
    assert "truth: True" in output
    assert "observer: succeeded\n" in output
    assert "observer: aborted\n" in output
    for reason in (
        "`msg.data` is string, not 5",
        "`msg.data` is bool, not 'yes'",
        "`msg` is std_msgs/msg/Float64, not std_msgs/msg/Bool",
        "`msg.header.frame_id` is string, not 7",
        "`msg.data` is float64, not 'x'",
    ):
        assert f"the message is invalid: {reason}" in output


def test_a_periodic_publication_ends_with_a_message_that_does_not_fit(graph2: Graph) -> None:
    output = graph2.run(
        """
from machine_node import *
import threading
from std_msgs.msg import Float64
from smachac.runtime.smach_ros2.topics import Publications

values, ended = iter([1.0, 2, "three"]), threading.Event()

def create():
    value = next(values, None)
    if value == "three":
        ended.set()
    return Float64(data=value)

publications = Publications(node)
publications.start("values", Float64, create, rate=50)
assert ended.wait(20)
publications.stop_all()
"""
    )
    assert output.count("the publication on 'values' ends: `msg.data` is float64, not 'three'") == 1
    assert "not None" not in output


GOALS = """
from machine_node import *

class Answer(smach.State):
    '''Writes what the goal describes: a result, feedback.'''

    def __init__(self):
        keys = ["action_result", "action_feedback"]
        super().__init__(["succeeded"], ["order"], keys)

    def execute(self, ud):
        ud.action_result = Fibonacci.Result(sequence=[ud.order])
        if ud.order == 1:
            ud.action_result = {"sequence": ["one"]}
        if ud.order == 2:
            ud.action_feedback = String(data="no feedback")
        return "succeeded"

machine = smach.StateMachine(["succeeded"], ["order"], ["action_result", "action_feedback"])
with machine:
    smach.StateMachine.add("ANSWER", Answer(), {"succeeded": "LAST"})
    smach.StateMachine.add("LAST", smach.CBState(lambda ud: "succeeded", outcomes=["succeeded"]))
wrapper = smach_ros.ActionServerWrapper(
    node, "work", Fibonacci, machine, ["succeeded"], expand_goal_slots=True
)
report("serves")
"""


def test_goals_results_and_feedback_are_checked(graph2: Graph) -> None:
    server = graph2.start(GOALS + "import sys\nsys.stdin.readline()\n")
    server.expect("serves")
    output = graph2.run(
        """
from machine_node import *
import numpy

def go(**arguments):
    ud = smach.UserData()
    ud.order = arguments.pop("order", None)
    state = smach_ros.SimpleActionState(
        node, "work", Fibonacci, result_slots=["sequence"], **arguments
    )
    outcome = state.execute(ud)
    report("goal", outcome, list(ud.sequence) if outcome == "succeeded" else "")

go(goal=Fibonacci.Goal(order=numpy.int64(5)))
go(goal=Fibonacci.Goal(order=5.0))
go(goal=Fibonacci.Goal(order=2**31))
go(goal_slots=["order"], order="5")
go(goal_cb=lambda ud, goal: Fibonacci.Result())
go(goal=Fibonacci.Goal(order=1))
go(goal=Fibonacci.Goal(order=2))
"""
    )
    words = [line for line in output.splitlines() if line.startswith("goal:")]
    assert words == ["goal: succeeded [5]", *["goal: aborted "] * 5, "goal: succeeded [2]"]
    for reason in (
        "`goal.order` is int32, not 5.0",
        "`goal.order` is int32, not 2147483648",
        "`goal.order` is int32, not '5'",
        "`goal` is test_msgs/action/Fibonacci_Goal, not test_msgs/action/Fibonacci_Result",
    ):
        assert f"nothing is sent to 'work': {reason}" in output
    server.expect("`result.sequence[0]` is int32, not 'one'")
    server.say("end")
    assert server.end() == 0, server.output
    feedback = "no feedback of an action server is sent: `feedback` is"
    assert (
        f"{feedback} test_msgs/action/Fibonacci_Feedback, not std_msgs/msg/String" in server.output
    )


def test_values_of_every_type_are_converted_or_refused_with_their_path(graph2: Graph) -> None:
    graph2.use_interfaces()
    laws = graph2.node("message_laws")
    assert laws.end() == 0, laws.output
    assert "sent: 8 messages of each of" in laws.output


DURATIONS = """
from smachac.runtime.smach_ros2.ros import duration

print([duration(each).nanoseconds for each in (2.01, 0.1, 5, 1.9999999999, -0.5, 1e-9, 86400.3)])
print("threads left: []")
"""


def test_a_duration_is_the_nearest_to_its_seconds(graph2: Graph) -> None:
    nanoseconds = [
        2_010_000_000,
        100_000_000,
        5_000_000_000,
        2_000_000_000,
        -500_000_000,
        1,
        86_400_300_000_000,
    ]
    assert f"{nanoseconds}\n" in graph2.run(DURATIONS)
