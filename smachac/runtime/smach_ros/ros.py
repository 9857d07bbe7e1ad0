"""rospy and its neighbours, imported when they are first needed."""

from __future__ import annotations

import socket
from importlib import import_module
from typing import Any, Protocol, TypeAlias
from urllib.parse import urlsplit

from smachac.runtime import smach
from smachac.runtime.smach import log

PROBE = 1.0
"""Seconds that a node has to accept a connection before nothing can be said of it."""


class Duration(Protocol):
    """What rospy.Duration has."""

    def to_sec(self) -> float: ...


Time: TypeAlias = "Duration | float"
"""A length of time: rospy.Duration, or a number of seconds."""


def load(name: str) -> Any:
    """The ROS module of that name. Raises ImportError, with what to do, if there is none."""
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(
            f"smach_ros needs ROS 1, and this Python has none ({error}); on Debian: sudo apt-get "
            "install python3-rospy python3-actionlib, and run the program with the system's python3"
        ) from error


def rospy() -> Any:
    """The module rospy; SMACH's log and shutdown check are its from now on, unless replaced."""
    module = load("rospy")
    if (smach.loginfo, smach.logerr) == (log.loginfo, log.logerr):
        smach.set_loggers(module.loginfo, module.logwarn, module.logdebug, module.logerr)
    if smach.is_shutdown is log.is_shutdown:
        smach.set_shutdown_check(module.is_shutdown)
    return module


def seconds(time: Time | None) -> float | None:
    """A length of time as a number of seconds; None stays None."""
    if time is None or isinstance(time, (int, float)):
        return time
    return time.to_sec()


def limit(time: Time | None) -> float | None:
    """A length of time as a number of seconds; None, and 0 as in smach_ros, is without limit."""
    return seconds(time) or None


def is_gone(node: str) -> bool:
    """Whether a node is known to have ended: unknown to the master, or nobody at its address."""
    master = load("rosgraph").Master(rospy().get_name())
    try:
        address = urlsplit(master.lookupNode(node))
    except load("rosgraph").MasterError:
        return True
    except Exception:  # no master, no verdict
        return False
    try:
        with socket.create_connection((address.hostname, address.port), PROBE):
            return False
    except ConnectionRefusedError:
        return True
    except OSError:
        return False
