"""Messages of common packages of ROS are checked without an installation: types, fields, values."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

STATE = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {limit: 3.0}
states:
  - STEP:
      template: {template}
      {fields}
      transitions: {{{transitions}}}
"""
CLASS = """
import rospy
import smach
{imports}


class Look(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"])
        self.got = None
        rospy.Subscriber("/t", Temperature, self.on_message)

    def execute(self, userdata):
        {body}
        self.got = message
        return "done"

    def on_message(self, message):
        self.got = {got}

    def on_other(self, message: Temperature) -> None:
        self.got = message.variance
"""
FILES = {
    "main.yml": "name: sm\ntemplate: Base\noutcomes: [done]\n"
    "states: [{LOOK: {template: Look, transitions: {done: done}}}]\n",
    "templates/Look.yml": "name: Look\noutcomes: {done: {}}\ncode: {python: 'cell.look:Look'}\n",
}


def report(script: str, files: dict[str, str]) -> list[tuple[str, str, str | None]]:
    """The marked text, the message and the help of the findings of SM512."""
    found = analyse(Source("main.yml", script), memory_library(files, BUILT_IN), []).report
    return [
        (item.span.text, item.finding.message, item.finding.help)
        for item in found
        if item.code == "SM512"
    ]


def monitor(type: str, code: str, files: dict[str, str] | None = None) -> list[str | None]:
    """The helps for a condition on messages of a type."""
    fields = f"topic: t\n      msg_type: {type}\n      input_keys: [limit]\n      timeout: 5.0\n"
    fields += f"      cond_cb: 'lambda userdata, message: {code}'"
    script = STATE.replace("{limit: 3.0}", "{{limit: 3.0}}").format(
        template="MonitorState",
        fields=fields,
        transitions="valid: done, invalid: failed, preempted: failed",
    )
    return [help for _, _, help in report(script, files or {})]


def server(template: str, fields: str) -> list[str | None]:
    script = STATE.replace("{limit: 3.0}", "{{limit: 3.0}}").format(
        template=template,
        fields=fields,
        transitions="succeeded: done, aborted: failed, preempted: failed",
    )
    return [help for _, _, help in report(script, {})]


def look(
    imports: str = "", body: str = "message = 1", got: str = "1"
) -> list[tuple[str, str, str | None]]:
    imports = f"from sensor_msgs.msg import Temperature\n{imports}"
    code = CLASS.format(imports=imports, body=body.replace("\n", "\n        "), got=got)
    return report(FILES["main.yml"], {**FILES, "cell/look.py": code})


@pytest.mark.parametrize(
    ("type", "help"),
    [
        ("std_msgs/Float", "write `Float32` or `Float64`"),
        ("std_msgs/msg/Int", "write `Int8`, `Int16`, `Int32` or `Int64`"),
        ("std_msgs/float32", "did you mean `Float32`?"),
        ("std_msgs/Double", "did you mean `Float64`?"),
        ("std_msgs/Boolean", "did you mean `Bool`?"),
        ("geometry_msgs/PoseStamp", "did you mean `PoseStamped`?"),
        ("sensor_msgs/Laser", "did you mean `LaserScan`?"),
        ("geometry_msgs/JointState", "write `sensor_msgs/JointState`, which is in another package"),
        ("move_base_msgs/MoveBasGoal", "did you mean `MoveBaseGoal`?"),
    ],
)
def test_a_type_that_its_package_does_not_have(type: str, help: str) -> None:
    assert monitor(type, "True") == [help]


@pytest.mark.parametrize(
    "type",
    [
        "std_msgs/Float32", "std_msgs/msg/Time", "move_base_msgs/MoveBaseActionGoal",
        "control_msgs/DynamicJointState", "my_msgs/Float", "nav2_msgs/msg/Costmap",
        "geometry_msgs/PolygonInstance",
    ],
)  # fmt: skip
def test_a_type_that_some_version_of_ros_can_have(type: str) -> None:
    assert monitor(type, "True") == []


def test_a_package_of_the_user_replaces_the_common_one() -> None:
    files = {"std_msgs/msg/Float.msg": "float64 value\n"}
    assert monitor("std_msgs/Float", "message.value > 3", files) == []
    assert monitor("std_msgs/Float64", "True", files) == ["did you mean `Float`?"]


