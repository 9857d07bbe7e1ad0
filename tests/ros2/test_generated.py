"""Programs that smachac makes for ROS 2, run as nodes: states, parameters, signals, exit codes."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

import smachac
from tests.ros.ros_graph import Program
from tests.ros2.ros2_graph import PYTHON, ROOT, Graph

pytestmark = pytest.mark.ros2

EXAMPLE = ROOT / "examples" / "ros2_mobile_base"


def base(graph: Graph, *parameters: str) -> Program:
    """The simulated base of the example; it is ready."""
    given = [text for parameter in parameters for text in ("-p", parameter)]
    program = graph._launch([PYTHON, str(EXAMPLE / "base.py"), "--ros-args", *given])
    program.expect("ready")
    return program


def patrol(graph: Graph, *arguments: str) -> Program:
    """The program of the example, started."""
    (text,) = smachac.compile(EXAMPLE / "patrol.yml", "python").values()
    return graph.start(text, *arguments)


def test_the_example_docks(graph2: Graph) -> None:
    robot = base(graph2, "speed:=10.0")
    program = patrol(graph2)
    assert program.end() == 0, program.output
    assert program.output.endswith("outcome: docked\n")
    assert robot.output.count("drive to") == 4


def test_a_low_battery_shortens_the_patrol(graph2: Graph) -> None:
    robot = base(graph2, "speed:=10.0", "charge:=0.32")
    program = patrol(graph2)
    assert program.end() == 0, program.output
    assert robot.output.count("drive to") == 2


def test_an_aborted_goal_ends_with_exit_code_1(graph2: Graph) -> None:
    base(graph2, "speed:=10.0", "range:=0.5")
    program = patrol(graph2)
    assert program.end() == 1, program.output
    assert program.output.endswith("outcome: aborted\n")


def test_parameters_are_set_before_the_machine_is_built(graph2: Graph) -> None:
    robot = base(graph2, "speed:=0.001")
    program = patrol(graph2, "--ros-args", "-p", "patience:=1")  # an int for a float
    assert program.end() == 1, program.output
    assert "outcome: aborted" in program.output
    assert robot.output.count("drive to") == 1


def test_a_parameter_of_a_wrong_type_ends_the_program(graph2: Graph) -> None:
    program = patrol(graph2, "--ros-args", "-p", "patience:=long")
    assert program.end() == 1
    last = program.output.splitlines()[-1]
    assert last.startswith("parameter 'patience': ")
    assert "DOUBLE" in last
    assert "Traceback" not in program.output


def test_names_are_remapped(graph2: Graph) -> None:
    (text,) = smachac.compile(EXAMPLE / "patrol.yml", "python").values()
    base(graph2, "speed:=10.0")
    program = graph2.start(
        text, *("--ros-args", "-p", "battery_topic:=power", "-r", "power:=/battery")
    )
    assert program.end() == 0, program.output


VIEWER = """
import json, rclpy
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("viewer")
qos = QoSProfile(depth=20, durability=DurabilityPolicy.TRANSIENT_LOCAL)

def show(message):
    fields = json.loads(message.data)
    print(sorted(fields), [f"{fields['path']}/{each}" for each in fields.get("active_states", [])],
          flush=True)
    if fields.get("active_states") == ["WAIT"]:
        print("nodes", sorted(set(node.get_node_names()) - {"viewer"}), flush=True)

for name in "status", "structure":
    node.create_subscription(
        String, f"/robot_1/patrol/smach/container_{name}_json", show, qos
    )
print("ready", flush=True)
rclpy.spin(node)
"""

VIEWED = """
name: patrol
template: ROSBase
outcomes: [succeeded, aborted, preempted]
states:
  - DRIVE:
      template: StateMachine
      outcomes: [succeeded, aborted, preempted]
      states:
        - WAIT:
            template: WaitForMsgState
            topic: nothing
            msg_type: std_msgs/String
            timeout: 1000.0
            transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""

STATUS = [
    *("active_states", "ended", "info", "initial_states", "local_data", "path", "stamp"),
    "userdata",
]
STRUCTURE = [
    *("children", "container_outcomes", "internal_outcomes", "outcomes_from", "outcomes_to"),
    *("path", "stamp"),
]


