"""An action server whose goals tell it what to do; see `WORK`."""

from __future__ import annotations

import os
import threading

import actionlib
import rospy
from actionlib.msg import TestAction, TestFeedback, TestGoal, TestResult
from client import say

CANCELLED = threading.Event()


def succeed() -> None:
    server.set_succeeded(TestResult(result=42))


def abort() -> None:
    server.set_aborted(TestResult(result=7))


def until_cancelled() -> None:
    server.publish_feedback(TestFeedback(feedback=41))
    CANCELLED.wait()
    say("cancelled")
    server.set_preempted(TestResult(result=3))


def deaf() -> None:
    CANCELLED.wait()
    say("cancelled")
    threading.Event().wait()


def crash() -> None:
    os._exit(1)


def preempt_itself() -> None:
    server.set_preempted(TestResult(result=6))


def finish_when_cancelled() -> None:
    CANCELLED.wait()
    server.set_succeeded(TestResult(result=7))


WORK = {
    1: succeed,
    2: abort,
    3: until_cancelled,
    4: deaf,
    5: crash,
    6: preempt_itself,
    7: finish_when_cancelled,
}


def execute(goal: TestGoal) -> None:
    CANCELLED.clear()
    say(f"goal {goal.goal}")
    if server.is_preempt_requested():
        CANCELLED.set()
    WORK[goal.goal]()


rospy.init_node("action_server")
server = actionlib.SimpleActionServer("work", TestAction, execute, auto_start=False)
server.register_preempt_callback(CANCELLED.set)
server.start()
say("ready")
rospy.spin()
