"""The quality of service of ROS 2 topics as data."""

from __future__ import annotations

from typing import Any

import pytest

from smachac.runtime import ros2_qos

DEFAULT = {
    "reliability": "reliable",
    "durability": "volatile",
    "history": "keep_last",
    "depth": 10,
}


@pytest.mark.parametrize(
    ("value", "stated"),
    [
        (None, {}),
        (3, {"depth": 3}),
        ("default", {}),
        ("sensor_data", {"reliability": "best_effort", "depth": 5}),
        ("latched", {"durability": "transient_local", "depth": 1}),
        ({"durability": "transient_local"}, {"durability": "transient_local"}),
        ({"preset": "sensor_data", "depth": 2}, {"reliability": "best_effort", "depth": 2}),
    ],
)
def test_policies_of_a_value(value: Any, stated: dict[str, Any]) -> None:
    assert ros2_qos.faults(value) == []
    assert ros2_qos.policies(value) == {**DEFAULT, **stated}


@pytest.mark.parametrize(
    ("value", "fault"),
    [
        ("fast", "no preset `fast`; its presets are default, sensor_data"),
        (0, "the depth of `qos` must be a positive whole number, not `0`"),
        (True, "the depth of `qos` must be a positive whole number, not `True`"),
        ({"depth": "5"}, "the depth of `qos` must be a positive whole number, not `5`"),
        (
            {"reliability": "good"},
            "`reliability` of `qos` must be reliable or best_effort, not `good`",
        ),
        (
            {"speed": 1},
            "no policy `speed`; its policies are reliability, durability, history, depth",
        ),
        ({"preset": "fast"}, "no preset `fast`"),
    ],
)
def test_faults_of_a_value(value: Any, fault: str) -> None:
    ((text, *_),) = ros2_qos.faults(value)
    assert fault in text
