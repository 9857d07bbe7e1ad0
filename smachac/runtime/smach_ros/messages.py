"""The message types of smach_msgs, generated when needed, as Debian has no such package.

ROS identifies a message type by a checksum (MD5) over its fields, their types and their order. They
are those of SMACH 2.5 for ROS 1, so SMACH's viewer reads the messages; tests/ros holds the sums.
"""

from __future__ import annotations

import functools
from typing import Any

from smachac.runtime.smach_ros import ros

HEADER = """
================================================================================
MSG: std_msgs/Header
uint32 seq
time stamp
string frame_id
"""

STATUS = """Header header
string path
string[] initial_states
string[] active_states
string local_data
string info
"""
"""The status of a container. local_data: its userdata as a dict, pickled, in base 64."""

STRUCTURE = """Header header
string path
string[] children
string[] internal_outcomes
string[] outcomes_from
string[] outcomes_to
string[] container_outcomes
"""
"""The structure of a container. A transition has an entry in each of the three outcome lists."""

COMMAND = """string path
string[] initial_states
string local_data
"""
"""The command that sets the initial states of a container."""


@functools.cache
def message(name: str, text: str) -> Any:
    """The class of the message `smach_msgs/<name>`; cached, as a type may exist only once."""
    full = f"smach_msgs/{name}"
    return ros.load("genpy.dynamic").generate_dynamic(full, text)[full]


def container_status() -> Any:
    """The class SmachContainerStatus."""
    return message("SmachContainerStatus", STATUS + HEADER)


def container_structure() -> Any:
    """The class SmachContainerStructure."""
    return message("SmachContainerStructure", STRUCTURE + HEADER)


def initial_status_command() -> Any:
    """The class SmachContainerInitialStatusCmd."""
    return message("SmachContainerInitialStatusCmd", COMMAND)
