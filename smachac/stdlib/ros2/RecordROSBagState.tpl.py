{% extends "State.tpl.py" %}
{% block imports %}
from smachac.runtime.smach_ros2.bag_states import RecordROSBagState
{% endblock %}
{% block cb_defs %}{% endblock cb_defs %}
{% block body %}
{{ add("RecordROSBagState", "node" | code, action, input_keys=inputs if input_keys is defined, output_keys=output_keys) }}
{% endblock body %}
