{% block meta %}
name: ROSHelp
description: Functions that the ROS states share.
type: None
{% endblock meta %}
{% block imports %}
import rospy
{% endblock %}
{% block defs %}
def optional(userdata, key, default=None):
    """The value of a userdata key, or the default if the key is absent."""
    return userdata[key] if key in userdata else default


def write_keys(userdata, outputs, names, value):
    """Write a value to each of the names that is an output key."""
    for name in names:
        if name in outputs:
            userdata[name] = value


def must_stop(state):
    """True after a preempt request and during the shutdown of the node."""
    return state.preempt_requested() or rospy.is_shutdown()


def preempted_or_aborted(state):
    """The outcome `preempted` after a preempt request, otherwise `aborted`."""
    if state.preempt_requested() and "preempted" in state.get_registered_outcomes():
        state.service_preempt()
        return "preempted"
    return "aborted"
{% endblock %}
