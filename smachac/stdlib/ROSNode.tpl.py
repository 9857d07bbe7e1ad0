{% include "StopSignals.tpl.py" %}


def start_node(name):
    """Start a ROS node, which the first signal shuts down."""
    rospy.init_node(name, disable_signals=True)
    stop_at_signals(lambda: rospy.signal_shutdown("signal"))


def preempt_at_shutdown(machine):
    """Preempt a state machine before the node shuts down and wait up to 5 s."""

    def preempt():
        end = time.monotonic() + 5.0
        machine.request_preempt()
        while machine.is_running():
            if time.monotonic() > end:
                smach.logwarn(
                    "the state machine did not end within 5 s: the node shuts down"
                )
                break
            time.sleep(0.02)

    rospy.on_shutdown(preempt)
