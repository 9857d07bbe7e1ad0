{% block imports %}
import rospy
from trajectory_msgs.msg import JointTrajectoryPoint
{% endblock %}
{% block defs %}
def parse_jointtrajectorypoint(data):
    """A JointTrajectoryPoint of a list of positions, or one itself."""
    if isinstance(data, JointTrajectoryPoint):
        return data
    return JointTrajectoryPoint(positions=[float(each) for each in data])
{% endblock %}
