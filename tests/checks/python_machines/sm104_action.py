"""An outcome of an action without a transition."""

import actionlib_msgs.msg
import smach
import smach_ros


def action():
    sm = smach.StateMachine(outcomes=["done"])
    with sm:
        move = smach_ros.SimpleActionState("move", actionlib_msgs.msg.GoalStatus)
        sm.add("MOVE", move, {"succeeded": "done"})
    return sm
