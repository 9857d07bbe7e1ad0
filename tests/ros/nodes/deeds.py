"""States of a user that programs of the tests import."""

from __future__ import annotations

import threading
from typing import Any

import rospy
from client import say, wait_for_line

from smachac.runtime import smach


class Deed(smach.State):
    """Does one of the things below."""

    def __init__(self, deed: str) -> None:
        super().__init__(["succeeded"])
        self.deed = deed

    def execute(self, userdata: Any) -> str:
        say(f"begins to {self.deed}")
        {"ask": ask, "listen": listen, "wait": wait}[self.deed](self)
        return "succeeded"


def ask(state: smach.State) -> None:
    """Ask the master for something, and tell when its answer is waited for; wait for a request."""
    lock = rospy.core.xmlrpcapi(rospy.core.rosgraph.get_master_uri())._lock

    def watch() -> None:
        while not lock.locked():
            rospy.rostime.wallsleep(0.001)
        say("asked")

    wait_for_line()
    threading.Thread(target=watch, daemon=True).start()
    rospy.get_param("/nothing", None)
    while not state.preempt_requested():
        rospy.rostime.wallsleep(0.01)


def listen(state: smach.State) -> None:
    """Look at nothing but whether the node shuts down."""
    while not rospy.is_shutdown():
        rospy.rostime.wallsleep(0.01)


def wait(state: smach.State) -> None:
    """Wait for ever."""
    threading.Event().wait()