@pytest.mark.parametrize(
    ("type", "code", "help"),
    [
        ("sensor_msgs/Temperature", "message.temp < 70.0", "did you mean `temperature`?"),
        ("sensor_msgs/msg/BatteryState", "message.percent > 0.2", "did you mean `percentage`?"),
        ("sensor_msgs/LaserScan", "min(message.range) > 0.5", "did you mean `ranges`?"),
        (
            "geometry_msgs/WrenchStamped",
            "message.force.z < userdata.limit",
            "write `message.wrench.force.z`",
        ),
        (
            "nav_msgs/Odometry",
            "message.pose.position.x > 1",
            "write `message.pose.pose.position.x`",
        ),
        (
            "nav_msgs/Odometry",
            "message.orientation.w > 1",
            "write `message.pose.pose.orientation.w`",
        ),
        ("geometry_msgs/Pose", "message.pose.position.x > 1", "write `message.position.x`"),
        ("geometry_msgs/PoseStamped", "message.header.frame", "did you mean `frame_id`?"),
        (
            "std_msgs/Float32",
            "message.value > 3",
            "write `data`, its only field, in place of `value`",
        ),
        ("std_msgs/Float32", "message > 3", "write `message.data`"),
        ("std_msgs/Float32", "userdata.limit - message > 3", "write `message.data`"),
        ("std_msgs/Float32", "float(message) > 3", "write `message.data`"),
        ("std_msgs/Float32", 'message["data"] > 3', "write `message.data`"),
        ("std_msgs/String", 'message == "go"', "write `message.data`"),
        ("std_msgs/Bool", "message", "write `message.data`"),
        (
            "sensor_msgs/Temperature",
            "3 < message",
            "write `message.` and one of its fields: `temperature`, `variance`",
        ),
    ],
)
def test_a_wrong_use_of_a_message(type: str, code: str, help: str) -> None:
    assert monitor(type, code) == [help]


@pytest.mark.parametrize(
    ("type", "code"),
    [
        ("sensor_msgs/Temperature", "message.header.seq + message.header.stamp.secs > 3"),
        ("sensor_msgs/Temperature", "message.header.stamp.sec > 3 and message._type"),
        ("sensor_msgs/Temperature", "message.SLOT_TYPES and message.serialize"),
        ("sensor_msgs/CameraInfo", "message.K[0] > 1 and message.k[0] > 1"),
        ("sensor_msgs/Range", "message.variance < 3"),
        (
            "sensor_msgs/BatteryState",
            "message.power_supply_status == message.POWER_SUPPLY_STATUS_FULL",
        ),
        ("sensor_msgs/NavSatFix", "message.status.status >= message.status.STATUS_FIX"),
        ("sensor_msgs/JointState", '"elbow" in message.name and message.position[0] > 1'),
        ("std_msgs/Float32", 'message is not None and "%s" % message != "x"'),
        ("std_msgs/Float32", "message == message or message in [userdata.limit]"),
        ("nav_msgs/Path", "len(message.poses) > 3 and message.poses[0].pose.position.x > 1"),
    ],
)
def test_a_right_use_of_a_message(type: str, code: str) -> None:
    assert monitor(type, code) == []


@pytest.mark.parametrize(
    ("template", "fields", "help"),
    [
        ("ServiceState", "service: std_srvs/SetBol\n      request: {data: true}",
         "did you mean `SetBool`?"),
        ("ServiceState", "service: std_srvs/SetBool\n      request: {on: true}",
         "write `data`, its only field, in place of `on`"),
        ("SimpleActionState", "action: move_base_msgs/MoveBasAction\n      goal: {x: 1}",
         "did you mean `MoveBaseAction`?"),
        ("SimpleActionState",
         "action: move_base_msgs/MoveBaseAction\n      goal: {pose: {header: {frame_id: map}}}",
         "did you mean `target_pose`?"),
        ("SimpleActionState",
         "action: control_msgs/GripperCommandAction\n      goal: {position: 0.04, max_effort: 9.0}",
         "write `command: {position: 0.04, max_effort: 9.0}` in place of `max_effort` and"
         " `position`"),
    ],
)  # fmt: skip
def test_services_and_actions(template: str, fields: str, help: str) -> None:
    name = "service_namespace" if template == "ServiceState" else "action_server_namespace"
    assert server(template, f"{name}: x\n      timeout: 5.0\n      {fields}") == [help]


