"""Ready-made states: two are built-in types, one has an outcome of its callback."""
import smach
import smach_ros
from std_srvs.srv import SetBool, SetBoolRequest
from std_msgs.msg import Bool
from nav_of_mine.msg import GoAction, GoGoal


@smach.cb_interface(input_keys=['goal_x'], output_keys=['way'], outcomes=['too_far'])
def reached(userdata, status, result):
    userdata.way = result.length
    if result.length > userdata.goal_x * 3:
        return 'too_far'


def fill(userdata, goal):
    goal.x = userdata.goal_x
    return goal


def quiet(userdata, message):
    return not message.data


sm = smach.StateMachine(outcomes=['there', 'failed'], input_keys=['goal_x'])
sm.userdata.on = True
with sm:
    smach.StateMachine.add('GO', smach_ros.SimpleActionState('go', GoAction, goal_cb=fill, result_cb=reached,
                                                             input_keys=['goal_x']),
                           transitions={'succeeded': 'LAMP', 'aborted': 'failed', 'preempted': 'failed',
                                        'too_far': 'failed'})
    smach.StateMachine.add('LAMP', smach_ros.ServiceState('lamp', SetBool, request_slots=['data'],
                                                          input_keys=['data']),
                           transitions={'succeeded': 'WATCH', 'preempted': 'failed', 'aborted': 'failed'},
                           remapping={'data': 'on'})
    smach.StateMachine.add('WATCH', smach_ros.MonitorState('bumper', Bool, quiet, max_checks=3),
                           transitions={'valid': 'there', 'invalid': 'failed', 'preempted': 'failed'})