def test_a_viewer_sees_the_active_states(graph2: Graph, tmp_path: Path) -> None:
    path = tmp_path / "patrol.yml"
    path.write_text(VIEWED, encoding="utf-8")
    (text,) = smachac.compile(path, "python", options={"introspection": "yes"}).values()
    program = graph2.start(text, "--ros-args", "-r", "__ns:=/robot_1")
    program.expect("state machine starting in 'WAIT'")
    viewer = graph2.start(VIEWER)
    viewer.expect("ready")  # it comes late, and gets all that is latched
    viewer.expect(f"{STATUS} ['/patrol/DRIVE/WAIT']")
    viewer.expect("nodes ['patrol', 'patrol_introspection']")
    viewer.expect(str(STRUCTURE))
    program.send(signal.SIGINT)
    assert program.end() == 130, program.output
    assert "publisher already registered" not in program.output


IN_TEXTS = """
name: machine
template: ROSBase
outcomes: [succeeded, aborted, preempted]
params: {name: nothing, order: 1}
states:
  - COUNT:
      template: SimpleActionState
      action_server_namespace: [/wo, [params, name]]
      action: test_msgs/action/Fibonacci
      goal: {order: [params, order]}
      server_wait_timeout: 20.0
      transitions: {succeeded: succeeded, aborted: aborted, preempted: preempted}
"""


def test_parameters_inside_texts_and_goals_are_overridden(graph2: Graph, tmp_path: Path) -> None:
    path = tmp_path / "machine.yml"
    path.write_text(IN_TEXTS, encoding="utf-8")
    (text,) = smachac.compile(path, "python").values()
    server = graph2.node("server")
    program = graph2.start(text, "--ros-args", "-p", "name:=rk", "-p", "order:=8")
    assert program.end() == 0, program.output
    server.expect("goal 8")


def test_ctrl_c_cancels_the_goal(graph2: Graph) -> None:
    robot = base(graph2, "speed:=0.01")
    program = patrol(graph2)
    robot.expect("drive to")
    program.send(signal.SIGINT)
    assert program.end() == 130, program.output
    assert program.output.endswith("outcome: preempted\n")
    robot.expect("cancelled")


def test_run_shows_progress(graph2: Graph) -> None:
    base(graph2, "speed:=10.0")
    script = str(EXAMPLE / "patrol.yml")
    program = graph2._launch([PYTHON, "-m", "smachac", "run", script, "--ros"])
    assert program.end() == 0, program.output
    assert "  DOCK  " in program.output
    assert program.output.endswith("outcome: docked\n")


