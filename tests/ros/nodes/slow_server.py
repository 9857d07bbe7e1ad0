"""An action server that begins no goal: `pending` says when one is recalled, `deaf` nothing."""

from __future__ import annotations

import sys

import actionlib
import rospy
from actionlib.msg import TestAction, TestActionFeedback, TestActionGoal, TestActionResult
from actionlib_msgs.msg import GoalID, GoalStatusArray
from client import say


def pending() -> None:
    server = actionlib.ActionServer(
        "work",
        TestAction,
        lambda goal: say("goal"),
        lambda goal: goal.set_canceled(),
        auto_start=False,
    )
    server.start()
    say("ready")
    rospy.spin()


def deaf() -> None:
    """Has the topics of a server, and reports on no goals."""
    rospy.Subscriber("work/goal", TestActionGoal, lambda goal: say("goal"))
    rospy.Subscriber("work/cancel", GoalID, lambda goal: say("cancel"))
    rospy.Publisher("work/result", TestActionResult, queue_size=1)
    rospy.Publisher("work/feedback", TestActionFeedback, queue_size=1)
    status = rospy.Publisher("work/status", GoalStatusArray, queue_size=1)
    say("ready")
    while not rospy.is_shutdown():
        status.publish(GoalStatusArray())
        rospy.rostime.wallsleep(0.02)


rospy.init_node("slow_server")
{"pending": pending, "deaf": deaf}[sys.argv[1]]()
