"""SMACH and its states of ROS 2, as they are installed, else those of the bundled runtime.

`from smachac.runtime.installed import smach, smach_ros`: each import of the names looks for SMACH
again.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

BUNDLED = {"smach": "smachac.runtime.smach", "smach_ros": "smachac.runtime.smach_ros2"}
"""The packages of the bundled runtime by the names of those that they replace."""


def __getattr__(name: str) -> Any:
    """The package of a name. Raises AttributeError for another name."""
    if name not in BUNDLED:
        raise AttributeError(name)
    try:
        return import_module(name)
    except ImportError:
        return import_module(BUNDLED[name])
