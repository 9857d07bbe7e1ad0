{% block imports %}
import rospy
import tf2_ros
{% endblock %}
{% block class_defs %}
class TF2ListenerSingleton:
    """The one listener to tf of this program, made when it is first asked for."""

    _made = None

    @classmethod
    def get(cls):
        """The buffer and the listener that fills it."""
        if cls._made is None:
            buffer = tf2_ros.Buffer()
            cls._made = (buffer, tf2_ros.TransformListener(buffer))
        return cls._made

    @classmethod
    def look_up(cls, state, target, source, timeout):
        """The newest transform, or None after `timeout` seconds or when the state is to stop."""
        buffer, _ = cls.get()
        end = rospy.Time.now() + rospy.Duration(timeout)
        while not stopping(state):
            # Short waits: tf2 asks nobody whether it is still wanted.
            if buffer.can_transform(target, source, rospy.Time(0), rospy.Duration(0.1)):
                return buffer.lookup_transform(target, source, rospy.Time(0))
            if rospy.Time.now() > end:
                smach.logwarn(f"no transform from {source} to {target} in {timeout} s")
                return None
        return None
{% endblock %}