@pytest.mark.parametrize(
    ("message", "type", "help"),
    [
        ("{temp: 3.0}", "sensor_msgs/Temperature", "did you mean `temperature`?"),
        ("{data: 3.0}", "std_msgs/Float", "write `Float32` or `Float64`"),
        ("{linear: {x: 1.0}}", "geometry_msgs/TwistStamped", "write `twist: {linear: {x: 1.0}}`"),
    ],
)
def test_published_mappings(message: str, type: str, help: str) -> None:
    script = f"""
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{msg: {message}, msg_type: {type}}}
states:
  - SAY:
      template: PublishMsgState
      action: start
      input_keys: [msg, msg_type]
      transitions: {{succeeded: done, aborted: failed}}
"""
    assert [help for _, _, help in report(script, {})] == [help]


@pytest.mark.parametrize(
    ("imports", "body", "got", "marked", "help"),
    [
        ("from std_msgs.msg import Float", "message = 1", "1", "Float",
         "write `Float32` or `Float64`"),
        ("from std_srvs.srv import SetBolRequest as R", "message = 1", "1", "SetBolRequest",
         "did you mean `SetBool`?"),
        ("from std_srvs.msg import SetBool", "message = 1", "1", "SetBool",
         "import it from `std_srvs.srv`"),
        ("import geometry_msgs.msg", "message = geometry_msgs.msg.Twst()", "1", "Twst",
         "did you mean `Twist`?"),
        ("", "message = 1", "message.temp", "temp", "did you mean `temperature`?"),
        ("", "message = 1", "message + 1", "message",
         "write `message.` and one of its fields: `temperature`, `variance`"),
        ("from geometry_msgs.msg import Twist as T", "message = T()\nmessage.linear.w = 1.0", "1",
         "w", "use one of its fields: `x`, `y`, `z`"),
        ("from std_msgs.msg import Float64", "message = Float64(dat=1.0)", "1", "dat",
         "did you mean `data`?"),
        ("from std_srvs.srv import SetBool",
         "message = SetBool.Request()\nmessage.value = True", "1", "value",
         "write `data`, its only field, in place of `value`"),
        ("from move_base_msgs.msg import MoveBaseGoal",
         'message = MoveBaseGoal()\nmessage.target_pose.position.x = 1', "1", "position",
         "write `message.target_pose.pose.position.x`"),
        ("", 'message = rospy.wait_for_message("/t", Temperature)\nself.got = message.temp', "1",
         "temp", "did you mean `temperature`?"),
    ],
)  # fmt: skip
def test_messages_in_a_class(imports: str, body: str, got: str, marked: str, help: str) -> None:
    found = look(imports, body, got)
    assert [(text, help) for text, _, help in found] == [(marked, help)]


@pytest.mark.parametrize(
    ("imports", "body", "got"),
    [
        ("from std_msgs.msg import _Float32, Float32 as Float", "message = Float(data=1.0)", "1"),
        ("from my_msgs.msg import Foo", "message = Foo(any=1)", "1"),
        ("", "message = Temperature()\nmessage = 3", "1"),
        ("", "message = 1\nself.on_message(None)", "message.temp"),
        ("", "message = 1", "message.temp if hasattr(message, 'temp') else 1"),
        ("", "message = Temperature(temperature=1.0, header=None)", "message.header.seq"),
        ("from std_srvs.srv import SetBool, SetBoolRequest", "message = SetBoolRequest(True)", "1"),
        ("from control_msgs.msg import FollowJointTrajectoryGoal",
         "message = FollowJointTrajectoryGoal()\nmessage.multi_dof_trajectory = 1", "1"),
    ],
)  # fmt: skip
def test_right_messages_in_a_class(imports: str, body: str, got: str) -> None:
    assert look(imports, body, got) == []
