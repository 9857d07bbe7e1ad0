"""Programs for SMACH's smach_ros for ROS 2 on the bundled runtime: every public name, arguments by
position and by keyword, and nodes that the programs themselves spin."""

from __future__ import annotations

import pytest

from tests.ros2.ros2_graph import Graph

pytestmark = pytest.mark.ros2

START = """
import sys
from smachac.runtime import smach, smach_ros2

sys.modules.update(smach=smach, smach_ros=smach_ros2)

import threading

import rclpy
import rclpy.time
from rclpy.action import ActionClient, ActionServer, GoalResponse
from rclpy.duration import Duration
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_msgs.msg import Int32
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci

from smach import *
from smach_ros import *

rclpy.init()


def spin(node, executor):
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    return thread


def finish(executor, *threads):
    executor.shutdown()
    rclpy.try_shutdown()
    for thread in threads:
        thread.join()
    left = [each.name for each in threading.enumerate() if each is not threading.main_thread()]
    print("threads left:", left)


class Counting:
    '''An action server: order 1 succeeds, 2 aborts, 3 is rejected.'''

    def __init__(self, node):
        self.server = ActionServer(
            node, Fibonacci, "count", self.execute, goal_callback=self.accept
        )

    def accept(self, goal):
        return GoalResponse.REJECT if goal.order == 3 else GoalResponse.ACCEPT

    def execute(self, handle):
        order = handle.request.order
        handle.abort() if order == 2 else handle.succeed()
        return Fibonacci.Result(sequence=[order, 10])


ENDS = ["succeeded", "aborted", "preempted"]
"""

GOALS = """
node = rclpy.create_node("goals")
server = Counting(node)
machine = Sequence([*ENDS, "counted"], "succeeded")
machine.userdata["goal"] = Fibonacci.Goal(order=1)
machine.userdata["order"] = 1
machine.userdata["number"] = 1
spoilt = Fibonacci.Goal(order=2)


def replaced(userdata, goal):
    return Fibonacci.Goal(order=userdata.order)


def changed(userdata, goal, *numbers, **named):
    goal.order = sum(numbers) + named.get("more", 0)


@cb_interface(input_keys=["goal"])
def taken(userdata, goal):
    return userdata.goal


class Keys(RosState):
    '''Ends as succeeded if it gets its keys.'''

    def __init__(self, node, keys):
        RosState.__init__(self, node, outcomes=["succeeded", "aborted"], input_keys=keys)
        self.keys = keys

    def execute(self, userdata):
        self.node.get_logger().info(f"keys {self.keys}")
        return "succeeded" if all(key in userdata for key in self.keys) else "aborted"


def store(userdata, status, result, *more, **named):
    userdata.stored = list(result.sequence) + [*more, *named.values()]


def state(**arguments):
    return SimpleActionState(node, "count", Fibonacci, **arguments)


with machine:
    Sequence.add("GOAL", state(goal=Fibonacci.Goal(order=1)))
    Sequence.add("KEY", state(goal_key="goal"))
    Sequence.add("SLOT", state(goal_slots=["order"]))
    Sequence.add("REMAPPED", state(goal_slots=["order"]), remapping={"order": "number"})
    Sequence.add("REPLACED", state(goal_cb=replaced, input_keys=["order"]))
    Sequence.add("TAKEN", state(goal_cb=taken))
    Sequence.add("LAMBDA", state(goal_cb=lambda userdata, goal: Fibonacci.Goal(order=1)))
    Sequence.add("ARGS", state(goal_cb=changed, goal_cb_args=[1]))
    Sequence.add("KWARGS", state(goal_cb=changed, goal_cb_kwargs={"more": 1}))
    Sequence.add("BOTH", state(goal_cb=changed, goal_cb_args=[3], goal_cb_kwargs={"more": -2}))
    Sequence.add("SLOT_WINS", state(goal=spoilt, goal_slots=["order"]))
    change = CBInterface(lambda userdata, goal: setattr(goal, "order", 1), output_keys=["order"])
    Sequence.add("FUNCTION_WINS", state(goal=spoilt, goal_cb=change))
    Sequence.add("RESULT", state(goal_key="goal", result_key="result"))
    Sequence.add("HAS_RESULT", Keys(node, ["result"]))
    Sequence.add("SEQUENCE", state(goal_key="goal", result_slots=["sequence"]))
    Sequence.add("HAS_SEQUENCE", Keys(node, ["sequence"]))
    renamed = {"sequence": "numbers"}
    Sequence.add("NUMBERS", state(goal_key="goal", result_slots=["sequence"]), remapping=renamed)
    Sequence.add("HAS_NUMBERS", Keys(node, ["numbers"]))
    Sequence.add("STORED", state(
        goal_key="goal", result_cb=store, result_cb_args=[20], result_cb_kwargs={"last": 30},
        output_keys=["stored"],
    ))
    Sequence.add("ABORTED", state(goal=spoilt), {"aborted": "REJECTED"})
    Sequence.add("REJECTED", state(goal=Fibonacci.Goal(order=3)), {"aborted": "COUNTED"})
    Sequence.add("COUNTED", state(
        goal_key="goal",
        result_cb=CBInterface(lambda userdata, status, result: "counted", outcomes=["counted"]),
    ))
executor = SingleThreadedExecutor()
thread = spin(node, executor)
print("outcome:", machine.execute())
print("stored:", machine.userdata.stored, spoilt.order)
finish(executor, thread)
"""

