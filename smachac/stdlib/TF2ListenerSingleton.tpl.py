{% block imports %}
import rospy
import tf2_ros
{% endblock %}
{% block class_defs %}
class TF2ListenerSingleton:
    """The tf2 listener of the program; the first call of `get` creates it."""

    _instance = None

    @classmethod
    def get(cls):
        """The tf2 buffer and the listener that fills it."""
        if cls._instance is None:
            buffer = tf2_ros.Buffer()
            cls._instance = (buffer, tf2_ros.TransformListener(buffer))
        return cls._instance

    @classmethod
    def look_up(cls, state, target, source, timeout):
        """The newest transform; None after `timeout` seconds or a preempt request."""
        buffer, _ = cls.get()
        end = rospy.Time.now() + rospy.Duration(timeout)
        while not must_stop(state):
            # Short waits, because a preempt request does not end a wait of tf2.
            if buffer.can_transform(target, source, rospy.Time(0), rospy.Duration(0.1)):
                return buffer.lookup_transform(target, source, rospy.Time(0))
            if rospy.Time.now() > end:
                smach.logwarn(f"no transform from {source} to {target} in {timeout} s")
                return None
        return None
{% endblock %}
