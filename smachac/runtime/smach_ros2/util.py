"""set_preempt_handler, under the name that its module has in smach_ros."""

from __future__ import annotations

from smachac.runtime.smach_ros2.signals import set_preempt_handler

__all__ = ["set_preempt_handler"]
