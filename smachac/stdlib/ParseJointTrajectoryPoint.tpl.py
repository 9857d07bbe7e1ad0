{% block imports %}
import rospy
from trajectory_msgs.msg import JointTrajectoryPoint
{% endblock %}
{% block defs %}
def parse_jointtrajectorypoint(data):
    """Convert a list of joint positions to a JointTrajectoryPoint."""
    if isinstance(data, JointTrajectoryPoint):
        return data
    return JointTrajectoryPoint(positions=[float(each) for each in data])
{% endblock %}
