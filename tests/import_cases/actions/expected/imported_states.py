# Imported from machine.py by smachac; the lines below have the sha256 c3b7c770dd0a1f0a.
"""Classes for the states of the scripts in this folder."""

try:
    import smach
    import smach_ros
except ImportError:  # without SMACH
    from smachac.runtime import smach
    from smachac.runtime import smach_ros

import machine


class SimpleActionState_2(smach_ros.SimpleActionState):
    """../machine.py:28"""

    def __init__(self, action_name):
        super().__init__(
            action_name=action_name,
            action_spec=machine.GoAction,
            goal_cb=machine.fill,
            result_cb=machine.reached,
            outcomes=['succeeded', 'aborted', 'preempted', 'too_far'],
            input_keys=['goal_x'],
            output_keys=['way'],
        )
