"""Programs for ROS 2: the node, its parameters, and what states get."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from textwrap import indent

import pytest

import smachac
from smachac.targets import OptionError

ROOT = Path(__file__).parents[2]

HEAD = """
name: sm
template: {base}
outcomes: [succeeded, aborted, preempted]
params: {params}
states:
"""


def program(folder: Path, states: str, *, base: str = "ROSBase", params: str = "{}") -> str:
    """The program of a script with these states."""
    path = folder / "main.yml"
    path.write_text(HEAD.format(base=base, params=params) + states, encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    return text


WAIT = """
  - WAIT:
      template: WaitForMsgState
      topic: [params, topic]
      msg_type: std_msgs/String
      timeout: [params, patience]
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""

CALL = """
  - CALL:
      template: ServiceState
      service_namespace: call
      service: %s
      %s
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""

SLEEP = """
  - SLEEP:
      template: SleepState
      time: 0
      transitions: {succeeded: succeeded, preempted: preempted}
"""

GRASP = """
  - GRASP: {template: Grasp, transitions: {done: succeeded}}
"""


def test_the_state_of_the_docs_is_that_of_the_example() -> None:
    text = (ROOT / "docs/ros.md").read_text("utf-8")
    state = text.split("```yaml\n")[1].split("```")[0]
    script = (ROOT / "examples/ros2_mobile_base/patrol.yml").read_text("utf-8")
    assert indent(state, 8 * " ") in script


def test_the_example_has_no_finding() -> None:
    assert smachac.check(ROOT / "examples/ros2_mobile_base/patrol.yml") == []


def test_params_are_parameters_of_the_node(tmp_path: Path) -> None:
    text = program(tmp_path, WAIT, params="{topic: battery, patience: 5, node: x}")
    # `patience` is a float in the interface; nothing looks up `node`
    assert 'def build(node, topic="battery", patience=5.0):' in text
    assert "WaitForMsgState(node, topic, String, timeout=patience)" in text
    assert 'return program.run_once("sm", build, arguments)' in text


def test_a_parameter_has_another_name_than_the_node(tmp_path: Path) -> None:
    states = WAIT.replace("[params, topic]", "[params, node]")
    text = program(tmp_path, states, params="{node: battery, patience: 5.0}")
    assert 'def build(node, node_="battery", patience=5.0):' in text


def test_params_of_sub_scripts_are_followed(tmp_path: Path) -> None:
    (tmp_path / "wait.yml").write_text(
        "- INNER:\n    template: StateMachine\n    outcomes: [succeeded, aborted, preempted]\n"
        "    states:\n" + WAIT.replace("\n", "\n    "),
        encoding="utf-8",
    )
    states = """
  - {0}:
      script: wait
      params: {{topic: [params, topic], patience: {1}}}
      transitions: {{succeeded: {2}, aborted: aborted, preempted: preempted}}
"""
    calls = states.format("A", "5.0", "B") + states.format("B", "6.0", "succeeded")
    text = program(tmp_path, calls, params="{topic: battery}")
    assert 'def build(node, topic="battery"):' in text
    assert "build_wait(node, " in text
    assert "topic=topic" in text
    assert '"battery"' not in text.partition("def build(")[0]


@pytest.mark.parametrize(
    ("topic", "printed"),
    [
        ("['/', [params, topic]]", 'f"/{topic}"'),
        ("['{', [params, topic], '}', [params, n]]", 'f"{{{topic}}}{n}"'),
        ("[params, whole]", 'f"/{topic}/x"'),
    ],
)
def test_a_param_inside_a_text(topic: str, printed: str, tmp_path: Path) -> None:
    params = "{topic: battery, patience: 5.0, n: 3, whole: ['/', [params, topic], /x]}"
    text = program(tmp_path, WAIT.replace("[params, topic]", topic), params=params)
    assert 'def build(node, topic="battery", patience=5.0' in text
    assert f"WaitForMsgState(node, {printed}, String, timeout=patience)" in text


def test_params_inside_mappings_and_lists(tmp_path: Path) -> None:
    states = CALL % (
        "my_srvs/Grip",
        "request: {pose: {x: [params, x], ids: [{a: [params, n]}, {a: 1}]}}",
    )
    text = program(tmp_path, states, params="{x: 0.5, n: 2}")
    assert "def build(node, x=0.5, n=2):" in text
    assert '{"pose": {"x": x, "ids": [{"a": n}, {"a": 1}]}}' in text.replace("\n", "").replace(
        "  ", ""
    )


def test_params_of_an_iterator_and_of_userdata(tmp_path: Path) -> None:
    states = """
  - EACH:
      template: StateMachine
      outcomes: [succeeded, aborted, preempted]
      userdata: {home: [at, [params, name]]}
      for_each: {item: place, in: [params, xs]}
      states: [%s]
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""
    wait = "WAIT: {template: WaitForMsgState, topic: [params, topic], msg_type: std_msgs/String,"
    wait += " transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}}"
    params = "{xs: [1.5, 2.5], topic: battery, name: home}"
    text = program(tmp_path, states % f"{{{wait}}}", params=params)
    assert 'def build(node, xs=[1.5, 2.5], topic="battery", name="home"):' in text
    assert "it=xs," in text
    assert 'f"at{name}"' in text