POSITIONS = """
node = SmachNode("positions")
node.start()
server = Counting(node)


def answer(request, response):
    response.success, response.message = request.data, "called"
    return response


node.create_service(SetBool, "enable", answer)
calls = []


def goal_cb(userdata, goal, first, last):
    calls.append(("goal", userdata.more, first, last))


def result_cb(userdata, status, result, first, last):
    calls.append(("result", status, list(result.sequence), first, last))
    userdata.out = 1
    return "done"


def request_cb(userdata, request, first, last):
    calls.append(("request", userdata.more, request.data, first, last))


def response_cb(userdata, response, first, last):
    calls.append(("response", response.message, first, last))
    return "done"


def watched(userdata, message):
    userdata.out = message.data + userdata.more
    return message.data < 3


def condition(userdata):
    calls.append(("condition", userdata.more))
    return len([each for each in calls if each[0] == "condition"]) > 1


machine = StateMachine([*ENDS, "done"])
machine.userdata.goal = Fibonacci.Goal(order=2)
machine.userdata.request = SetBool.Request(data=False)
machine.userdata.order, machine.userdata.data, machine.userdata.more = 1, True, 7
with machine:
    StateMachine.add(
        "ACT",
        SimpleActionState(
            node, "count", Fibonacci,
            Fibonacci.Goal(), "goal", ["order"], goal_cb, ["a"], {"last": "b"},
            "result", ["sequence"], result_cb, ["c"], {"last": "d"},
            ["more"], ["out"], ["done"],
            Duration(seconds=20), Duration(seconds=20.0), rclpy.time.Duration(seconds=20),
        ),
        {"done": "CALL"},
    )
    StateMachine.add(
        "CALL",
        ServiceState(
            node, "enable", SetBool,
            SetBool.Request(), request_cb, ["e"], {"last": "f"}, "request", ["data"],
            response_cb, ["g"], {"last": "h"}, "response", ["message"],
            ["more"], [], ["done"],
        ),
        {"done": "CHECK"},
    )
    StateMachine.add(
        "CHECK", ConditionState(node, condition, ["more"], 50, Duration(seconds=20), 5),
        {"true": "WATCH", "false": "aborted"},
    )
    StateMachine.add(
        "WATCH", MonitorState(node, "numbers", Int32, watched, 9, ["more"], ["out"]),
        {"valid": "aborted", "invalid": "succeeded"},
    )
publisher = node.create_publisher(Int32, "numbers", 1)
numbers = iter(range(1000))
timer = node.create_timer(0.02, lambda: publisher.publish(Int32(data=next(numbers))))
print("outcome:", machine.execute())
for each in calls:
    print(each)
data = machine.userdata
print("data:", list(data.sequence), data.response.success, data.message, data.out >= 10)
node.destroy_timer(timer)
rclpy.shutdown()
node.join()
print("threads left:", [each.name for each in threading.enumerate()][1:])
"""

