{% block imports %}
from smachac.runtime.smach_ros2.transform_states import TF2ListenerState
{% endblock %}
