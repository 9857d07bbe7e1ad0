{% extends "State.tpl.py" %}
{% block imports %}
from smachac.runtime.smach_ros2.publish_states import PublishObserverMsgState
{% endblock %}
{% block cb_defs %}{% endblock cb_defs %}
{% block body %}
{{ add("PublishObserverMsgState", "node" | code, action, "smacha/" ~ name | lower, sub_topic=sub_topic, input_keys=inputs if input_keys is defined, output_keys=output_keys, qos=qos, subscriber_wait_timeout=subscriber_wait_timeout) }}
{% endblock body %}
