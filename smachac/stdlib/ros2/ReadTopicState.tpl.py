{% block imports %}
from smachac.runtime.smach_ros2.topics import ReadTopicState
{% endblock %}