def test_equal_values_of_two_params_stay_two_parameters(tmp_path: Path) -> None:
    (tmp_path / "sub.yml").write_text(
        "- INNER:\n    template: StateMachine\n    outcomes: [succeeded, preempted]\n"
        "    states:\n    - NAP:\n        template: SleepState\n        time: [params, nap]\n"
        "        transitions: {succeeded: END, preempted: preempted}\n"
        "    - END:\n        template: SleepState\n        time: [params, end]\n"
        "        transitions: {succeeded: succeeded, preempted: preempted}\n",
        encoding="utf-8",
    )
    call = "  - {0}: {{script: sub, params: {{nap: [params, {1}]}},"
    call += " transitions: {{succeeded: {2}}}}}\n"
    calls = "\n" + call.format("A", "first", "B") + call.format("B", "second", "succeeded")
    text = program(tmp_path, calls, params="{first: 1.0, second: 1.0, end: 2.0}")
    assert "build_sub(node, time=first, end=end)" in text
    assert "build_sub(node, time=second, end=end)" in text
    ast.parse(text)


TIMED = CALL % ("std_srvs/Trigger", "timeout: [params, patience]\n      retry: %s")
TIMED = TIMED.replace("aborted: aborted", "timeout: aborted, exhausted: aborted")


def test_params_that_are_fixed_are_findings(tmp_path: Path) -> None:
    params = "{topic: battery, patience: 5.0, type: std_srvs/Trigger, most: 3}"
    wait = WAIT.replace("succeeded: succeeded", "succeeded: CALL")
    states = wait + TIMED.replace("std_srvs/Trigger", "[params, type]").replace(
        "%s", "{on: [aborted], max: [params, most]}"
    )
    program(tmp_path, states, params=params)
    found = [item for item in smachac.check(tmp_path / "main.yml") if item.code == "SM610"]
    assert [(item.finding.arguments, item.severity.value) for item in found] == [
        (("service", "type"), "info"),
        (("timeout", "patience"), "warning"),
        (("retry", "most"), "info"),
    ]
    assert found[1].span.text == "patience"
    (tmp_path / "smachac.toml").write_text("ros = 1\n", encoding="utf-8")
    assert "SM610" not in [item.code for item in smachac.check(tmp_path / "main.yml")]


def test_a_whole_number_that_is_a_float_elsewhere_stays_in_a_request(tmp_path: Path) -> None:
    more = "request: {n: [params, patience], name: [a, [params, patience]]}"
    states = WAIT.replace("succeeded: succeeded", "succeeded: CALL") + CALL % ("my_srvs/Grip", more)
    text = program(tmp_path, states, params="{topic: battery, patience: 5}")
    assert '{"n": 5, "name": "a5"}' in text
    found = [item for item in smachac.check(tmp_path / "main.yml") if item.code == "SM610"]
    assert [item.finding.arguments for item in found] == [("request", "patience")]


PUBLISH = """
  - SAY:
      template: PublishMsgState
      action: once
      input_keys: [msg]
      output_keys: [msg]
      callbacks: {msg: 'lambda ud: %s'}
      transitions: {succeeded: succeeded, aborted: aborted}
"""