WRAPPED = """
node = rclpy.create_node("wrapped")
server = Counting(node)


@cb_interface(input_keys=["action_result"], output_keys=["action_result"])
def passed_on(userdata, status, result):
    userdata.action_result.sequence = [*result.sequence, 5]


inner = Sequence(ENDS, "succeeded")
with inner:
    Sequence.add("KEY", SimpleActionState(node, "count", Fibonacci, goal_key="action_goal"))
    Sequence.add("SLOT", SimpleActionState(node, "count", Fibonacci, goal_slots=["order"]))
    Sequence.add("RESULT", SimpleActionState(
        node, "count", Fibonacci, goal=Fibonacci.Goal(order=1), result_cb=passed_on
    ))
ActionServerWrapper(
    node, "wrapped", Fibonacci, inner, ["succeeded"], ["aborted"], ["preempted"],
    "action_goal", "action_feedback", "action_result", {"order": "copy"}, {}, {}, True, False,
)


class Slow(RosState):
    '''Checks for a preempt request; the rate of the node sets its pace.'''

    def __init__(self, node):
        super().__init__(node, outcomes=ENDS)

    def execute(self, userdata):
        print("slow", flush=True)
        runs.set()
        rate = self.node.create_rate(50)
        while rclpy.ok():
            if self.preempt_requested():
                self.service_preempt()
                return "preempted"
            rate.sleep()
        return "aborted"


runs = threading.Event()
slow = Sequence(ENDS, "succeeded")
with slow:
    Sequence.add("SLOW", Slow(node))
wrapper = ActionServerWrapper(
    node=node, server_name="slow", action_spec=Fibonacci, wrapped_container=slow,
    succeeded_outcomes=["succeeded"], aborted_outcomes=["aborted"],
    preempted_outcomes=["preempted"],
)
executor = MultiThreadedExecutor(3)
thread = spin(node, executor)


def ended(name, cancelled=False):
    client = ActionClient(node, Fibonacci, name)
    client.wait_for_server()
    accepted, done, results = threading.Event(), threading.Event(), []
    future = client.send_goal_async(Fibonacci.Goal(order=1))
    future.add_done_callback(lambda _: accepted.set())
    accepted.wait()
    if cancelled:
        runs.wait()
        future.result().cancel_goal_async()
    response = future.result().get_result_async()
    response.add_done_callback(lambda _: done.set())
    done.wait()
    return response.result().status, list(response.result().result.sequence)


print("ended:", ended("wrapped"), ended("slow", cancelled=True))
finish(executor, thread)
"""

VIEWED = """
class First(State):
    def __init__(self):
        State.__init__(self, ["done"], [], ["seen"])

    def execute(self, userdata):
        userdata.seen = True
        return "done"


class Never(State):
    def __init__(self):
        State.__init__(self, ["done"])

    def execute(self, userdata):
        raise RuntimeError("the machine starts elsewhere")


machine, inner = StateMachine(["done"]), StateMachine(["done"])
with machine:
    StateMachine.add("NEVER", Never(), {"done": "INNER"})
    StateMachine.add("INNER", inner, {"done": "done"})
    with inner:
        StateMachine.add("FIRST", First(), {})
machine.set_initial_state(["NEVER"])
viewed = IntrospectionServer("viewed", machine, "/viewed")
starting = threading.Thread(target=viewed.start)
starting.start()
client = IntrospectionClient()
while "/viewed" not in client.get_servers():
    pass
userdata = UserData()
done = client.set_initial_state(
    "viewed", "/viewed", ["INNER"], userdata, timeout=rclpy.time.Duration(seconds=20)
)
print("set:", done)
print("outcome:", machine.execute(), inner.userdata.seen)
starting.join()
viewed.stop()
viewed.clear()
rclpy.shutdown()
"""

STOPPED = """
node = SmachNode("stopped")
node.start()
server = Counting(node)
machine = StateMachine(ENDS)
entered = threading.Event()


def never(userdata):
    entered.set()
    return False


with machine:
    StateMachine.add("WAIT", ConditionState(node, never, max_checks=-1), {
        "true": "succeeded", "false": "aborted", "preempted": "preempted",
    })
set_preempt_handler(machine)
outcomes = []
runner = threading.Thread(target=lambda: outcomes.append(machine.execute()))
runner.start()
entered.wait()
rclpy.shutdown()
runner.join()
node.join()
print("outcome:", *outcomes)
"""


def test_goals_and_results(graph2: Graph) -> None:
    output = graph2.run(START + GOALS)
    assert "outcome: counted" in output, output
    assert "stored: [1, 10, 20, 30] 2" in output


def test_arguments_by_position(graph2: Graph) -> None:
    output = graph2.run(START + POSITIONS)
    assert "outcome: succeeded" in output, output
    assert [line for line in output.splitlines() if line.startswith("(")] == [
        "('goal', 7, 'a', 'b')",
        "('result', 4, [1, 10], 'c', 'd')",
        "('request', 7, True, 'e', 'f')",
        "('response', 'called', 'g', 'h')",
        "('condition', 7)",
        "('condition', 7)",
    ]
    assert "data: [1, 10] True called True" in output


def test_a_wrapper_its_states_and_its_client_on_one_node(graph2: Graph) -> None:
    output = graph2.run(START + WRAPPED)
    assert "ended: (4, [1, 10, 5]) (5, [])" in output, output


def test_a_client_sets_the_initial_state_before_the_start(graph2: Graph) -> None:
    program = graph2.start(START + VIEWED)
    assert program.end() == 0, program.output
    assert "set: True" in program.output
    assert "outcome: done True" in program.output


def test_a_shutdown_preempts_the_machine(graph2: Graph) -> None:
    program = graph2.start(START + STOPPED)
    assert program.end() == 0, program.output
    assert "outcome: preempted" in program.output
