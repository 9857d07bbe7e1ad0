"""smach_ros where there is no ROS: it can be imported, and says what is missing when it is used."""

from __future__ import annotations

import sys
from collections.abc import Callable

import pytest

from smachac.runtime import smach, smach_ros
from smachac.runtime.smach_ros import ros


@pytest.mark.parametrize(
    "make",
    [
        lambda: smach_ros.ServiceState("name", object()),
        lambda: smach_ros.SimpleActionState("name", object()),
        lambda: smach_ros.MonitorState("name", object(), bool),
        lambda: smach_ros.ConditionState(bool),
        lambda: smach_ros.IntrospectionServer("name", smach.StateMachine(["done"]), "/ROOT"),
        smach_ros.IntrospectionClient,
        lambda: smach_ros.ActionServerWrapper("name", object(), smach.StateMachine(["done"])),
        lambda: smach_ros.set_preempt_handler(smach.StateMachine(["done"])),
    ],
)
def test_what_needs_ros_says_so(
    make: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "rospy", None)
    with pytest.raises(ImportError, match=r"needs ROS 1, .* apt-get install python3-rospy"):
        make()


def test_all_names_are_there() -> None:
    assert all(hasattr(smach_ros, name) for name in smach_ros.__all__)


class Lasting:
    """What stands for rospy.Duration here."""

    def to_sec(self) -> float:
        return 1.5


@pytest.mark.parametrize(("time", "seconds"), [(None, None), (2, 2), (0.5, 0.5), (Lasting(), 1.5)])
def test_lengths_of_time_are_seconds_or_durations(
    time: ros.Time | None, seconds: float | None
) -> None:
    assert ros.seconds(time) == seconds
