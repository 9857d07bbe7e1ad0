"""ROS 2: from a preempt request to the cancel request at the server, and service calls a second.

    python bench/ros2.py [count]

The servers are a process of their own. The machine is a state machine of ten service states; the
plain client calls the same service with rclpy's `call`, from the same node and thread.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
PYTHON = ROOT / ".venv-ros2" / "bin" / "python"

COUNT = 200
STATES = 10
ROUNDS = 5


def serve() -> None:
    """The process of the servers: a service, and an action that runs until it is cancelled."""
    import rclpy
    from rclpy.action import ActionServer, CancelResponse
    from rclpy.callback_groups import ReentrantCallbackGroup
    from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
    from std_srvs.srv import Trigger
    from test_msgs.action import Fibonacci

    rclpy.init()
    node = rclpy.create_node("server")
    group = ReentrantCallbackGroup()
    cancelled: list[int] = []

    def cancel(handle: Any) -> Any:
        cancelled.append(time.monotonic_ns())
        return CancelResponse.ACCEPT

    def execute(handle: Any) -> Any:
        handle.publish_feedback(Fibonacci.Feedback())
        while not handle.is_cancel_requested:
            time.sleep(0.001)
        handle.canceled()
        return Fibonacci.Result(sequence=list(divmod(cancelled[-1], 1_000_000_000)))

    def trigger(request: Any, response: Any) -> Any:
        return response

    ActionServer(node, Fibonacci, "run", execute, cancel_callback=cancel, callback_group=group)
    node.create_service(Trigger, "trigger", trigger, callback_group=group)
    executor = MultiThreadedExecutor(2)
    executor.add_node(node)
    print("ready", flush=True)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        os._exit(0)


def delays(node: Any, count: int) -> list[float]:
    """Milliseconds from `request_preempt` to the cancel callback of the server."""
    from test_msgs.action import Fibonacci

    from smachac.runtime import smach
    from smachac.runtime import smach_ros2 as smach_ros

    begin: list[int] = []

    def request() -> None:
        begin.append(time.monotonic_ns())
        state.request_preempt()

    def on_feedback(userdata: Any, feedback: Any) -> None:
        threading.Timer(0.01 + 0.0007 * (len(begin) % 30), request).start()

    state = smach_ros.SimpleActionState(
        node, "run", Fibonacci, result_slots=["sequence"], feedback_cb=on_feedback
    )
    found = []
    for _ in range(count):
        userdata: Any = smach.UserData()
        assert state.execute(userdata) == "preempted"
        seconds, rest = userdata.sequence
        found.append((seconds * 1_000_000_000 + rest - begin[-1]) / 1e6)
    return found


def rates(node: Any, count: int) -> tuple[float, float]:
    """Transitions a second of the machine, and calls a second of the plain client."""
    from std_srvs.srv import Trigger

    from smachac.runtime import smach
    from smachac.runtime import smach_ros2 as smach_ros

    client = node.create_client(Trigger, "trigger")
    client.wait_for_service()
    machine = smach.StateMachine(["succeeded", "aborted", "preempted"])
    with machine:
        for number in range(STATES):
            following = {} if number == STATES - 1 else {"succeeded": f"CALL_{number + 1}"}
            state = smach_ros.ServiceState(node, "trigger", Trigger)
            smach.StateMachine.add(f"CALL_{number}", state, following)
    ours, plain = [], []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        for _ in range(count // STATES):
            assert machine.execute() == "succeeded"
        ours.append(time.perf_counter() - begin)
        begin = time.perf_counter()
        for _ in range(count // STATES * STATES):
            client.call(Trigger.Request())
        plain.append(time.perf_counter() - begin)
    return count / min(ours), count / min(plain)


def main(count: int = COUNT) -> int:
    """Print the figures; 0 also where there is no ROS 2."""
    try:
        import rclpy
    except ImportError:
        if PYTHON.exists() and Path(sys.executable) != PYTHON:
            os.execv(PYTHON, [str(PYTHON), *sys.argv])
        print("no ROS 2: make test-ros2 installs it")
        return 0
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    sys.path.insert(0, str(ROOT))
    from smachac.runtime import smach
    from smachac.runtime.smach_ros2 import program

    node = program.start_node("bench")
    smach.set_loggers(smach.log.quiet, print, smach.log.quiet, print)
    command = [sys.executable, __file__, "serve"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    try:
        assert server.stdout is not None
        server.stdout.readline()
        found = sorted(delays(node, count))
        last = found[min(len(found) - 1, len(found) * 99 // 100)]
        print(
            f"preempt request to cancel request at the server: median "
            f"{statistics.median(found):.2f} ms, 99th percentile {last:.2f} ms ({count} goals)"
        )
        ours, plain = rates(node, 10 * count)
        print(
            f"service calls: {ours:.0f} transitions a second, plain rclpy client {plain:.0f}; "
            f"ratio {ours / plain:.2f}"
        )
    finally:
        server.kill()
        server.wait()
        program.stop_node(node)
    return 0 if rclpy.ok() is False else 1


if __name__ == "__main__":
    if sys.argv[1:] == ["serve"]:
        serve()
        sys.exit()
    sys.exit(main(*map(int, sys.argv[1:])))
