"""smach_ros2 where there is no ROS 2: the import names what is missing."""

from __future__ import annotations

import sys
from importlib import import_module

import pytest


def test_the_import_names_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "rclpy", None)
    monkeypatch.delitem(sys.modules, "smachac.runtime.smach_ros2", raising=False)
    with pytest.raises(ImportError, match=r"needs ROS 2, .* pip install ros-kilted-rclpy"):
        import_module("smachac.runtime.smach_ros2")
