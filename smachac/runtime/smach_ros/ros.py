"""Access to rospy and related packages, which are imported when they are first needed."""

from __future__ import annotations

import socket
from importlib import import_module
from typing import Any, Protocol, TypeAlias
from urllib.parse import urlsplit

from smachac.runtime import smach
from smachac.runtime.smach import log

PROBE_TIMEOUT = 1.0
"""Seconds that a node has to accept a connection; after them its state counts as unknown."""


class Duration(Protocol):
    """The interface of rospy.Duration."""

    def to_sec(self) -> float: ...


Time: TypeAlias = "Duration | float"
"""A duration: rospy.Duration, or a number of seconds."""


def load(name: str) -> Any:
    """The ROS module of that name. Raises ImportError with the packages to install."""
    try:
        return import_module(name)
    except ImportError as error:
        raise ImportError(
            f"smach_ros needs ROS 1, and this Python has none ({error}); on Debian: sudo apt-get "
            "install python3-rospy python3-actionlib, and run the program with the system's python3"
        ) from error


def rospy() -> Any:
    """The module rospy. SMACH gets its loggers and shutdown check, unless a script set others."""
    module = load("rospy")
    if (smach.loginfo, smach.logerr) == (log.loginfo, log.logerr):
        smach.set_loggers(module.loginfo, module.logwarn, module.logdebug, module.logerr)
    if smach.is_shutdown is log.is_shutdown:
        smach.set_shutdown_check(module.is_shutdown)
    return module


def seconds(time: Time | None) -> float | None:
    """A duration as a number of seconds; None stays None."""
    if time is None or isinstance(time, (int, float)):
        return time
    return time.to_sec()


def limit(time: Time | None) -> float | None:
    """A time limit as a number of seconds; None, and 0 as in smach_ros, means no limit."""
    return seconds(time) or None


def is_gone(node: str) -> bool:
    """Whether a node has certainly ended: unknown to the master, or its address refuses."""
    master = load("rosgraph").Master(rospy().get_name())
    try:
        address = urlsplit(master.lookupNode(node))
    except load("rosgraph").MasterError:
        return True
    except Exception:  # without a master the state of the node is unknown
        return False
    try:
        with socket.create_connection((address.hostname, address.port), PROBE_TIMEOUT):
            return False
    except ConnectionRefusedError:
        return True
    except OSError:
        return False
