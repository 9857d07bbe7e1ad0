"""The messages of smach_msgs, made when needed: Debian has no such package.

What rospy's tools and SMACH's viewer on other machines go by is the checksum (MD5) over the fields,
their types and their order, here those of SMACH 2.5 for ROS 1. tests/ros holds the sums.
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
"""What a container does now. local_data: its userdata, a dict, pickled and in base 64."""

STRUCTURE = """Header header
string path
string[] children
string[] internal_outcomes
string[] outcomes_from
string[] outcomes_to
string[] container_outcomes
"""
"""What a container is made of; one entry in each of three lists for a transition."""

COMMAND = """string path
string[] initial_states
string local_data
"""
"""The order to start a container elsewhere from now on."""


@functools.cache
def message(name: str, text: str) -> Any:
    """The class of the message `smach_msgs/<name>`."""
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
