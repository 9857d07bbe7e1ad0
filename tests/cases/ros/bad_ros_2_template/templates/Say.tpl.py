{% block meta %}
name: Say
description: Writes to the log of ROS.
outcomes:
- succeeded
{% endblock meta %}
{% block imports %}
import rospy
{% endblock imports %}
{% block class_defs %}
class Say(smach.State):
    def __init__(self):
        super().__init__(outcomes=["succeeded"])

    def execute(self, userdata):
        rospy.loginfo("here")
        return "succeeded"
{% endblock class_defs %}