@pytest.mark.parametrize(
    ("message", "printed"),
    [
        ("Bool(data=True)", "from std_msgs.msg import Bool"),
        ("Duration(sec=1)", "from builtin_interfaces.msg import Duration"),
        ("std_msgs.msg.Bool(data=True)", "import std_msgs.msg"),
        ("[my_msgs.msg.Grip(), my_msgs.srv.Open.Request()]", "import my_msgs.srv"),
    ],
)
def test_code_that_makes_messages_is_imported(message: str, printed: str, tmp_path: Path) -> None:
    lines = program(tmp_path, PUBLISH % message).splitlines()
    assert printed in lines
    assert "SM019" not in [item.code for item in smachac.check(tmp_path / "main.yml")]


@pytest.mark.parametrize("message", ["GoalStatus()", "grips.Open()", "msg.Bool()", "a.msg.open()"])
def test_names_that_are_no_messages_of_ros_2(message: str, tmp_path: Path) -> None:
    with pytest.raises(smachac.ScriptError) as found:
        program(tmp_path, PUBLISH % message)
    assert "SM019" in [item.code for item in found.value.report]


@pytest.mark.parametrize(
    ("service", "more", "printed"),
    [
        ("std_srvs/SetBool", "request: {data: true}", 'filled(SetBool.Request(), {"data": True})'),
        (
            "std_srvs.srv.SetBool",
            "request: SetBoolRequest(data=True)",
            "SetBool.Request(data=True)",
        ),
        (
            "std_srvs/srv/SetBool",
            "request: SetBool.Request(data=True)",
            "SetBool.Request(data=True)",
        ),
    ],
)
def test_requests(service: str, more: str, printed: str, tmp_path: Path) -> None:
    text = program(tmp_path, CALL % (service, more))
    assert f"request={printed}" in text
    assert "from std_srvs.srv import SetBool\n" in text


def test_a_class_of_the_user_gets_the_node(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Grasp.yml").write_text(
        'name: Grasp\noutcomes: {done: {}}\ncode: {python: "robot:Grasp"}\n', encoding="utf-8"
    )
    code = (
        "import smach\n\n\nclass Grasp(smach.State):\n    def __init__(self{parameter}):\n"
        "        super().__init__(outcomes=['done'])\n\n    def execute(self, userdata):\n"
        "        return 'done'\n"
    )
    (tmp_path / "robot.py").write_text(code.format(parameter=", node"), encoding="utf-8")
    assert "Grasp(node)" in program(tmp_path, GRASP, base="Base")
    (tmp_path / "robot.py").write_text(code.format(parameter=""), encoding="utf-8")
    text = program(tmp_path, GRASP, base="Base")
    assert "Grasp()" in text
    assert "rclpy" not in text


def test_a_script_without_ros_is_no_node(tmp_path: Path) -> None:
    text = program(tmp_path, SLEEP, base="Base")
    assert "def build():" in text
    assert "def main():" in text
    assert "node" not in text


def test_outcomes_of_failure_end_with_exit_code_1(tmp_path: Path) -> None:
    assert 'failures=["aborted", "preempted"]' in program(tmp_path, SLEEP)