WAITING = """
name: machine
template: {base}
outcomes: [succeeded]
states:
  - WAIT: {{template: SleepState, time: 1000, transitions: {{preempted: succeeded}}}}
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
@pytest.mark.parametrize("way", ["run", "program", "own base"])
def test_a_stop_signal_gives_the_exit_code(
    graph2: Graph, tmp_path: Path, way: str, number: signal.Signals
) -> None:
    path = tmp_path / "machine.yml"
    path.write_text(WAITING.format(base="Own" if way == "own base" else "ROSBase"))
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates/Own.tpl.py").write_text('{% extends "ROSBase.tpl.py" %}\n')
    (tmp_path / "templates/Own.yml").write_text(
        "{name: Own, kind: base, code: {python: Own.tpl.py}}"
    )
    if way == "run":
        trace = tmp_path / "trace"
        os.mkfifo(trace)
        words = ["run", str(path), "--trace", str(trace), "--ros"]
        program = graph2._launch([PYTHON, "-m", "smachac", *words])
        with trace.open() as events:
            while "WAIT" not in events.readline():
                pass
            program.send(number)
            assert '"finish"' in events.read()
    else:
        (text,) = smachac.compile(path, "python").values()
        program = graph2.start(text)
        program.expect("starting in 'WAIT'")
        program.send(number)
    assert program.end() == 128 + number
    assert program.output.endswith("outcome: succeeded\n")


def test_the_commands_of_the_docs(graph2: Graph, tmp_path: Path) -> None:
    text = (ROOT / "docs/ros.md").read_text("utf-8")
    lines = text.split("## ROS 2\n")[1].split("```\n")[1].splitlines()
    assert [line.split()[0] for line in lines] == ["pip", "cd", "python", "smachac", "python"]
    packages = (ROOT / "scripts" / "ros2.txt").read_text("utf-8").split()
    assert set(lines[0].split()[3:]) <= set(packages)
    tools = tmp_path / "tools"
    tools.mkdir()
    for name, command in (("python", f'"{PYTHON}"'), ("smachac", f'"{sys.executable}" -m smachac')):
        tool = tools / name
        tool.write_text(f'#!/bin/sh\nexec {command} "$@"\n', encoding="utf-8")
        tool.chmod(0o755)
    made = EXAMPLE / "patrol.py"
    commands = [*lines[1:], "code=$?", "kill $!", "exit $code"]
    environment = {**graph2.environment, "PATH": f"{tools}{os.pathsep}{os.environ['PATH']}"}
    try:
        done = subprocess.run(
            ["bash", "-c", "\n".join(commands)],
            cwd=ROOT, env=environment, capture_output=True, text=True, check=False,
        )  # fmt: skip
    finally:
        made.unlink(missing_ok=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.endswith("outcome: docked\n")


def test_a_package_is_built_by_colcon_and_runs(graph2: Graph, tmp_path: Path) -> None:
    folder = tmp_path / "src" / "patrol"
    files = smachac.compile(EXAMPLE / "patrol.yml", "python", options={"package": "true"})
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    venv = tmp_path / "venv"  # no space in its path: the system cannot start a script otherwise
    venv.symlink_to(Path(PYTHON).parents[1])
    python, colcon = venv / "bin" / "python", Path(PYTHON).with_name("colcon")
    built = subprocess.run(
        [python, colcon, "build", "--base-paths", "src"], cwd=tmp_path, env=graph2.environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert built.returncode == 0, built.stderr
    installed = tmp_path / "install" / "patrol"
    index = installed / "share" / "ament_index" / "resource_index" / "packages" / "patrol"
    assert index.is_file()
    assert (installed / "share" / "patrol" / "launch" / "patrol.launch.py").is_file()
    base(graph2, "speed:=10.0")
    command = f"source {tmp_path}/install/setup.bash && exec {installed}/lib/patrol/patrol"
    program = graph2._launch(["bash", "-c", command])
    assert program.end() == 0, program.output
    assert program.output.endswith("outcome: docked\n")


SERVED = """
name: machine
template: ROSBase
outcomes: [succeeded, aborted, preempted]
input_keys: [order]
output_keys: [sequence]
states:
  - COUNT:
      template: CallbacksState
      input_keys: [order]
      output_keys: [sequence]
      callbacks: {sequence: 'lambda ud: list(range(ud.order))'}
      transitions: {succeeded: LONG}
  - LONG:
      template: ConditionalOutcomeState
      input_keys: [order]
      outcomes: [long, failed, short]
      callbacks: {long: 'lambda ud: ud.order > 9', failed: 'lambda ud: ud.order > 5'}
      default_outcome: short
      transitions: {long: SLEEP, failed: aborted, short: succeeded}
  - SLEEP:
      template: SleepState
      time: 1000
      transitions: {succeeded: succeeded, preempted: preempted}
