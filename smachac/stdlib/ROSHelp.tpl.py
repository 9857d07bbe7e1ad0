{% block meta %}
name: ROSHelp
description: What the ROS states have in common.
type: None
{% endblock meta %}
{% block imports %}
import rospy
{% endblock %}
{% block defs %}
def optional(userdata, key, default=None):
    """The value under a key that may be absent."""
    return userdata[key] if key in userdata else default


def give(userdata, outputs, names, value):
    """Write a value to those of the names that are outputs."""
    for name in names:
        if name in outputs:
            userdata[name] = value


def stopping(state):
    """Whether a state is to end: it is asked to, or the node shuts down."""
    return state.preempt_requested() or rospy.is_shutdown()


def given_up(state):
    """The outcome of a state that was stopped."""
    if state.preempt_requested() and "preempted" in state.get_registered_outcomes():
        state.service_preempt()
        return "preempted"
    return "aborted"
{% endblock %}
