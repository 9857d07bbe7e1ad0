"""Services that answer, raise, crash, hang, and answer when they are told to."""

from __future__ import annotations

import os
import threading
from typing import Any

import rospy
from client import say, wait_for_line
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse


def answer(request: Any) -> Any:
    return SetBoolResponse(success=request.data, message="yes" if request.data else "no")


def fail(request: Any) -> Any:
    raise ValueError("not today")


def crash(request: Any) -> Any:
    say("called")
    os._exit(1)


def hang(request: Any) -> Any:
    say("called")
    threading.Event().wait()


def ponder(request: Any) -> Any:
    say("called")
    wait_for_line()
    return answer(request)


rospy.init_node("service_server")
for service in (answer, fail, crash, hang, ponder):
    rospy.Service(service.__name__, SetBool, service)
rospy.Service("gripper", Trigger, lambda request: TriggerResponse(success=True))
say("ready")
rospy.spin()
