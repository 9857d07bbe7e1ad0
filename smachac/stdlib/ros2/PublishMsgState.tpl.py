{% extends "State.tpl.py" %}
{% block imports %}
from smachac.runtime.smach_ros2.publish_states import PublishMsgState
{% endblock %}
{% block cb_defs %}{% endblock cb_defs %}
{% block body %}
{{ add("PublishMsgState", "node" | code, action, "smacha/" ~ name | lower, input_keys=inputs if input_keys is defined, output_keys=output_keys, qos=qos, subscriber_wait_timeout=subscriber_wait_timeout) }}
{% endblock body %}
