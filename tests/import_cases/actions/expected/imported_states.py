# Imported from ../machine.py by smachac; the lines below have the sha256 7bbcd73e9f147de3.
"""Classes for the states of the scripts in this folder."""

try:
    import smach_ros
except ImportError:  # without SMACH
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