"""


def test_a_machine_is_offered_as_an_action(graph2: Graph, tmp_path: Path) -> None:
    path = tmp_path / "machine.yml"
    path.write_text(SERVED, encoding="utf-8")
    options = {"action": "test_msgs/action/Fibonacci"}
    (text,) = smachac.compile(path, "python", options=options).values()
    program = graph2.start(text)
    caller = graph2.node("caller")
    caller.say("3")
    caller.expect("ended succeeded [0, 1, 2]")
    caller.say("6")
    caller.expect("ended aborted")
    caller.say("10")
    caller.expect("accepted")
    program.expect("'LONG':'long'-->'SLEEP'")
    caller.say("cancel")
    caller.expect("ended canceled")
    caller.say("2")
    caller.expect("ended succeeded [0, 1]")
    program.send(signal.SIGINT)
    assert program.end() == 130, program.output


DRIVING = """
name: machine
template: ROSBase
outcomes: [succeeded, preempted]
input_keys: [speed]
output_keys: [message]
userdata: {message: docked}
states:
  - NAVIGATE:
      template: StateMachine
      outcomes: [succeeded, preempted]
      states:
        - GO:
            template: WaitForMsgState
            topic: seen/NAVIGATE/GO
            qos: latched
            msg_type: std_msgs/String
            timeout: 100.0
            transitions: {succeeded: succeeded, aborted: preempted, preempted: preempted}
      transitions: {succeeded: DOCK, preempted: preempted}
  - DOCK:
      template: WaitForMsgState
      topic: seen/DOCK
      qos: latched
      msg_type: std_msgs/String
      timeout: 100.0
      transitions: {succeeded: succeeded, aborted: preempted, preempted: preempted}
"""

DRIVER = """
import threading
import rclpy
from rclpy.action import ActionClient
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String
from smachac_test_interfaces.action import Drive

rclpy.init()
node = rclpy.create_node("caller")
latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
states = ["/NAVIGATE", "/NAVIGATE/GO", "/DOCK"]
seen = {state: node.create_publisher(String, f"seen{state}", latched) for state in states}
client = ActionClient(node, Drive, "machine")
threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
client.wait_for_server()
paths = []


def show(message):  # each state ends after this
    paths.append(message.feedback.state)
    seen[message.feedback.state].publish(String())


response = client.send_goal(Drive.Goal(speed=0.5), feedback_callback=show)
print("paths", paths)
print("result", response.result.message)
rclpy.shutdown()
"""


def test_the_feedback_of_the_action_is_the_path_of_the_active_state(
    graph2: Graph, tmp_path: Path
) -> None:
    path = tmp_path / "machine.yml"
    path.write_text(DRIVING, encoding="utf-8")
    options = {"action": "smachac_test_interfaces/action/Drive"}
    (text,) = smachac.compile(path, "python", options=options).values()
    graph2.use_interfaces()
    program = graph2.start(text)
    caller = graph2.start(DRIVER)
    caller.expect("paths ['/NAVIGATE', '/NAVIGATE/GO', '/DOCK']")
    caller.expect("result docked")
    program.send(signal.SIGINT)
    assert program.end() == 130, program.output


def test_a_managed_node(graph2: Graph, tmp_path: Path) -> None:
    path = tmp_path / "machine.yml"
    script = (EXAMPLE / "patrol.yml").read_text("utf-8").replace("name: patrol", "name: machine")
    path.write_text(script, encoding="utf-8")
    (text,) = smachac.compile(path, "python", options={"lifecycle": "true"}).values()
    robot = base(graph2, "speed:=0.1")
    program = graph2.start(text, "--ros-args", "-p", "patience:=60.0")
    manager = graph2.node("manager")
    for _ in range(2):
        for step in ("configure", "activate"):
            manager.say(step)
            manager.expect(f"{step} done")
        robot.expect("drive to")
        for step in ("deactivate", "cleanup"):
            manager.say(step)
            manager.expect(f"{step} done")
        robot.expect("cancelled")
    manager.say("shutdown")
    manager.expect("shutdown done")
    assert program.end() == 1, program.output
    assert program.output.endswith("outcome: preempted\n")


def test_a_managed_node_with_a_wrong_parameter_is_not_configured(
    graph2: Graph, tmp_path: Path
) -> None:
    path = tmp_path / "machine.yml"
    script = (EXAMPLE / "patrol.yml").read_text("utf-8").replace("name: patrol", "name: machine")
    path.write_text(script, encoding="utf-8")
    (text,) = smachac.compile(path, "python", options={"lifecycle": "true"}).values()
    program = graph2.start(text, "--ros-args", "-p", "patience:=long")
    manager = graph2.node("manager")
    manager.say("configure")
    manager.expect("configure failed")
    manager.say("unconfigured")
    manager.expect("is unconfigured")
    program.send(signal.SIGINT)
    assert program.end() == 130, program.output
