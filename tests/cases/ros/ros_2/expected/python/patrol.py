# Made by smachac 0.1.0 from main.yml (sha256 b60880ba9ee335fa).
"""The state machine `patrol`."""

from smachac.runtime.installed import smach, smach_ros
from smachac.runtime.smach_ros2 import program
from smachac.runtime.smach_ros2.bag_states import RecordROSBagState
from smachac.runtime.smach_ros2.message_fields import checking, filled
from smachac.runtime.smach_ros2.publish_states import PublishMsgState, PublishObserverMsgState
from smachac.runtime.smach_ros2.ros import duration
from smachac.runtime.smach_ros2.topics import ReadTopicState, WaitForMsgState
from smachac.runtime.smach_ros2.transform_states import TF2ListenerState, TransformMsgState
from std_msgs.msg import Float32
from std_srvs.srv import SetBool, Trigger
from test_msgs.action import Fibonacci


def build(node, battery_topic="/battery", patience=60.0, mode="rotation"):
    """Build the state machine `patrol`."""
    patrol = smach.StateMachine(outcomes=["succeeded", "aborted", "preempted"])  # main.yml:2
    patrol.userdata.order = 3
    patrol.userdata.file = "run.bag"
    patrol.userdata.topics = ["/battery"]
    patrol.userdata.msg = [1.0, 2.0, 0.0]
    patrol.userdata.topic = "goal"
    patrol.userdata.frame_id = "map"
    patrol.userdata.target = "map"
    patrol.userdata.source = "base"
    with patrol:
        smach.StateMachine.add(  # main.yml:19
            "RECORD",
            RecordROSBagState(node, "start"),
            transitions={"succeeded": "COUNT", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:23
            "COUNT",
            smach_ros.SimpleActionState(
                node,
                "count",
                Fibonacci,
                goal_slots=["order"],
                goal_cb=checking(Fibonacci.Goal),
                result_slots=["sequence"],
                exec_timeout=duration(patience),
                server_wait_timeout=duration(5.0),
            ),
            transitions={
                "succeeded": "COUNT_AGAIN",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:32
            "COUNT_AGAIN",
            smach_ros.SimpleActionState(
                node, "count", Fibonacci, goal=filled(Fibonacci.Goal(), {"order": 5})
            ),
            transitions={"succeeded": "ENABLE", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:38
            "ENABLE",
            smach_ros.ServiceState(
                node,
                "enable",
                SetBool,
                request=filled(SetBool.Request(), {"data": True}),
                response_slots=["message"],
            ),
            transitions={"succeeded": "DOCK", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:45
            "DOCK",
            smach_ros.ServiceState(
                node,
                "dock",
                Trigger,
                request=Trigger.Request(),
                request_cb=checking(Trigger.Request),
            ),
            transitions={"succeeded": "BATTERY", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:51
            "BATTERY",
            WaitForMsgState(
                node,
                battery_topic,
                Float32,
                msg_cb=lambda message, userdata: message.data > 0.2,
                timeout=patience,
            ),
            transitions={"succeeded": "READ", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:58
            "READ",
            ReadTopicState(node, input_keys=["topic"], output_keys=["output"]),
            transitions={"succeeded": "WATCH", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:63
            "WATCH",
            smach_ros.MonitorState(
                node,
                battery_topic,
                Float32,
                lambda userdata, message: message.data > 0.2,
                max_checks=3,
            ),
            transitions={"valid": "CHECK", "invalid": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:70
            "CHECK",
            smach_ros.ConditionState(
                node,
                lambda userdata: True,
                poll_rate=duration(0.1),
                timeout=duration(10.0),
                max_checks=-1,
            ),
            transitions={"true": "FRAME", "false": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:77
            "FRAME",
            TF2ListenerState(node),
            transitions={
                "succeeded": "MOVE_POINT",
                "aborted": "aborted",
                "preempted": "preempted",
            },
        )

        smach.StateMachine.add(  # main.yml:80
            "MOVE_POINT",
            TransformMsgState(
                node,
                transform_type=mode,
                input_keys=["msg", "frame_id"],
                output_keys=["output_msg"],
            ),
            transitions={"succeeded": "PUBLISH", "aborted": "aborted", "preempted": "preempted"},
        )

        smach.StateMachine.add(  # main.yml:86
            "PUBLISH",
            PublishMsgState(node, "start", "smacha/publish", input_keys=["msg", "topic", "rate"]),
            transitions={"succeeded": "ECHO", "aborted": "aborted"},
        )

        smach.StateMachine.add(  # main.yml:91
            "ECHO",
            PublishObserverMsgState(
                node, "add", "smacha/echo", sub_topic=battery_topic, input_keys=["msg", "topic"]
            ),
            transitions={"succeeded": "succeeded", "aborted": "aborted"},
        )
    return patrol


def main(arguments=None):
    """Run the state machine once in a ROS node and return its outcome."""
    return program.run_once(
        "patrol", build, arguments, choices={"mode": ["transform", "translation", "rotation"]}
    )


if __name__ == "__main__":
    raise SystemExit(program.run_main(main, failures=["aborted", "preempted"]))