def test_a_package(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    params = "{topic: battery, patience: 5, deep: [1.0, 2.0]}"
    path.write_text(HEAD.format(base="ROSBase", params=params) + WAIT, encoding="utf-8")
    files = smachac.compile(path, "python", options={"package": "true"})
    assert list(files) == [
        *("sm/sm.py", "sm/__init__.py", "package.xml", "setup.py", "setup.cfg"),
        *("resource/sm", "launch/sm.launch.py"),
    ]
    start = "program.run_main(main, failures=["
    plain = smachac.compile(path, "python")["sm.py"].partition(start)[0]
    head, _, tail = plain.rpartition('if __name__ == "__main__":')
    assert files["sm/sm.py"].startswith(f"{head}def run_node():")
    assert files["sm/sm.py"].endswith(f'if __name__ == "__main__":{tail}run_node())\n')
    needed = re.findall("<exec_depend>(.*)</exec_depend>", files["package.xml"])
    assert needed == ["rclpy", "std_msgs"]
    launch = files["launch/sm.launch.py"]
    ast.parse(launch)
    assert 'DeclareLaunchArgument("patience", default_value="5.0")' in launch
    assert 'LaunchConfiguration("patience"), value_type=float' in launch
    named = smachac.compile(path, "python", options={"package": "robot_patrol"})
    assert "robot_patrol/sm.py" in named
    assert '"sm = robot_patrol.sm:run_node"' in named["setup.py"]


@pytest.mark.parametrize(
    ("base", "options", "message"),
    [
        ("ROSBase", {"package": "My Robot"}, "`package` must be `true` or match"),
        ("ROSBase", {"package": "true", "ros": "1"}, "needs a node of ROS 2"),
        ("Base", {"package": "true"}, "needs a node of ROS 2"),
        ("Base", {"action": "my_msgs/action/Fetch"}, "needs a node of ROS 2"),
        ("ROSBase", {"action": "Fetch"}, "must be a type such as"),
        ("Base", {"lifecycle": "true"}, "needs a node of ROS 2"),
        ("ROSBase", {"lifecycle": "on"}, "must be `true` or `false`"),
        ("ROSBase", {"lifecycle": "true", "action": "a/B"}, "exclude each other"),
        ("ROSBase", {"ros": "3"}, "`ros` must be `1` or `2`"),
    ],
)
def test_wrong_options(base: str, options: dict[str, str], message: str, tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(HEAD.format(base=base, params="{}") + SLEEP, encoding="utf-8")
    with pytest.raises(OptionError, match=message):
        smachac.compile(path, "python", options=options)


def test_a_machine_as_an_action(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(HEAD.format(base="ROSBase", params="{}") + SLEEP, encoding="utf-8")
    text = smachac.compile(path, "python", options={"action": "my_msgs/Fetch"})["sm.py"]
    assert "from my_msgs.action import Fetch\n" in text
    assert 'succeeded_outcomes=["succeeded"],' in text
    assert 'aborted_outcomes=["aborted"],' in text
    assert 'preempted_outcomes=["preempted"],' in text
    assert "serving.serve(node, sm)" in text


@pytest.mark.parametrize(
    ("qos", "fault"),
    [
        ("sensor_data", ""),
        ("5", ""),
        ("{reliability: best_effort, durability: transient_local, depth: 1}", ""),
        ("null", ""),
        ("sensors", "no preset `sensors`"),
        ("0", "a positive whole number"),
        ("{reliability: maybe}", "`reliability` of `qos` must be reliable or best_effort"),
        ("{dept: 5}", "no policy `dept`"),
        ("{depth: [1]}", "a positive whole number"),
        ("[sensor_data]", "a positive whole number"),
    ],
)
def test_the_quality_of_service_is_checked(qos: str, fault: str, tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    states = WAIT.replace("timeout:", f"qos: {qos}\n      timeout:")
    params = "{topic: battery, patience: 5}"
    path.write_text(HEAD.format(base="ROSBase", params=params) + states, encoding="utf-8")
    found = [item for item in smachac.check(path) if item.code == "SM004"]
    assert len(found) == bool(fault)
    assert all(fault in item.message for item in found)


def test_a_managed_node(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    params = "{topic: battery, patience: 5}"
    path.write_text(HEAD.format(base="ROSBase", params=params) + WAIT, encoding="utf-8")
    text = smachac.compile(path, "python", options={"lifecycle": "true"})["sm.py"]
    assert 'program.start_node("sm", arguments, kind, build=configured)' in text
    assert "return program.run(node, node)" in text
    path.write_text(HEAD.format(base="ROSBase", params="{}") + SLEEP, encoding="utf-8")
    text = smachac.compile(path, "python", options={"lifecycle": "true"})["sm.py"]
    assert 'program.start_node("sm", arguments, kind, build=build)' in text


def test_a_base_of_the_user_that_extends_the_one_of_a_node(tmp_path: Path) -> None:
    base = tmp_path / "templates" / "MyBase.tpl.py"
    base.parent.mkdir()
    base.write_text(
        '{% extends "ROSBase.tpl.py" %}\n'
        "{% block imports %}\n{{ super() }}\nimport math\n{% endblock %}"
    )
    text = program(tmp_path, SLEEP, base="MyBase")
    assert "program.start_node(" in text
    assert text.count("from smachac.runtime.smach_ros2 import program\n") == 1
    assert text.count("import math\n") == 1
